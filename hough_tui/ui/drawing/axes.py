"""Axes: round numbers along the edges of a picture, and how much room they take."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.shortening import cut
from hough_tui.ui.drawing.viewport import Limits

DECIMAL = (1.0, 2.0, 5.0, 10.0)
"""Steps between ticks, times a power of ten."""

DEGREES = (15.0, 30.0, 45.0, 90.0, 180.0)
"""Steps between ticks of a wide range of angles, in degrees."""

ROWS_APART = 4
"""Least distance of ticks on an upright axis."""

SMALLEST_FOR_GUTTER, SMALLEST_FOR_FIGURES, SMALLEST_FOR_RULE = 28, 9, 13
"""Columns from which there are figures at the left; rows from which there are below, and a rule with them."""


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a picture, its positions being shares of its length from its lower end.

    Attributes
    ----------
    low, high : the values at its ends, low < high
    unit : written behind its figures or at its end; may be empty
    is_angle : whether it is in degrees
    only : the one value that it has a figure for, where it is no scale but a single place
    """

    low: float
    high: float
    unit: str = ""
    is_angle: bool = False
    only: float | None = None

    def ticks(self, most: int) -> tuple[list[float], list[str]]:
        """Return round values at most so many steps apart from end to end, and their figures."""
        if self.only is not None:
            return [self.only], [figures([self.only], self.high - self.low)[0]]
        values, step = ticks(self.low, self.high, most, self.is_angle)
        return values, figures(values, step)


def ticks(low: float, high: float, most: int, is_angle: bool = False) -> tuple[list[float], float]:
    """Return round numbers between two, and their step: 1, 2 or 5 times a power of ten.

    Parameters
    ----------
    low, high : the ends, low < high
    most : how many steps at most, ≥ 1
    is_angle : whether wide steps are parts of a turn, in degrees
    """
    rough = (high - low) / max(1, most)
    if is_angle and rough > DECIMAL[-1]:
        step = next((step for step in DEGREES if step >= 0.999 * rough), DEGREES[-1])
    else:
        power = 10.0 ** math.floor(math.log10(rough))
        step = next((factor * power for factor in DECIMAL if factor * power >= 0.999 * rough), 10.0 * power)
    first, last = math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6)
    # A step too small beside the values would give the same value again and again.
    values = dict.fromkeys(index * step + 0.0 for index in range(first, min(last, first + most) + 1))
    return list(values)[: most + 1], step


def figures(values: Sequence[float], step: float) -> list[str]:
    """Return values as text, all with the decimals that the step needs."""
    greatest = max((abs(value) for value in values), default=0.0)
    if greatest >= 1e12 or 0.0 < step < 1e-6:
        return [f"{value:.6g}" for value in values]
    decimals = decimals_of(step)
    return [f"{round(value, decimals) + 0.0:.{decimals}f}" for value in values]


def decimals_of(step: float) -> int:
    """Return the decimals, at most six, with which multiples of a step are told exactly enough."""
    for decimals in range(7):
        if abs(round(step, decimals) - step) <= 1e-3 * step:
            return decimals
    return 6


@dataclass(frozen=True, slots=True)
class Frame:
    """Where the parts of a chart lie in it.

    Attributes
    ----------
    width, height : of the picture, in cells
    gutter : columns at its left, for the figures of the upright axis
    below : rows of the axis below it: 0, 1 (figures), 2 (figures and a rule)
    foot : rows at the bottom for words: 0 or 1
    """

    width: int
    height: int
    gutter: int
    below: int
    foot: int

    @classmethod
    def within(cls, width: int, height: int, up: Axis) -> Frame:
        """Return the frame for a chart of a size in cells, its upright axis given."""
        foot = 1 if height >= 4 else 0
        below = 2 if height >= SMALLEST_FOR_RULE else 1 if height >= SMALLEST_FOR_FIGURES else 0
        rows = max(1, height - foot - below)
        gutter = 0
        if width >= SMALLEST_FOR_GUTTER:
            wanted = 1 + max((len(words) for words in upright_figures(up, rows)[1]), default=0)
            gutter = wanted if wanted <= width // 3 else 0
        return cls(max(1, width - gutter), rows, gutter, below, foot)


