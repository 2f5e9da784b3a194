"""Runs side by side: the rows that they have in common, and which differ beyond chance."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from string import ascii_uppercase
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.results import Identity, identity
from hough_tui.experiments.stores.folder import Run
from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.metrics import field_name, metric
from hough_tui.reports.numerals import NONE, Pair, aligned, as_given, fixed, intervals, number, pair, percent
from scenarios.sweeps import SINGULAR

METRICS = ("success_rate", "false_track_ratio", "count_exact_rate")
"""What can be compared: shares that have an interval and a value in each trial."""

Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Difference:
    """A second rate less a first one.

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
    """Return the difference of two rates with its interval, from the intervals of the two.

    Parameters
    ----------
    first, ends : a rate and the ends of its interval
    second, others : another one
    correlation : of the two rates' per-trial values, where both saw the same draws; 0 where
        they are independent

    References
    ----------
    R. G. Newcombe, Statistics in Medicine 17, 1998: pages 873 (method 10, independent) and 2635
    (method 10, paired).
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
    key : the metric, one of `METRICS`
    names, seeds : of the runs
    rows : those that stand in more than one run
    lone : number of rows that stand in one run only
    """

    key: str
    names: tuple[str, ...]
    seeds: tuple[Any, ...]
    rows: tuple[ComparedRow, ...]
    lone: int

    @property
    def letters(self) -> str:
        """What the runs are called for short."""
        return "".join(ascii_uppercase[index % 26] for index in range(len(self.names)))


def compare(runs: Sequence[tuple[str, Run]], key: str) -> Comparison:
    """Compare runs, the first of them with each of the others.

    Parameters
    ----------
    runs : names and runs, at least two
    key : of `METRICS`
    """
    places = [{identity(row): index for index, row in enumerate(run.document["rows"])} for _, run in runs]
    everywhere = list(dict.fromkeys(row for found in places for row in found))
    common = [row for row in everywhere if sum(row in found for found in places) > 1]
    paired = list(zip(places, runs, strict=True))
    rows = [_compared(row, [(run, place.get(row)) for place, (_, run) in paired], key) for row in common]
    return Comparison(
        key,
        tuple(name for name, _ in runs),
        tuple(run.document.get("seed") for _, run in runs),
        tuple(rows),
        len(everywhere) - len(common),
    )


def _compared(row: Identity, found: Sequence[tuple[Run, int | None]], key: str) -> ComparedRow:
    """Return what runs say of a row, from the place that it has in each of them."""
    base, first = found[0]
    told = [None if at is None else run.document["rows"][at] for run, at in found]
    differences = [_difference(base, first, run, at, key) for run, at in found[1:]]
    return ComparedRow(row, tuple(told), (None, *differences))


def comparison_sheet(comparison: Comparison) -> Sheet:
    """Return a comparison as a table."""
    known, rows = metric(comparison.key), comparison.rows
    columns = _names([row.identity for row in rows]) if rows else []
    for index, letter in enumerate(comparison.letters) if rows else ():
        told = [row.rows[index] or {} for row in rows]
        values = [percent(number(row.get(comparison.key))) for row in told]
        columns.append(Column(f"{letter}\n{known.label}", aligned(values)))
        ends = [pair(row.get(known.interval or "")) for row in told]
        shown = intervals([(percent(low), percent(high)) for low, high in ends])
        columns.append(Column(f"{letter}\n95 %", shown, rank=20, quiet=True))
    for index, letter in list(enumerate(comparison.letters))[1:] if rows else ():
        heading = f"{letter} − {comparison.letters[0]}"
        columns += _difference_columns(heading, [row.differences[index] for row in rows])
    return Sheet("", tuple(columns), tuple(_notes(comparison)))


def comparison_document(comparison: Comparison) -> dict[str, Any]:
    """Return a comparison as scripts read it."""
    known = metric(comparison.key)
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
                "values": [None if told is None else told.get(comparison.key) for told in row.rows],
                "ci95": [None if told is None else told.get(known.interval or "") for told in row.rows],
                "differences": [
                    None
                    if found is None
                    else {
                        "value": found.value,
                        "ci95": [found.low, found.high],
                        "beyond_chance": found.is_beyond_chance,
                    }
                    for found in row.differences
                ],
            }
        )
    return {
        "runs": list(comparison.names),
        "seeds": list(comparison.seeds),
        "metric": comparison.key,
        "rows": rows,
        "rows_in_one_run_only": comparison.lone,
        "same_criteria": not _differ_in_criteria(comparison),
    }


def _difference(base: Run, first: int | None, other: Run, second: int | None, key: str) -> Difference | None:
    if first is None or second is None:
        return None
    before, after = base.document["rows"][first], other.document["rows"][second]
    values = number(before.get(key)), number(after.get(key))
    ends = metric(key).interval or ""
    pairs = pair(before.get(ends)), pair(after.get(ends))
    if None in (*values, *pairs[0], *pairs[1]):
        return None
    related = 0.0
    # Trials of one seed are one and the same draws, or share their clutter: they go in pairs.
    if before["seed"] == after["seed"] and before["trials"] == after["trials"]:
        if base.document.get("complete", True) and other.document.get("complete", True):
            related = _correlation(
                _per_trial(base.columns[first], key), _per_trial(other.columns[second], key)
            )
    return difference(values[0] or 0.0, pairs[0], values[1] or 0.0, pairs[1], related)


def _per_trial(columns: Mapping[str, NDArray[Any]], key: str) -> NDArray[np.float64]:
    if key == "success_rate":
        found: NDArray[np.float64] = columns["found"].mean(axis=1)
        return found
    if key == "count_exact_rate":
        return np.asarray(columns["excess"] == 0, np.float64)
    ratio: NDArray[np.float64] = columns["false"] / np.maximum(columns["tracks"], 1)
    return ratio


def _correlation(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    spread = float(first.std() * second.std())
    if len(first) != len(second) or spread == 0.0:
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


def _difference_columns(heading: str, differences: Sequence[Difference | None]) -> list[Column]:
    values = aligned([NONE if given is None else _signed(given.value) for given in differences])
    ends = intervals(
        [
            (NONE, NONE) if given is None else (_signed(given.low), _signed(given.high))
            for given in differences
        ]
    )
    verdicts = tuple(
        NONE if given is None else "differs" if given.is_beyond_chance else "" for given in differences
    )
    styles = tuple("bold" if verdict == "differs" else "" for verdict in verdicts)
    return [
        Column(f"{heading}\npoints", values, styles=styles),
        Column("95 %\ninterval", ends, quiet=True),
        Column("beyond\nchance", verdicts, prose=True, styles=styles),
    ]


def _signed(share: float) -> str:
    text = fixed(100.0 * share, 1)
    return text if text.startswith("-") or text == "0.0" else f"+{text}"


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
    found = [given for row in comparison.rows for given in row.differences if given is not None]
    surprising = sum(given.is_beyond_chance for given in found)
    notes.append(
        f"{surprising} of {len(found)} differences {'lies' if surprising == 1 else 'lie'} beyond chance; "
        f"with 95 % intervals one in 20 would without any cause."
        if found
        else f"Nothing here has a rate of {metric(comparison.key).label} in two of them."
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
        for before, after in pairwise(told for told in row.rows if told is not None)
    )
