"""The choice of the metrics and intervals that a table of rates shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Footer, SelectionList, Static
from textual.widgets.selection_list import Selection

from hough_tui.reports.metric_columns import Offer

Columns = tuple[str, ...]


class ColumnsScreen(ModalScreen["Columns | None"]):
    """Choose columns; the result is their keys, none for those that say something, None for no change.

    Parameters
    ----------
    offers : the columns that there are
    shown : keys of those that the table shows
    """

    DEFAULT_CSS = """
    ColumnsScreen { align: center middle; }
    ColumnsScreen > Vertical { width: 76; max-width: 95%; height: auto; max-height: 90%; padding: 0 1;
        background: $surface; border: round $primary; border-title-color: $text;
        border-title-style: bold; }
    ColumnsScreen SelectionList { height: auto; max-height: 1fr; border: none; background: $surface; }
    ColumnsScreen Static { color: $text-muted; height: 3; padding: 0 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q", "leave", "Back", id="columns.leave"),
        Binding("enter", "take", "Show these", id="columns.take", priority=True),
        Binding("a", "all", "All", id="columns.all"),
        Binding("d", "default", "As it was", id="columns.default"),
        Binding("j", "move(1)", "Next", id="columns.next", show=False),
        Binding("k", "move(-1)", "Previous", id="columns.previous", show=False),
    ]

    def __init__(self, offers: Sequence[Offer], shown: Sequence[str]) -> None:
        super().__init__()
        self._offers, self._shown = tuple(offers), frozenset(shown)

    def compose(self) -> ComposeResult:
        """Lay out the list above the definition of what is under the cursor."""
        with Vertical() as frame:
            frame.border_title = "Columns: Space marks, Enter shows"
            yield SelectionList[str](
                *(Selection(Text(offer.words), offer.key, offer.key in self._shown) for offer in self._offers)
            )
            yield Static(markup=False)
        yield Footer(show_command_palette=False)

    def on_mount(self) -> None:
        """Choose at once."""
        self.query_one(SelectionList).focus()

    @on(SelectionList.SelectionHighlighted)
    def _define(self, event: SelectionList.SelectionHighlighted[str]) -> None:
        self.query_one(Static).update(self._offers[event.selection_index].definition)

    def action_take(self) -> None:
        """Show what is marked, in the order of the list."""
        marked = set(self.query_one(SelectionList).selected)
        self.dismiss(tuple(offer.key for offer in self._offers if offer.key in marked))

    def action_all(self) -> None:
        """Mark every column."""
        self.query_one(SelectionList).select_all()

    def action_default(self) -> None:
        """Show what says something, as a table does that was not asked for anything."""
        self.dismiss(())

    def action_move(self, step: int) -> None:
        """Move the cursor."""
        offered = self.query_one(SelectionList)
        (offered.action_cursor_down if step > 0 else offered.action_cursor_up)()

    def action_leave(self) -> None:
        """Change nothing."""
        self.dismiss(None)
