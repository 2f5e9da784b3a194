"""The trials of a row as columns of text, in several orders; a million of them without a widget each."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Generic

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.schema import Listed
from hough_tui.reports.numerals import fixed, number
from hough_tui.ui.runs.shown_run import CellT, ColumnsT, RowTrials

Rows = NDArray[np.int64]
Cell = Callable[[int], tuple[str, str]]

PLAIN, WRONG, QUIET = "", "wrong", "quiet"
"""How a cell is drawn."""

FAILED_FIRST, BY_NUMBER = "failed first", "trial"
"""Orders of every kind of trials, the one in which they are shown first before the other."""

PER_TARGET = 2
"""Dimensions of a column by target."""

LONGEST_NAME = 12


@dataclass(frozen=True, slots=True)
class TrialColumn:
    """One column.

    Attributes
    ----------
    heading : one or two lines
    width : in cells
    cell : returns the text of a row and how it is drawn
    order : what to sort by; None for none
    """

    heading: str
    width: int
    cell: Cell
    order: str | None = None


class TrialTable(ABC, Generic[CellT, ColumnsT]):
    """The trials behind a row, as the schema of their columns says that they are listed.

    Parameters
    ----------
    trials : what to show

    Attributes
    ----------
    columns : what is shown of them
    """

    def __init__(self, trials: RowTrials[CellT, ColumnsT]) -> None:
        self.trials = trials
        self.columns = (self._number_column(), *self.own_columns(), *self._listed_columns())

    def __len__(self) -> int:
        return len(self.trials.numbers)

    @cached_property
    def orders(self) -> Mapping[str, Callable[[], Rows]]:
        """What they can be sorted by, the order in which they are shown first before the others."""
        orders: dict[str, Callable[[], Rows]] = {
            FAILED_FIRST: self.failed_first,
            BY_NUMBER: lambda: np.argsort(self.trials.numbers, kind="stable"),
        }
        for name, listed in self._listed.items():
            values = getattr(self.trials.columns, name)
            orders.setdefault(listed.order, partial(greatest_first, values))
        return orders

    def order(self, by: str) -> Rows:
        """Return the rows in one of the `orders`."""
        return self.orders[by]()

    @property
    def first_order(self) -> Rows:
        """The rows in the order in which they are shown first."""
        return self.failed_first() if len(self) else np.zeros(0, np.int64)

    @property
    @abstractmethod
    def words(self) -> str:
        """How many trials there are, and how many failed."""

    @abstractmethod
    def failed_first(self) -> Rows:
        """Return the rows, the worst failures first."""

    @abstractmethod
    def missing(self, row: int, target: int) -> tuple[str, str]:
        """Return what stands in place of a number of a target that there is none of, and how it is drawn."""

    def own_columns(self) -> list[TrialColumn]:
        """Return what is shown before the columns of the schema."""
        return []

    @cached_property
    def _listed(self) -> dict[str, Listed]:
        """How columns are listed, by name: those of which there is something to show."""
        columns = self.trials.columns
        shown = {name: column.listed for name, column in columns.schema().items() if column.listed}
        return {name: listed for name, listed in shown.items() if self._says_something(name, listed)}

    def _says_something(self, name: str, listed: Listed) -> bool:
        values = getattr(self.trials.columns, name)
        if listed.is_hidden_at_zero:
            return bool(values.any())
        is_required = self.trials.columns.schema()[name].is_required
        return values.size > 0 and (is_required or bool(np.isfinite(values).any()))

    def _listed_columns(self) -> Iterator[TrialColumn]:
        """Yield the columns of the schema: those of a trial first, those of each target together."""
        by_target = []
        for name, listed in self._listed.items():
            values = getattr(self.trials.columns, name)
            if values.ndim < PER_TARGET:
                yield self._count_column(listed, values)
            elif values.dtype == np.bool_:
                yield self._share_column(listed, values)
            else:
                by_target.append((listed, values))
        for target, declared in enumerate(self.trials.cell.world.targets):
            name = (declared.name or f"target {target + 1}")[:LONGEST_NAME]
            for listed, values in by_target:
                width = max(7, len(listed.heading), len(name))
                cell = self._number_cell(listed, values, target)
                yield TrialColumn(f"{name}\n{listed.heading}", width, cell, listed.order)

    def _number_column(self) -> TrialColumn:
        numbers = self.trials.numbers
        widest = len(f"{numbers.max(initial=0):,}")
        return TrialColumn("trial", max(6, widest), lambda row: (f"{numbers[row]:,}", PLAIN), BY_NUMBER)

    def _count_column(self, listed: Listed, values: NDArray[Any]) -> TrialColumn:
        width = max(5, *(len(line) for line in listed.heading.split("\n")))
        return TrialColumn(
            listed.heading,
            width,
            lambda row: (f"{values[row]:,}", PLAIN if values[row] else QUIET),
            listed.order,
        )

    def _share_column(self, listed: Listed, values: NDArray[np.bool_]) -> TrialColumn:
        counts, whole = values.sum(axis=1), values.shape[1]

        def cell(row: int) -> tuple[str, str]:
            kind = PLAIN if counts[row] == whole else WRONG
            return f"{counts[row]}/{whole}", kind if listed.order == FAILED_FIRST else QUIET

        return TrialColumn(listed.heading, max(5, len(listed.heading)), cell, listed.order)

    def _number_cell(self, listed: Listed, values: NDArray[Any], target: int) -> Cell:
        def cell(row: int) -> tuple[str, str]:
            value = number(float(listed.shown(values[row, target])))
            return self.missing(row, target) if value is None else (fixed(value, listed.decimals), PLAIN)

        return cell


def greatest_first(values: NDArray[Any]) -> Rows:
    """Return rows in the order of their greatest value, whatever its sign, those without one last."""
    if values.dtype == np.bool_:
        values = values.sum(axis=1)
    if values.ndim < PER_TARGET:
        return np.argsort(-values, kind="stable")
    finite = np.where(np.isnan(values), -1.0, np.abs(values))
    return np.argsort(-finite.max(axis=1, initial=-1.0), kind="stable")
