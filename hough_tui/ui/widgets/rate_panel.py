"""A run's table and chart, with the way to its trials, to files and to the clipboard."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, ClassVar

from rich.text import Text
from textual import events, on, work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.message import Message
from textual.widget import Widget
from textual.widgets import DataTable, Static

from algorithms.errors import RequestError
from hough_tui.directories import data_directory
from hough_tui.experiments.cases import AnyCell, Row
from hough_tui.experiments.chunks.clustering import ClusteringCell
from hough_tui.experiments.chunks.initiation import InitiationCell
from hough_tui.reports.documents import markdown_text
from hough_tui.reports.metric_columns import offered
from hough_tui.reports.rates import rate_sheets
from hough_tui.ui.messages import TrialOpened
from hough_tui.ui.runs.shown_run import ShownRun
from hough_tui.ui.screens.columns import ColumnsScreen
from hough_tui.ui.screens.export import Document, ExportScreen
from hough_tui.ui.screens.question import telling
from hough_tui.ui.screens.trials import TrialsScreen
from hough_tui.ui.widgets.chart_pane import ChartPane
from hough_tui.ui.widgets.cluster_trials import ClusterTrials
from hough_tui.ui.widgets.rate_grid import RateGrid
from hough_tui.ui.widgets.rate_plot import RatePlot
from hough_tui.ui.widgets.track_trials import TrackTrials
from hough_tui.ui.widgets.trial_table import Rows, TrialTable
from scenarios.files.atomic import replace_file

TALL, WIDE, BROAD = 27, 120, 90
"""Lines from which table and chart stand above each other; columns of the terminal, and of the panel,
from which they stand side by side."""

STACKED, NOTED, MOST_NOTES = 0.6, 1 / 3, 8
"""Of the panel's lines, the share of table and notes where the chart stands below; of these, the share that
a long table leaves to its notes; and the most lines of notes."""


TABLES: dict[type[AnyCell], type[TrialTable[Any, Any]]] = {
    InitiationCell: TrackTrials,
    ClusteringCell: ClusterTrials,
}
"""The tables of the trials of each kind of row."""


class RatePanel(Widget):
    """Rates as a table and as a chart: both where there is room, else one of them."""

    DEFAULT_CSS = """
    RatePanel { layout: vertical; height: 1fr; background: $surface; }
    RatePanel #rates { height: 1fr; }
    RatePanel #chart { height: 1fr; display: none; }
    RatePanel RateGrid { height: auto; }
    RatePanel #notes { height: auto; padding: 0 1; scrollbar-size: 1 1; }
    RatePanel.-chart #rates { display: none; }
    RatePanel.-chart #chart { display: block; }
    RatePanel.-stacked #rates { display: block; height: auto; max-height: 60%; }
    RatePanel.-stacked #chart { display: block; border-top: solid $panel; }
    RatePanel.-beside { layout: horizontal; }
    RatePanel.-beside #rates { display: block; width: 1fr; height: 1fr; }
    RatePanel.-beside #chart { display: block; width: 1fr; height: 1fr; border-left: solid $panel; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("c", "switch", "Chart", id="rates.chart"),
        Binding("m", "metric(1)", "Metric", id="rates.metric"),
        Binding("M", "metric(-1)", "Metric before", id="rates.metric-before", show=False),
        Binding("t", "by_trial", "False % by trial", id="rates.by-trial", show=False),
        Binding("o", "by_target", "Success by target", id="rates.by-target", show=False),
        Binding("C", "columns", "Columns", id="rates.columns", show=False),
        Binding("down,j", "row(1)", "Next row", id="rates.next-row", show=False),
        Binding("up,k", "row(-1)", "Previous row", id="rates.previous-row", show=False),
        Binding("e", "export", "Export", id="rates.export", show=False),
        Binding("y", "copy", "Copy the table", id="rates.copy", show=False),
    ]

    class TrialsRead(Message):
        """The trials behind a row are at hand."""

        def __init__(self, table: TrialTable[Any, Any], order: Rows) -> None:
            super().__init__()
            self.table, self.order = table, order

    class DocumentRead(Message):
        """The document that is to be exported is at hand."""

        def __init__(self, called: str, document: Document) -> None:
            super().__init__()
            self.called, self.document = called, document

    class Told(Message):
        """Something in a thread came to an end, well or not."""

        def __init__(self, text: str, *, is_problem: bool) -> None:
            super().__init__()
            self.text, self.is_problem = text, is_problem

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.shown: ShownRun | None = None
        self._rows: tuple[Row, ...] = ()
        self._said = Text()

    def compose(self) -> ComposeResult:
        """Lay out the table above its notes, and the chart below the choice of its metric."""
        with Vertical(id="rates"):
            yield RateGrid()
            with VerticalScroll(id="notes", can_focus=False):
                yield Static(markup=False)
        yield ChartPane(id="chart")

    @property
    def grid(self) -> RateGrid:
        """The table."""
        return self.query_one(RateGrid)

    @property
    def chart(self) -> ChartPane:
        """The chart."""
        return self.query_one(ChartPane)

    def show(self, run: ShownRun | None) -> None:
        """Show a run in place of the one before."""
        self.shown = run
        self.grid.sort_by(None)
        self.grid.show_rows(())
        self.fill(run.rows if run is not None else ())

    def fill(self, rows: Sequence[Row]) -> None:
        """Show the rows of the run as they are now."""
        self._rows = tuple(rows)
        self.grid.show_rows(rows)
        self.chart.fill(self.shown, self._rows, self.grid.chosen_index)
        self._tell_notes()

    def take_focus(self) -> None:
        """Put the focus on what is seen of table and chart."""
        (self.grid if self.query_one("#rates").display else self.query_one(RatePlot)).focus()

    def on_resize(self, event: events.Resize) -> None:
        """Show both where there is room."""
        is_tall = event.size.height >= TALL
        is_broad = self.app.size.width >= WIDE and event.size.width >= BROAD
        self.set_class(is_tall, "-stacked")
        self.set_class(is_broad and not is_tall, "-beside")
        self.refresh_bindings()
        self.call_after_refresh(self._share_lines)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Offer the switch only where table and chart take turns."""
        return action != "switch" or not (self.has_class("-stacked") or self.has_class("-beside"))

    # The chart

    def action_switch(self) -> None:
        """Show the chart in place of the table, or the table again."""
        self.toggle_class("-chart")
        self.call_after_refresh(self._switched)

    def _switched(self) -> None:
        self.take_focus()
        self.chart.draw()

    def action_metric(self, step: int) -> None:
        """Draw the next metric."""
        self.chart.next_metric(step)

    def action_by_trial(self) -> None:
        """Draw the ratio of false tracks of the row under the cursor by trial, or the metric again."""
        self.chart.turn_by_trial()
        if not self.chart.display:
            self.action_switch()

    # The table

    def action_by_target(self) -> None:
        """Put success by target beside success, or back to the end of the table."""
        if not self.grid.turn_targets():
            self.notify("No scenario has several targets: success is that of the one", markup=False)
        elif not self.query_one("#rates").display:
            self.action_switch()

    def action_columns(self) -> None:
        """Choose what the table shows."""
        rows = [row for row in self._rows if row["trials"]]
        if not rows:
            self.notify("There is no row yet whose columns could be chosen", markup=False)
            return
        if not self.query_one("#rates").display:
            self.action_switch()

        def choose(keys: tuple[str, ...] | None) -> None:
            if keys is not None:
                self.grid.want(keys)

        self.app.push_screen(ColumnsScreen(offered(rows), self.grid.shown_keys), choose)

    def action_row(self, step: int) -> None:
        """Choose another row while the focus is on the chart."""
        self.grid.move_cursor(row=self.grid.cursor_row + step)

    @on(DataTable.RowHighlighted)
    def _row_changed(self) -> None:
        self._tell_notes()
        self.chart.turn_to(self.grid.chosen_index)

    @on(DataTable.RowSelected)
    def _row_opened(self, event: DataTable.RowSelected) -> None:
        event.stop()
        index = self.grid.chosen_index
        if self.shown is not None and index is not None:
            self._read_trials(self.shown, index)

    def _experiment(self, chosen: Row) -> list[Row]:
        key = chosen["set"], chosen["experiment"]
        return [row for row in self._rows if (row["set"], row["experiment"]) == key]

    def _tell_notes(self) -> None:
        index, text = self.grid.chosen_index, Text()
        if index is not None and index < len(self._rows):
            (sheet,) = rate_sheets(self._experiment(self._rows[index]))
            text.append(sheet.title, "bold").append("  ")
            text.append(" ".join(sheet.notes), "dim")
            for warning in sheet.warnings:
                text.append(f"\n{warning}")
        self.query_one("#notes Static", Static).update(text)
        self._said = text
        self.call_after_refresh(self._share_lines)

    def _share_lines(self) -> None:
        """Give the notes the lines that a short table leaves, and a part of them all below a long one."""
        rates, notes = self.query_one("#rates"), self.query_one("#notes")
        lines = int(STACKED * self.size.height) if self.has_class("-stacked") else self.size.height
        width = max(1, rates.size.width - notes.gutter.width)
        wanted = len(self._said.wrap(self.app.console, width)) if self._said else 0
        table = self.grid.virtual_size.height + self.grid.scrollbar_size_horizontal
        given = min(wanted, MOST_NOTES, max(int(NOTED * lines), lines - table))
        notes.styles.max_height = max(1, given)
        self.grid.styles.max_height = max(1, lines - given)

    # The trials

    @work(thread=True, exclusive=True, exit_on_error=False, group="trials")
    def _read_trials(self, run: ShownRun, index: int) -> None:
        try:
            trials = run.trials(index)
            table = TABLES[type(trials.cell)](trials)
            self.post_message(self.TrialsRead(table, table.first_order))
        except RequestError as error:
            self.post_message(self.Told(str(error), is_problem=True))

    @on(TrialsRead)
    def _show_trials(self, event: TrialsRead) -> None:
        cell = event.table.trials.cell

        def opened(trial: int | None) -> None:
            if trial is not None:
                self.post_message(TrialOpened(cell, trial))

        self.app.push_screen(TrialsScreen(event.table, event.order), opened)

    # Files

    def action_export(self) -> None:
        """Write the run as CSV, JSON or Markdown."""
        if self.shown is not None:
            self._read_document(self.shown)

    @work(thread=True, exclusive=True, exit_on_error=False, group="document")
    def _read_document(self, run: ShownRun) -> None:
        try:
            self.post_message(self.DocumentRead(run.name, run.document()))
        except RequestError as error:
            self.post_message(self.Told(str(error), is_problem=True))

    @on(DocumentRead)
    def _ask_path(self, event: DocumentRead) -> None:
        self.app.push_screen(ExportScreen(event.called, event.document), self.tell_written)

    def tell_written(self, path: Path | None) -> None:
        """Say where a file is."""
        if path is not None:
            self.notify(f"Written to {path}", markup=False)

    def action_copy(self) -> None:
        """Copy the table as Markdown, to the clipboard and to a file."""
        rows = [row for row in self._rows if row["trials"]]
        if rows and self.shown is not None:
            text = markdown_text(rows, self.grid.wanted)
            self.app.copy_to_clipboard(text)
            self._write_copy(self.shown.name, text)

    @work(thread=True, exit_on_error=False, group="copy")
    def _write_copy(self, name: str, text: str) -> None:
        path = data_directory() / "exports" / f"{datetime.now():%Y%m%d-%H%M%S-%f}-{name}.md"
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            replace_file(path, text)
        except OSError as error:
            why = f"The table is on the clipboard only; {path} cannot be written: {error.strerror or error}"
            self.post_message(self.Told(why, is_problem=True))
        else:
            self.post_message(self.Told(f"Copied; also in {path}", is_problem=False))

    @on(Told)
    def _tell(self, event: Told) -> None:
        if event.is_problem:
            self.app.push_screen(telling("That did not work", event.text))
        else:
            self.notify(event.text, markup=False)
