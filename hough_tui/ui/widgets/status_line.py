"""The status line: which set, whether it is saved, what runs."""

from __future__ import annotations

from rich.text import Text
from textual.reactive import reactive
from textual.widget import Widget


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
        left = Text(self.file, no_wrap=True)
        if self.is_changed:
            left.append(" ● changed", style="bold")
        if self.is_wrong:
            left.append("  ✗ a field is wrong", style="bold red")
        right = " · ".join(part for part in (self.state, self.job) if part)
        room = self.size.width - left.cell_len - len(right)
        if room < 1 and right:
            left.truncate(max(0, self.size.width - len(right) - 1), overflow="ellipsis")
            room = self.size.width - left.cell_len - len(right)
        return left + Text(" " * max(1, room) + right)
