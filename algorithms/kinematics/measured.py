"""Plots with their noise, as the kernels of kinematics take them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.kinematics.matrices import axes_of, inverses
from algorithms.plots import PlotChunk

Array = NDArray[np.float64]


class Measured(NamedTuple):
    """Plots of one batch, or of a chunk of batches.

    Attributes
    ----------
    position : float64 (n, ≥ d)
    time : float64 (n,)
    scan : int32 (n,)
    covariance : float64 (n, d, d), of the noise; (1, d, d) where all are the same; NaN where not known
    weight : float64 of the same shape, the inverses; 1 on the diagonal where the noise is not known
    """

    position: Array
    time: Array
    scan: NDArray[np.int32]
    covariance: Array
    weight: Array

    @classmethod
    def of(cls, chunk: PlotChunk, covariance: Array | None, dimensions: int) -> Measured:
        """Return the plots of a chunk with covariances as `noise.covariances` gives them."""
        if covariance is None:
            weight = np.eye(dimensions)[None]
            covariance = np.full_like(weight, np.nan)
        else:
            weight = inverses(covariance, axes_of(dimensions))
        return cls(np.ascontiguousarray(chunk.position), chunk.time, chunk.scan, covariance, weight)


@kernel
def own_row(measured, plot):  # type: ignore[no-untyped-def]
    """Return the row of a plot in `covariance` and `weight`: 0 where all plots share one."""
    return plot if len(measured.weight) > 1 else 0


@kernel
def part_of(measured, begin, end):  # type: ignore[no-untyped-def]
    """Return the plots from `begin` up to, not including, `end` (views, not copies)."""
    covariance, weight = measured.covariance, measured.weight
    if len(weight) > 1:
        covariance, weight = covariance[begin:end], weight[begin:end]
    return Measured(
        measured.position[begin:end], measured.time[begin:end], measured.scan[begin:end], covariance, weight
    )
