"""Text charts: rates against what was swept, plots and tracks in the plane, clusters of points."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

# A figure of its own for each chart: the one that plotext's functions share is global state.
from plotext._figure import _figure_class  # type: ignore[import-untyped]

from algorithms.clustering.clusters import Clusters
from hough_tui.reports.dots import Axis, dotted, span, ticks
from hough_tui.reports.series import Series, rate_series

Array = NDArray[np.float64]
Limits = tuple[tuple[float, float], tuple[float, float]]

COLOURS = (33, 208, 35, 170, 37, 178, 167, 105)
"""Of the 256 colours, such as can be read on a dark and on a light ground."""

AGES = (245, 109, 73, 37)
"""Colours of old to new plots."""

ESCAPES = re.compile(r"\x1b\[[0-9;]*m")
INTERFERENCE = 245
"""Colour of points that are in no cluster."""

MOST_LABELS = 40
SMALLEST = 9
"""Lines that a chart of rates needs beside its legend."""

NO_BREAK = "\N{NO-BREAK SPACE}"


@dataclass(frozen=True, slots=True)
class TrackLine:
    """A track in the plane.

    Attributes
    ----------
    x, y : float64 (k,), its plots from the first to the last
    label : what is written at its last plot; may be empty
    """

    x: Array
    y: Array
    label: str = ""


def rate_chart(rows: Sequence[Mapping[str, Any]], metric: str, width: int, height: int, colour: bool) -> str:
    """Return a chart of a metric against the swept field, one line for each initiator and scenario.

    Without a swept field each row is a point of its own.

    Parameters
    ----------
    rows : result rows of one experiment
    metric : key of a measured quantity, such as `success_rate`
    width, height : of the chart with its title and legend, in cells
    colour : whether to colour it; without, the markers tell the series apart
    """
    data = rate_series(rows, metric)
    if not data.series:
        return f"{data.label}: no row has a value."
    legend = _legend(data.series, width, max(1, height - SMALLEST), colour)
    room = max(SMALLEST - 1, height - 1 - len(legend))
    count = len(data.series)
    places = np.array([x for series in data.series for x in series.x])
    reach = span(places, max(0.04, count / width)) if data.swept else (-0.5, count - 0.5)
    top = 100.0 if data.share else data.highest * 1.05 or 1.0
    marks = ticks(0.0, top, max(2, min(6, room // 3)))
    names = [f"{mark:.10g}" for mark in marks]
    # Left of the points stand the figures and a line, below them a line, the figures and the key.
    across = Axis(*reach, max(2, width - 1 - max(map(len, names))))
    up = Axis(0.0, top, max(2, room - 2 - bool(data.swept)))
    figure = _figure(width, room, across, up)
    figure.xaxes(True, False)
    figure.yaxes(True, False)
    figure.yticks(marks, names)
    figure.xticks(*data.ticks)
    figure.xlabel(data.swept)
    cell = (across.high - across.low) / across.cells
    # Points of one place stand side by side, a cell apart, while there is room for it.
    apart = 1 if data.closest > 2 * count * cell and data.swept else 0
    paints = [COLOURS[index % len(COLOURS)] if colour else "default" for index in range(count)]
    x = [
        across.snapped(np.array(series.x), apart * (index - count // 2)).tolist()
        for index, series in enumerate(data.series)
    ]
    y = [up.snapped(np.clip(series.y, 0.0, top)).tolist() for series in data.series]
    # All the lines, then all the intervals, then all the markers: no series hides another one's points.
    for index in range(count if data.swept else 0):
        figure.plot(x[index], y[index], marker="braille", color=paints[index])
    for index, series in enumerate(data.series):
        points = zip(x[index], y[index], series.y, series.intervals, strict=True)
        for place, middle, value, (low, high) in points:
            if low is not None and high is not None:
                # From where the marker stands, so that a short interval does not reach a next cell by chance.
                ends = np.clip([middle - (value - low), middle + (high - value)], 0.0, top)
                figure.plot([place] * 2, ends.tolist(), marker="│", color=paints[index])
    for index, series in enumerate(data.series):
        figure.scatter(x[index], y[index], marker=series.marker, color=paints[index])
    title = data.label + (", bars: 95 % interval" if data.has_intervals else "")
    return "\n".join([title, _drawn(figure, colour), *legend])


def plane_chart(
    x: Array,
    y: Array,
    scan: NDArray[np.int32],
    tracks: Sequence[TrackLine],
    limits: Limits | None,
    unit: str,
    width: int,
    height: int,
    colour: bool,
) -> str:
    """Return a picture of plots and tracks, north up.

    Parameters
    ----------
    x, y : of the plots
    scan : of the plots; later ones are drawn in a stronger colour
    tracks : drawn as lines from their first to their last plot
    limits : ends of x and of y; None for what the plots and tracks take up
    unit : of length; may be empty
    width, height : of the whole picture, in cells
    colour : whether to colour it
    """
    if limits is None:
        east = span(np.concatenate([x, *(track.x for track in tracks)]), 0.02)
        north = span(np.concatenate([y, *(track.y for track in tracks)]), 0.02)
    else:
        east, north = span(np.array(limits[0], float)), span(np.array(limits[1], float))
    marks = [ticks(*east, max(2, width // 12)), ticks(*north, max(2, height // 4))]
    names = [[f"{mark:.10g}" for mark in on_axis] for on_axis in marks]
    # Beside the plane stand its frame and the figures of the axes, above it a line of ours.
    across = Axis(*east, max(2, width - 2 - max(map(len, names[1]), default=0)))
    up = Axis(*north, max(2, height - 5))
    figure = _figure(width, height - 1, across, up)
    figure.xticks(marks[0], names[0])
    figure.yticks(marks[1], names[1])
    figure.xlabel(_with("x, east", unit))
    inside = across.holds(x) & up.holds(y)
    cells = dotted(x[inside], y[inside], _ages(scan)[inside], across, up)
    if cells.glyphs:
        paints = [AGES[age] for age in cells.newest] if colour else "default"
        figure.scatter(cells.x.tolist(), cells.y.tolist(), marker=cells.glyphs, color=paints)
    for index, track in enumerate(tracks):
        finite = np.isfinite(track.x) & np.isfinite(track.y)
        if not finite.any():
            continue
        path_x, path_y = across.reach(track.x[finite]).tolist(), up.reach(track.y[finite]).tolist()
        paint = COLOURS[(index + 1) % len(COLOURS)] if colour else "default"
        # Quarter blocks stand out from the dots of the plots where there is no colour.
        figure.plot(path_x, path_y, marker="hd", color=paint)
        if track.label and index < MOST_LABELS:
            free = across.cells - 1 - across.dots(np.array(path_x[-1:]), 1)[0]
            side = "left" if free > len(track.label) else "right"
            text = f" {track.label}" if side == "left" else f"{track.label} "
            figure.text(text, path_x[-1], path_y[-1], color=paint, style="bold", alignment=side)
    title = f"{_with('y, north', unit)} · {_count(len(x), 'plot')}"
    if len(x) > np.count_nonzero(inside):
        title += f" ({len(x) - np.count_nonzero(inside):,} outside)"
    title += f" · {_count(len(tracks), 'track')}" if tracks else ""
    return f"{title}\n{_drawn(figure, colour)}"


def cluster_chart(clusters: Clusters, scan: int, radius: float, width: int, height: int, colour: bool) -> str:
    """Return a picture of the points, ellipses and plots of one scan, Doppler upwards.

    Parameters
    ----------
    clusters : of any number of scans
    scan : index of the one that is drawn
    radius : of the ellipses, in standard deviations
    width, height : of the whole picture, in cells
    colour : whether to colour each cluster; its number stands at its plot in any case
    """
    points = clusters.points.scan(scan)
    rows = slice(clusters.points.offsets[scan], clusters.points.offsets[scan + 1])
    label = np.where(clusters.kept[rows], clusters.label[rows], -1)
    own = np.flatnonzero(clusters.scan == scan).tolist()
    outlines = [clusters.ellipse(index).outline(radius) for index in own]
    across_span = span(np.concatenate([points.range, *(along for along, _ in outlines)]), 0.05)
    up_span = span(np.concatenate([points.doppler, *(doppler for _, doppler in outlines)]), 0.05)
    marks = [ticks(*across_span, max(2, width // 12)), ticks(*up_span, max(2, height // 4))]
    names = [[f"{mark:.10g}" for mark in on_axis] for on_axis in marks]
    across = Axis(*across_span, max(2, width - 2 - max(map(len, names[1]), default=0)))
    up = Axis(*up_span, max(2, height - 5))
    figure = _figure(width, height - 1, across, up)
    figure.xticks(marks[0], names[0])
    figure.yticks(marks[1], names[1])
    figure.xlabel("range")
    for index, (along, doppler) in zip(own, outlines, strict=True):
        paint = _paint(index, colour)
        figure.plot(across.reach(along).tolist(), up.reach(doppler).tolist(), marker="·", color=paint)
    # Points last but for the plots: a dot of an outline must not hide one.
    cells = dotted(points.range, points.doppler, label + 1, across, up)
    if cells.glyphs:
        paints = [_paint(int(newest) - 1, colour) for newest in cells.newest] if colour else "default"
        figure.scatter(cells.x.tolist(), cells.y.tolist(), marker=cells.glyphs, color=paints)
    for number, index in enumerate(own):
        place = clusters.range[index : index + 1], clusters.doppler[index : index + 1]
        x, y = across.snapped(place[0]).tolist(), up.snapped(place[1]).tolist()
        figure.scatter(x, y, marker="✚", color=_paint(index, colour))
        if number < MOST_LABELS:
            beside = across.snapped(place[0], 1).tolist()[0]
            figure.text(str(index), beside, y[0], color=_paint(index, colour), style="bold", alignment="left")
    title = f"Doppler · {_count(len(points), 'point')} · {_count(len(own), 'cluster')}"
    loose = int(np.count_nonzero(label < 0))
    title += f" · {loose:,} left out" if loose else ""
    title += f" · ellipses of {radius:.3g} σ" if own else ""
    return f"{title}\n{_drawn(figure, colour)}"


def _paint(index: int, colour: bool) -> Any:
    if not colour:
        return "default"
    return INTERFERENCE if index < 0 else COLOURS[index % len(COLOURS)]


def _figure(width: int, height: int, across: Axis, up: Axis) -> Any:
    figure = _figure_class()
    # Otherwise plotext cuts it to the size of the terminal, and to 80 × 24 where there is none.
    figure._limit_size(False, False)
    figure.plot_size(width, height)
    figure.theme("clear")
    figure.xlim(across.low, across.high)
    figure.ylim(up.low, up.high)
    return figure


def _drawn(figure: Any, colour: bool) -> str:
    text: str = figure.build()
    # Even a chart without any colour is full of codes that end one.
    lines = text.split("\n") if colour else [line.rstrip() for line in ESCAPES.sub("", text).split("\n")]
    return "\n".join(lines).rstrip("\n")


def _legend(series: Sequence[Series], width: int, most: int, colour: bool) -> list[str]:
    """Return the lines that say which marker is which series; none for a single nameless one."""
    if len(series) == 1 and not series[0].label:
        return []
    # No-break blanks keep a marker and its name on one line.
    entries = [f"{one.marker} {one.label}".replace(" ", NO_BREAK) for one in series]
    lines = textwrap.wrap("   ".join(entries), width, break_on_hyphens=False)
    if len(lines) > most:
        lines = lines[: most - 1]
        named = sum(line.count("   ") + 1 for line in lines)
        lines.append(f"and {len(series) - named} more")
    if colour:
        lines = _painted(lines, [one.marker for one in series])
    return [line.replace(NO_BREAK, " ") for line in lines]


def _painted(lines: Sequence[str], markers: Sequence[str]) -> list[str]:
    """Return the lines of a legend with coloured markers: letters are markers, too, and not only these."""
    painted = 0

    def paint(found: re.Match[str]) -> str:
        nonlocal painted
        if painted == len(markers) or found[2] != markers[painted]:
            return found[0]
        painted += 1
        return f"{found[1]}\x1b[38;5;{COLOURS[(painted - 1) % len(COLOURS)]}m{found[2]}\x1b[0m{NO_BREAK}"

    return [re.sub(f"(^|   )(.){NO_BREAK}", paint, line) for line in lines]


def _ages(scan: NDArray[np.int32]) -> NDArray[np.int64]:
    if not len(scan):
        return np.zeros(0, np.int64)
    first, last = int(scan.min()), int(scan.max())
    return (scan.astype(np.int64) - first) * (len(AGES) - 1) // max(1, last - first)


def _with(name: str, unit: str) -> str:
    return f"{name}, {unit}" if unit else name


def _count(number: int, what: str) -> str:
    return f"{number:,} {what}{'' if number == 1 else 's'}"
