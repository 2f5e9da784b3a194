"""A choice of one from a list, over the main screen."""

from __future__ import annotations

from typing import ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option


class Choice(ModalScreen[str | None]):
    """Choose one of several; the result is its key, or None."""

    DEFAULT_CSS = """
    Choice { align: center middle; }
    Choice > Vertical { width: 76; max-width: 95%; height: auto; max-height: 90%; padding: 1 2;
        background: $surface; border: round $primary; }
    Choice .title { text-style: bold; margin-bottom: 1; }
    Choice OptionList { height: auto; max-height: 18; border: none; background: $surface; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Back", id="choice.leave"),
        Binding("j", "move(1)", "Next", id="choice.next", show=False),
        Binding("k", "move(-1)", "Previous", id="choice.previous", show=False),
    ]

    def __init__(self, title: str, options: dict[str, str]) -> None:
        super().__init__()
        self._title, self._options = title, options

    def compose(self) -> ComposeResult:
        """Lay out the list."""
        with Vertical():
            yield Static(self._title, classes="title", markup=False)
            yield OptionList(*(Option(Text(label), id=key) for key, label in self._options.items()))

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Choose."""
        self.dismiss(event.option.id)

    def action_move(self, step: int) -> None:
        """Move the choice."""
        options = self.query_one(OptionList)
        (options.action_cursor_down if step > 0 else options.action_cursor_up)()

    def action_leave(self) -> None:
        """Choose nothing."""
        self.dismiss(None)
