"""Formats of result documents: which one is written, and how documents of earlier ones are read."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

FORMAT = 2
"""The format of documents that are written; those without a number are of format 1."""

RENAMED_IN_2 = {
    "success_ci95": "success_rate_ci95",
    "count_exact_ci95": "count_exact_rate_ci95",
}
"""Keys of rows: of format 1, and since."""


def upgraded(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return the document of a run in the format of today.

    Raises
    ------
    KeyError, TypeError
        Where it is no such document.
    """
    if document.get("format", 1) >= FORMAT:
        return dict(document)
    return {"format": FORMAT, **document, "rows": [_upgraded_row(row) for row in document["rows"]]}


def _upgraded_row(row: Mapping[str, Any]) -> dict[str, Any]:
    renamed = {RENAMED_IN_2.get(key, key): value for key, value in row.items()}
    if "trials_without_track" in row and row.get("trials"):
        renamed.setdefault("no_track_rate", row["trials_without_track"] / row["trials"])
    return renamed
