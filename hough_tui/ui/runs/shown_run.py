"""Runs as the views show them: one row a cell, and the trials behind each row."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from hough_tui.experiments.cases import AnyCell, Row
from hough_tui.experiments.columns.schema import Columns
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.results import cells_of_run, columns_of_row, result
from hough_tui.experiments.rows import row_of
from hough_tui.experiments.stores.folder import Run

CellT = TypeVar("CellT", bound=AnyCell, covariant=True)
ColumnsT = TypeVar("ColumnsT", bound=Columns, covariant=True)


@dataclass(frozen=True, slots=True)
class RowTrials(Generic[CellT, ColumnsT]):
    """The trials behind one row.

    Attributes
    ----------
    cell : what ran
    columns : which trials of the experiment they are, and what each of them gave
    """

    cell: CellT
    columns: ColumnsT

    @property
    def numbers(self) -> NDArray[np.int32]:
        """Which trials of the experiment they are, int32 (trials,)."""
        return self.columns.trial


AnyTrials = RowTrials[AnyCell, Columns]
"""The trials behind a row of any kind of experiment."""


class ShownRun(ABC):
    """A run on the screen.

    Attributes
    ----------
    name : what files that are made of it are called
    rows : one a cell, in the order of the plan; they are replaced, never changed
    """

    name: str
    rows: tuple[Row, ...]

    @abstractmethod
    def trials(self, index: int) -> AnyTrials:
        """Return the trials behind a row; it may take long.

        Raises
        ------
        RequestError
            Where they cannot be told.
        """

    @abstractmethod
    def document(self) -> dict[str, Any]:
        """Return the result document, as it is kept and exported; it may take long.

        Raises
        ------
        RequestError
            Where there is none yet.
        """


class LiveRun(ShownRun):
    """A run of this session, under way or over."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.name = "+".join(scenario_set.name for scenario_set in job.plan.sets)
        self.rows = tuple(cell.blank() for cell in job.plan.cells)
        self.is_over = False
        self._run: Run | None = None

    def snapshot(self) -> tuple[Row, ...]:
        """Return the rows over the trials that are finished by now.

        Notes
        -----
        A cell that has no more trials than in the rows at hand keeps its row.
        """
        return tuple(
            row if row["trials"] == self.job.progress.done[index] else self._tallied(index, row)
            for index, row in enumerate(self.rows)
        )

    def trials(self, index: int) -> AnyTrials:
        trials = self.job.finished_trials(index)
        if trials is None:
            raise RequestError("no trial of this row is finished yet")
        columns, _ = trials
        return RowTrials(self.job.plan.cells[index], columns)

    def document(self) -> dict[str, Any]:
        return self.whole().document

    def whole(self) -> Run:
        """Return the run as it is kept; it may take long.

        Raises
        ------
        RequestError
            Where it is still under way.
        """
        if not self.is_over:
            raise RequestError("the run is still under way; wait for its end, or cancel it")
        if self._run is None:
            self._run = result(self.job)
        return self._run

    def _tallied(self, index: int, row: Row) -> Row:
        trials = self.job.finished_trials(index)
        return row if trials is None else row_of(self.job.plan.cells[index], *trials)


class KeptRun(ShownRun):
    """A run from the store."""

    def __init__(self, name: str, run: Run) -> None:
        self.name = name
        self.run = run
        self.rows = tuple(run.document["rows"])
        self._cells = cells_of_run(run)

    def trials(self, index: int) -> AnyTrials:
        cell, row = self._cells[index], self.rows[index]
        if cell is None:
            raise RequestError(
                "this row's scenario and initiator cannot be told from the sets that were kept with the "
                "run, so its trials cannot be drawn again"
            )
        # Runs of the first versions do not say which trials they are of.
        if "trial" not in self.run.columns[index] and row["trials"] < cell.experiment.trials:
            raise RequestError(
                f"the run was cancelled after {row['trials']:,} of this row's "
                f"{cell.experiment.trials:,} trials, and the version that kept it did not keep "
                "which ones they were; run it again to open its trials"
            )
        return RowTrials(cell, columns_of_row(self.run, index))

    def document(self) -> dict[str, Any]:
        return self.run.document


def cell_words(cell: AnyCell) -> str:
    """Return what ran in a cell: scenario, initiator, swept values."""
    swept = (f"{key} {value:g}" for key, value in cell.swept.items())
    return " · ".join((*cell.names.values(), *swept))
