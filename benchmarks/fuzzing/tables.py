"""Mutated CSV files: recorded plots, points of a radar of high resolution, and the shapes of other tools."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from benchmarks.fuzzing.mutations import EXTREMES, damaged, hostile, number

Rows = list[list[str]]
"""The header and the rows of a table, as text."""


def mutated_table(dice: random.Random) -> bytes:
    """Return a mutated CSV file."""
    rows = dice.choice(SHAPES)(dice)
    for _ in range(dice.choice((0, 1, 1, 1, 2, 3))):
        rows = dice.choice(MUTATIONS)(dice, rows)
    delimiter = dice.choice((",",) * 60 + (";", "\t", "|", " "))
    content = "".join(delimiter.join(cells) + "\n" for cells in rows).encode("utf-8", "surrogatepass")
    if dice.random() < 0.12:
        content = damaged(dice, content)
    return content


def plots(dice: random.Random) -> list[dict[str, float]]:
    """Return plots of a few targets among clutter: numbers by the names of columns."""
    scans, size = dice.randint(1, 10), 10.0 ** dice.choice((0, 1, 1, 2, 4, 5))
    interval = dice.choice((1.0, 4.0, 10.0, 0.1))
    lines = [[dice.uniform(0.0, size) for _ in "xyz"] for _ in range(dice.randint(0, 3))]
    speeds = [[dice.uniform(-1.0, 1.0) * size / 50.0 for _ in "xyz"] for _ in lines]
    rows = []
    for scan in range(scans):
        time = scan * interval
        for start, speed in zip(lines, speeds, strict=True):
            rows.append(
                (
                    scan,
                    time,
                    [
                        a + v * scan + dice.gauss(0.0, size / 1000.0)
                        for a, v in zip(start, speed, strict=True)
                    ],
                )
            )
        for _ in range(dice.randint(0, 12)):
            rows.append((scan, time, [dice.uniform(0.0, size) for _ in "xyz"]))
    return [
        {
            **{"scan": scan, "time": time, "x": place[0], "y": place[1], "z": place[2]},
            **{"amplitude": dice.expovariate(1.0), "doppler": dice.uniform(-50.0, 50.0)},
            **{"range": math.hypot(*place), "azimuth": math.degrees(math.atan2(place[0], place[1])) % 360.0},
        }
        for scan, time, place in rows
    ]


def _columns(*names: str) -> Callable[[random.Random], Rows]:
    """Return the shape of a file with some of the columns of plots."""

    def shape(dice: random.Random) -> Rows:
        return [list(names), *([f"{row[name]:.6g}" for name in names] for row in plots(dice))]

    return shape


def points(dice: random.Random) -> Rows:
    """Return points in cells of range and Doppler, in scans and dwells, such as `cluster` takes."""
    centres = [(dice.uniform(0.0, 100.0), dice.uniform(-40.0, 40.0)) for _ in range(dice.randint(1, 4))]
    names = dice.choice(
        (["range", "doppler", "amplitude"], ["scan", "dwell", "range", "doppler", "amplitude"])
    )
    rows = [list(names)]
    for scan in range(dice.randint(1, 3)):
        for centre in centres:
            for _ in range(dice.randint(1, 20)):
                cells = {
                    "range": round(dice.gauss(centre[0], 3.0)),
                    "doppler": round(dice.gauss(centre[1], 2.0)),
                }
                values = {
                    **cells,
                    "scan": scan,
                    "dwell": dice.choice((10.5, 11.0)),
                    "amplitude": f"{dice.expovariate(1):.4f}",
                }
                rows.append([str(values[name]) for name in names])
    return rows


def _decimal_comma(dice: random.Random) -> Rows:
    """Return a table as a spreadsheet writes it that has a comma in numbers."""
    rows = _columns("scan", "time", "x", "y")(dice)
    return [[";".join(cell.replace(".", ",") for cell in cells)] for cells in rows]


def _headerless(dice: random.Random) -> Rows:
    return _columns("scan", "x", "y")(dice)[1:] or [["0", "1", "2"]]


def _clock(dice: random.Random) -> Rows:
    """Return plots with a time of day, in nautical miles and degrees."""
    rows = [["Time", "Scan", "Range (nmi)", "Azimuth (deg)", "Type", "", ""]]
    for row in plots(dice):
        clock = f"23:{int(row['time'] // 60) % 60:02}:{row['time'] % 60:06.3f}"
        rows.append(
            [clock, f"{row['scan']:g}", f"{row['range']:.3f}", f"{row['azimuth']:.2f}", "PSR", "", ""]
        )
    return rows


def _dated(dice: random.Random) -> Rows:
    """Return positions with dates, latitudes and longitudes."""
    rows = [["BaseDateTime", "MMSI", "LAT", "LON", "VesselName"]]
    for row in plots(dice):
        date = f"2022-06-20T00:{int(row['time'] // 60) % 60:02}:{int(row['time'] % 60):02}"
        rows.append(
            [date, "900000000", f"{50 + row['x'] / 1e5:.5f}", f"{8 + row['y'] / 1e5:.5f}", '"SHIP, 0"']
        )
    return rows


def _messages(dice: random.Random) -> Rows:
    """Return messages without a header, most of their cells empty."""
    return [
        ["MSG", "3", "1", "1", f"A{row['scan']:g}", "", "", "2024/04/23", f"{row['x']:.5f}", "", "0"]
        for row in plots(dice)
    ]


def _epoch(dice: random.Random) -> Rows:
    rows = _columns("time", "x", "y", "z")(dice)
    since = dice.choice((1_600_000_000, 1_600_000_000_000))
    return [rows[0], *([str(since + float(cells[0]) * since / 1.6e9), *cells[1:]] for cells in rows[1:])]


def _without_values(dice: random.Random) -> Rows:
    rows = _columns("scan", "time", "x", "y", "amplitude", "doppler")(dice)
    return [rows[0], *([*cells[:4], "NaN", ""] for cells in rows[1:])]


def _spreadsheet(dice: random.Random) -> Rows:
    rows = _columns("scan", "x", "y")(dice)
    return [
        *([["sep=,"]] if dice.random() < 0.5 else []),
        *([*cells, "", ""] for cells in rows),
        ["", "", "", "", ""],
    ]


PLOTS = _columns("scan", "time", "x", "y", "z", "amplitude", "doppler")
"""The shape of a file with every column that initiators read."""

SHAPES: tuple[Callable[[random.Random], Rows], ...] = (
    *(_columns("scan", "x", "y"),) * 5,
    *(PLOTS,) * 8,
    *(_columns("scan", "x", "y", "z"),) * 6,
    *(_columns("scan", "time", "x", "y"),) * 3,
    _columns("time", "x", "y"),
    _columns("time", "x", "y", "z"),
    _columns("scan", "x", "y", "range", "doppler", "amplitude"),
    _columns("scan", "range", "azimuth", "doppler"),
    *(points,) * 9,
    *(_decimal_comma, _headerless, _clock, _dated, _messages, _epoch, _without_values, _spreadsheet),
)


def _cell(dice: random.Random, rows: Rows) -> Rows:
    """Return a table with another number, or a text, in some cells."""
    for _ in range(dice.choice((1, 1, 2, 5))):
        cells = dice.choice(rows)
        if cells:
            at = dice.randrange(len(cells))
            cells[at] = _other(dice, cells[at])
    return rows


def _other(dice: random.Random, cell: str) -> str:
    kind = dice.randrange(10)
    if kind == 0:
        return dice.choice(
            (
                "",
                " ",
                "NaN",
                "nan",
                "inf",
                "-Infinity",
                "1_0",
                "0x10",
                "1e",
                "٣",
                "1,5",
                "−1",
                "1e999",
                "null",
            )
        )
    if kind == 1:
        return hostile(dice, cell)
    try:
        return str(number(dice, float(cell)))
    except (OverflowError, ValueError):
        return str(dice.choice(EXTREMES))


def _column(dice: random.Random, rows: Rows) -> Rows:
    """Return a table with one column scaled, shifted, made constant, or extreme."""
    at = dice.randrange(max(1, *map(len, rows)))
    kind, extreme = dice.randrange(4), dice.choice(EXTREMES)
    factor = 10.0 ** dice.choice((-320, -100, -12, -3, 3, 6, 9, 12, 100, 160, 300))
    for cells in rows[1:]:
        if at < len(cells):
            try:
                old = float(cells[at])
            except ValueError:
                continue
            changed = (old * factor, old + factor, extreme, number(dice, old))[kind]
            is_whole = isinstance(changed, int) or (changed.is_integer() and abs(changed) < 1e18)
            cells[at] = str(int(changed)) if is_whole else repr(changed)
    return rows


def _places(dice: random.Random, rows: Rows) -> Rows:
    """Return a table with all coordinates scaled alike."""
    names = [name.strip().casefold() for name in rows[0]]
    factor = 10.0 ** dice.choice((-320, -160, -20, -6, 3, 6, 9, 11, 12, 20, 150, 160, 300))
    for cells in rows[1:]:
        for at, name in enumerate(names[: len(cells)]):
            if name in ("x", "y", "z", "range", "doppler"):
                try:
                    cells[at] = repr(float(cells[at]) * factor)
                except ValueError:
                    continue
    return rows


def _row(dice: random.Random, rows: Rows) -> Rows:
    """Return a table with a row lost, repeated, moved, too long or too short."""
    at, kind = dice.randrange(len(rows)), dice.randrange(6)
    if kind == 0 and len(rows) > 1:
        del rows[at]
    elif kind == 1:
        rows[at:at] = [list(rows[at])] * dice.choice((1, 5, 300))
    elif kind == 2:
        dice.shuffle(rows)
    elif kind == 3:
        rows[at] = [*rows[at], "1"]
    elif kind == 4:
        rows[at] = rows[at][:-1]
    else:
        rows[at] = []
    return rows


def _header(dice: random.Random, rows: Rows) -> Rows:
    """Return a table with a column renamed, repeated, lost or without a name."""
    if not rows[0]:
        return rows
    at, kind = dice.randrange(len(rows[0])), dice.randrange(5)
    if kind == 0:
        rows[0][at] = dice.choice(
            ("x_km", "X", " y ", "z", "scan", "time", "dwell", "amplitude", "", "track", "frame")
        )
    elif kind == 1:
        rows[0][at] = hostile(dice, rows[0][at])
    elif kind == 2:
        rows = [[*cells, cells[at] if at < len(cells) else ""] for cells in rows]
    elif kind == 3:
        rows = [cells[:at] + cells[at + 1 :] for cells in rows]
    else:
        rows[0] = [f'"{name}"' for name in rows[0]]
    return rows


def _size(dice: random.Random, rows: Rows) -> Rows:
    """Return a table with its header alone, one row, or very many."""
    kind = dice.randrange(5)
    if kind == 0:
        return rows[:1]
    if kind < 3:
        return rows[: 1 + kind]
    most = 20_000 if kind == 3 else 2_000
    return [rows[0], *(rows[1:] * (most // max(1, len(rows) - 1) + 1))[:most]]


MUTATIONS: tuple[Callable[[random.Random, Rows], Rows], ...] = (
    *(_cell,) * 6,
    *(_column,) * 6,
    *(_places,) * 5,
    *(_row, _header),
    _size,
)
