"""The greatest cell first, with a window that follows the slant of its peak."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.ballots import trial_loop
from algorithms.hough.peaks.cells import centroid, scatter, written
from algorithms.hough.peaks.extraction import Extraction
from algorithms.hough.peaks.slanted_window import PeakRule, window_column, window_row
from algorithms.hough.peaks.threshold import at_threshold
from algorithms.rounding import floored

ASSUMED_SPEED = 200.0
"""Speed in m/s from which the length of a track follows: an initiator does not learn the targets."""


def peak_width(grid: Grid, expected: float, length: float, votes: float) -> float:
    """Return how many rows on each side of a line still hold a cell with so many of its votes.

    In a row at the angle δ the votes of a track spread evenly over L·sin δ, of which a cell holds
    the share Δρ/(L·sin δ).

    Parameters
    ----------
    grid : the quantisation
    expected : votes n·Pd of the track
    length : L, that of the track within the batch, in the unit of the grid
    votes : threshold
    """
    if length * votes == 0.0:
        return math.inf
    return expected * grid.rho_step / (length * votes * grid.theta_step)


@kernel
def _clear_along(values, row, centre_x, centre_y, rule, grid):  # type: ignore[no-untyped-def]
    """Set the values to zero in the window of a cell of a row, about the votes of a centroid."""
    height, width = values.shape
    for offset in range(-rule.rows, rule.rows + 1):
        target = window_row(offset, row, height, rule.wrap)
        if target < 0:
            continue
        centre = window_column(centre_x, centre_y, target, grid)
        for column in range(max(centre - rule.columns, 1), min(centre + rule.columns + 1, width - 1)):
            values[target, column] = 0


@kernel
def _best_first(ballot, rule, cells, count):  # type: ignore[no-untyped-def]
    """Append the cells at the threshold from the greatest down, each clearing what belongs to its peak.

    The window lies about the vote of the centroid of the cell's own plots. Of equal cells the one
    whose votes scatter least comes first: the cells on both sides of a peak's best row often have as
    many votes as it has. The values are changed.
    """
    values, first = ballot.values, count
    cells, end = at_threshold(values, rule.least, cells, count)
    candidates = cells[first:end].copy()
    if rule.last:
        candidates = candidates[::-1].copy()
    order = np.argsort(-candidates[:, 2], kind="mergesort")
    scatters = np.empty(len(order))
    begin = 0
    while begin < len(order) and count - first < rule.most:
        run = begin + 1
        while run < len(order) and candidates[order[run], 2] == candidates[order[begin], 2]:
            run += 1
        if run > begin + 1:
            for place in range(begin, run):
                row, column = floored(candidates[order[place], 0]), floored(candidates[order[place], 1]) + 1
                scatters[place] = np.inf
                if values[row, column] != 0:
                    scatters[place] = scatter(ballot, row, column)
            order[begin:run] = order[begin:run][np.argsort(scatters[begin:run], kind="mergesort")]
        for place in range(begin, run):
            row, column = floored(candidates[order[place], 0]), floored(candidates[order[place], 1]) + 1
            if values[row, column] == 0 or count - first == rule.most:
                continue
            cells, count = written(cells, count, row, column, values[row, column])
            values[row, column] = 0
            centre_x, centre_y = centroid(ballot, row, column)
            _clear_along(values, row, centre_x, centre_y, rule, ballot.grid)
        begin = run
    return cells, count


@dataclass(frozen=True, slots=True)
class BestFirst(Extraction):
    """Cells from the greatest down, each suppressing its own peak.

    Attributes
    ----------
    rows, columns : half the window around each
    wrap : whether it goes on across θ = 0 and π
    """

    name = "best-first"
    summary = "from the greatest down, each suppressing its own peak"
    windows = ("twice the width of a peak", "half the height of a peak and 1")
    cells_of_trials = trial_loop(_best_first)

    rows: int = 0
    columns: int = 0
    wrap: bool = True

    @classmethod
    def default_window(cls, grid: Grid, context: Context, votes: float) -> tuple[int, int]:
        """Return half the window that covers a peak.

        It is twice the width of the peak of a track at `ASSUMED_SPEED`, at most an eighth of a turn;
        and half the height n·Pd/T, in columns, that the votes have in the last row with T of them in
        one cell, with one column more because a border of columns may lie anywhere.
        """
        length = ASSUMED_SPEED / context.unit.metres * context.interval * (context.scans - 1)
        most = max(1, grid.theta_bins // 4)
        width = 2.0 * peak_width(grid, context.expected_votes, length, votes)
        rows = most if width >= most else max(1, math.ceil(width - 1e-9))
        return rows, 1 + math.ceil(0.5 * context.expected_votes / votes - 1e-9)

    def rule(self, grid: Grid, threshold: Any) -> PeakRule:
        """Return what the kernel needs to know."""
        rows, columns = min(self.rows, grid.theta_bins), min(self.columns, grid.rho_bins)
        return PeakRule(threshold, self.most, rows, columns, self.wrap, self.last)


EXTRACTION = BestFirst
