"""How far around a chosen cell the votes belong to its peak, by default."""

from __future__ import annotations

import math

from algorithms.context import Context
from algorithms.hough.grid import Grid
from algorithms.hough.search import Extraction

ASSUMED_SPEED = 200.0
"""Speed in m/s from which the length of a track follows: an initiator is not told of targets."""

FIXED = {
    Extraction.THRESHOLD: (0, 0),
    Extraction.SUCCESSIVE: (5, 5),
    Extraction.THESIS: (4, 2),
    Extraction.VOTE_REMOVAL: (0, 1),
}
"""Half the windows, in θ rows and ρ columns, that do not depend on anything. The course report's
±5; the thesis's, strictly within c2 = 5 and c1 = 3 cells."""


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


def suppression(extraction: Extraction, grid: Grid, context: Context, votes: float) -> tuple[int, int]:
    """Return half the default window of an extraction, in rows and in columns.

    For `BEST_FIRST`, whose window follows the slant of the peak, it is twice the width of the
    peak of a track at `ASSUMED_SPEED`, at most an eighth of a turn; and half the height n·Pd/T,
    in columns, that the votes have in the last row with T of them in one cell, with one column more
    because a border of columns may lie anywhere.
    """
    if extraction in FIXED:
        return FIXED[extraction]
    length = ASSUMED_SPEED / context.unit.metres * context.interval * (context.scans - 1)
    most = max(1, grid.theta_bins // 4)
    width = 2.0 * peak_width(grid, context.expected_votes, length, votes)
    rows = most if width >= most else max(1, math.ceil(width - 1e-9))
    return rows, 1 + math.ceil(0.5 * context.expected_votes / votes - 1e-9)
