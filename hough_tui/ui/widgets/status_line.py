"""The status line: which set, whether it is saved, what runs."""

from __future__ import annotations

from rich.cells import cell_len
from rich.text import Text
from textual.reactive import reactive
from textual.widget import Widget

from hough_tui.ui.drawing.shortening import BETWEEN, cut, fitted, ranked


class StatusLine(Widget):
    """One line above the footer."""

    DEFAULT_CSS = """
    StatusLine { height: 1; background: $panel; color: $text-muted; padding: 0 1; }
    """

    file: reactive[str] = reactive("")
    is_changed: reactive[bool] = reactive(False)
    is_wrong: reactive[bool] = reactive(False)
    state: reactive[str] = reactive("")
    job: reactive[str] = reactive("")

    def render(self) -> Text:
        """Return the line: the file at the left, what goes on at the right."""
        marks = Text(no_wrap=True)
        if self.is_changed:
            marks.append(" ● changed", style="bold")
        if self.is_wrong:
            marks.append("  ✗ a field is wrong", style="bold red")
        width = self.size.width - marks.cell_len
        right = fitted(ranked(BETWEEN.join(part for part in (self.state, self.job) if part)), width)
        left = Text(shortened(self.file, width - cell_len(right) - 1), no_wrap=True) + marks
        room = self.size.width - left.cell_len - cell_len(right)
        return left + Text(" " * room + right)


def shortened(file: str, width: int) -> str:
    """Return the path of a file without its first folders, or nothing at all, where there is no more room."""
    if cell_len(file) <= width:
        return file
    parts = file.split("/")
    for first in range(1, len(parts)):
        if cell_len(found := "/".join(("…", *parts[first:]))) <= width:
            return found
    return cut(parts[-1], width)
