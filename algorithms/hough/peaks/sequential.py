"""The greatest cell, again and again, the neighbourhood of each cleared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.ballots import trial_loop
from algorithms.hough.peaks.cells import maximum, written
from algorithms.hough.peaks.extraction import Extraction
from algorithms.rounding import floored


class SequentialRule(NamedTuple):
    """What `sequential` needs to know.

    Attributes
    ----------
    least : least value of a maximum
    most : how many are taken at most
    rows, columns : half the window that each clears
    wrap : whether the window goes on across θ = 0 and π, where ρ changes its sign
    last : whether of equal cells the last in θ-major order is taken
    """

    least: Any
    most: int
    rows: int
    columns: int
    wrap: bool
    last: bool


@kernel
def clear_window(accumulator, row, column, rule, grid):  # type: ignore[no-untyped-def]
    """Set the counts to zero in the window around a cell; without `wrap` it ends at the edges."""
    rho_min, rho_step = grid.rho_min, grid.rho_step
    height = accumulator.shape[0]
    for other in range(row - rule.rows, row + rule.rows + 1):
        target, centre = other, column
        if other < 0 or other >= height:
            if not rule.wrap:
                continue
            target = other % height
            if ((other - target) // height) % 2 != 0:
                rho = rho_min + (column - 0.5) * rho_step
                centre = floored((-rho - rho_min) / rho_step) + 1
        low = max(centre - rule.columns, 1)
        high = min(centre + rule.columns + 1, accumulator.shape[1] - 1)
        for cleared in range(low, high):
            accumulator[target, cleared] = 0


@kernel
def successive_maxima(ballot, rule, cells, count):  # type: ignore[no-untyped-def]
    """Append the greatest cell and clear the window around it, again and again; the values are changed.

    It ends early where no cell is left with at least the least value (and one vote).
    """
    for _ in range(rule.most):
        row, column, best = maximum(ballot.values, rule.last)
        if best < rule.least or best == 0:
            break
        cells, count = written(cells, count, row, column, best)
        clear_window(ballot.values, row, column, rule, ballot.grid)
    return cells, count


@dataclass(frozen=True, slots=True)
class Sequential(Extraction):
    """Maxima, the neighbourhood of each cleared before the next.

    Attributes
    ----------
    rows, columns : half the window around each
    wrap : whether it goes on across θ = 0 and π
    """

    name = "sequential"
    summary = "the greatest, again and again, a window around each cleared"
    windows = ("5", "5")
    # The course report's.
    half_window = (5, 5)
    cells_of_trials = trial_loop(successive_maxima)

    rows: int = 0
    columns: int = 0
    wrap: bool = True

    def rule(self, grid: Grid, threshold: Any) -> SequentialRule:
        """Return what the kernel needs to know."""
        rows, columns = min(self.rows, grid.theta_bins), min(self.columns, grid.rho_bins)
        return SequentialRule(threshold, self.most, rows, columns, self.wrap, self.last)


EXTRACTION = Sequential
