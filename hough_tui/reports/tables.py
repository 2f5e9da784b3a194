"""Tables for a terminal, from the documents that scripts read."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table

from hough_tui.experiments.metrics.registry import metric as metric_of
from hough_tui.reports.layout import Column, Sheet, repeats, sheet_table
from hough_tui.reports.metric_columns import metric_texts
from hough_tui.reports.numerals import (
    NONE,
    aligned,
    as_given,
    decimals_of_lengths,
    durations,
    fixed,
    intervals,
    number,
    pair,
    significant,
)
from hough_tui.reports.rates import rate_sheets

Document = Mapping[str, Any]

VERDICTS = {True: "yes", False: "no", None: NONE}


def rate_tables(rows: Sequence[Document], width: int, wanted: Sequence[str] | None = None) -> list[Table]:
    """Return one table for each experiment of each set.

    Parameters
    ----------
    rows : result rows as `hough-tui batch --json` prints them
    width : of the terminal, in cells
    wanted : keys of the metrics and intervals to show, in this order; None for those that say something
    """
    return [sheet_table(sheet, width) for sheet in rate_sheets(rows, wanted)]


def track_table(document: Document, width: int, most: int | None = None) -> Table:
    """Return the table of the tracks that an initiator found, strongest first.

    Parameters
    ----------
    document : as `hough-tui initiate --json` prints it; `unit` may stand in it
    width : of the terminal, in cells
    most : how many tracks to show; None for all
    """
    return sheet_table(track_sheet(document, most), width)


def published_table(document: Document, width: int) -> Table:
    """Return the table of published figures beside the measured ones.

    Parameters
    ----------
    document : as `hough-tui reproduce --json` prints it
    width : of the terminal, in cells
    """
    return sheet_table(published_sheet(document), width)


def listing(
    title: str,
    entries: Sequence[tuple[str, str]],
    width: int,
    headings: tuple[str, str] = ("name", "description"),
) -> Table:
    """Return a table of names and what they stand for.

    Parameters
    ----------
    title : a line above it; may be empty
    entries : name and description of each
    width : of the terminal, in cells
    headings : of the two columns
    """
    names, descriptions = tuple(name for name, _ in entries), tuple(text for _, text in entries)
    columns = (
        Column(headings[0], names, prose=True, styles=("bold",) * len(names)),
        Column(headings[1], descriptions, prose=True),
    )
    return sheet_table(Sheet(title, columns), width)


def track_sheet(document: Document, most: int | None = None) -> Sheet:
    """Return the tracks of a document, strongest first, as `track_table` shows them."""
    found = list(document.get("tracks") or [])
    found.sort(key=lambda track: -(number(track.get("score")) or 0.0))
    tracks = found[:most]
    unit = str(document.get("unit") or "")
    rho = _numbers(tracks, "rho")
    decimals = decimals_of_lengths([*rho, *(number(part) for track in tracks for part in _position(track))])
    columns = [
        Column("#", tuple(map(str, range(len(tracks))))),
        Column("score", aligned([as_given(track.get("score")) for track in tracks])),
        Column("plots", tuple(str(len(track.get("plots") or [])) for track in tracks), rank=30),
        Column("θ\n°", tuple(fixed(number(track.get("theta_deg")), 2) for track in tracks), rank=10),
        Column(_with("ρ", unit), tuple(fixed(value, decimals) for value in rho), rank=10),
    ]
    axes = range(max((len(_position(track)) for track in tracks), default=0))
    speed_unit = f"{unit}/s" if unit else ""
    for axis, name in zip(axes, "xyz", strict=False):
        texts = [fixed(_part(_position(track), axis), decimals) for track in tracks]
        columns.append(Column(_with(name, unit), tuple(texts), rank=40, called="position"))
    for axis, name in zip(axes, "xyz", strict=False):
        texts = [significant(_part(track.get("velocity"), axis)) for track in tracks]
        columns.append(Column(_with(f"v{name}", speed_unit), aligned(texts), rank=50, called="velocity"))
    courses = [_course(track.get("velocity")) for track in tracks]
    columns.append(Column(_with("speed", speed_unit), aligned([significant(speed) for speed, _ in courses])))
    columns.append(Column("heading\n°", tuple(fixed(heading, 1) for _, heading in courses)))
    name = str(document.get("initiator") or "")
    count = f"{len(found):,} track{'' if len(found) == 1 else 's'}"
    title = f"{name} · {count}" if name else count
    return Sheet(title, tuple(columns), _track_notes(document, tracks, len(found)), _outside(document))


def published_sheet(document: Document) -> Sheet:
    """Return published beside measured figures, as `published_table` shows them."""
    rows = list(document.get("rows") or [])
    metrics = [metric_of(str(row.get("metric") or "")) for row in rows]

    def texts(values: Sequence[float | None]) -> list[str]:
        pairs = zip(metrics, values, strict=True)
        return [text for metric, value in pairs for text in metric_texts(metric, [value])]

    pairs = [pair(row.get("ci95")) for row in rows]
    lows, highs = texts([low for low, _ in pairs]), texts([high for _, high in pairs])
    notes = list(dict.fromkeys(str(row["note"]) for row in rows if row.get("note")))
    marks = tuple(f"[{notes.index(str(row['note'])) + 1}]" if row.get("note") else "" for row in rows)
    verdicts = [row.get("consistent") for row in rows]
    cases = tuple(str(row.get("case") or NONE) for row in rows)
    columns = [
        Column("case", cases, prose=True, styles=repeats(cases)),
        Column("metric", tuple(metric.label() for metric in metrics), prose=True),
        Column("published", aligned(texts(_numbers(rows, "published")))),
        Column("measured", aligned(texts(_numbers(rows, "measured")))),
        Column("95 %\ninterval", intervals(list(zip(lows, highs, strict=True))), rank=10, quiet=True),
        Column(
            "agrees",
            tuple(VERDICTS.get(verdict, NONE) for verdict in verdicts),
            styles=tuple("bold red" if verdict is False else "" for verdict in verdicts),
        ),
    ]
    if notes:
        columns.append(Column("note", marks))
    trials = number(document.get("trials"))
    known_verdicts = [verdict for verdict in verdicts if verdict is not None]
    about = [f"{int(trials):,} trials an entry."] if trials is not None else []
    if known_verdicts:
        about.append(f"{sum(known_verdicts)} of {len(known_verdicts)} compared figures agree.")
    below = [" ".join(about)] if about else []
    below += [f"[{index}] {note}" for index, note in enumerate(notes, start=1)]
    return Sheet(f"{document.get('table') or ''} · published and measured", tuple(columns), tuple(below))


def _with(name: str, unit: str) -> str:
    return f"{name}\n{unit}" if unit else name


def _numbers(rows: Sequence[Document], key: str) -> list[float | None]:
    return [number(row.get(key)) for row in rows]


def _position(track: Document) -> Sequence[object]:
    return track.get("position") or ()


def _part(vector: Sequence[object] | None, axis: int) -> float | None:
    return number(vector[axis]) if vector is not None and axis < len(vector) else None


def _course(velocity: Sequence[object] | None) -> tuple[float | None, float | None]:
    """Return the speed and the heading in degrees clockwise from north, which is the y axis."""
    parts = [number(part) for part in velocity or ()]
    known = [part for part in parts if part is not None]
    if len(known) < 2 or len(known) < len(parts):
        return None, None
    east, north = known[:2]
    if east == 0.0 and north == 0.0:
        return math.hypot(*known), None
    # 359.96 would be printed as 360.0, which is written 0.0.
    heading = round(math.degrees(math.atan2(east, north)) % 360.0, 1) % 360.0
    return math.hypot(*known), heading


def _track_notes(document: Document, tracks: Sequence[Document], found: int) -> tuple[str, ...]:
    parts = []
    if len(tracks) < found:
        parts.append(f"The {len(tracks):,} strongest are shown.")
    counts = [
        f"{int(count):,} {what}"
        for what in ("plots", "scans")
        if (count := number(document.get(what))) is not None
    ]
    seconds = number(document.get("seconds"))
    if seconds is not None:
        unit, (duration,) = durations([seconds])
        counts.append(f"{duration} {unit}")
    if counts:
        parts.append(f"{', '.join(counts)}.")
    times = {number(track.get("time")) for track in tracks}
    if len(times) == 1 and (time := times.pop()) is not None:
        parts.append(f"Position and velocity at {as_given(time)} s, heading clockwise from north.")
    elif tracks:
        parts.append("Position and velocity at the first plot of each track, heading clockwise from north.")
    votes = document.get("accumulator") or {}
    sizes = [number(votes.get(key)) for key in ("theta_bins", "rho_bins", "votes", "max")]
    lines = [" ".join(parts)]
    counted = [
        f"{name.replace('_', ' ')} {count:,}" for name, count in (document.get("effort") or {}).items()
    ]
    if counted:
        lines.append(f"Counted: {', '.join(counted)}.")
    if None not in sizes:
        theta, rho, total, greatest = (int(size or 0) for size in sizes)
        lines.append(
            f"Accumulator of {theta:,} × {rho:,} cells (θ × ρ), {total:,} votes, {greatest:,} in the "
            "greatest cell."
        )
    return tuple(filter(None, lines))


def _outside(document: Document) -> tuple[str, ...]:
    outside = number((document.get("accumulator") or {}).get("votes_outside"))
    if not outside:
        return ()
    return (f"{int(outside):,} votes fell outside the grid: its range of ρ does not cover all plots.",)
