"""The cells in which recorded values lie, as far as the values themselves tell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.ellipse import width

LEAST = 8
"""Fewer different values may lie on a coarser grid by chance."""

PARTS = 6
"""The least difference of a few values may be so many cells."""

TOLERANCE = 0.02
"""By how much of a cell a difference may be off a whole number of cells; files round their values."""

NEAR = 20
"""Differences of up to so many cells tell how large one is before wider ones are looked at."""


def extent_of_cell(cell: float) -> float:
    """Return the extent of a set of points that lie in one cell."""
    return float(width(cell**2 / 12.0))


def cell_of(values: NDArray[np.float64], most: float) -> float:
    """Return the size of the cells in which values lie; 0 where they lie in none that can be told.

    Parameters
    ----------
    values : float64 (n,)
    most : the greatest extent of a target, which spreads over more than a cell

    Notes
    -----
    Whole numbers are numbers of cells, of size 1. Others lie in cells where all their differences are
    multiples of one step.
    """
    cell = 1.0 if np.all(values == np.rint(values)) else _step(np.diff(np.unique(values)))
    return cell if extent_of_cell(cell) <= most else 0.0


def _step(differences: NDArray[np.float64]) -> float:
    if len(differences) + 1 < LEAST:
        return 0.0
    # What rounding leaves of equal values is no difference.
    differences = differences[differences > 1e-9 * differences.sum()]
    for part in range(1, PARTS + 1):
        step = differences.min() / part
        for reach in (NEAR, np.inf):
            near = differences[differences <= reach * step]
            step = near.sum() / np.rint(near / step).sum()
        off = np.abs(differences / step - np.rint(differences / step))
        if off.max() <= TOLERANCE:
            # Twelve digits: sums of decimal fractions leave dust at the end.
            return float(f"{step:.12g}")
    return 0.0
