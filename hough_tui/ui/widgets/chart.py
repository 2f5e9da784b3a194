"""What the plane and the heat-map share: a view that zooms and pans, and a repaint of what differs."""

from __future__ import annotations

import os
from abc import abstractmethod
from collections.abc import Sequence
from itertools import zip_longest
from typing import NamedTuple

from rich.style import Style
from textual import events
from textual.geometry import Offset, Region, Size
from textual.strip import Strip
from textual.widget import Widget

from hough_tui.ui.drawing.axes import Axis, Frame, framed
from hough_tui.ui.drawing.console import for_console
from hough_tui.ui.drawing.palette import Palette, palette
from hough_tui.ui.drawing.viewport import Limits, Viewport

KEY_ZOOM, WHEEL_ZOOM = 1.5, 1.25
"""How much nearer one step takes things."""


class Drawn(NamedTuple):
    """A picture, the row and column in it that its axes point at, and the line at the foot of the chart."""

    picture: Sequence[Strip]
    cursor: tuple[int, int] | None
    foot: Strip


class Chart(Widget, can_focus=True):
    """A picture with axes; its subclasses say what of.

    A change marks the chart as stale. Once all waiting messages have been seen to, it is drawn
    again as a whole, which takes a few milliseconds, and only the lines that came out different
    are sent to the terminal, which over a slow line takes far longer.
    """

    ALLOW_SELECT = False

    DEFAULT_CSS = """
    Chart { width: 1fr; height: 1fr; }
    """

    def __init__(self, *, name: str | None = None, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(name=name, id=id, classes=classes)
        self._limits: Limits | None = None
        self._lines: list[Strip] = []
        self._drawn_for: Size | None = None
        self._is_stale = False
        self._drag: tuple[Offset, Viewport] | None = None
        self._was_dragged = False

    # What a subclass says of itself.

    @abstractmethod
    def home(self) -> Limits:
        """Return the limits with everything in view."""

    @abstractmethod
    def bounds(self) -> Limits:
        """Return the limits that no view goes beyond."""

    @abstractmethod
    def least(self) -> tuple[float, float]:
        """Return how much of each axis is shown at least."""

    @abstractmethod
    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        """Return the axis across and the upright one."""

    @abstractmethod
    def drawn(self, viewport: Viewport, colours: Palette, width: int) -> Drawn:
        """Return the picture and what goes with it; `width` is that of the whole chart."""

    @abstractmethod
    def clicked(self, row: int, column: int, times: int) -> None:
        """See to a click on a cell of the picture."""

    @property
    def is_waiting(self) -> bool:
        """Whether nothing has been given to be drawn yet: axes would be of nothing."""
        return False

    def adapted(self, viewport: Viewport) -> Viewport:
        """Return a view as this chart can show it."""
        return viewport

    # The view.

    @property
    def limits(self) -> Limits:
        """What is in view."""
        return self._limits or self.home()

    @property
    def layout_of_parts(self) -> tuple[Frame, Viewport]:
        """Where the parts of the chart lie, and what its picture is of."""
        frame = self._frame(self.limits)
        view = self.adapted(Viewport(self.limits, frame.width, frame.height))
        # The figures of other limits may be longer or shorter.
        frame = self._frame(view.limits)
        return frame, view.resized(frame.width, frame.height)

    @property
    def viewport(self) -> Viewport:
        """What is in view, and on how many cells."""
        return self.layout_of_parts[1]

    def _frame(self, limits: Limits) -> Frame:
        width, height = self.size
        return Frame.within(max(1, width), max(1, height), self.axes(limits)[1])

    def look_at(self, limits: Limits | None) -> None:
        """Show a part; None for everything."""
        wanted = None if limits == self.home() else limits
        if wanted != self._limits:
            self._limits = wanted
            self.changed()

    def zoom(self, factor: float, x: float, y: float) -> None:
        """Zoom about a point."""
        view = self.viewport.zoomed(factor, x, y, self.least())
        self.look_at(view.within(self.bounds()).limits)

    def pan(self, across: float, down: float) -> None:
        """Move the view by shares of its width and height."""
        view = self.viewport
        view = view.panned(across * view.width, down * view.height)
        self.look_at(view.within(self.bounds()).limits)

    # Drawing.

    def changed(self) -> None:
        """Have the chart drawn again when nothing else is waiting."""
        if self._is_stale or self._drawn_for is None:
            # What has not been on the screen yet is drawn when it gets there.
            return
        self._is_stale = True
        self.call_later(self._redraw)

    def render_line(self, y: int) -> Strip:
        # Another size has the whole chart repainted; any other change waits for `_redraw`, which
        # knows the lines that it takes.
        if self._drawn_for != self.size:
            self._draw()
        return self._lines[y] if y < len(self._lines) else Strip.blank(self.size.width, self._ground)

    @property
    def _ground(self) -> Style:
        """The ground, which Textual does not put under the lines that a widget gives."""
        return Style(bgcolor=self.rich_style.bgcolor)

    def notify_style_update(self) -> None:
        super().notify_style_update()
        # The ground may be another one, on focus or with another theme.
        self.changed()

    def _draw(self) -> None:
        self._drawn_for, self._is_stale = self.size, False
        if self.is_waiting:
            self._lines = []
            return
        colours = palette(self.app.current_theme.dark)
        frame, viewport = self.layout_of_parts
        picture, cursor, foot = self.drawn(viewport, colours, self.size.width)
        axes = self.axes(viewport.limits)
        lines = framed(picture, frame, axes, viewport.limits, colours, cursor)
        if frame.foot:
            lines.append(foot)
        if os.environ.get("TERM") == "linux":
            lines = for_console(lines)
        ground = self._ground
        self._lines = [line.apply_style(ground) for line in lines]

    def _redraw(self) -> None:
        if not self._is_stale:
            return
        if not self.size.area:
            # It is not on the screen. When it gets there, lines kept from before must not be taken.
            self._is_stale, self._drawn_for = False, None
            self.refresh()
            return
        before = self._lines
        self._draw()
        differ = [
            Region(0, row, self.size.width, 1)
            for row, (old, new) in enumerate(zip_longest(before, self._lines))
            if old != new
        ]
        if differ:
            self.refresh(*differ)

    def on_mount(self) -> None:
        self.app.theme_changed_signal.subscribe(self, lambda _: self.changed())

    # Mouse and keys.

    def _cell(self, event: events.MouseEvent) -> tuple[int, int]:
        """Return row and column of the picture at the pointer, perhaps outside it."""
        offset = event.get_content_offset_capture(self)
        return offset.y, offset.x - self.layout_of_parts[0].gutter

    def on_mouse_down(self, event: events.MouseDown) -> None:
        self._was_dragged = False
        self._drag = event.screen_offset, self.viewport
        self.capture_mouse()

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._drag is None:
            return
        begin, view = self._drag
        moved = event.screen_offset - begin
        if moved or self._was_dragged:
            self._was_dragged = True
            self.look_at(view.panned(-moved.x, -moved.y).within(self.bounds()).limits)

    def on_mouse_up(self) -> None:
        self._drag = None
        self.release_mouse()

    def on_mouse_release(self) -> None:
        self._drag = None

    def on_click(self, event: events.Click) -> None:
        row, column = self._cell(event)
        view = self.viewport
        if not self._was_dragged and 0 <= row < view.height and 0 <= column < view.width:
            self.clicked(row, column, event.chain)

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._wheel(event, WHEEL_ZOOM)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._wheel(event, 1.0 / WHEEL_ZOOM)

    def _wheel(self, event: events.MouseEvent, factor: float) -> None:
        # The wheel is the chart's: what the chart stands in must not scroll beneath the pointer.
        event.stop()
        row, column = self._cell(event)
        view = self.viewport
        column, row = min(max(column, 0), view.width - 1), min(max(row, 0), view.height - 1)
        self.zoom(factor, view.x(column + 0.5), view.y(row + 0.5))

    def action_fit(self) -> None:
        self.look_at(None)
