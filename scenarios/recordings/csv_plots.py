"""Recorded plots: read from CSV, and written as CSV.

A file begins with a header. It has the columns `x`, `y` and at least one of `scan` and `time`,
and may have `z`, `amplitude` and `doppler`; names count whatever their case and the spaces
around them. Further columns are carried along as text. Blank lines are not rows; the
columns named here must hold a number in every row.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.parameters import LARGEST, LEAST
from algorithms.plots import Plots
from scenarios.files.csv_tables import (
    LARGEST_SCAN,
    SCAN,
    NumberColumn,
    Numbers,
    TableForm,
    parse_columns,
    read_records,
    within,
)
from scenarios.files.set_files import read_text
from scenarios.simulate import Draw

LATEST = 1e19
"""The latest time, in seconds or whatever the file counts in: nanoseconds since 1970 are earlier."""

FORM = TableForm(
    {
        "scan": SCAN,
        "time": within(LATEST),
        **dict.fromkeys(("x", "y", "z", "doppler"), within(LARGEST)),
        "amplitude": NumberColumn(),
    },
    needed=("x", "y"),
    either=("scan", "time"),
    rows="plots",
)
"""The columns of a recording."""

LONGEST_INTERVAL = 1e9  # s: any scan number times it is far from overflow


@dataclass(frozen=True, slots=True)
class Recording:
    """Recorded plots, and where in their file each comes from.

    Attributes
    ----------
    plots : sorted by scan; within a scan in the order of the file
    rows : int64 (n,), for each plot the zero-based data row of the file, the header not counted
    extra : the further columns as text, for every data row of the file, in its order
    interval : seconds between scans, as given or as worked out
    assumed : what the file and the request leave open and how it was settled, in words, by
        `interval`, `scan`, `time`, or `order` where time runs backwards against the scans
    """

    plots: Plots
    rows: NDArray[np.int64]
    extra: dict[str, tuple[str, ...]]
    interval: float
    assumed: dict[str, str]


def read_plots(
    path: Path, *, interval: float | None = None, scans: tuple[int, int] | None = None
) -> Recording:
    """Return the plots of a CSV file, as `parse_plots` does, with its errors and those of `read_text`."""
    return parse_plots(read_text(path), str(path), interval=interval, scans=scans)


def parse_plots(
    text: str, source: str, *, interval: float | None = None, scans: tuple[int, int] | None = None
) -> Recording:
    """Return the plots of a CSV text.

    Without times, a plot's time is its scan × the interval. Without scans, a scan is an interval
    counted from the earliest time or, where no interval is given, each distinct time. With both,
    the scans rule: a time that runs backwards against them is taken as it is, and `assumed` says
    so, since the analyst may know why (clocks are set) where we do not.

    Parameters
    ----------
    text : the file's content
    source : what errors call the file
    interval : seconds between scans; worked out from the times where none is given
    scans : (a, b) keeps the scans a ≤ scan < b and numbers them such that a is scan 0;
        times, rows, extra columns and the interval stay those of the whole file

    Raises
    ------
    RequestError
        One line with the file's line and column, what is given and what is allowed.
    """
    if interval is not None and not LEAST <= interval <= LONGEST_INTERVAL:
        allowed = f"from {LEAST:g} s to {LONGEST_INTERVAL:g} s"
        raise RequestError(f"interval: {interval:g} is given; it must be {allowed}")
    columns, extra = parse_columns(text, source, FORM)
    assumed: dict[str, str] = {}
    scan = _scans(columns, source, interval, assumed)
    rows = np.argsort(scan, kind="stable").astype(np.int64)
    scan = scan[rows]
    if "time" in columns:
        time = columns["time"][rows]
        interval = _interval(scan, time, interval, assumed)
    else:
        if interval is None:
            interval = 1.0
            assumed["interval"] = "1 s, as the file has no times"
        time = scan * np.float64(interval)
        assumed["time"] = f"scan × {interval:g} s"
    if scans is not None:
        kept = _selected(scan, scans, source)
        scan, time, rows = scan[kept] - scans[0], time[kept], rows[kept]
    place = np.column_stack([columns[axis][rows] for axis in "xyz" if axis in columns])
    measured = {name: columns[name][rows] for name in ("amplitude", "doppler") if name in columns}
    return Recording(Plots(scan.astype(np.int32), time, place, **measured), rows, extra, interval, assumed)


def _scans(
    columns: dict[str, Numbers], source: str, interval: float | None, assumed: dict[str, str]
) -> NDArray[np.int64]:
    """Return the scan of each row: as given, or worked out from the times."""
    if "scan" in columns:
        return columns["scan"].astype(np.int64)
    time = columns["time"]
    if interval is None:
        distinct, scan = np.unique(time, return_inverse=True)
        assumed["scan"] = f"each distinct time is a scan, {len(distinct):,} in all"
        return scan.astype(np.int64)
    # A time on the border of two scans belongs to the later, though it be rounded down: times
    # since 1970 are rounded by more than the usual slack.
    slack = max(1e-9, 2.0 * float(np.spacing(np.abs(time).max())) / interval)
    number: Numbers = np.floor((time - time.min()) / interval + slack)
    if number.max() > LARGEST_SCAN:
        raise RequestError(
            f"{source}: at an interval of {interval:g} s the times, {time.min():g} to {time.max():g} s, span "
            f"more than {LARGEST_SCAN} scans; give a longer interval"
        )
    assumed["scan"] = f"each {interval:g} s from the earliest time is a scan"
    return number.astype(np.int64)


def _interval(
    scan: NDArray[np.int64], time: Numbers, interval: float | None, assumed: dict[str, str]
) -> float:
    """Return the interval, from the mean times of the (sorted) scans where it is not given."""
    numbers, first, counts = np.unique(scan, return_index=True, return_counts=True)
    # Counted from the scan's first time, so that the mean of equal times is exactly that time.
    since_first = time - np.repeat(time[first], counts)
    steps = np.diff(time[first] + np.add.reduceat(since_first, first) / counts)
    rates = steps / np.diff(numbers)
    back = np.flatnonzero(steps < 0.0)
    if len(back):
        begin, end = numbers[back[0]], numbers[back[0] + 1]
        more = f", the first of {len(back):,} such steps" if len(back) > 1 else ""
        assumed["order"] = f"by scan, though time runs backwards from scan {begin} to scan {end}{more}"
    if interval is None:
        rates = rates[(rates >= LEAST) & (rates <= LONGEST_INTERVAL)]
        interval = float(np.median(rates)) if len(rates) else 1.0
        why = "the median step of time" if len(rates) else "as the times do not tell it"
        assumed["interval"] = f"{interval:g} s, {why}"
    return interval


def _selected(scan: NDArray[np.int64], scans: tuple[int, int], source: str) -> slice:
    """Return where in the sorted scans a selection lies."""
    begin, end = np.searchsorted(scan, scans)
    if not 0 <= scans[0] < scans[1] or begin == end:
        raise RequestError(
            f"{source}: the scans from {scans[0]} up to, not including, {scans[1]} are asked for, which hold "
            f"no plots; the file has plots in {len(np.unique(scan)):,} of the scans {scan[0]} to {scan[-1]}"
        )
    return slice(int(begin), int(end))


def write_plots(draw: Draw, further: Mapping[str, Sequence[float]] | None = None) -> str:
    """Return the plots of one simulated trial, with their truth, as CSV that reads back bit for bit.

    Parameters
    ----------
    draw : one trial of a scenario; a plot of clutter has no `target`, `true_x`, `true_y`; in space there are
        `z` and `true_z`, too, and `amplitude` and `doppler` where plots have them
    further : columns to be written before the truth, one value a plot
    """
    if draw.chunk.trials != 1:
        raise ValueError(f"a draw of {draw.chunk.trials} trials; a file of plots holds one")
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    plots = draw.chunk.trial(0)
    axes = "xyz"[: plots.position.shape[1]]
    measured = {"amplitude": plots.amplitude, "doppler": plots.doppler}
    told = {name: column.tolist() for name, column in measured.items() if column is not None}
    told = {**(further or {}), **told}
    writer.writerow(["scan", "time", *axes, *told, "target", *(f"true_{axis}" for axis in axes)])
    columns = (plots.scan, plots.time, plots.position, draw.origin)
    values = zip(*told.values(), strict=True) if told else [()] * len(plots)
    rows = zip(*(column.tolist() for column in columns), values, strict=True)
    for scan, time, place, origin, beside in rows:
        truth: list[int | float | str] = [""] * (1 + len(axes))
        if origin >= 0:
            truth = [origin, *draw.states.position[0, scan, origin].tolist()]
        writer.writerow([scan, time, *place, *beside, *truth])
    return file.getvalue()


def write_assigned(text: str, recording: Recording, tracks: Sequence[NDArray[np.int64]]) -> str:
    """Return a CSV text with a column `track` added: the tracks to which each row's plot belongs.

    All rows and columns of the text are kept, in their order. The numbers of several tracks are
    joined with `;`; rows that no track has, or that were not selected, have none. A column `track` that
    the text already has becomes `input_track`.

    Parameters
    ----------
    text : the text that was read
    recording : what `parse_plots` made of it
    tracks : the plots of each track, as rows of `recording.plots` (as `Tracks.plots`)
    """
    assigned: dict[int, list[str]] = {}
    for number, plots in enumerate(tracks):
        for row in recording.rows[plots].tolist():
            assigned.setdefault(row, []).append(str(number))
    records = read_records(text.removeprefix("\ufeff"), "the recording")
    names = next(records)[1]
    taken = [name.strip().casefold() for name in names]
    if "track" in taken:
        free = (f"input_track{suffix}" for suffix in ("", *range(len(names))))
        names[taken.index("track")] = next(name for name in free if name not in taken)
    # Before Python 3.13 a field with a bare CR is not quoted by itself.
    bare = re.search(r"\r(?!\n)", text)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n", quoting=csv.QUOTE_ALL if bare else csv.QUOTE_MINIMAL)
    writer.writerow([*names, "track"])
    writer.writerows([*cells, ";".join(assigned.get(row, ()))] for row, (_, cells) in enumerate(records))
    return file.getvalue()
