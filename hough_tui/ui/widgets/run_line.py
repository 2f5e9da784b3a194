"""One line on how far a run is, with a bar."""

from __future__ import annotations

from typing import ClassVar

from rich.text import Text
from textual.reactive import reactive
from textual.widget import Widget

from hough_tui.ui.drawing.shortening import fitted, ranked

BAR = 20
"""Cells of the bar."""


class RunLine(Widget):
    """What a run does, or did, or would do."""

    DEFAULT_CSS = """
    RunLine { height: 1; padding: 0 1; color: $text-muted; }
    RunLine.-problem { color: $text-error; }
    RunLine > .run-line--bar { color: $primary; }
    """
    COMPONENT_CLASSES: ClassVar[set[str]] = {"run-line--bar"}

    text: reactive[str] = reactive("")
    share: reactive[float | None] = reactive(None)

    def tell(self, text: str, share: float | None = None, *, is_problem: bool = False) -> None:
        """Say something.

        Parameters
        ----------
        text : what to say; of its parts, between dots, the last are left out where there is no room
        share : how much of the run is done, in [0, 1]; None for no bar
        is_problem : whether it is a reason why nothing runs
        """
        self.text, self.share = text, share
        self.set_class(is_problem, "-problem")

    def render(self) -> Text:
        """Return the line."""
        line = Text(no_wrap=True)
        if self.share is not None:
            full = round(BAR * self.share)
            line.append("━" * full, self.get_component_rich_style("run-line--bar", partial=True))
            line.append("─" * (BAR - full) + " ", "dim")
        return line.append(fitted(ranked(self.text), self.size.width - line.cell_len))
