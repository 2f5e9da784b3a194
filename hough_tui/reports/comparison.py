"""Runs side by side: the rows that they have in common, and which differ beyond chance."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from string import ascii_uppercase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from hough_tui.experiments.cases import AnyCell
from hough_tui.experiments.metrics.registry import AnyMetric
from hough_tui.experiments.results import Identity, cells_of_run, identity, sample_of_row
from hough_tui.experiments.stores.folder import Run
from hough_tui.reports.field_names import field_name
from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.metric_columns import interval_texts, measured, metric_texts
from hough_tui.reports.numerals import NONE, Pair, aligned, as_given, intervals, number, pair
from scenarios.sweeps import SINGULAR

Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Difference:
    """A second figure less a first one.

    Attributes
    ----------
    value, low, high : it and its 95 % interval
    """

    value: float
    low: float
    high: float

    @property
    def is_beyond_chance(self) -> bool:
        """Whether the interval holds no 0."""
        return self.low > 0.0 or self.high < 0.0


def difference(first: float, ends: Pair, second: float, others: Pair, correlation: float = 0.0) -> Difference:
    """Return the difference of two figures with its interval, from the intervals of the two.

    Parameters
    ----------
    first, ends : a figure and the ends of its interval
    second, others : another one
    correlation : of the two figures' per-trial values, where both saw the same draws; 0 where
        they are independent

    References
    ----------
    R. G. Newcombe, Statistics in Medicine 17, 1998: pages 873 (method 10, independent) and 2635
    (method 10, paired); of figures that are no rates, G. Y. Zou and A. Donner, Statistics in Medicine 27,
    2008, page 1693.
    """
    below, above = first - (ends[0] or 0.0), (ends[1] or 0.0) - first
    below_other, above_other = second - (others[0] or 0.0), (others[1] or 0.0) - second

    def reach(one: float, other: float) -> float:
        return math.sqrt(max(0.0, one * one + other * other - 2.0 * correlation * one * other))

    value = second - first
    return Difference(value, value - reach(below_other, above), value + reach(above_other, below))


@dataclass(frozen=True, slots=True)
class ComparedRow:
    """What several runs say of one and the same row.

    Attributes
    ----------
    identity : what it is told apart by
    rows : of each run; None where it has no such row
    differences : of each run and the first one, which is the first: None for that, and where
        one of the two says nothing
    """

    identity: Identity
    rows: tuple[Row | None, ...]
    differences: tuple[Difference | None, ...]


@dataclass(frozen=True, slots=True)
class Comparison:
    """Runs side by side.

    Attributes
    ----------
    metric : what is compared
    names, seeds : of the runs
    rows : those that stand in more than one run
    lone : number of rows that stand in one run only
    """

    metric: AnyMetric
    names: tuple[str, ...]
    seeds: tuple[Any, ...]
    rows: tuple[ComparedRow, ...]
    lone: int

    @property
    def letters(self) -> str:
        """What the runs are called for short."""
        return "".join(ascii_uppercase[index % 26] for index in range(len(self.names)))


def comparable(rows: Sequence[Row]) -> list[AnyMetric]:
    """Return the metrics that rows can be compared by: those that have an interval in some row."""
    return [
        metric
        for metric in measured(rows)
        if any(None not in pair(row.get(metric.interval_key or "")) for row in rows)
    ]


def compare(runs: Sequence[tuple[str, Run]], metric: AnyMetric) -> Comparison:
    """Compare runs, the first of them with each of the others.

    Parameters
    ----------
    runs : names and runs, at least two
    metric : what is compared

    Raises
    ------
    RequestError
        Where the metric has no interval.
    """
    if metric.interval_key is None:
        raise RequestError(f"{metric.key} has no interval, so that no difference can be told from chance")
    sides = [_Side(run) for _, run in runs]
    everywhere = list(dict.fromkeys(row for side in sides for row in side.places))
    common = [row for row in everywhere if sum(row in side.places for side in sides) > 1]
    rows = [_compared(row, sides, metric) for row in common]
    return Comparison(
        metric,
        tuple(name for name, _ in runs),
        tuple(run.document.get("seed") for _, run in runs),
        tuple(rows),
        len(everywhere) - len(common),
    )


class _Side:
    """One of the runs, with the cells behind its rows."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self.rows: list[Row] = run.document["rows"]
        self.places = {identity(row): index for index, row in enumerate(self.rows)}

    @cached_property
    def cells(self) -> list[AnyCell | None]:
        """The cell of each row; None where the sets that were kept do not hold it."""
        return cells_of_run(self.run)

    @property
    def is_complete(self) -> bool:
        """Whether every trial was done."""
        return bool(self.run.document.get("complete", True))

    def row(self, wanted: Identity) -> Row | None:
        """Return a row; None where there is no such one."""
        return self.rows[self.places[wanted]] if wanted in self.places else None

    def per_trial(self, wanted: Identity, metric: AnyMetric) -> NDArray[np.float64]:
        """Return one number a trial of a row; none where its cell is not known."""
        place = self.places[wanted]
        cell = self.cells[place]
        return np.zeros(0) if cell is None else metric.per_trial(sample_of_row(self.run, place, cell))


