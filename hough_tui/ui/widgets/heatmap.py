"""The accumulator as a heat-map, θ from above to below and ρ across, with a cursor that reads it out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from rich.style import Style
from textual.binding import Binding
from textual.message import Message

from hough_tui.ui.drawing.axes import Axis, foot
from hough_tui.ui.drawing.halfblock import Overlay, flattened, inks, picture, shaded
from hough_tui.ui.drawing.palette import LEVELS, Palette, ink
from hough_tui.ui.drawing.sampling import DOWN, Levels, Sampling, levels, pooled, samplings
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.widgets.chart import KEY_ZOOM, Chart, Drawn
from hough_tui.ui.widgets.heatmap_scene import HeatmapScene

__all__ = ["Heatmap", "HeatmapScene"]

STRIDE = 10
"""Cells of a long step of the cursor."""

LEAST_ROWS, LEAST_COLUMNS = 4, 8
"""Cells that are in view at least."""

TRACK_MARK = "○"

ROOM_FOR_WIDE_SCALE = 68
"""Columns from which each level of the scale has a cell of its own."""

Words = list[tuple[str, Style | None]]

EMPTY = HeatmapScene(np.zeros((0, 0), np.uint32), np.zeros(0), np.zeros(0), "")


class Heatmap(Chart):
    """A picture of an accumulator in which no peak is lost: a screen cell shows the greatest of its cells."""

    BINDINGS = [
        Binding("left,h", "move(0, -1)", "Less ρ", show=False, id="heatmap.left"),
        Binding("right,l", "move(0, 1)", "More ρ", show=False, id="heatmap.right"),
        Binding("up,k", "move(-1, 0)", "Less θ", show=False, id="heatmap.up"),
        Binding("down,j", "move(1, 0)", "More θ", show=False, id="heatmap.down"),
        Binding("shift+left,H", "move(0, -10)", "Ten less ρ", show=False, id="heatmap.far-left"),
        Binding("shift+right,L", "move(0, 10)", "Ten more ρ", show=False, id="heatmap.far-right"),
        Binding("shift+up,K", "move(-10, 0)", "Ten less θ", show=False, id="heatmap.far-up"),
        Binding("shift+down,J", "move(10, 0)", "Ten more θ", show=False, id="heatmap.far-down"),
        Binding("plus,equals_sign", "zoom(1)", "Zoom in", show=False, id="heatmap.zoom-in"),
        Binding("minus", "zoom(-1)", "Zoom out", show=False, id="heatmap.zoom-out"),
        Binding("0", "fit", "Fit", show=False, id="heatmap.fit"),
        Binding("f", "fit_votes", "Fit to votes", show=False, id="heatmap.fit-votes"),
        Binding("p", "next_peak(1)", "Next peak", id="heatmap.next-peak"),
        Binding("P", "next_peak(-1)", "Previous peak", show=False, id="heatmap.previous-peak"),
        Binding("enter", "choose", "Choose cell", id="heatmap.choose"),
    ]

    class CellHighlighted(Message):
        """The cursor is on another cell, or the cell under it belongs to another scene."""

        def __init__(self, heatmap: Heatmap, row: int, column: int) -> None:
            super().__init__()
            self.heatmap = heatmap
            self.row = row
            self.column = column

        @property
        def control(self) -> Heatmap:
            """The heat-map whose cursor it is."""
            return self.heatmap

    class CellChosen(Message):
        """A cell was chosen."""

        def __init__(self, heatmap: Heatmap, row: int, column: int) -> None:
            super().__init__()
            self.heatmap = heatmap
            self.row = row
            self.column = column

        @property
        def control(self) -> Heatmap:
            """The heat-map in which it was chosen."""
            return self.heatmap

    def __init__(self, *, name: str | None = None, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(name=name, id=id, classes=classes)
        self._scene = EMPTY
        self._cursor = 0, 0
        self._trace: NDArray[np.int64] | None = None
        self._sampled: tuple[HeatmapScene, Viewport, Levels, Levels] | None = None

    @property
    def cursor(self) -> tuple[int, int]:
        """Row and column of the cell under the cursor."""
        return self._cursor

    def show(self, scene: HeatmapScene) -> None:
        """Show a scene; view and cursor stay at the same θ and ρ, a curve is dropped."""
        if scene is self._scene:
            return
        before, self._scene = self._scene, scene
        self._trace = None
        if scene.is_empty:
            self._cursor, self._limits = (0, 0), None
        elif before.is_empty:
            self._cursor, self._limits = scene.strongest, None
        elif scene.shape != before.shape or (before.home(), *_key(before)) != (scene.home(), *_key(scene)):
            row, column = self._cursor
            here = before.at(scene, Limits(column + 0.5, column + 0.5, row + 0.5, row + 0.5))
            self._cursor = self._clipped(int(np.floor(here.top)), int(np.floor(here.left)))
            if self._limits is not None:
                width, height = max(1, self.size.width), max(1, self.size.height)
                moved = Viewport(before.at(scene, self._limits), width, height).within(scene.home())
                self._limits = None if moved.limits == scene.home() else moved.limits
        self.changed()
        self._tell()

    def move_cursor(self, row: int, column: int) -> None:
        """Put the cursor on a cell, the nearest one there is, and bring it into view."""
        if self._scene.is_empty:
            return
        wanted = self._clipped(row, column)
        if wanted != self._cursor:
            self._cursor = wanted
            self.changed()
            self._tell()
        self._follow()

    def trace(self, columns_by_row: NDArray[np.int64] | None) -> None:
        """Draw a curve through one column of each row, −1 where it is outside; None for no curve."""
        given = None if columns_by_row is None else np.array(columns_by_row, np.int64)
        if given is not None and len(given) != self._scene.shape[0]:
            given = None
        before, self._trace = self._trace, given
        if given is None or before is None:
            is_same = given is before
        else:
            is_same = np.array_equal(given, before)
        if not is_same:
            self.changed()

    @property
    def is_waiting(self) -> bool:
        return self._scene is EMPTY

    def home(self) -> Limits:
        return self._scene.home()

    def bounds(self) -> Limits:
        return self._scene.home()

    def least(self) -> tuple[float, float]:
        rows, columns = self._scene.shape
        return min(LEAST_COLUMNS, max(1, columns)), min(LEAST_ROWS, max(1, rows))

    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        return self._scene.axes(limits)

    def drawn(self, viewport: Viewport, colours: Palette, width: int) -> Drawn:
        shown, table = self._levels(viewport)
        overlay = Overlay(viewport.width, viewport.height)
        cursor = None
        if not self._scene.is_empty:
            rows, columns = samplings(viewport, self._scene.shape)
            cursor = self._put_on(overlay, rows, columns)
        if self.app.no_color and self.app.native_ansi_color:
            lines = shaded(shown, overlay)
        else:
            lines = picture(shown, colours, overlay)
        return Drawn(lines, cursor, foot(self._words(colours), self._scale(table, colours, width), width))

    def clicked(self, row: int, column: int, times: int) -> None:
        if self._scene.is_empty:
            return
        rows, columns = samplings(self.viewport, self._scene.shape)
        first, last = int(rows.first[DOWN * row]), int(rows.last[DOWN * row + 1])
        left, right = int(columns.first[column]), int(columns.last[column])
        # What is seen there is the greatest of these.
        under = self._scene.comparable[first : last + 1, left : right + 1]
        down, along = divmod(int(np.argmax(under)), under.shape[1])
        self.move_cursor(first + down, left + along)
        if times > 1:
            self.action_choose()

    def action_move(self, rows: int, columns: int) -> None:
        self.move_cursor(self._cursor[0] + rows, self._cursor[1] + columns)

    def action_zoom(self, steps: int) -> None:
        row, column = self._cursor
        self.zoom(KEY_ZOOM**steps, column + 0.5, row + 0.5)
        self._follow()

    def action_fit_votes(self) -> None:
        """Show the columns of ρ that have votes, and nothing beside them."""
        if not self._scene.is_empty:
            self.look_at(self._scene.occupied())

    def action_next_peak(self, step: int) -> None:
        if self._scene.is_empty:
            return
        peaks = self._scene.peaks
        if len(peaks):
            here = np.flatnonzero((peaks == self._cursor).all(axis=1))
            place = (int(here[0]) + step) % len(peaks) if len(here) else 0
            self.move_cursor(*peaks[place].tolist())

    def action_choose(self) -> None:
        if not self._scene.is_empty:
            self.post_message(self.CellChosen(self, *self._cursor))

    def _tell(self) -> None:
        if self.is_running and not self._scene.is_empty:
            self.post_message(self.CellHighlighted(self, *self._cursor))

    def _clipped(self, row: int, column: int) -> tuple[int, int]:
        rows, columns = self._scene.shape
        return min(max(int(row), 0), rows - 1), min(max(int(column), 0), columns - 1)

    def _follow(self) -> None:
        """Bring the cell under the cursor into view, and its neighbours with it."""
        if self._limits is not None:
            row, column = self._cursor
            view = self.viewport.showing(column - 1.0, row - 1.0).showing(column + 2.0, row + 2.0)
            self.look_at(view.within(self.bounds()).limits)

    def _levels(self, viewport: Viewport) -> tuple[Levels, Levels]:
        """Return the level of each picture element, worked out once a view, and what became of levels."""
        scene = self._scene
        if self._sampled is None or self._sampled[0] is not scene or self._sampled[1] != viewport:
            if scene.is_empty:
                shown = np.zeros((DOWN * viewport.height, viewport.width), np.uint8)
            else:
                values = pooled(scene.comparable, *samplings(viewport, scene.shape))
                shown = levels(values, *scene.extremes)
            self._sampled = scene, viewport, *flattened(shown)
        return self._sampled[2], self._sampled[3]

    def _put_on(self, overlay: Overlay, rows: Sampling, columns: Sampling) -> tuple[int, int] | None:
        """Put curve, tracks and cursor over the picture; return row and column of the cursor, if in view."""
        if self._trace is not None:
            elements = np.zeros((len(rows.first), len(columns.first)), np.bool_)
            every = np.flatnonzero((self._trace >= 0) & (self._trace < self._scene.shape[1]))
            tops, bottoms = rows.where(every)
            lefts, rights = columns.where(self._trace[every])
            for top, bottom, left, right in zip(tops, bottoms, lefts, rights, strict=True):
                elements[top:bottom, left:right] = True
            overlay.trace(elements)
        for top, bottom, left, right in _cells(rows, columns, self._scene.mark_cells):
            overlay.put((top + bottom) // 2, (left + right) // 2, TRACK_MARK)
        here = _cells(rows, columns, np.array([self._cursor]))
        if not here:
            return None
        ((top, bottom, left, right),) = here
        # Corners around the cell leave it as it is; the ground of each keeps the level that it covers.
        for row, column, corner in (
            (top - 1, left - 1, "┌"),
            (top - 1, right + 1, "┐"),
            (bottom + 1, left - 1, "└"),
            (bottom + 1, right + 1, "┘"),
        ):
            overlay.put(row, column, corner)
        return (top + bottom) // 2, (left + right) // 2

    def _words(self, colours: Palette) -> Words:
        """Return the read-out of the cell under the cursor."""
        if self._scene.is_empty:
            return []
        theta, rho, value = self._scene.words(*self._cursor)
        plain, strong = ink(colours.text), ink(colours.lit, bold=True)
        return [
            ("θ ", ink(colours.muted)),
            (f"{theta}  ", plain),
            ("ρ ", ink(colours.muted)),
            (f"{rho}  ", plain),
            (value, strong),
        ]

    def _scale(self, table: Levels, colours: Palette, width: int) -> Words:
        """Return the colour scale with what its ends stand for."""
        if self._scene.is_empty:
            return []
        made, muted = inks(colours), ink(colours.muted)
        low, high = self._scene.ends
        if width >= ROOM_FOR_WIDE_SCALE:
            steps: Words = [(" ", made.style(level, level)) for level in table.tolist()]
        else:
            pairs = table.reshape(LEVELS // 2, 2).tolist()
            steps = [("▌", made.style(right, left)) for left, right in pairs]
        return [(f"{low} ", muted), *steps, (f" {high}", muted)]


def _key(scene: HeatmapScene) -> tuple[float, ...]:
    return (*scene.theta_deg[[0, -1]].tolist(), *scene.rho[[0, -1]].tolist())


def _cells(rows: Sampling, columns: Sampling, given: NDArray[np.int64]) -> list[tuple[int, int, int, int]]:
    """Return first and last row, first and last column of the screen cells that show cells in view."""
    tops, bottoms = rows.where(given[:, 0])
    lefts, rights = columns.where(given[:, 1])
    seen = (tops < bottoms) & (lefts < rights)
    edges = (tops // DOWN, (bottoms - 1) // DOWN, lefts, rights - 1)
    return list(zip(*(edge[seen].tolist() for edge in edges), strict=True))
