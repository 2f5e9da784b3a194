"""Points of a high-resolution radar, read from CSV.

A file has the columns `range`, `doppler`, `amplitude` and may have `scan`; without it all points are
of scan 0. It may have `dwell`, a number such as the azimuth of the beam: points of several dwells of one
scan do not meet. Further columns are not looked at.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.points import ALLOWED, Points, is_allowed
from algorithms.errors import RequestError
from algorithms.parameters import LARGEST
from scenarios.files.csv_tables import SCAN, NumberColumn, TableForm, parse_columns, within

AMPLITUDE = NumberColumn(ALLOWED["amplitude"], lambda values: is_allowed("amplitude", values))

FORM = TableForm(
    {"scan": SCAN, **dict.fromkeys(("dwell", "range", "doppler"), within(LARGEST)), "amplitude": AMPLITUDE},
    needed=("range", "doppler", "amplitude"),
)
"""The columns of a file of points."""


@dataclass(frozen=True, slots=True)
class PointRecording:
    """Recorded points, and where in their file each comes from.

    Attributes
    ----------
    points : sorted by scan and dwell; within one in the order of the file. `Points` calls each dwell with
        points a scan, for its points are clustered alone
    scans : int64 (points.scans,), the number of each one's scan in the file
    rows : int64 (n,), for each point the zero-based data row of the file, the header not counted
    dwells : float64 (points.scans,), the dwell of each, where the file has them
    """

    points: Points
    scans: NDArray[np.int64]
    rows: NDArray[np.int64]
    dwells: NDArray[np.float64] | None = None

    def place(self, index: int) -> dict[str, int | float]:
        """Return the scan and, where there is one, the dwell of the points that are clustered alone."""
        scan: dict[str, int | float] = {"scan": int(self.scans[index])}
        return scan if self.dwells is None else {**scan, "dwell": float(self.dwells[index])}

    @property
    def fullest(self) -> int:
        """The first scan, or the dwell that has the most points."""
        return 0 if self.dwells is None else int(np.diff(self.points.offsets).argmax())


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
    dwell = columns.get("dwell", np.zeros(len(scan)))
    rows = np.lexsort((dwell, scan)).astype(np.int64)
    if only is not None:
        rows = rows[scan[rows] == only]
        if not len(rows):
            raise RequestError(
                f"{source}: scan {only} is asked for, which holds no points; the file has points in "
                f"{len(np.unique(scan)):,} of the scans {scan.min()} to {scan.max()}"
            )
    is_first = np.diff(scan[rows], prepend=-1) != 0
    is_first |= np.diff(dwell[rows], prepend=np.nan) != 0.0
    first = np.flatnonzero(is_first)
    offsets = np.append(first, len(rows)).astype(np.int64)
    along, doppler, amplitude = (columns[name][rows] for name in FORM.needed)
    found = dwell[rows][first] if "dwell" in columns else None
    return PointRecording(Points.of(along, doppler, amplitude, offsets), scan[rows][first], rows, found)