def _compared(wanted: Identity, sides: Sequence[_Side], metric: AnyMetric) -> ComparedRow:
    """Return what runs say of a row."""
    differences = [_difference(sides[0], other, wanted, metric) for other in sides[1:]]
    return ComparedRow(wanted, tuple(side.row(wanted) for side in sides), (None, *differences))


def comparison_sheet(comparison: Comparison) -> Sheet:
    """Return a comparison as a table."""
    metric, rows = comparison.metric, comparison.rows
    columns = _names([row.identity for row in rows]) if rows else []
    units = {str(row.get("unit") or "") for compared in rows for row in compared.rows if row is not None}
    length = units.pop() if len(units) == 1 else ""
    for index, letter in enumerate(comparison.letters) if rows else ():
        own = [row.rows[index] or {} for row in rows]
        values = metric_texts(metric, [number(row.get(metric.key)) for row in own])
        columns.append(Column(f"{letter}\n{metric.label(length)}", aligned(values), key=metric.key))
        ends = interval_texts(metric, [pair(row.get(metric.interval_key or "")) for row in own])
        columns.append(Column(f"{letter}\n95 %", ends, rank=20, quiet=True))
    for index, letter in list(enumerate(comparison.letters))[1:] if rows else ():
        heading = f"{letter} − {comparison.letters[0]}\n{_unit_of_difference(metric, length)}".rstrip()
        columns += _difference_columns(metric, heading, [row.differences[index] for row in rows])
    return Sheet("", tuple(columns), tuple(_notes(comparison)))


def comparison_document(comparison: Comparison) -> dict[str, Any]:
    """Return a comparison as scripts read it."""
    key, interval = comparison.metric.key, comparison.metric.interval_key or ""
    rows = []
    for row in comparison.rows:
        set_name, experiment, parts, swept = row.identity
        named = zip(SINGULAR.values(), parts, strict=True)
        rows.append(
            {
                "set": set_name,
                "experiment": experiment,
                **{part: name for part, name in named if name is not None},
                "swept": dict(swept),
                "values": [None if one is None else one.get(key) for one in row.rows],
                "ci95": [None if one is None else one.get(interval) for one in row.rows],
                "differences": [
                    None
                    if one is None
                    else {
                        "value": one.value,
                        "ci95": [one.low, one.high],
                        "beyond_chance": one.is_beyond_chance,
                    }
                    for one in row.differences
                ],
            }
        )
    return {
        "runs": list(comparison.names),
        "seeds": list(comparison.seeds),
        "metric": key,
        "rows": rows,
        "rows_in_one_run_only": comparison.lone,
        "same_criteria": not _differ_in_criteria(comparison),
    }


