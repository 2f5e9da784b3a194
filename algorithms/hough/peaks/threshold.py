"""Every cell that reaches the threshold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.ballots import trial_loop
from algorithms.hough.peaks.cells import with_room
from algorithms.hough.peaks.extraction import Extraction, greatest


@kernel
def _row_hits(accumulator, row, least):  # type: ignore[no-untyped-def]
    hits = np.int32(0)
    counts = accumulator[row]
    for column in range(1, accumulator.shape[1] - 1):
        hits += np.int32(counts[column] >= least)
    return hits


@kernel
def _write_hits(accumulator, row, votes, cells, count):  # type: ignore[no-untyped-def]
    counts = accumulator[row]
    for column in range(1, accumulator.shape[1] - 1):
        if counts[column] >= votes:
            cells[count, 0] = row
            cells[count, 1] = column - 1
            cells[count, 2] = counts[column]
            count += 1
    return count


@kernel
def at_threshold(accumulator, votes, cells, count):  # type: ignore[no-untyped-def]
    """Append every cell with at least so many votes, in θ-major order.

    Returns
    -------
    cells : int64 (≥ count, 3), perhaps enlarged
    count : number of cells written so far
    """
    for row in range(accumulator.shape[0]):
        # A vectorised pass tells which few rows are worth a search cell by cell.
        hits = _row_hits(accumulator, row, votes)
        if hits > 0:
            cells = with_room(cells, count + hits)
            count = _write_hits(accumulator, row, votes, cells, count)
    return cells, count


class ThresholdRule(NamedTuple):
    """What `threshold` needs to know: the least value of a cell."""

    least: Any


@kernel
def _choose(ballot, rule, cells, count):  # type: ignore[no-untyped-def]
    return at_threshold(ballot.values, rule.least, cells, count)


@dataclass(frozen=True, slots=True)
class Threshold(Extraction):
    """Every cell with enough votes; of more than `maxima`, the greatest."""

    name = "threshold"
    summary = "every one"
    cells_of_trials = trial_loop(_choose)

    def rule(self, grid: Grid, threshold: Any) -> ThresholdRule:
        """Return the least value of a cell."""
        return ThresholdRule(threshold)

    def limited(self, cells: NDArray[Any], ends: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[np.int64]]:
        """Return the greatest cells of each trial, at most `maxima`."""
        return greatest(cells, ends, self.most, self.last)


EXTRACTION = Threshold
