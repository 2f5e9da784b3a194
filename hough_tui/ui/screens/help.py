"""Help for the focused view: what it shows, and its keys."""

from __future__ import annotations

from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import ActiveBinding, Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static


class HelpScreen(ModalScreen[None]):
    """Tell what a view is for, and which keys work there."""

    DEFAULT_CSS = """
    HelpScreen { align: center middle; }
    HelpScreen > VerticalScroll { width: 78; max-width: 95%; height: auto; max-height: 90%; padding: 1 2;
        background: $surface; border: round $primary; }
    HelpScreen .keys { margin-top: 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,f1", "leave", "Back", id="help.leave"),
        Binding("j", "scroll(1)", "Down", id="help.down", show=False),
        Binding("k", "scroll(-1)", "Up", id="help.up", show=False),
    ]

    def __init__(self, text: str, bindings: list[ActiveBinding]) -> None:
        super().__init__()
        self._text, self._listed = text, bindings

    def compose(self) -> ComposeResult:
        """Lay out the text above the keys."""
        with VerticalScroll():
            yield Static(self._text, markup=False)
            yield Static(self._keys(), classes="keys")

    def action_scroll(self, lines: int) -> None:
        """Scroll by lines."""
        self.query_one(VerticalScroll).scroll_relative(y=lines, animate=False)

    def action_leave(self) -> None:
        """Go back."""
        self.dismiss(None)

    def _keys(self) -> Table:
        table = Table(box=None, padding=(0, 2, 0, 0), show_header=False)
        table.add_column(style="bold", no_wrap=True)
        table.add_column()
        table.add_column(style="dim", no_wrap=True)
        keys: dict[str, list[str]] = {}
        shown: dict[str, Binding] = {}
        for active in self._listed:
            binding = active.binding
            name = binding.id or binding.action
            if binding.description and (binding.id or not binding.system):
                keys.setdefault(name, []).append(self.app.get_key_display(binding))
                shown[name] = binding
        for name, binding in shown.items():
            joined = " ".join(dict.fromkeys(keys[name]))
            table.add_row(Text(joined), Text(binding.description), Text(binding.id or ""))
        return table
