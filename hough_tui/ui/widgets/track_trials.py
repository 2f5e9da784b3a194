"""The trials of a row of initiation: targets found, tracks, false ones, errors."""

from __future__ import annotations

import numpy as np

from hough_tui.experiments.chunks.initiation import InitiationCell
from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.reports.numerals import NONE
from hough_tui.ui.runs.shown_run import RowTrials
from hough_tui.ui.widgets.trial_table import QUIET, WRONG, Rows, TrialTable


class TrackTrials(TrialTable[InitiationCell, TrialColumns]):
    """The trials behind a row of initiation."""

    def __init__(self, trials: RowTrials[InitiationCell, TrialColumns]) -> None:
        columns = trials.columns
        self.targets = columns.found.shape[1]
        self.missed = int((columns.found.sum(axis=1) < self.targets).sum())
        self.with_false = int((columns.false > 0).sum())
        super().__init__(trials)

    @property
    def words(self) -> str:
        """How many trials there are, and how many failed."""
        unit = self.trials.cell.world.unit.value
        missing = "" if not self.targets else f" · {self.missed:,} miss a target"
        return f"{len(self):,} trials{missing} · {self.with_false:,} have false tracks · lengths in {unit}"

    def failed_first(self) -> Rows:
        """Return the rows, those first that find the fewest targets, then have the most false tracks."""
        columns = self.trials.columns
        # The last key counts most.
        keys = (self.trials.numbers, -columns.duplicates, -columns.false, columns.found.sum(axis=1))
        return np.lexsort(keys)

    def missing(self, row: int, target: int) -> tuple[str, str]:
        """Return what stands in place of a number of a target that there is none of."""
        return (NONE, QUIET) if self.trials.columns.found[row, target] else ("missed", WRONG)
