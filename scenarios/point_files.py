"""Points of a high-resolution radar, read from CSV.

A file has the columns `range`, `doppler`, `amplitude` and may have `scan`; without it all points are
of scan 0. Further columns are not looked at.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.points import ALLOWED, Points, is_allowed
from algorithms.errors import RequestError
from scenarios.csv_tables import SCAN, NumberColumn, Numbers, TableForm, parse_columns


def _column(name: str) -> NumberColumn:
    def holds(values: Numbers) -> NDArray[np.bool_]:
        return is_allowed(name, values)

    return NumberColumn(ALLOWED[name], holds)


FORM = TableForm(
    {"scan": SCAN, **{name: _column(name) for name in ALLOWED}}, needed=("range", "doppler", "amplitude")
)
"""The columns of a file of points."""


@dataclass(frozen=True, slots=True)
class PointRecording:
    """Recorded points, and where in their file each comes from.

    Attributes
    ----------
    points : sorted by scan; within a scan in the order of the file; only scans with points
    scans : int64 (scans,), the number of each scan in the file
    rows : int64 (n,), for each point the zero-based data row of the file, the header not counted
    """

    points: Points
    scans: NDArray[np.int64]
    rows: NDArray[np.int64]


def parse_points(text: str, source: str, only: int | None = None) -> PointRecording:
    """Return the points of a CSV text.

    Parameters
    ----------
    text : the file's content
    source : what errors call the file
    only : keeps the points of this scan alone

    Raises
    ------
    RequestError
        One line with the file's line and column, what is given and what is allowed.
    """
    columns, _ = parse_columns(text, source, FORM)
    scan = columns.get("scan", np.zeros(len(columns["range"]))).astype(np.int64)
    rows = np.argsort(scan, kind="stable").astype(np.int64)
    if only is not None:
        rows = rows[scan[rows] == only]
        if not len(rows):
            raise RequestError(
                f"{source}: scan {only} is asked for, which holds no points; the file has points in "
                f"{len(np.unique(scan)):,} of the scans {scan.min()} to {scan.max()}"
            )
    numbers, first = np.unique(scan[rows], return_index=True)
    offsets = np.append(first, len(rows)).astype(np.int64)
    along, doppler, amplitude = (columns[name][rows] for name in FORM.needed)
    return PointRecording(Points.of(along, doppler, amplitude, offsets), numbers, rows)
