"""Result rows as the series of a chart."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from hough_tui.experiments.metrics.registry import metric as metric_of
from hough_tui.reports.field_names import PARTS, field_name
from hough_tui.reports.numerals import Pair, as_given, number, pair
from hough_tui.reports.visible import visible_line

Row = Mapping[str, Any]

MARKERS = "●○■□▲△◆◇" + "abcdefghijklmnopqrstuvwxyz"
WIDE_SPAN = 100.0
"""From this ratio of the greatest to the least swept value on, its logarithm is drawn."""


@dataclass(frozen=True, slots=True)
class Series:
    """One line of a chart.

    Attributes
    ----------
    label : what tells it from the others; empty where it is alone
    marker : one character
    x, y : of its points, in order of x
    intervals : of its points, (None, None) where there is none
    """

    label: str
    marker: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    intervals: tuple[Pair, ...]


@dataclass(frozen=True, slots=True)
class ChartData:
    """What a chart of rates shows.

    Attributes
    ----------
    label : of the metric, with its unit
    share : whether it is given in per cent
    swept : the key on the x axis; empty where nothing was swept and the points stand in a row
    ticks : places on the x axis and what is written there
    series : the lines; none where no row has a value
    """

    label: str
    share: bool
    swept: str
    ticks: tuple[list[float], list[str]]
    series: tuple[Series, ...]

    @property
    def highest(self) -> float:
        """The greatest value or end of an interval."""
        peaks = [peak for series in self.series for _, peak in series.intervals if peak is not None]
        return max([*peaks, *(y for series in self.series for y in series.y)], default=0.0)

    @property
    def closest(self) -> float:
        """The smallest distance between neighbouring places on the x axis."""
        places = sorted({x for series in self.series for x in series.x})
        return min((after - before for before, after in pairwise(places)), default=1.0)

    @property
    def has_intervals(self) -> bool:
        """Whether any point has an interval."""
        return any(ends != (None, None) for series in self.series for ends in series.intervals)


def rate_series(rows: Sequence[Row], metric: str) -> ChartData:
    """Return the series of a metric: one for each scenario, initiator and further swept values.

    Parameters
    ----------
    rows : result rows of one experiment
    metric : key of a measured quantity
    """
    shown = metric_of(metric)
    factor = 100.0 if shown.is_share else 1.0
    rows = [row for row in rows if number(row.get(metric)) is not None]
    key = _swept_key(rows)
    groups: dict[str, list[Row]] = {}
    for row, label in zip(rows, _labels(rows, key), strict=True):
        groups.setdefault(label, []).append(row)
    values = sorted({_swept(row, key) for row in rows}) if key else []
    is_wide = bool(values) and values[0] > 0.0 and values[-1] >= WIDE_SPAN * values[0]
    series = []
    for index, (label, part) in enumerate(groups.items()):
        part = sorted(part, key=lambda row: _swept(row, key)) if key else part
        x = tuple(_place(_swept(row, key), is_wide) if key else float(index) for row in part)
        y = tuple(factor * (number(row[metric]) or 0.0) for row in part)
        ends = tuple(_interval(row, shown.interval_key, factor) for row in part)
        series.append(Series(label, MARKERS[index % len(MARKERS)], x, y, ends))
    written = [_place(value, is_wide) for value in values], [as_given(value) for value in values]
    named = visible_line(field_name(key)) + (" (logarithmic)" if is_wide else "")
    units = {str(row.get("unit") or "") for row in rows}
    label = shown.label(units.pop() if len(units) == 1 else "")
    return ChartData(label, shown.is_share, named, written, tuple(series))


def _swept_key(rows: Sequence[Row]) -> str:
    """Return the first swept key that has several values, all of them numbers; empty for none."""
    for key in dict.fromkeys(key for row in rows for key in row.get("swept") or {}):
        values = [number((row.get("swept") or {}).get(key)) for row in rows]
        if None not in values and len(set(values)) > 1:
            return str(key)
    return ""


def _swept(row: Row, key: str) -> float:
    return number(row["swept"][key]) or 0.0


def _interval(row: Row, key: str | None, factor: float) -> Pair:
    low, high = pair(row.get(key)) if key else (None, None)
    return (None, None) if low is None or high is None else (factor * low, factor * high)


def _place(value: float, is_wide: bool) -> float:
    return math.log10(value) if is_wide else value


def _labels(rows: Sequence[Row], key: str) -> list[str]:
    """Return for each row what tells its series from the others."""
    parts = [
        {
            **{part: str(row.get(part) or "") for part in PARTS},
            **{
                name: f"{field_name(name)} {as_given(value)}"
                for name, value in (row.get("swept") or {}).items()
                if name != key
            },
        }
        for row in rows
    ]
    names = dict.fromkeys(name for part in parts for name in part)
    several = [name for name in names if len({part.get(name) for part in parts}) > 1]
    labels = [", ".join(filter(None, (part.get(name, "") for name in several))) for part in parts]
    return [visible_line(label) for label in labels]