def _difference(base: _Side, other: _Side, wanted: Identity, metric: AnyMetric) -> Difference | None:
    before, after = base.row(wanted), other.row(wanted)
    if before is None or after is None:
        return None
    values = number(before.get(metric.key)), number(after.get(metric.key))
    ends = metric.interval_key or ""
    pairs = pair(before.get(ends)), pair(after.get(ends))
    if None in (*values, *pairs[0], *pairs[1]):
        return None
    related = 0.0
    # Trials of one seed are one and the same draws, or share their clutter: they go in pairs.
    if before["seed"] == after["seed"] and before["trials"] == after["trials"]:
        if base.is_complete and other.is_complete:
            related = _correlation(base.per_trial(wanted, metric), other.per_trial(wanted, metric))
    return difference(values[0] or 0.0, pairs[0], values[1] or 0.0, pairs[1], related)


def _correlation(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    if len(first) != len(second):
        return 0.0
    # A trial in which one of the two has nothing to say makes no pair.
    both = np.isfinite(first) & np.isfinite(second)
    first, second = first[both], second[both]
    spread = float(first.std() * second.std()) if len(first) > 1 else 0.0
    if spread == 0.0:
        return 0.0
    return float(((first - first.mean()) * (second - second.mean())).mean()) / spread


def _names(rows: Sequence[Identity]) -> list[Column]:
    told = [
        {"set": set_name, "experiment": experiment, **dict(zip(SINGULAR.values(), parts, strict=True))}
        for set_name, experiment, parts, _ in rows
    ]
    columns = []
    for heading in told[0]:
        texts = tuple(str(row[heading] or NONE) for row in told)
        # What runs is told always, all else where it tells rows apart.
        if len(set(texts)) > 1 or (heading == "initiator" and any(row[heading] for row in told)):
            columns.append(Column(heading, texts, prose=True))
    swept = [dict(values) for *_, values in rows]
    for key in dict.fromkeys(key for values in swept for key in values):
        columns.append(Column(field_name(key), aligned([as_given(values.get(key)) for values in swept])))
    return columns


def _unit_of_difference(metric: AnyMetric, length: str) -> str:
    return "points" if metric.is_share else metric.unit_of(length)


def _difference_columns(
    metric: AnyMetric, heading: str, differences: Sequence[Difference | None]
) -> list[Column]:
    values = aligned([NONE if one is None else _signed(metric, one.value) for one in differences])
    ends = intervals(
        [
            (NONE, NONE) if one is None else (_signed(metric, one.low), _signed(metric, one.high))
            for one in differences
        ]
    )
    verdicts = tuple(
        NONE if one is None else "differs" if one.is_beyond_chance else "" for one in differences
    )
    styles = tuple("bold" if verdict == "differs" else "" for verdict in verdicts)
    return [
        Column(heading, values, styles=styles),
        Column("95 %\ninterval", ends, quiet=True),
        Column("beyond\nchance", verdicts, prose=True, styles=styles),
    ]


def _signed(metric: AnyMetric, value: float) -> str:
    (text,) = metric_texts(metric, [value])
    return text if text.startswith("-") or text in ("0", "0.0") else f"+{text}"


def _notes(comparison: Comparison) -> list[str]:
    notes = [
        f"{letter}: {name}, seed {as_given(seed)}"
        for letter, name, seed in zip(comparison.letters, comparison.names, comparison.seeds, strict=True)
    ]
    if not comparison.rows:
        return [
            *notes,
            "No row stands in more than one of them: rows are matched by set, experiment, what of the set "
            "runs, and swept values.",
        ]
    differences = [one for row in comparison.rows for one in row.differences if one is not None]
    surprising = sum(one.is_beyond_chance for one in differences)
    notes.append(
        f"{surprising} of {len(differences)} differences {'lies' if surprising == 1 else 'lie'} beyond "
        "chance; with 95 % intervals one in 20 would without any cause."
        if differences
        else f"Nothing here has a figure of {comparison.metric.label()} in two of them."
    )
    if comparison.lone:
        stand = "s stand" if comparison.lone > 1 else " stands"
        notes.append(f"{comparison.lone} row{stand} in one run only and are left out.")
    if _differ_in_criteria(comparison):
        notes.append("The runs do not count success by the same criterion everywhere.")
    return notes


def _differ_in_criteria(comparison: Comparison) -> bool:
    return any(
        before.get("criterion") != after.get("criterion")
        for row in comparison.rows
        for before, after in pairwise(one for one in row.rows if one is not None)
    )
