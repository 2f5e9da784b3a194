"""Metrics of result rows as columns of a table, and which of them a table is asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from algorithms.errors import RequestError
from algorithms.parameters import unknown
from hough_tui.experiments.metrics.kinds import kind_of
from hough_tui.experiments.metrics.registry import METRICS, AnyMetric
from hough_tui.reports.layout import Column, broken
from hough_tui.reports.numerals import Pair, aligned, durations, intervals, number, pair, percent, significant

Row = Mapping[str, Any]

ALL = "all"
"""What stands for every column."""

SHORT_NAME = 8
"""Width at which the name of a target is broken."""

MANY_TARGETS, UNLIKE = 3, 0.1
"""Where so many targets differ by more than this, their mean says little: their columns go first."""

RANK_OF_TWO, RANK_OF_UNLIKE, RANK_OF_ALIKE = 90, 35, 55
"""Ranks of columns by target: of few targets, of many that differ, of many that do not."""


def metric_texts(metric: AnyMetric, values: Sequence[float | None]) -> list[str]:
    """Return values of a metric as people read them, without the unit."""
    return [percent(value) if metric.is_share else significant(value) for value in values]


def has_values(metric: AnyMetric, rows: Sequence[Row]) -> bool:
    """Return whether any row has a number, or several by target, for a metric."""
    return any(number(row.get(metric.key)) is not None or _by_target(metric, row) for row in rows)


def measured(rows: Sequence[Row]) -> list[AnyMetric]:
    """Return the metrics that are one number and of which some row has a value, in their order."""
    return [metric for metric in METRICS.values() if metric.estimator.is_number and has_values(metric, rows)]


def charted(key: str) -> AnyMetric:
    """Return a metric that is one number a row.

    Raises
    ------
    RequestError
        Where there is none of that key.
    """
    known = [metric.key for metric in METRICS.values() if metric.estimator.is_number]
    if key not in known:
        raise RequestError(f"--metric: {unknown(key, known, 'metric')}")
    return METRICS[key]


def column_keys() -> list[str]:
    """Return what tables can be asked for: the keys of metrics and of their intervals."""
    shown = [one for one in METRICS.values() if one.estimator.is_number or one.estimator.is_by_target]
    return [key for metric in shown for key in (metric.key, metric.interval_key) if key is not None]


def parse_columns(text: str) -> tuple[str, ...]:
    """Return the keys of columns from a list with commas; `all` stands for every one.

    Raises
    ------
    RequestError
        Where one is not known, or none is named.
    """
    keys, known = [key.strip() for key in text.split(",") if key.strip()], column_keys()
    if keys == [ALL]:
        return tuple(known)
    metrics = [*(key for key in known if key in METRICS), ALL]
    for key in keys:
        if key not in known:
            raise RequestError(f"--columns: {unknown(key, metrics, 'metric')}")
    if not keys:
        raise RequestError(f"--columns: no metric is named; give some of {', '.join(metrics)}")
    return tuple(dict.fromkeys(keys))


@dataclass(frozen=True, slots=True)
class Offer:
    """A column that a table of some rows can show.

    Attributes
    ----------
    key : of the metric or its interval
    words : what it is called, with its unit
    definition : what it is
    """

    key: str
    words: str
    definition: str


def offered(rows: Sequence[Row]) -> list[Offer]:
    """Return the columns that say something of rows, each interval after its metric."""
    offers = []
    for metric in METRICS.values():
        is_column = metric.estimator.is_number or metric.estimator.is_by_target
        if is_column and has_values(metric, rows):
            label = metric.label()
            offers.append(Offer(metric.key, label, metric.definition))
            if any(None not in pair(row.get(metric.interval_key or "")) for row in rows):
                words = f"95 % interval of {label}"
                offers.append(Offer(metric.interval_key or "", f"  {words}", metric.definition))
    return offers


def metric_columns(rows: Sequence[Row], wanted: Sequence[str] | None = None) -> list[Column]:
    """Return the columns of metrics of rows.

    Parameters
    ----------
    rows : result rows as `hough-tui batch --json` prints them
    wanted : keys of columns, all of which stay as long as there is room, the last leaving first; None for
        those that have a rank and say something
    """
    if wanted is not None:
        before = [None, *wanted]
        return [
            column
            for rank, (key, previous) in enumerate(zip(wanted, before, strict=False))
            for column in _wanted(rows, key, previous, rank)
        ]
    kinds = {kind_of(row).world for row in rows}
    columns, by_target = [], list[Column]()
    for metric in METRICS.values():
        if metric.kind is not None and metric.kind.world not in kinds:
            continue
        if metric.estimator.is_by_target:
            by_target += _target_columns(metric, rows)
        if not metric.estimator.is_number:
            continue
        values = [number(row.get(metric.key)) for row in rows]
        is_silent = not any(values) if metric.is_hidden_at_zero else set(values) <= {None}
        if metric.rank == 0 or (metric.rank is not None and not is_silent):
            columns.append(_column(metric, rows, metric.rank))
        if metric.interval_rank is not None:
            columns += _interval_columns(metric, rows, metric.interval_rank)
    # How targets differ comes after what is said of all of them.
    return columns + by_target


def _wanted(rows: Sequence[Row], key: str, previous: str | None, rank: int) -> list[Column]:
    """Return the columns of a key; an interval that does not stand beside its metric says whose it is."""
    for metric in METRICS.values():
        if metric.key == key:
            is_by_target = metric.estimator.is_by_target
            return _target_columns(metric, rows, rank) if is_by_target else [_column(metric, rows, rank)]
        if metric.interval_key == key:
            (column,) = _interval_columns(metric, rows, rank, is_wanted=True)
            return [column if previous == metric.key else replace(column, heading=f"{metric.words}\n95 %")]
    return []


def _column(metric: AnyMetric, rows: Sequence[Row], rank: int) -> Column:
    values = [number(row.get(metric.key)) for row in rows]
    if metric.is_duration:
        unit, cells = durations(values)
        return Column(f"{unit}\n/trial", cells, rank=rank, called=metric.words, key=metric.key)
    units = list(dict.fromkeys(str(row.get("unit") or "") for row in rows))
    texts = aligned(metric_texts(metric, values))
    if len(units) > 1 and metric.unit_of() != metric.unit:
        # Each row has its own unit of length.
        own = [metric.unit_of(str(row.get("unit") or "")) for row in rows]
        room = max(map(len, own))
        texts = tuple(f"{text} {unit:<{room}}" for text, unit in zip(texts, own, strict=True))
        units = [""]
    heading = _heading(metric, units[0] if units else "")
    return Column(heading, texts, rank=rank, called=metric.words, key=metric.key)


def _heading(metric: AnyMetric, length: str) -> str:
    if metric.heading:
        return metric.heading.format(length=length).rstrip("\n")
    return "\n".join(filter(None, (metric.words, metric.unit_of(length))))


def _interval_columns(
    metric: AnyMetric, rows: Sequence[Row], rank: int, *, is_wanted: bool = False
) -> list[Column]:
    """Return the column of an interval; none where no row has one, unless it is wanted."""
    pairs = [pair(row.get(metric.interval_key or "")) for row in rows]
    if not is_wanted and all(ends == (None, None) for ends in pairs):
        return []
    cells, called = interval_texts(metric, pairs), f"the interval of {metric.label()}"
    key = metric.interval_key or ""
    return [Column("95 %\ninterval", cells, rank=rank, quiet=True, called=called, key=key)]


def interval_texts(metric: AnyMetric, pairs: Sequence[Pair]) -> tuple[str, ...]:
    """Return intervals of a metric as people read them."""
    lows = metric_texts(metric, [low for low, _ in pairs])
    highs = metric_texts(metric, [high for _, high in pairs])
    return intervals(list(zip(lows, highs, strict=True)))


def _target_columns(metric: AnyMetric, rows: Sequence[Row], rank: int | None = None) -> list[Column]:
    """Return a column for each target; none of one target, whose figures are those of all."""
    shares = [_by_target(metric, row) for row in rows]
    most = max(map(len, shares), default=0)
    if most < 2:
        return []
    if rank is None:
        known = [[share for share in values if share is not None] for values in shares]
        spread = max((max(values) - min(values) for values in known if values), default=0.0)
        # Of two targets the mean tells nearly as much; of more it hides which of them is missed.
        rank = RANK_OF_TWO
        if most >= MANY_TARGETS:
            rank = RANK_OF_UNLIKE if spread > UNLIKE else RANK_OF_ALIKE
    columns = []
    for target in range(most):
        values = [one[target] if target < len(one) else None for one in shares]
        heading = f"{broken(_target_name(rows, target), SHORT_NAME)}\n{metric.unit_of()}"
        cells = aligned(metric_texts(metric, values))
        columns.append(Column(heading, cells, rank=rank, quiet=True, called=metric.words, key=metric.key))
    return columns


def _by_target(metric: AnyMetric, row: Row) -> list[float | None]:
    values = row.get(metric.key)
    return [number(value) for value in values] if isinstance(values, (list, tuple)) else []


def _target_name(rows: Sequence[Row], target: int) -> str:
    """Return what all rows call a target, else its number."""
    names = {(list(row.get("target_names") or []) + [None] * (target + 1))[target] for row in rows}
    name = names.pop() if len(names) == 1 else None
    return str(name or f"target {target + 1}")
