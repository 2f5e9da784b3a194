"""The voting kernels: plots into the cells of an accumulator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid

FIRST = 1
"""Column of an accumulator row that holds the grid's first column: the one before it takes
the votes below the grid, the one after the last takes those above."""


class GridArrays(NamedTuple):
    """A grid as the kernels take it.

    Attributes
    ----------
    cosine, sine : float64 (theta bins,), of the centres of the rows
    columns : number of ρ columns
    rho_min, rho_step : measured from `origin`
    origin : the point that is taken off the coordinates before they vote
    """

    cosine: NDArray[np.float64]
    sine: NDArray[np.float64]
    columns: int
    rho_min: float
    rho_step: float
    origin: tuple[float, float]

    @classmethod
    def of(cls, grid: Grid) -> GridArrays:
        """Return the arrays of a grid."""
        theta = grid.theta
        return cls(np.cos(theta), np.sin(theta), grid.rho_bins, grid.rho_min, grid.rho_step, grid.origin)

    def accumulator(self) -> NDArray[np.uint32]:
        """Return an empty accumulator, with a column on each side for the votes outside."""
        return np.zeros((len(self.cosine), self.columns + 2), dtype=np.uint32)


@kernel
def vote(x, y, grid, accumulator, columns):  # type: ignore[no-untyped-def]
    """Add one vote a row for each plot.

    Parameters
    ----------
    x, y : float64 (n,), measured from the grid's origin
    grid : `GridArrays`
    accumulator : uint32 (rows, ρ columns + 2), changed in place
    columns : int32 (≥ n,), working space

    Notes
    -----
    The columns of one row are worked out first, which the compiler turns into vector
    instructions, and counted afterwards: votes outside land in the two sentinel columns, so
    that neither loop has a branch.
    """
    top = float(accumulator.shape[1] - 1)
    for row in range(len(grid.cosine)):
        along_x, along_y = grid.cosine[row] / grid.rho_step, grid.sine[row] / grid.rho_step
        first = FIRST - grid.rho_min / grid.rho_step
        for plot in range(len(x)):
            column = x[plot] * along_x + y[plot] * along_y + first
            # Clamped while it is a float: beyond the integers the conversion has no defined result.
            # Written such that a column that is no number, ∞ − ∞, counts as outside, too.
            column = column if column > 0.0 else 0.0
            columns[plot] = np.int32(column if column < top else top)
        counts = accumulator[row]
        for plot in range(len(x)):
            counts[np.uint32(columns[plot])] += np.uint32(1)


@kernel
def votes_outside(accumulator):  # type: ignore[no-untyped-def]
    """Return the number of votes in the sentinel columns."""
    total = np.int64(0)
    for row in range(accumulator.shape[0]):
        total += np.int64(accumulator[row, 0]) + np.int64(accumulator[row, accumulator.shape[1] - 1])
    return total


@dataclass(frozen=True, slots=True)
class Accumulator:
    """The votes of one batch of plots.

    Attributes
    ----------
    grid : the quantisation
    votes : uint32 (theta bins, rho bins)
    votes_outside : votes that fell outside the grid
    std : float64 (theta bins, rho bins), the sample standard deviation of the ρ that voted for each
        cell, NaN where it is not defined; None for an initiator that does not work it out
    weighted : float64 (theta bins, rho bins), the weighted votes; None for one without
    """

    grid: Grid
    votes: NDArray[np.uint32]
    votes_outside: int
    std: NDArray[np.float64] | None = None
    weighted: NDArray[np.float64] | None = None

    @property
    def total(self) -> int:
        """Number of votes inside the grid."""
        return int(self.votes.sum(dtype=np.int64))

    @property
    def greatest(self) -> tuple[int, int]:
        """Row and column of the greatest cell, the first in θ-major order."""
        return divmod(int(np.argmax(self.votes)), self.grid.rho_bins)


def accumulate(position: NDArray[np.float64], grid: Grid) -> Accumulator:
    """Return the accumulator of plots.

    Parameters
    ----------
    position : float64 (n, 2) or (n, 3), finite; the z of 3-D plots does not vote
    grid : the quantisation

    References
    ----------
    P. V. C. Hough, 1962; R. O. Duda and P. E. Hart, Comm. ACM 15, 1972 (normal form).
    """
    arrays = GridArrays.of(grid)
    padded = arrays.accumulator()
    x, y = (np.ascontiguousarray(position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    vote(x, y, arrays, padded, np.empty(len(x), np.int32))
    return Accumulator(grid, np.ascontiguousarray(padded[:, FIRST:-1]), int(votes_outside(padded)))
