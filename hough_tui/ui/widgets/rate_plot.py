"""The chart beside the table: drawn in a thread, since plotext takes 30 to 100 ms for one."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import Console
from rich.text import Text
from textual import work
from textual.message import Message
from textual.strip import Strip
from textual_plotext import PlotextPlot

Drawing = Callable[[int, int], str]
"""Returns the text of a chart, with the codes of its colours, for a width and a height in cells."""


class RatePlot(PlotextPlot, can_focus=True):
    """A chart of plotext; each drawing has a figure of its own."""

    DEFAULT_CSS = """
    RatePlot { background: $surface; }
    RatePlot:focus { background: $surface-lighten-1 50%; }
    """

    class Drawn(Message):
        """A drawing is ready."""

        def __init__(self, lines: tuple[Strip, ...]) -> None:
            super().__init__()
            self.lines = lines

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._drawing: Drawing | None = None
        self._drawn: tuple[Strip, ...] = ()
        self._drawn_of: tuple[Drawing, int, int] | None = None
        self._is_busy = False
        self._is_stale = False

    def show(self, drawing: Drawing | None) -> None:
        """Show a chart, when it is drawn; None for nothing.

        While nobody sees the widget nothing is drawn: that comes when it has a size.
        """
        self._drawing = drawing
        if drawing is None:
            self._drawn, self._drawn_of = (), None
            self.refresh()
        else:
            self._redraw()

    def on_resize(self) -> None:
        """Draw for the new size."""
        self._redraw()

    def render_line(self, y: int) -> Strip:
        """Return a line of what was drawn last."""
        style, width = self.rich_style, self.content_size.width
        line = self._drawn[y] if y < len(self._drawn) else Strip([])
        return line.crop_extend(0, width, style).apply_style(style)

    def on_rate_plot_drawn(self, event: Drawn) -> None:
        """Show what was drawn, and draw again where it is out of date."""
        event.stop()
        self._is_busy = False
        if self._drawing is not None:
            # Even one that is out of date is newer than what is on the screen.
            self._drawn = event.lines
            self.refresh()
        if self._is_stale:
            self._redraw()

    def _redraw(self) -> None:
        width, height = self.content_size
        if self._drawing is None or width < 10 or height < 5:
            return
        wanted = self._drawing, width, height
        if wanted == self._drawn_of:
            return
        # One at a time: what is asked for meanwhile is drawn once, after it.
        self._is_stale = self._is_busy
        if not self._is_busy:
            self._is_busy, self._drawn_of = True, wanted
            self._draw(self._drawing, width, height, self.app.console)

    @work(thread=True, exit_on_error=False, group="chart")
    def _draw(self, drawing: Drawing, width: int, height: int, console: Console) -> None:
        try:
            text = Text.from_ansi(drawing(width, height), no_wrap=True)
        except Exception as error:
            text = Text(f"This chart cannot be drawn: {error}", style="bold")
        # Down to the segments, so that the event loop has nothing more to work out.
        lines = text.split("\n", allow_blank=True)
        self.post_message(self.Drawn(tuple(Strip(list(line.render(console, end=""))) for line in lines)))
