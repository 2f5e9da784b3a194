"""Columns of tables of result rows beside their metrics: names and swept values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hough_tui.reports.field_names import field_name
from hough_tui.reports.layout import Column, broken, repeats
from hough_tui.reports.numerals import (
    NONE,
    aligned,
    as_given,
    number,
)

Row = Mapping[str, Any]

SHORT_KEY = 8


def name_columns(rows: Sequence[Row], *parts: str) -> list[Column]:
    """Return a column of each part; of one that is the same in all rows, only if it is the last.

    Parameters
    ----------
    parts : keys of names, such as `scenario` and `initiator`
    """
    names = {part: tuple(str(row.get(part) or NONE) for row in rows) for part in parts}
    shown = [part for part in parts if part == parts[-1] or len(set(names[part])) > 1]
    columns = []
    for part in shown:
        # A name is told again where one before it changes.
        upto = parts[: parts.index(part) + 1]
        told = [" ".join(found) for found in zip(*(names[one] for one in upto), strict=True)]
        columns.append(Column(part, names[part], prose=True, styles=repeats(told)))
    return columns


def swept_columns(rows: Sequence[Row]) -> list[Column]:
    """Return a column of each swept value."""
    keys = list(dict.fromkeys(key for row in rows for key in row.get("swept") or {}))
    short = [field_name(key) for key in keys]
    names = short if len(set(short)) == len(keys) else keys
    return [
        Column(
            broken(name, SHORT_KEY),
            aligned([as_given((row.get("swept") or {}).get(key)) for row in rows]),
        )
        for key, name in zip(keys, names, strict=True)
    ]


def trial_words(rows: Sequence[Row]) -> str:
    """Return how many trials there were, of which seed."""
    counts = [int(row["trials"]) for row in rows if number(row.get("trials")) is not None]
    seeds = list(dict.fromkeys(as_given(row.get("seed")) for row in rows if row.get("seed") is not None))
    parts = []
    if counts:
        few, many = min(counts), max(counts)
        parts.append(f"{many:,} trials a row" if few == many else f"{few:,} to {many:,} trials a row")
    if seeds:
        parts.append(f"seed {seeds[0]}" if len(seeds) == 1 else f"seeds {', '.join(seeds)}")
    return f"{', '.join(parts)}." if parts else ""
