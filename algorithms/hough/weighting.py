"""Weighted votes: a cell counts for more, the less the ρ that voted for it scatter."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.moments import reciprocals, vote_with_moments
from algorithms.hough.voting import FIRST, Accumulator, GridArrays, votes_outside

LEAST_DEVIATION = 1e-9
"""The least standard deviation that a weight is worked out from, in columns: equal ρ have none."""

BYTES_PER_CELL = 20
"""Votes, weighted votes and standard deviations of one cell."""


@dataclass(frozen=True, slots=True)
class Weighting:
    """How votes are weighted.

    Attributes
    ----------
    several : whether several lines are sought: each cell is compared with the least deviation of
        its own θ and of its own ρ; otherwise with that of the whole accumulator
    eta : exponent η of the single-line weight (s_min/s)^(2η)
    least_votes : T1, which the votes of a cell must exceed for its deviation to count
    """

    several: bool
    eta: float
    least_votes: int


@kernel
def deviations(votes, squares, least_votes, by_theta, by_rho):  # type: ignore[no-untyped-def]
    """Turn the squares M2 of each cell into its sample standard deviation, in place.

    Parameters
    ----------
    votes : uint32 (rows, ρ columns + 2)
    squares : float64 of the same shape; afterwards the deviations in columns, at least
        `LEAST_DEVIATION`, infinite where the votes do not exceed `least_votes` or are fewer than two
    by_theta : float64 (rows,), is given the least deviation of each θ
    by_rho : float64 (ρ columns + 2,), is given the least deviation of each ρ
    """
    least = np.uint32(max(least_votes, 1))
    by_rho[:] = np.inf
    for row in range(votes.shape[0]):
        counts, sums = votes[row], squares[row]
        least_of_row = np.inf
        for column in range(FIRST, len(counts) - 1):
            deviation = np.inf
            if counts[column] > least:
                deviation = max(math.sqrt(sums[column] / (counts[column] - 1.0)), LEAST_DEVIATION)
                least_of_row = min(least_of_row, deviation)
                by_rho[column] = min(by_rho[column], deviation)
            sums[column] = deviation
        by_theta[row] = least_of_row


@kernel
def line_weight(least, deviation):  # type: ignore[no-untyped-def]
    """Return α^(1/α) with α = (least/deviation)², the weight where several lines are sought."""
    alpha = (least / deviation) * (least / deviation)
    return math.exp(math.log(alpha) / alpha) if alpha > 0.0 else 0.0


class WeightingSpace(NamedTuple):
    """How votes are weighted, and the arrays in which that is done.

    Attributes
    ----------
    several, eta, least_votes : see `Weighting`
    votes : uint32 (rows, ρ columns + 2)
    weighted : float64 of the same shape, the weighted votes; 0 in the sentinel columns
    deviation : float64 of the same shape: see `deviations`
    by_theta, by_rho : see `deviations`
    inverse, places : see `vote_with_moments`
    """

    several: bool
    eta: float
    least_votes: int
    votes: NDArray[np.uint32]
    weighted: NDArray[np.float64]
    deviation: NDArray[np.float64]
    by_theta: NDArray[np.float64]
    by_rho: NDArray[np.float64]
    inverse: NDArray[np.float64]
    places: NDArray[np.float64]

    @classmethod
    def of(cls, weighting: Weighting, votes: NDArray[np.uint32], plots: int) -> WeightingSpace:
        """Return working space beside an accumulator, for at most so many plots."""
        rows, columns = votes.shape
        return cls(
            weighting.several, float(weighting.eta), weighting.least_votes,
            votes, np.zeros(votes.shape), np.zeros(votes.shape), np.empty(rows), np.empty(columns),
            reciprocals(plots), np.empty(plots),
        )  # fmt: skip


@kernel
def weigh(x, y, grid, space):  # type: ignore[no-untyped-def]
    """Fill votes, deviations and weighted votes of a `WeightingSpace` with those of plots.

    Parameters
    ----------
    x, y : float64 (n,), measured from the grid's origin
    grid : `GridArrays`
    """
    votes, weighted, deviation = space.votes, space.weighted, space.deviation
    by_theta, by_rho = space.by_theta, space.by_rho
    # The means are needed until the deviations are known, the weighted votes from then on.
    mean, squares = weighted, deviation
    votes[:] = 0
    mean[:] = 0.0
    squares[:] = 0.0
    vote_with_moments(x, y, grid, votes, mean, squares, space.inverse, space.places)
    deviations(votes, squares, space.least_votes, by_theta, by_rho)
    least = by_theta.min()
    weighted[:] = 0.0
    for row in range(len(votes)):
        if by_theta[row] == np.inf:
            continue
        for column in range(FIRST, votes.shape[1] - 1):
            scatter = deviation[row, column]
            if scatter == np.inf:
                continue
            if space.several:
                weight = 0.5 * (line_weight(by_theta[row], scatter) + line_weight(by_rho[column], scatter))
            else:
                weight = (least / scatter) ** (2.0 * space.eta)
            weighted[row, column] = votes[row, column] * weight


def accumulate_weighted(position: NDArray[np.float64], grid: Grid, weighting: Weighting) -> Accumulator:
    """Return the accumulator of plots with standard deviations and weighted votes.

    Parameters
    ----------
    position : float64 (n, 2) or (n, 3), finite; the z of 3-D plots does not vote
    grid : the quantisation
    weighting : how votes are weighted

    Notes
    -----
    With s the sample standard deviation of the ρ that voted for a cell, one line is weighted by
    (s_min/s)^(2η), s_min the least of the whole accumulator (equations 3-5 to 3-7). Several lines
    are weighted by (w_θ + w_ρ)/2, w = α^(1/α), α = s²_min/s², s_min the least of the cell's θ for
    w_θ and of its ρ for w_ρ (equations 3-8 and 3-9, where a column is a θ and a row is a ρ).

    Where the votes do not exceed T1, s is not defined and the weight is 0. The thesis puts a
    great constant in the place of s (equation 3-4); in a row or a column without one qualified
    cell that constant is the least, and every cell there would keep its votes.

    References
    ----------
    Master's thesis on the Hough transform for track initiation, 2004, sections 3.3.2 and 3.3.3.
    """
    arrays = GridArrays.of(grid)
    x, y = (np.ascontiguousarray(position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    space = WeightingSpace.of(weighting, arrays.accumulator(), len(x))
    weigh(x, y, arrays, space)
    inside = np.s_[:, FIRST:-1]
    deviation = space.deviation[inside]
    return Accumulator(
        grid,
        np.ascontiguousarray(space.votes[inside]),
        int(votes_outside(space.votes)),
        np.where(np.isfinite(deviation), deviation * grid.rho_step, np.nan),
        np.ascontiguousarray(space.weighted[inside]),
    )
