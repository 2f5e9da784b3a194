"""The density of a target's votes over the bins of ρ, as a curve with the edges of the bins drawn in."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from rich.style import Style
from textual.binding import Binding
from textual.message import Message

from hough_tui.reports.numerals import percent, significant
from hough_tui.ui.drawing.axes import Axis, Frame, foot
from hough_tui.ui.drawing.braille import ACROSS, DOWN, Canvas
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.shortening import Part, fitted
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.widgets.chart import Chart, Drawn

if TYPE_CHECKING:
    from hough_tui.quantisation.forecast import VotePicture

EDGE, CURVE, HOME, WORDS, HOME_WORDS = 1, 2, 3, 4, 5
"""Layers, from the lowest."""

NARROWEST = 1.5
"""Cells from which bins are wide enough to be told apart by their edges."""

DASH = 2
"""Dots of a dash of an edge."""

NOTHING = Limits(0.0, 1.0, 0.0, 1.0)


class PredictionDensity(Chart):
    """How the votes of one target lie about its peak; what falls into the home cell is filled in."""

    BINDINGS = [
        Binding("n", "next_target(1)", "Next target", id="prediction.next-target"),
        Binding("N", "next_target(-1)", "Previous target", show=False, id="prediction.previous-target"),
    ]

    class TargetChosen(Message):
        """Another target is shown."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._pictures: tuple[VotePicture, ...] = ()
        self._target = 0
        self._unit = ""

    @property
    def shown(self) -> VotePicture | None:
        """What is shown of which target; None where there is none."""
        return self._pictures[self._target] if self._pictures else None

    def show(self, pictures: tuple[VotePicture, ...], unit: str) -> None:
        """Show other pictures, that of the same target where it is still there."""
        self._pictures, self._unit = pictures, unit
        self._target = min(self._target, max(0, len(pictures) - 1))
        self.changed()

    def action_next_target(self, step: int) -> None:
        if self._pictures:
            self._target = (self._target + step) % len(self._pictures)
            self.changed()
            self.post_message(self.TargetChosen())

    # What a chart asks; this one is always seen as a whole.

    def home(self) -> Limits:
        shown = self.shown
        return NOTHING if shown is None else Limits(shown.low, shown.high, 0.0, 1.0)

    def bounds(self) -> Limits:
        return self.home()

    def least(self) -> tuple[float, float]:
        limits = self.home()
        return limits.right - limits.left, limits.top - limits.bottom

    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        return Axis(limits.left, limits.right, self._unit), Axis(limits.bottom, limits.top)

    def _frame(self, limits: Limits) -> Frame:
        # A density by length has no figures that anyone would read: those of the bins are written there.
        frame = super()._frame(limits)
        return replace(frame, width=frame.width + frame.gutter, gutter=0)

    def adapted(self, viewport: Viewport) -> Viewport:
        # The uppermost row is left to the shares of the bins.
        rows = viewport.height
        return replace(viewport, limits=viewport.limits._replace(top=rows / max(1, rows - 1)))

    def clicked(self, row: int, column: int, times: int) -> None:
        """Leave a click at choosing the chart."""

    def drawn(self, viewport: Viewport, colours: Palette, width: int) -> Drawn:
        shown = self.shown
        if shown is None:
            return Drawn(Canvas(viewport).strips(styles(colours)), None, foot([], [], width))
        line = fitted(legend(shown, self._unit, self._target, len(self._pictures)), width)
        words = foot([(line, ink(colours.muted))], [], width)
        return Drawn(painted(shown, viewport).strips(styles(colours)), None, words)


def styles(colours: Palette) -> list[Style | None]:
    """Return the style of each layer."""
    return [
        None,
        ink(colours.rule),
        ink(colours.unknown),
        ink(colours.found),
        ink(colours.muted),
        ink(colours.found, bold=True),
    ]


