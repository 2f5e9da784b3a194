"""Runs side by side."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import ClassVar

from textual import work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.message import Message
from textual.screen import ModalScreen
from textual.widgets import Footer, Static

from hough_tui.directories import data_directory
from hough_tui.experiments.metrics.registry import leading_metric
from hough_tui.experiments.stores.folder import Run
from hough_tui.reports.comparison import comparable, compare, comparison_sheet
from hough_tui.reports.documents import sheet_markdown
from hough_tui.reports.layout import Sheet
from hough_tui.ui.widgets.rate_grid import RateGrid
from scenarios.files.atomic import replace_file


class ComparisonScreen(ModalScreen[None]):
    """Compare runs row by row.

    Parameters
    ----------
    runs : names and runs; the others are compared with the first
    """

    DEFAULT_CSS = """
    ComparisonScreen { align: center middle; }
    ComparisonScreen > Vertical {
        width: 100%; height: 100%; background: $surface; border: round $primary;
        border-title-color: $text; border-title-style: bold;
    }
    ComparisonScreen RateGrid { height: auto; max-height: 1fr; }
    ComparisonScreen VerticalScroll { height: auto; max-height: 9; padding: 0 1; scrollbar-size: 1 1; }
    ComparisonScreen Static { color: $text-muted; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q", "leave", "Back", id="comparison.leave"),
        Binding("m", "metric", "Metric", id="comparison.metric"),
        Binding("y", "copy", "Copy", id="comparison.copy"),
    ]

    class Told(Message):
        """A file is written, or not."""

        def __init__(self, text: str) -> None:
            super().__init__()
            self.text = text

    def __init__(self, runs: Sequence[tuple[str, Run]]) -> None:
        super().__init__()
        self._runs = tuple(runs)
        rows = [row for _, run in self._runs for row in run.document["rows"]]
        self._metric = leading_metric(rows)
        self._metrics = comparable(rows) or [self._metric]
        self._sheet = Sheet("", ())

    def compose(self) -> ComposeResult:
        """Lay out the table above its notes."""
        with Vertical():
            yield RateGrid(opens=False)
            with VerticalScroll(can_focus=False):
                yield Static(markup=False)
        yield Footer(show_command_palette=False)

    def on_mount(self) -> None:
        """Compare first what runs of this kind are for."""
        self._show()
        self.query_one(RateGrid).focus()

    def action_metric(self) -> None:
        """Compare the next metric."""
        here = self._metrics.index(self._metric) if self._metric in self._metrics else -1
        self._metric = self._metrics[(here + 1) % len(self._metrics)]
        self._show()

    def action_copy(self) -> None:
        """Copy the comparison as Markdown, to the clipboard and to a file."""
        text = sheet_markdown(self._sheet)
        self.app.copy_to_clipboard(text)
        self._write(text)

    @work(thread=True, exit_on_error=False, group="copy")
    def _write(self, text: str) -> None:
        path = data_directory() / "exports" / f"{datetime.now():%Y%m%d-%H%M%S-%f}-comparison.md"
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            replace_file(path, text)
        except OSError as error:
            self.post_message(self.Told(f"On the clipboard only; {path}: {error.strerror or error}"))
        else:
            self.post_message(self.Told(f"Copied; also in {path}"))

    def on_comparison_screen_told(self, event: Told) -> None:
        """Say where the file is."""
        self.notify(event.text, markup=False)

    def action_leave(self) -> None:
        """Go back."""
        self.dismiss(None)

    def _show(self) -> None:
        self._sheet = comparison_sheet(compare(self._runs, self._metric))
        identifying = next(
            (index for index, column in enumerate(self._sheet.columns) if column.key == self._metric.key),
            0,
        )
        self.query_one(RateGrid).show_columns(self._sheet.columns, identifying)
        self.query_one(Static).update("\n".join(self._sheet.notes))
        self.query_one(Vertical).border_title = f"{self._metric.label()} of {len(self._runs)} runs"
