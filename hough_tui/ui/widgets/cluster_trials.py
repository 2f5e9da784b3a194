"""The trials of a row of clustering: how many clusters, and how far plots are from the targets."""

from __future__ import annotations

import numpy as np

from hough_tui.experiments.chunks.clustering import ClusteringCell
from hough_tui.experiments.columns.clustering import ClusterColumns
from hough_tui.ui.widgets.trial_table import FAILED_FIRST, PLAIN, WRONG, Rows, TrialColumn, TrialTable


class ClusterTrials(TrialTable[ClusteringCell, ClusterColumns]):
    """The trials behind a row of clustering."""

    @property
    def words(self) -> str:
        """How many trials there are, and how many count wrong."""
        excess = self.trials.columns.excess
        few, many = int((excess < 0).sum()), int((excess > 0).sum())
        return (
            f"{len(self):,} trials · {few:,} with too few clusters, {many:,} with too many · errors in cells"
        )

    def failed_first(self) -> Rows:
        """Return the rows, those first that count most wrongly, then place a target worst."""
        columns = self.trials.columns
        squared = np.where(np.isnan(columns.squared_error), np.inf, columns.squared_error)
        # The last key counts most.
        return np.lexsort((self.trials.numbers, -squared.max(axis=1, initial=0.0), -np.abs(columns.excess)))

    def missing(self, row: int, target: int) -> tuple[str, str]:
        """Return what stands in place of a number of a target that there is none of."""
        return "no plot", WRONG

    def own_columns(self) -> list[TrialColumn]:
        """Return the numbers of clusters beside those of targets."""
        return [TrialColumn("clusters", 8, self._count, FAILED_FIRST)]

    def _count(self, row: int) -> tuple[str, str]:
        columns = self.trials.columns
        kind = WRONG if columns.excess[row] else PLAIN
        return f"{columns.clusters[row]}/{columns.squared_error.shape[1]}", kind
