"""Groups of neighbouring cells at the threshold, each represented by its least deviation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.ballots import trial_loop
from algorithms.hough.peaks.cells import scatter
from algorithms.hough.peaks.extraction import Extraction, greatest
from algorithms.hough.peaks.threshold import at_threshold
from algorithms.rounding import floored


class ThesisRule(NamedTuple):
    """What `thesis` needs to know.

    Attributes
    ----------
    least : least value of a cell
    rows, columns : how far cells of a group are from its first one
    last : whether of equal deviations the last in θ-major order is taken
    """

    least: Any
    rows: int
    columns: int
    last: bool


@kernel
def _least_deviations(ballot, rule, cells, count):  # type: ignore[no-untyped-def]
    """Append one cell a group of neighbouring cells at the threshold.

    The first cell in θ-major order that is left, and those within ±rows and ±columns of it, are
    a group. The cell of the group whose votes, weighted or not, have the least standard deviation
    represents it; of equals the first, or with `last` the last.

    References
    ----------
    Master's thesis on the Hough transform for track initiation, 2004, section 4.2. Deviations:
    a group that is cleared is passed over (taken literally, its step 4 ends there, after the
    first group or two); ρ is counted upwards within one θ (its matrices count downwards).
    """
    first = count
    cells, end = at_threshold(ballot.values, rule.least, cells, count)
    is_left = np.ones(end - first, np.bool_)
    for here in range(first, end):
        if not is_left[here - first]:
            continue
        row, column = floored(cells[here, 0]), floored(cells[here, 1])
        best, least = here, -1.0
        for other in range(here + 1, end):
            other_row, other_column = floored(cells[other, 0]), floored(cells[other, 1])
            if other_row - row > rule.rows:
                break
            if not is_left[other - first] or abs(other_column - column) > rule.columns:
                continue
            is_left[other - first] = False
            if least < 0.0:
                least = scatter(ballot, row, column + 1)
            spread = scatter(ballot, other_row, other_column + 1)
            if spread < least or (rule.last and spread == least):
                best, least = other, spread
        # Never behind `here`, so what is overwritten has been dealt with.
        cells[count] = cells[best]
        count += 1
    return cells, count


@dataclass(frozen=True, slots=True)
class Thesis(Extraction):
    """One cell a group of neighbours; of more than `maxima`, the greatest.

    Attributes
    ----------
    rows, columns : how far cells of a group are from its first one
    """

    name = "thesis"
    summary = "one a group of neighbours"
    windows = ("4", "2")
    # Strictly within the thesis's c2 = 5 and c1 = 3 cells.
    half_window = (4, 2)
    cells_of_trials = trial_loop(_least_deviations)

    rows: int = 0
    columns: int = 0

    def rule(self, grid: Grid, threshold: Any) -> ThesisRule:
        """Return what the kernel needs to know."""
        rows, columns = min(self.rows, grid.theta_bins), min(self.columns, grid.rho_bins)
        return ThesisRule(threshold, rows, columns, self.last)

    def limited(self, cells: NDArray[Any], ends: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[np.int64]]:
        """Return the greatest cells of each trial, at most `maxima`."""
        return greatest(cells, ends, self.most, self.last)


EXTRACTION = Thesis
