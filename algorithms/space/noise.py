"""What the noise of each plot is in space: its covariance, and the weight that follows from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.plots import PlotChunk

Array = NDArray[np.float64]

LEAST_DEVIATION = 1e-3
"""The least standard deviation of a plot, in metres: without any noise a test of a fit has no meaning."""


def in_space(chunk: PlotChunk, name: str) -> None:
    """Refuse plots that lie in the plane.

    Raises
    ------
    RequestError
        Where positions have no z.
    """
    if chunk.position.shape[1] < 3:
        raise RequestError(
            f"{name} works in space, and the plots have no z; give a column z, or a scenario in space"
        )


def covariances(chunk: PlotChunk, context: Context) -> Array:
    """Return the covariance of the noise of each plot, float64 (n, 3, 3).

    It is that which the plots bring; else the context's σ on each axis (the greatest for an axis
    that it does not tell). No standard deviation is less than `LEAST_DEVIATION`.

    Raises
    ------
    RequestError
        Where neither is known.
    """
    least = (LEAST_DEVIATION / context.unit.metres) ** 2
    if chunk.covariance is not None:
        return np.ascontiguousarray(chunk.covariance + least * np.eye(3))
    if context.sigma is None:
        raise RequestError("the noise is not known: give sigma, or plots of a sensor with known noise")
    sigma = [*context.sigma, *[max(context.sigma)] * 3][:3]
    one = np.diag(np.square(sigma)) + least * np.eye(3)
    return np.tile(one, (len(chunk.scan), 1, 1))
