"""The trials behind a row of a table of rates."""

from __future__ import annotations

from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Footer, Static

from hough_tui.ui.runs.shown_run import cell_words
from hough_tui.ui.widgets.trial_list import TrialList
from hough_tui.ui.widgets.trial_table import Rows, TrialTable


class TrialsScreen(ModalScreen[int | None]):
    """Choose a trial; the result is its number, or None."""

    DEFAULT_CSS = """
    TrialsScreen { align: center middle; }
    TrialsScreen > Vertical {
        width: 96%; max-width: 110; height: 94%; background: $surface; border: round $primary;
        border-title-color: $text; border-title-style: bold; border-subtitle-color: $text-muted;
    }
    TrialsScreen .about { color: $text-muted; padding: 0 1; height: auto; }
    TrialsScreen TrialList { height: 1fr; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,q", "leave", "Back", id="trials.leave")]

    def __init__(self, table: TrialTable[Any, Any], order: Rows) -> None:
        super().__init__()
        self._table, self._order = table, order

    def compose(self) -> ComposeResult:
        """Lay out the list below what it is about."""
        with Vertical():
            yield Static(self._table.words, classes="about", markup=False)
            yield TrialList(self._table, self._order)
        yield Footer(show_command_palette=False)

    def on_mount(self) -> None:
        """Say which row this is."""
        frame = self.query_one(Vertical)
        frame.border_title = cell_words(self._table.trials.cell).replace("[", r"\[")
        self._tell_order()
        self.query_one(TrialList).focus()

    def on_trial_list_ordered(self) -> None:
        """Say how the trials are sorted."""
        self._tell_order()

    def on_trial_list_opened(self, event: TrialList.Opened) -> None:
        """Answer with the trial."""
        self.dismiss(event.trial)

    def action_leave(self) -> None:
        """Answer nothing."""
        self.dismiss(None)

    def _tell_order(self) -> None:
        self.query_one(Vertical).border_subtitle = f"by {self.query_one(TrialList).sorted_by}".replace(
            "by failed", "failed"
        )
