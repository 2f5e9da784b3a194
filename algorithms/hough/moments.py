"""The moments of the ρ that vote for each cell: count, mean and sum of squares in one pass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.voting import FIRST, GridArrays


@kernel
def vote_with_moments(x, y, grid, accumulator, mean, squares, inverse, places):  # type: ignore[no-untyped-def]
    """Add one vote a row for each plot, and bring mean and squares of each cell up to date.

    Parameters
    ----------
    x, y : float64 (n,), measured from the grid's origin
    grid : `GridArrays`
    accumulator : uint32 (rows, ρ columns + 2), changed in place as by `vote`
    mean : float64 of the same shape, changed in place: of the places that voted, in columns
        from the left edge of the first sentinel column; 0 before the first vote
    squares : float64 of the same shape, changed in place: M2, the sum of the squared
        deviations from the mean, in squared columns; 0 before the first vote
    inverse : float64 (≥ the most votes of a cell,), 1, 1/2, 1/3, …
    places : float64 (≥ n,), working space

    Notes
    -----
    Welford's recurrence with a table in place of its division. It subtracts each place from
    the mean so far, never two great sums, so that the deviation is as exact as the places are,
    and exactly 0 for equal ones. Means and squares of the sentinel columns mean nothing.

    References
    ----------
    B. P. Welford, Technometrics 4, 1962.
    """
    top = float(accumulator.shape[1] - 1)
    for row in range(len(grid.cosine)):
        along_x, along_y = grid.cosine[row] / grid.rho_step, grid.sine[row] / grid.rho_step
        first = FIRST - grid.rho_min / grid.rho_step
        for plot in range(len(x)):
            place = x[plot] * along_x + y[plot] * along_y + first
            # As in `vote`: clamped while it is a float, and no number counts as outside.
            place = place if place > 0.0 else 0.0
            places[plot] = place if place < top else top
        counts, means, sums = accumulator[row], mean[row], squares[row]
        for plot in range(len(x)):
            place = places[plot]
            column = np.uint32(np.int32(place))
            step = place - means[column]
            moved = means[column] + step * inverse[counts[column]]
            sums[column] += step * (place - moved)
            means[column] = moved
            counts[column] += np.uint32(1)


def reciprocals(most: int) -> NDArray[np.float64]:
    """Return 1, 1/2, 1/3, … for as many votes as a cell can have."""
    return 1.0 / np.arange(1, max(1, most) + 1)


@dataclass(frozen=True, slots=True)
class Moments:
    """The moments of the ρ that voted for each cell.

    Attributes
    ----------
    votes : uint32 (theta bins, rho bins)
    mean : float64 (theta bins, rho bins), measured from the grid's origin; NaN without a vote
    squares : float64 (theta bins, rho bins), M2, the sum of the squared deviations from the mean
    """

    votes: NDArray[np.uint32]
    mean: NDArray[np.float64]
    squares: NDArray[np.float64]

    @property
    def deviation(self) -> NDArray[np.float64]:
        """Sample standard deviation (n − 1) of each cell; NaN for fewer than two votes."""
        with np.errstate(invalid="ignore", divide="ignore"):
            degrees = np.where(self.votes > 1, self.votes - 1.0, np.nan)
            return np.asarray(np.sqrt(self.squares / degrees))


def moments(position: NDArray[np.float64], grid: Grid) -> Moments:
    """Return the moments of the ρ of plots, cell by cell.

    Parameters
    ----------
    position : float64 (n, 2) or (n, 3), finite; the z of 3-D plots does not vote
    grid : the quantisation
    """
    arrays = GridArrays.of(grid)
    votes = arrays.accumulator()
    mean, squares = np.zeros(votes.shape), np.zeros(votes.shape)
    x, y = (np.ascontiguousarray(position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    vote_with_moments(x, y, arrays, votes, mean, squares, reciprocals(len(x)), np.empty(len(x)))
    inside = np.s_[:, FIRST:-1]
    counts = np.ascontiguousarray(votes[inside])
    rho = grid.rho_min + (mean[inside] - FIRST) * grid.rho_step
    return Moments(counts, np.where(counts > 0, rho, np.nan), squares[inside] * grid.rho_step**2)
