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

from hough_tui.experiments.store import Run
from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.metrics import field_name, metric
from hough_tui.reports.numerals import NONE, Pair, aligned, as_given, fixed, intervals, number, pair, percent
from hough_tui.ui.views.shown_run import Identity, identity
from scenarios.sweeps import SINGULAR

METRICS = ("success_rate", "false_track_ratio")
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


def compared(runs: Sequence[tuple[str, Run]], key: str = METRICS[0]) -> Sheet:
    """Return the sheet that compares runs, the first of them with each of the others.

    Parameters
    ----------
    runs : names and runs, at least two
    key : of `METRICS`
    """
    known = metric(key)
    places = [{identity(row): index for index, row in enumerate(run.document["rows"])} for _, run in runs]
    everywhere = list(dict.fromkeys(row for found in places for row in found))
    common = [row for row in everywhere if sum(row in found for found in places) > 1]
    columns = _names(common) if common else []
    letters = [ascii_uppercase[index % 26] for index in range(len(runs))]
    for letter, found, (_, run) in zip(letters, places, runs, strict=True) if common else ():
        rows = [run.document["rows"][found[row]] if row in found else {} for row in common]
        columns.append(
            Column(f"{letter}\n{known.label}", aligned([percent(number(row.get(key))) for row in rows]))
        )
        ends = [pair(row.get(known.interval or "")) for row in rows]
        shown = intervals([(percent(low), percent(high)) for low, high in ends])
        columns.append(Column(f"{letter}\n95 %", shown, rank=20, quiet=True))
    surprising = 0
    for letter, found, (_, run) in list(zip(letters, places, runs, strict=True))[1:] if common else ():
        differences = [_difference(row, runs[0][1], places[0], run, found, key) for row in common]
        columns += _difference_columns(f"{letter} − {letters[0]}", differences)
        surprising += sum(given is not None and given.is_beyond_chance for given in differences)
    return Sheet("", tuple(columns), tuple(_notes(runs, letters, common, everywhere, surprising)))


def _difference(
    row: Identity,
    base: Run,
    base_places: Mapping[Identity, int],
    other: Run,
    other_places: Mapping[Identity, int],
    key: str,
) -> Difference | None:
    if row not in base_places or row not in other_places:
        return None
    first, second = base_places[row], other_places[row]
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


def _notes(
    runs: Sequence[tuple[str, Run]],
    letters: Sequence[str],
    common: Sequence[Identity],
    everywhere: Sequence[Identity],
    surprising: int,
) -> list[str]:
    notes = [
        f"{letter}: {name}, seed {as_given(run.document.get('seed'))}"
        for letter, (name, run) in zip(letters, runs, strict=True)
    ]
    if not common:
        return [
            *notes,
            "No row stands in more than one of them: rows are matched by set, experiment, scenario, "
            "initiator and swept values.",
        ]
    pairs = len(common) * (len(runs) - 1)
    notes.append(
        f"{surprising} of {pairs} differences {'lies' if surprising == 1 else 'lie'} beyond chance; "
        f"with 95 % intervals one in 20 would without any cause."
    )
    if len(everywhere) > len(common):
        lone = len(everywhere) - len(common)
        notes.append(f"{lone} row{'s stand' if lone > 1 else ' stands'} in one run only and are left out.")
    criteria = [
        [row.get("criterion") for row in run.document["rows"] if identity(row) in common] for _, run in runs
    ]
    if any(before != after for before, after in pairwise(criteria)):
        notes.append("The runs do not count success by the same criterion everywhere.")
    return notes
