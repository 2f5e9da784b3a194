"""A line that says what is seen, as much of it as there is room for."""

from __future__ import annotations

from rich.text import Text
from textual.reactive import reactive
from textual.widget import Widget

from hough_tui.ui.drawing.shortening import Part, fitted


class Caption(Widget):
    """One line of parts, of which those that matter least are left out first."""

    DEFAULT_CSS = """
    Caption { height: 1; width: 1fr; color: $text-muted; padding: 0 1; }
    """

    parts: reactive[tuple[Part, ...]] = reactive(())

    def tell(self, *parts: Part | str) -> None:
        """Say something else."""
        self.parts = tuple(Part(part) if isinstance(part, str) else part for part in parts)

    def render(self) -> Text:
        """Return what fits."""
        return Text(fitted(self.parts, self.size.width), no_wrap=True)