def painted(shown: VotePicture, viewport: Viewport) -> Canvas:
    """Return the picture of a target's votes: edges of bins, the curve, the filled home cell, and shares."""
    canvas = Canvas(viewport)
    columns = seen_columns(shown, viewport)
    cells = shown.step * viewport.width / (shown.high - shown.low)
    if cells >= NARROWEST:
        edges = [shown.first + column * shown.step for column in (*columns, columns.stop)]
        upright = [np.array([(edge, 0.0), (edge, 1.0)]) for edge in edges]
        canvas.lines(upright, [EDGE] * len(upright), DASH)
    canvas.lines([_seen_curve(shown, viewport)], [CURVE])
    if shown.home >= 0:
        canvas.lines(*_filling(shown, viewport))
        for column in columns:
            _write_share(canvas, shown, column, cells)
    return canvas


def seen_columns(shown: VotePicture, viewport: Viewport) -> range:
    """Return the columns of the accumulator that are seen in whole or in part."""
    limits = viewport.limits
    first = math.floor((limits.left - shown.first) / shown.step)
    last = math.ceil((limits.right - shown.first) / shown.step)
    return range(min(max(0, first), shown.bins), min(max(0, last), shown.bins))


def _dot(viewport: Viewport) -> float:
    """Return the height of a dot: what is less is not seen."""
    return abs(viewport.limits.top - viewport.limits.bottom) / (DOWN * viewport.height)


def _seen_curve(shown: VotePicture, viewport: Viewport) -> np.ndarray:
    """Return the curve where it rises by a dot, with the points beside: a jump has its edge."""
    rises = np.pad(shown.curve[:, 1] >= _dot(viewport), 1)
    return np.where((rises[:-2] | rises[1:-1] | rises[2:])[:, None], shown.curve, np.nan)


def _filling(shown: VotePicture, viewport: Viewport) -> tuple[list[np.ndarray], list[int]]:
    """Return an upright line up to the curve at each column of dots within the home cell."""
    begin = shown.first + shown.home * shown.step
    dots = ACROSS * viewport.width
    rho = np.asarray(viewport.x((np.arange(dots) + 0.5) / ACROSS))
    inside = (rho >= begin) & (rho < begin + shown.step)
    # One that is narrower than a dot is still marked.
    rho = rho[inside] if inside.any() else np.array([begin + 0.5 * shown.step])
    heights = np.interp(rho, shown.curve[:, 0], shown.curve[:, 1], left=0.0, right=0.0)
    least = _dot(viewport)
    lines = [
        np.array([(x, 0.5 * least), (x, height)])
        for x, height in zip(rho.tolist(), heights.tolist(), strict=True)
        if height >= least
    ]
    return lines, [HOME] * len(lines)


def _write_share(canvas: Canvas, shown: VotePicture, column: int, cells: float) -> None:
    share, view = shown.shares.get(column), canvas.viewport
    if share is None:
        return
    words = f"{percent(share)} %" if cells >= 9 else f"{100.0 * share:.0f}"
    middle = float(view.column(shown.first + (column + 0.5) * shown.step))
    begin = math.floor(middle - 0.5 * len(words) + 0.5)
    # A blank on each side keeps the figures of neighbours apart.
    if len(words) + 2 <= cells and begin >= 0 and begin + len(words) <= view.width:
        canvas.write(0, begin, words, HOME_WORDS if column == shown.home else WORDS)
    elif column == shown.home:
        begin = min(max(0, begin), max(0, view.width - len(words)))
        canvas.write(0, begin, words, HOME_WORDS)


def legend(shown: VotePicture, unit: str, target: int, targets: int) -> tuple[Part, ...]:
    """Return whose votes are seen, and where."""
    name = shown.name if targets < 2 else f"{shown.name}, {target + 1} of {targets}"
    return (
        Part(name, short=shown.name),
        *([Part("outside the columns", 1)] if shown.home < 0 else []),
        Part(f"row {shown.row}, θ {shown.theta:.2f}°", 2, f"row {shown.row}"),
        Part(f"{significant(shown.away)}° beside its line", 3),
        Part(f"R {significant(shown.spread)} {unit}", 4),
        *([Part("n: the next", 5)] if targets > 1 else []),
    )
