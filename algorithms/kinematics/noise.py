"""Noise of plots: the covariance of each position."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.plots import PlotChunk

Array = NDArray[np.float64]

LEAST_DEVIATION = 1e-3
"""The least standard deviation of a plot, in metres: without any noise a test of a fit has no meaning."""


def covariances(chunk: PlotChunk, context: Context, dimensions: int) -> Array | None:
    """Return the covariances of the noise of plots in the first axes; None where the noise is not known.

    They are those that the plots bring; else the context's σ on each axis (the greatest for an axis
    that it does not tell). No standard deviation is less than `LEAST_DEVIATION`.

    Parameters
    ----------
    dimensions : d, number of axes: 2 or 3

    Returns
    -------
    float64 (n, d, d), or (1, d, d) where all plots have the same
    """
    least = (LEAST_DEVIATION / context.unit.metres) ** 2
    if chunk.covariance is not None:
        own = chunk.covariance[:, :dimensions, :dimensions]
        return np.ascontiguousarray(own + least * np.eye(dimensions))
    if context.sigma is None:
        return None
    sigma = [*context.sigma, *[max(context.sigma)] * dimensions][:dimensions]
    same: Array = np.diag(np.square(sigma)) + least * np.eye(dimensions)
    return same[None]
