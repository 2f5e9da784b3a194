"""The greatest cell, again and again, the votes of its plots removed from every cell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.ballots import trial_loop, with_plots
from algorithms.hough.peaks.cells import centroid, column_of, least_scattered, maximum, written
from algorithms.hough.peaks.extraction import Extraction
from algorithms.hough.peaks.slanted_window import PeakRule, window_column, window_row
from algorithms.hough.weighting import weigh


@kernel
def _take_plots(ballot, row, column, rule):  # type: ignore[no-untyped-def]
    """Move the plots that voted in the window of a cell behind those that are left; return how many stay."""
    x, y, left = ballot.x, ballot.y, len(ballot.x)
    height, width = ballot.votes.shape
    centre_x, centre_y = centroid(ballot, row, column)
    for offset in range(-rule.rows, rule.rows + 1):
        target = window_row(offset, row, height, rule.wrap)
        if target < 0:
            continue
        centre = column
        if offset != 0:
            centre = window_column(centre_x, centre_y, target, ballot.grid)
        plot = 0
        while plot < left:
            voted = column_of(ballot, target, plot)
            if 0 < voted < width - 1 and abs(voted - centre) <= rule.columns:
                left -= 1
                x[plot], x[left] = x[left], x[plot]
                y[plot], y[left] = y[left], y[plot]
            else:
                plot += 1
    return left


@kernel
def _take_votes(ballot, left, space):  # type: ignore[no-untyped-def]
    """Take back the votes of all plots from `left` on; weighted votes are worked out anew.

    Weighted votes are no sums over plots: without the plots of a peak the deviations of the cells
    that they crossed shrink, and the least of a θ or a ρ may be another one.
    """
    if space is None:
        for target in range(len(ballot.votes)):
            for plot in range(left, len(ballot.x)):
                ballot.votes[target, column_of(ballot, target, plot)] -= np.uint32(1)
    else:
        weigh(ballot.x[:left], ballot.y[:left], ballot.grid, space)


@kernel
def _removed_votes(ballot, rule, cells, count):  # type: ignore[no-untyped-def]
    """Append the greatest cell and take back every vote of its plots, until none reaches the threshold.

    Of equal cells the one whose votes scatter least is taken. Its plots are those that voted within
    ±columns of it in its row (with ±rows, also within the slanted window in the rows beside it). The
    accumulator is changed.
    """
    ballot = with_plots(ballot, ballot.x.copy(), ballot.y.copy())
    for _ in range(rule.most):
        _, _, best = maximum(ballot.values, rule.last)
        if best < rule.least or best == 0:
            break
        row, column = least_scattered(ballot, best, rule.last)
        cells, count = written(cells, count, row, column, best)
        left = _take_plots(ballot, row, column, rule)
        _take_votes(ballot, left, ballot.space)
        ballot = with_plots(ballot, ballot.x[:left], ballot.y[:left])
    return cells, count


@dataclass(frozen=True, slots=True)
class VoteRemoval(Extraction):
    """Cells from the greatest down, each taking its plots' votes with it.

    Attributes
    ----------
    rows, columns : half the window in which a plot that voted belongs to the cell
    wrap : whether it goes on across θ = 0 and π
    """

    name = "vote-removal"
    summary = "from the greatest down, each suppressing its plots' votes"
    windows = ("0", "1")
    half_window = (0, 1)
    cells_of_trials = trial_loop(_removed_votes)

    rows: int = 0
    columns: int = 0
    wrap: bool = True

    def rule(self, grid: Grid, threshold: Any) -> PeakRule:
        """Return what the kernel needs to know."""
        rows, columns = min(self.rows, grid.theta_bins), min(self.columns, grid.rho_bins)
        return PeakRule(threshold, self.most, rows, columns, self.wrap, self.last)


EXTRACTION = VoteRemoval
