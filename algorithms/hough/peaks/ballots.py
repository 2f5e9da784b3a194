"""Ballots: the plots of a batch and their votes, and the loop over the batches of a chunk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.voting import GridArrays, vote, votes_outside
from algorithms.hough.weighting import Weighting, WeightingSpace, weigh

Array = NDArray[np.float64]


class Ballot(NamedTuple):
    """Plots and the accumulator that they vote into.

    Attributes
    ----------
    x, y : float64 (n,), measured from the grid's origin
    grid : the quantisation
    votes : uint32 (rows, ρ columns + 2), with a sentinel column on each side
    values : what cells are chosen by: `votes`, or the weighted votes in the same shape
    space : how votes are weighted; None where they count as they are
    columns : int32 (≥ n,), working space
    """

    x: Array
    y: Array
    grid: GridArrays
    votes: NDArray[np.uint32]
    values: NDArray[Any]
    space: WeightingSpace | None
    columns: NDArray[np.int32]

    @classmethod
    def of(cls, x: Array, y: Array, grid: GridArrays, weighting: Weighting | None, most: int) -> Ballot:
        """Return the plots of a chunk with an accumulator for one batch of at most so many of them."""
        votes = grid.accumulator()
        space = None if weighting is None else WeightingSpace.of(weighting, votes, most)
        values = votes if space is None else space.weighted
        return cls(x, y, grid, votes, values, space, np.empty(most, np.int32))


@kernel
def with_plots(ballot, x, y):  # type: ignore[no-untyped-def]
    """Return the accumulator with other plots; it is not filled anew."""
    return Ballot(x, y, ballot.grid, ballot.votes, ballot.values, ballot.space, ballot.columns)


@kernel
def _fill(ballot, space):  # type: ignore[no-untyped-def]
    """Fill the votes of one batch, and with `space` the weighted ones."""
    # An argument of its own: the compiler leaves out what a space that is None does not need.
    if space is None:
        ballot.votes[:] = 0
        vote(ballot.x, ballot.y, ballot.grid, ballot.votes, ballot.columns)
    else:
        weigh(ballot.x, ballot.y, ballot.grid, space)


def trial_loop(choose_cells: Callable[..., Any]) -> Callable[..., Any]:
    """Return a kernel that chooses the cells of each trial of a chunk.

    Parameters
    ----------
    choose_cells : kernel (ballot, rule, cells, count) -> (cells, count): appends the cells chosen from a
        filled accumulator, whose values it may change
    """

    @kernel
    def cells_of_trials(ballot, offsets, rule, cells):  # type: ignore[no-untyped-def]
        """Return cells, the ends of trials among them, and the votes outside the grid of each trial.

        Parameters
        ----------
        ballot : `Ballot`, of the chunk
        offsets : int64 (trials + 1,), where the plots of each trial begin
        rule : what `choose_cells` needs to know
        cells : int64 or float64 (≥ 0, 3), room for cells: row, column without the sentinel, value
        """
        trials = len(offsets) - 1
        ends = np.zeros(trials + 1, np.int64)
        outside = np.zeros(trials, np.int64)
        count = 0
        for trial in range(trials):
            first, end = offsets[trial], offsets[trial + 1]
            own = with_plots(ballot, ballot.x[first:end], ballot.y[first:end])
            _fill(own, own.space)
            outside[trial] = votes_outside(own.votes)
            cells, count = choose_cells(own, rule, cells, count)
            ends[trial + 1] = count
        return cells[:count], ends, outside

    return cells_of_trials
