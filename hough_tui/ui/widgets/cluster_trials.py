"""The trials of a row of clustering: how many clusters, and how far plots are from the targets."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.chunks.clustering import ClusteringCell
from hough_tui.experiments.columns.clustering import ClusterColumns
from hough_tui.reports.numerals import fixed, number
from hough_tui.ui.runs.shown_run import RowTrials
from hough_tui.ui.widgets.trial_table import PLAIN, QUIET, WRONG, Rows, TrialColumn, TrialTable, by_number

ClustersOfTrials = RowTrials[ClusteringCell, ClusterColumns]


def _greatest(trials: ClustersOfTrials) -> NDArray[np.float64]:
    """Return the greatest squared error of each trial, infinite where there is no plot."""
    squared = trials.columns.squared_error
    if squared.shape[1] == 0:
        return np.zeros(len(squared))
    greatest: NDArray[np.float64] = np.where(np.isnan(squared), np.inf, squared).max(axis=1)
    return greatest


def _failed_first(trials: ClustersOfTrials) -> Rows:
    # The last key counts most.
    return np.lexsort((trials.numbers, -_greatest(trials), -np.abs(trials.columns.excess)))


def _by_excess(trials: ClustersOfTrials) -> Rows:
    return np.argsort(-trials.columns.excess, kind="stable")


def _by_error(trials: ClustersOfTrials) -> Rows:
    return np.argsort(-_greatest(trials), kind="stable")


class ClusterTrials(TrialTable[ClusteringCell, ClusterColumns]):
    """The trials behind a row of clustering."""

    ORDERS = {
        "failed first": _failed_first,
        "trial": by_number,
        "excess": _by_excess,
        "error": _by_error,
    }

    @property
    def words(self) -> str:
        """How many trials there are, and how many count wrong."""
        excess = self.trials.columns.excess
        few, many = int((excess < 0).sum()), int((excess > 0).sum())
        return (
            f"{len(self):,} trials · {few:,} with too few clusters, {many:,} with too many · errors in cells"
        )

    def told(self) -> list[TrialColumn]:
        """Return the number of clusters, and the distance of each target from the nearest plot."""
        columns = self.trials.columns
        found = [
            TrialColumn("clusters", 8, self._count, "failed first"),
            TrialColumn("excess", 6, self._excess, "excess"),
        ]
        targets = self.trials.cell.world.targets
        for index in range(columns.squared_error.shape[1]):
            name = (targets[index].name or f"target {index + 1}")[:12]
            found.append(TrialColumn(f"{name}\nerror", max(8, len(name)), self._error(index), "error"))
        return found

    def _count(self, row: int) -> tuple[str, str]:
        columns = self.trials.columns
        kind = WRONG if columns.excess[row] else PLAIN
        return f"{columns.clusters[row]}/{columns.squared_error.shape[1]}", kind

    def _excess(self, row: int) -> tuple[str, str]:
        excess = int(self.trials.columns.excess[row])
        return f"{excess:+d}" if excess else "0", PLAIN if excess else QUIET

    def _error(self, target: int) -> Callable[[int], tuple[str, str]]:
        squared = self.trials.columns.squared_error

        def cell(row: int) -> tuple[str, str]:
            value = float(squared[row, target])
            return ("no plot", WRONG) if np.isnan(value) else (fixed(number(np.sqrt(value)), 2), PLAIN)

        return cell
