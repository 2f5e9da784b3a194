"""Noise of plots: the covariance of each position."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.plots import PlotChunk

Array = NDArray[np.float64]

LEAST_DEVIATION = 1e-3
"""The least standard deviation of a plot, in metres: without any noise a test of a fit has no meaning."""

LEAST_SHARE = 1e-14
"""The least variance of a plot as a share of the sum over its axes: below it a covariance has no inverse."""


def covariances(chunk: PlotChunk, context: Context, dimensions: int) -> Array | None:
    """Return the covariances of the noise of plots in the first axes; None where the noise is not known.

    They are those that the plots bring; else the context's σ on each axis (the greatest for an axis
    that it does not tell). No standard deviation is less than `LEAST_DEVIATION`, no variance less
    than `LEAST_SHARE` of the sum of them.

    Parameters
    ----------
    dimensions : d, number of axes: 2 or 3

    Returns
    -------
    float64 (n, d, d), or (1, d, d) where all plots have the same
    """
    least = (LEAST_DEVIATION / context.unit.metres) ** 2
    if chunk.covariance is not None:
        return np.ascontiguousarray(enlarged(chunk.covariance[:, :dimensions, :dimensions], least))
    if context.sigma is None:
        return None
    sigma = [*context.sigma, *[max(context.sigma)] * dimensions][:dimensions]
    return enlarged(np.diag(np.square(sigma)), least)[None]


def enlarged(covariance: Array, least: float) -> Array:
    """Return covariances that have an inverse: each axis has so much more variance, or `LEAST_SHARE` of all.

    Parameters
    ----------
    covariance : float64 (…, d, d)
    """
    trace = np.trace(covariance, axis1=-2, axis2=-1)
    more = np.maximum(least, LEAST_SHARE * trace)[..., None, None]
    return np.asarray(covariance + more * np.eye(covariance.shape[-1]))
