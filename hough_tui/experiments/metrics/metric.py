"""Metric: one measured quantity, with all that tables, charts, files, commands and pages say of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.schema import Columns
from hough_tui.experiments.metrics.estimators import Estimate, Estimator
from hough_tui.experiments.metrics.kinds import Kind

if TYPE_CHECKING:
    # Tables of kept runs need no scenarios: cells are named here, and not loaded.
    from hough_tui.experiments.cases import AnyCell

CellT = TypeVar("CellT", bound="AnyCell", covariant=True)
ColumnsT = TypeVar("ColumnsT", bound=Columns, covariant=True)

LAST = 85
"""The rank of a metric that says nothing of it: tables show it where there is room for nearly all."""


@dataclass(frozen=True, slots=True)
class Sample(Generic[CellT, ColumnsT]):
    """Trials of a cell, from which metrics are computed.

    Attributes
    ----------
    cell : what ran
    columns : what each trial gave, at least one trial
    seconds : worker time from draw to score, the control left out
    """

    cell: CellT
    columns: ColumnsT
    seconds: float


AnySample = Sample[Any, Columns]
SampleT = TypeVar("SampleT", bound=AnySample)


@dataclass(frozen=True, slots=True)
class Metric(Generic[SampleT]):
    """One measured quantity.

    Attributes
    ----------
    key : its name in documents, on the command line and in published tables
    kind : of experiment; None for a metric of every kind
    words : its name for people, without a unit
    definition : one sentence: what it is
    values : what each trial gave, as the estimator takes it
    estimator : how the figure and its interval come from these values
    heading : in a narrow table, one or two lines; by default words and unit
    unit : `%` for a share of 1, `°`, `s`, …; `{length}` stands for the scenario's unit of length
    rank : which tables show it: 0 always, of the others the greatest leaves first where there is no room;
        None only where it is asked for
    interval_rank : the same of its interval
    is_hidden_at_zero : whether a table leaves it out where no row has another value than 0, unless it
        is asked for
    """

    key: str
    kind: Kind | None
    words: str
    definition: str
    values: Callable[[SampleT], Any]
    estimator: Estimator
    heading: str = ""
    unit: str = ""
    rank: int | None = LAST
    interval_rank: int | None = None
    is_hidden_at_zero: bool = False

    @property
    def interval_key(self) -> str | None:
        """Key of its interval in documents; None where it has none."""
        return f"{self.key}_ci95" if self.estimator.has_interval else None

    @property
    def is_share(self) -> bool:
        """Whether it lies between 0 and 1 and is shown as per cent."""
        return self.unit == "%"

    @property
    def is_duration(self) -> bool:
        """Whether it is a time in seconds, which tables show in the unit that suits it."""
        return self.unit == "s"

    def unit_of(self, length: str = "") -> str:
        """Return its unit where lengths are in the unit `length`; empty where rows differ in that."""
        return self.unit.format(length=length) if length or "{length}" not in self.unit else ""

    def label(self, length: str = "") -> str:
        """Return name and unit."""
        return f"{self.words} {self.unit_of(length)}".rstrip()

    def estimate(self, sample: SampleT) -> Estimate:
        """Return the figure of a sample."""
        return self.estimator.estimate(self.values(sample))

    def entries(self, sample: SampleT) -> Mapping[str, Any]:
        """Return what a row of the result document says of it: the figure, and its interval if it has one."""
        estimate = self.estimate(sample)
        entries: dict[str, Any] = {self.key: estimate.value}
        if self.interval_key is not None:
            entries[self.interval_key] = None if estimate.interval is None else list(estimate.interval)
        return entries

    def per_trial(self, sample: SampleT) -> NDArray[np.float64]:
        """Return one number a trial, NaN where it says nothing; none of what trials have no values of."""
        return self.estimator.per_trial(self.values(sample))