def upright_figures(up: Axis, rows: int) -> tuple[list[float], list[str]]:
    """Return the ticks of an upright axis and their figures, those of angles with their unit."""
    values, words = up.ticks(max(1, rows // ROWS_APART))
    return values, [word + up.unit for word in words] if up.is_angle else words


def gutter(
    frame: Frame, up: Axis, points_down: bool, palette: Palette, cursor: int | None
) -> list[list[Segment]]:
    """Return the segments at the left of each row of the picture.

    Parameters
    ----------
    frame : of the chart
    up : the axis at the left
    points_down : whether its lower end is above
    palette : the colours
    cursor : the row to be pointed at
    """
    if not frame.gutter:
        return [[] for _ in range(frame.height)]
    words_style, rule = ink(palette.muted), ink(palette.rule)
    blank = Segment(" " * (frame.gutter - 1) + "│", rule)
    found = [[blank] for _ in range(frame.height)]
    for value, words in zip(*upright_figures(up, frame.height), strict=True):
        if len(words) >= frame.gutter:
            continue
        share = (value - up.low) / (up.high - up.low)
        row = min(max(0, int((share if points_down else 1.0 - share) * frame.height)), frame.height - 1)
        found[row] = [Segment(words.rjust(frame.gutter - 1), words_style), Segment("┤", rule)]
    if cursor is not None and 0 <= cursor < frame.height:
        # The mark takes the place of the rule, beside a figure, if there is one.
        text = "".join(segment.text for segment in found[cursor])[:-1]
        found[cursor] = [Segment(text, words_style), Segment("▸", ink(palette.lit, bold=True))]
    return found


def beneath(frame: Frame, across: Axis, palette: Palette, cursor: int | None) -> list[Strip]:
    """Return the lines of the axis below the picture.

    Parameters
    ----------
    frame : of the chart
    across : the axis
    palette : the colours
    cursor : the column to be pointed at
    """
    if not frame.below:
        return []
    left, width = frame.gutter, frame.gutter + frame.width
    rule, figures_line = ["─"] * frame.width, [" "] * width
    unit = across.unit
    end = width - (len(unit) + 1 if unit else 0)
    widest = max((len(words) for words in across.ticks(max(1, frame.width // 12))[1]), default=1)
    taken = -1
    for value, words in zip(*across.ticks(max(1, frame.width // (widest + 4))), strict=True):
        share = (value - across.low) / (across.high - across.low)
        column = min(max(0, int(share * frame.width)), frame.width - 1)
        rule[column] = "┬"
        first = min(max(0, left + column - len(words) // 2), max(0, end - len(words)))
        if first > taken and first + len(words) <= end:
            figures_line[first : first + len(words)] = words
            taken = first + len(words)
    if unit:
        figures_line[width - len(unit) :] = unit
    lines = [Strip([Segment("".join(figures_line)[:width], ink(palette.muted))], width)]
    if frame.below > 1:
        lines.insert(0, _rule(frame, "".join(rule), palette, cursor))
    return lines


def _rule(frame: Frame, rule: str, palette: Palette, cursor: int | None) -> Strip:
    style = ink(palette.rule)
    corner = " " * (frame.gutter - 1) + "└" if frame.gutter else ""
    if cursor is None or not 0 <= cursor < frame.width:
        return Strip([Segment(corner + rule, style)], frame.gutter + frame.width)
    parts = [
        Segment(corner + rule[:cursor], style),
        Segment("▴", ink(palette.lit, bold=True)),
        Segment(rule[cursor + 1 :], style),
    ]
    return Strip([part for part in parts if part.text], frame.gutter + frame.width)


def framed(
    picture: Sequence[Strip],
    frame: Frame,
    axes: tuple[Axis, Axis],
    limits: Limits,
    palette: Palette,
    cursor: tuple[int, int] | None = None,
) -> list[Strip]:
    """Return a picture with its axes: all lines of a chart but its foot.

    Parameters
    ----------
    picture : its lines
    frame : of the chart
    axes : the one below, the one at the left
    limits : of the picture, which tell which way the upright axis points
    palette : the colours
    cursor : row and column of the picture to be pointed at
    """
    across, up = axes
    row, column = cursor or (None, None)
    sides = gutter(frame, up, limits.bottom > limits.top, palette, row)
    width = frame.gutter + frame.width
    lines = [Strip([*side, *line], width) for side, line in zip(sides, picture, strict=True)]
    return [*lines, *beneath(frame, across, palette, column)]


def foot(
    parts: Sequence[tuple[str, Style | None]], right: Sequence[tuple[str, Style | None]], width: int
) -> Strip:
    """Return a line of words, some at its left and, where there is room, some at its right.

    Where even those at the left have no room, whole words are left out.
    """
    kept: list[Segment] = []
    room = width
    for words, style in parts:
        shown = words if len(words) <= room else cut(words, room)
        kept.append(Segment(shown, style))
        room -= len(shown)
        if shown != words:
            break
    length = sum(len(words) for words, _ in right)
    if right and length + (2 if kept else 0) <= room:
        kept.append(Segment(" " * (room - length)))
        kept += [Segment(words, style) for words, style in right]
        room = 0
    if room:
        kept.append(Segment(" " * room))
    return Strip([part for part in kept if part.text], width)
