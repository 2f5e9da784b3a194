"""The trials of a row as columns of text, in several orders; a million of them without a widget each."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Generic

import numpy as np
from numpy.typing import NDArray

from hough_tui.ui.runs.shown_run import AnyTrials, CellT, ColumnsT, RowTrials

Rows = NDArray[np.int64]

PLAIN, WRONG, QUIET = "", "wrong", "quiet"
"""How a cell is drawn."""


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
    cell: Callable[[int], tuple[str, str]]
    order: str | None = None


class TrialTable(ABC, Generic[CellT, ColumnsT]):
    """The trials behind a row; the subclasses say what each of them gave.

    Parameters
    ----------
    trials : what to show

    Attributes
    ----------
    ORDERS : what they can be sorted by, the order in which they are shown first before the others
    columns : what is told of them
    """

    ORDERS: ClassVar[Mapping[str, Callable[[Any], Rows]]] = {}

    def __init__(self, trials: RowTrials[CellT, ColumnsT]) -> None:
        self.trials = trials
        self.columns = (self._number_column(), *self.told())

    def __len__(self) -> int:
        return len(self.trials.numbers)

    def order(self, by: str) -> Rows:
        """Return the rows in one of the `ORDERS`."""
        return self.ORDERS[by](self.trials)

    @property
    def first_order(self) -> Rows:
        """The rows in the order in which they are shown first."""
        return self.order(next(iter(self.ORDERS))) if len(self) else np.zeros(0, np.int64)

    @property
    @abstractmethod
    def words(self) -> str:
        """How many trials there are, and how many failed."""

    @abstractmethod
    def told(self) -> list[TrialColumn]:
        """Return the columns beside that of the trials' numbers."""

    def _number_column(self) -> TrialColumn:
        numbers = self.trials.numbers
        widest = len(f"{numbers.max(initial=0):,}")
        return TrialColumn("trial", max(6, widest), lambda row: (f"{numbers[row]:,}", PLAIN), "trial")


def by_number(trials: AnyTrials) -> Rows:
    """Return the rows in the order of their trials."""
    return np.argsort(trials.numbers, kind="stable")
