"""Result rows and documents as text for files: CSV, Markdown, JSON."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from algorithms.tracks import Tracks
from hough_tui import __version__
from hough_tui.experiments.formats import FORMAT
from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.rates import rate_sheets
from hough_tui.reports.visible import ACTING

Row = Mapping[str, Any]

LINE = 100
"""What fits into so many characters stands on one line of a JSON document."""


def csv_text(rows: Sequence[Row]) -> str:
    """Return result rows as CSV, one column a number.

    Parameters
    ----------
    rows : as `hough-tui batch --json` prints them

    Notes
    -----
    What lies in a mapping has its own column, `swept.scans`; an interval has two, `…_low` and
    `…_high`; any other list is numbered from 0. Numbers keep all their digits; what is null,
    NaN or infinite is an empty field.
    """
    flat = [_flat(row) for row in rows]
    # Columns of one key stay together, even where a later row is the first to have one of them.
    groups: dict[str, dict[str, None]] = {}
    for row in flat:
        for key, fields in row.items():
            groups.setdefault(key, {}).update(dict.fromkeys(fields))
    columns = [(key, name) for key, names in groups.items() for name in names]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([name for _, name in columns])
    for row in flat:
        writer.writerow([_field(row.get(key, {}).get(name)) for key, name in columns])
    return out.getvalue()


def markdown_text(rows: Sequence[Row], wanted: Sequence[str] | None = None) -> str:
    """Return result rows as Markdown, one table for each experiment of each set.

    Parameters
    ----------
    rows : as `hough-tui batch --json` prints them
    wanted : keys of the metrics and intervals to show; None for those that say something
    """
    return "\n".join(sheet_markdown(sheet) for sheet in rate_sheets(rows, wanted))


def sheet_markdown(sheet: Sheet) -> str:
    """Return a sheet as a Markdown heading, table and notes; all its columns are there."""
    lines = [f"### {sheet.title}", ""] if sheet.title else []
    if sheet.columns:
        texts = [[column.name, *column.cells] for column in sheet.columns]
        cells = [[_escaped(text) for text in column] for column in texts]
        widths = [max(3, *map(len, column)) for column in cells]
        marks = [_rule(column, width) for column, width in zip(sheet.columns, widths, strict=True)]
        for index in range(len(cells[0])):
            row = [
                f"{column[index]:<{width}}" if given.prose else f"{column[index]:>{width}}"
                for given, column, width in zip(sheet.columns, cells, widths, strict=True)
            ]
            lines.append(f"| {' | '.join(row)} |")
            if index == 0:
                lines.append(f"| {' | '.join(marks)} |")
    for note in (*sheet.notes, *sheet.warnings):
        lines += ["", note]
    return "\n".join(lines) + "\n"


def json_text(document: object) -> str:
    """Return a document as JSON that any reader takes: NaN and infinities become null.

    Characters that act on a terminal, and lone surrogates, are written as JSON's own escapes.

    Parameters
    ----------
    document : of mappings, sequences, texts and numbers, those of numpy among them
    """
    text = _written(_plain(document), 0)
    # Outside of JSON's texts there is nothing but ASCII: what acts on a terminal stands within one.
    return ACTING.sub(lambda match: f"\\u{ord(match[0]):04x}", text) + "\n"


def document_text(document: Mapping[str, Any]) -> str:
    """Return a document for scripts as JSON: first its format and the version, unless it has its own."""
    return json_text({"format": FORMAT, "version": __version__, **document})


FORMATS: dict[str, tuple[str, Callable[[Mapping[str, Any]], str]]] = {
    ".csv": ("CSV", lambda document: csv_text(document["rows"])),
    ".json": ("JSON", document_text),
    ".md": ("Markdown", lambda document: markdown_text(document["rows"])),
}
"""By the ending of a file's name: what the format is called, and how a result document is written so."""


def _flat(row: Row) -> dict[str, dict[str, object]]:
    return {key: dict(_fields(key, value)) for key, value in row.items()}


def _fields(name: str, value: object) -> Iterable[tuple[str, object]]:
    if isinstance(value, Mapping):
        for key, part in value.items():
            yield from _fields(f"{name}.{key}", part)
    elif name.endswith("_ci95"):
        low, high = value if isinstance(value, (list, tuple)) and len(value) == 2 else (None, None)
        yield from ((f"{name}_low", low), (f"{name}_high", high))
    elif isinstance(value, (list, tuple)):
        for index, part in enumerate(value):
            yield from _fields(f"{name}.{index}", part)
    else:
        yield name, value


def _field(value: object) -> str:
    plain = _plain(value)
    if plain is None:
        return ""
    return plain if isinstance(plain, str) else json.dumps(plain, ensure_ascii=False)


def _escaped(text: str) -> str:
    # The blanks that line figures up in a terminal mean nothing here.
    text = re.sub(r"\s+", " ", text.strip()).replace("– ", "–")
    return text.replace("\\", "\\\\").replace("|", "\\|")


def _rule(column: Column, width: int) -> str:
    return "-" * width if column.prose else "-" * (width - 1) + ":"


def _plain(value: object) -> Any:
    """Return a value in JSON's own types."""
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in value]
    raise TypeError(f"a {type(value).__name__} cannot be written as JSON")


def _written(value: Any, depth: int) -> str:
    """Write structure line by line, but short parts and lists of numbers on one line."""
    if not value or not isinstance(value, (dict, list)):
        return json.dumps(value, ensure_ascii=False, allow_nan=False)
    parts = value.values() if isinstance(value, dict) else value
    # A list of numbers is data: one line, however long.
    is_data = isinstance(value, list) and not any(isinstance(part, (dict, list)) for part in parts)
    if is_data or len(value) <= LINE // 2:
        line = json.dumps(value, ensure_ascii=False, allow_nan=False)
        if is_data or 2 * depth + len(line) <= LINE:
            return line
    begin = "\n" + "  " * (depth + 1)
    end = "\n" + "  " * depth
    lines = [_written(part, depth + 1) for part in parts]
    if isinstance(value, list):
        return "[" + begin + f",{begin}".join(lines) + end + "]"
    keys = [json.dumps(key, ensure_ascii=False) for key in value]
    return "{" + begin + f",{begin}".join(map(": ".join, zip(keys, lines, strict=True))) + end + "}"


def track_csv(tracks: Tracks) -> str:
    """Return tracks as CSV: line, score, number of plots, state and scan of confirmation.

    Of a covariance each element stands once: `covariance.x.vy` is that of x with the velocity in y.
    """
    states = tracks.states
    axes = "xyz"[: states.dimensions]
    names = [*axes, *(f"v{axis}" for axis in axes)]
    pairs = [(i, j) for i in range(len(names)) for j in range(i, len(names))]
    return csv_text(
        [
            {
                "theta_deg": math.degrees(tracks.theta[index]),
                "rho": float(tracks.rho[index]),
                "score": float(tracks.score[index]),
                "plots": len(tracks.plots[index]),
                "position": [float(value) for value in states.position[index]],
                "velocity": [float(value) for value in states.velocity[index]],
                "time": float(states.time[index]),
                "first_scan": int(states.scan[index]),
                "confirmed_scan": int(tracks.confirmed_scan[index]),
                "covariance": {
                    f"{names[i]}.{names[j]}": float(states.covariance[index, i, j]) for i, j in pairs
                },
            }
            for index in range(len(tracks))
        ]
    )
