"""Clusters and the splits that led to them, as tables for a terminal, from the document that scripts read."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table

from hough_tui.reports.layout import Column, Sheet, sheet_table
from hough_tui.reports.numerals import aligned, as_given, durations, fixed, number, significant

Document = Mapping[str, Any]

AXES = {"range": "range", "doppler": "Doppler"}


def cluster_table(document: Document, width: int) -> Table:
    """Return the table of the plots of all clusters.

    Parameters
    ----------
    document : as `hough-tui cluster --json` prints it
    width : of the terminal, in cells
    """
    return sheet_table(cluster_sheet(document), width)


def step_table(document: Document, scan: int, width: int, dwell: float | None = None) -> Table:
    """Return the tree of the splits of one scan, or of one dwell of it.

    Parameters
    ----------
    document : as `hough-tui cluster --json --steps` prints it
    scan, dwell : which one
    width : of the terminal, in cells
    """
    return sheet_table(step_sheet(document, scan, dwell), width)


def cluster_sheet(document: Document) -> Sheet:
    """Return the plots of all clusters."""
    found = list(document.get("clusters") or ())
    ellipses = [cluster.get("ellipse") or {} for cluster in found]
    widths = [ellipse.get("widths") or (None, None) for ellipse in ellipses]
    in_range, in_doppler = _decimals(document, "range", widths), _decimals(document, "doppler", widths)
    dwells = []
    if any("dwell" in cluster for cluster in found):
        dwells.append(Column("dwell", aligned([as_given(cluster.get("dwell")) for cluster in found])))
    columns = (
        Column("#", tuple(str(index) for index in range(len(found)))),
        Column("scan", tuple(str(cluster.get("scan")) for cluster in found)),
        *dwells,
        Column("range", _sizes([cluster.get("range") for cluster in found], in_range)),
        Column("Doppler", _sizes([cluster.get("doppler") for cluster in found], in_doppler)),
        Column("amplitude", aligned([significant(number(cluster.get("amplitude"))) for cluster in found])),
        Column("points", tuple(str(len(cluster.get("members") or ())) for cluster in found)),
        Column("kept", tuple(str(len(cluster.get("kept") or ())) for cluster in found), rank=10),
        Column("chord", _sizes([ellipse.get("chord") for ellipse in ellipses], in_range), rank=30),
        Column("extent in\nrange", _sizes([width[0] for width in widths], in_range), rank=20),
        Column("extent in\nDoppler", _sizes([width[1] for width in widths], in_doppler), rank=20),
        Column("angle\n°", _sizes([ellipse.get("angle_deg") for ellipse in ellipses], 1), rank=40),
    )
    count = f"{len(found):,} cluster{'' if len(found) == 1 else 's'}"
    return Sheet(f"{document.get('mode')} · {count}", columns, (_counts(document),))


def step_sheet(document: Document, scan: int, dwell: float | None = None) -> Sheet:
    """Return the sets of points of one scan that were looked at, each below the one it is a part of."""
    found = [
        step
        for step in document.get("steps") or ()
        if step["scan"] == scan and (dwell is None or step["dwell"] == dwell)
    ]
    columns = (
        Column("step", tuple(_branch(found, index) for index in range(len(found))), prose=True),
        Column("points", tuple(str(len(step["points"])) for step in found)),
        Column("verdict", tuple(verdict_words(step) for step in found), prose=True),
        Column("why", tuple(str(step["why"]) for step in found), prose=True),
    )
    return Sheet(f"splits of scan {scan}" + (f", dwell {dwell:g}" if dwell is not None else ""), columns)


def _branch(steps: Sequence[Document], index: int) -> str:
    """Return the number of a step after the branches of the tree that lead to it."""
    text, here = str(index), index
    is_own = True
    while (parent := steps[here]["parent"]) is not None:
        is_last = steps[parent]["parts"][-1] == here
        text = (("└ " if is_last else "├ ") if is_own else ("  " if is_last else "│ ")) + text
        here, is_own = parent, False
    return text


def verdict_words(step: Document) -> str:
    """Return what becomes of a set of points."""
    if step["verdict"] == "split":
        return f"split in {AXES[step['axis']]} at {step['cut']:.6g}, gap {significant(step['gap'])}"
    return f"cluster {step['cluster']}" if step["cluster"] is not None else "too few points"


def _decimals(document: Document, axis: str, widths: Sequence[Sequence[object]]) -> int:
    """Return how many decimals tell sizes along an axis apart that differ by a thousandth of a target's."""
    extent = number((document.get("parameters") or {}).get(f"{axis}_extent"))
    if extent is None:
        # Of a mode that does not look at this axis, the widest cluster stands for a target.
        own = (number(width[list(AXES).index(axis)]) for width in widths)
        extent = max((width for width in own if width is not None), default=0.0)
    return min(12, max(0, 3 - math.floor(math.log10(extent)))) if extent > 0.0 else 2


def _sizes(values: Sequence[object], decimals: int) -> tuple[str, ...]:
    return tuple(fixed(number(value), decimals) for value in values)


def _counts(document: Document) -> str:
    """Return in words how many points there were, and how many are in no plot."""
    counts = [
        f"{int(count):,} {what[:-1] if count == 1 else what}"
        for what in ("points", "scans")
        if (count := number(document.get(what))) is not None
    ]
    counts.append(f"{len(document.get('interference') or ()):,} of the points in no plot")
    if (seconds := number(document.get("seconds"))) is not None:
        unit, (duration,) = durations([seconds])
        counts.append(f"{duration} {unit}")
    return f"{', '.join(counts)}."
