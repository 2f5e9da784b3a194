"""Results: the runs kept so far, to show again, compare, export and delete."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual import events, on, work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
from textual.widget import Widget
from textual.widgets import DataTable, Static

from algorithms.errors import RequestError
from hough_tui.experiments.stores.folder import FolderStore, Run
from hough_tui.ui.drawing.shortening import ranked
from hough_tui.ui.runs.run_summaries import KeptSummary, summaries
from hough_tui.ui.runs.shown_run import KeptRun
from hough_tui.ui.screens.comparison import ComparisonScreen
from hough_tui.ui.screens.export import Document, ExportScreen
from hough_tui.ui.screens.question import Question, telling
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.rate_panel import RatePanel
from hough_tui.ui.widgets.run_list import RunList
from scenarios.model import ScenarioSet

WIDE, TALL = 120, 34
"""Columns of the terminal and lines of the view from which list and run stand above each other."""


class ResultsView(Widget):
    """The runs that were kept; one of them as table and chart."""

    HELP = (
        "The runs kept so far, the newest first. Enter shows one again, with its table, its chart and its "
        "trials. Space marks runs; = compares those that are marked, the oldest with each of the others: "
        "rows of the same set, experiment, scenario, initiator and swept values stand side by side, with the "
        "difference, its 95 % interval and whether it lies beyond chance. e exports the run, Delete removes "
        "the marked runs, or the one under the cursor. Escape leads back to the list."
    )
    DEFAULT_CSS = """
    ResultsView { layout: vertical; height: 1fr; background: $surface; }
    ResultsView #list { height: 1fr; }
    ResultsView RunList { height: 1fr; }
    ResultsView #run { height: 1fr; display: none; }
    ResultsView #called { height: 1; padding: 0 1; background: $panel; text-style: bold; }
    ResultsView.-run #list { display: none; }
    ResultsView.-run #run { display: block; }
    ResultsView.-both #list { display: block; height: 30%; min-height: 8; }
    ResultsView.-both #run { display: block; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "back", "Back to the list", id="results.back", show=False),
        Binding("u", "reload", "Read the list again", id="results.reload", show=False),
    ]

    class Listed(Message):
        """The list is read."""

        def __init__(self, found: list[KeptSummary]) -> None:
            super().__init__()
            self.found = found

    class RunRead(Message):
        """A run is read."""

        def __init__(self, run: KeptRun) -> None:
            super().__init__()
            self.run = run

    class RunsRead(Message):
        """Runs that are to be compared are read."""

        def __init__(self, runs: list[tuple[str, Run]]) -> None:
            super().__init__()
            self.runs = runs

    class DocumentRead(Message):
        """The document of a run that is to be exported is read."""

        def __init__(self, name: str, document: Document) -> None:
            super().__init__()
            self.name, self.document = name, document

    class Failed(Message):
        """Something could not be done."""

        def __init__(self, text: str) -> None:
            super().__init__()
            self.text = text

    def compose(self) -> ComposeResult:
        """Lay out the list, and the run that is shown."""
        with Vertical(id="list"):
            yield Caption(id="about")
            yield RunList()
        with Vertical(id="run"):
            yield Static(id="called", markup=False)
            yield RatePanel()

    def on_mount(self) -> None:
        """Read the list."""
        self._list()

    def on_show(self) -> None:
        """Read the list again: runs may have come."""
        self._list()

    def on_resize(self, event: events.Resize) -> None:
        """Show list and run together where there is room."""
        self.set_class(self.app.size.width >= WIDE and event.size.height >= TALL, "-both")

    def show_set(self, given: ScenarioSet) -> None:
        """Nothing changes: kept runs do not depend on the set that is open."""

    def set_runnable(self, reason: str | None) -> None:
        """Nothing changes: nothing runs here."""

    def take_focus(self) -> None:
        """Put the focus on the list, or on the run in its place."""
        if self.query_one("#list").display:
            self.query_one(RunList).focus()
        else:
            self.query_one(RatePanel).take_focus()

    # The list

    def action_reload(self) -> None:
        """Read the list again."""
        self._list()

    @work(thread=True, exclusive=True, exit_on_error=False, group="list")
    def _list(self) -> None:
        try:
            self.post_message(self.Listed(summaries(FolderStore(), self.query_one(RunList).known)))
        except OSError as error:
            self.post_message(self.Failed(f"The runs cannot be listed: {error}"))

    @on(Listed)
    def _show_list(self, event: Listed) -> None:
        runs = self.query_one(RunList)
        runs.show_runs(event.found)
        self._tell_about()

    @on(RunList.Marked)
    def _tell_about(self) -> None:
        runs = self.query_one(RunList)
        count = len(runs.known)
        if not count:
            text = "no run has been kept yet: those of the Monte Carlo view and of `hough-tui batch` are"
        elif runs.marked:
            text = f"{count:,} runs · {len(runs.marked)} marked · = compares, Delete deletes them"
        else:
            text = f"{count:,} run{'s' * (count != 1)} · Enter shows, Space marks, e exports, Delete deletes"
        self.query_one("#about", Caption).tell(*ranked(text))

    # One run

    @on(DataTable.RowSelected, "RunList")
    def _chosen(self, event: DataTable.RowSelected) -> None:
        event.stop()
        if event.row_key.value is not None:
            self._read(event.row_key.value)

    @work(thread=True, exclusive=True, exit_on_error=False, group="read")
    def _read(self, name: str) -> None:
        try:
            self.post_message(self.RunRead(KeptRun(name, FolderStore().load(name))))
        except (RequestError, OSError) as error:
            self.post_message(self.Failed(str(error)))

    @on(RunRead)
    def _show_run(self, event: RunRead) -> None:
        self.query_one("#called", Static).update(event.run.name)
        self.add_class("-run")
        panel = self.query_one(RatePanel)
        panel.show(event.run)
        self.call_after_refresh(panel.take_focus)

    def action_back(self) -> None:
        """Go back to the list."""
        self.remove_class("-run")
        self.query_one(RunList).focus()

    # Several

    @on(RunList.Comparing)
    def _compare(self, event: RunList.Comparing) -> None:
        if len(event.names) < 2:
            self.notify("Mark two runs or more with Space first", markup=False)
        else:
            self._read_several(event.names)

    @work(thread=True, exclusive=True, exit_on_error=False, group="read")
    def _read_several(self, names: list[str]) -> None:
        store = FolderStore()
        try:
            self.post_message(self.RunsRead([(name, store.load(name)) for name in names]))
        except (RequestError, OSError) as error:
            self.post_message(self.Failed(str(error)))

    @on(RunsRead)
    def _show_comparison(self, event: RunsRead) -> None:
        self.app.push_screen(ComparisonScreen(event.runs))

    # Files

    @on(RunList.Exporting)
    def _export(self, event: RunList.Exporting) -> None:
        self._read_document(event.names[0])

    @work(thread=True, exclusive=True, exit_on_error=False, group="read")
    def _read_document(self, name: str) -> None:
        try:
            self.post_message(self.DocumentRead(name, FolderStore().document(name)))
        except (RequestError, OSError) as error:
            self.post_message(self.Failed(str(error)))

    @on(DocumentRead)
    def _ask_path(self, event: DocumentRead) -> None:
        def written(path: Path | None) -> None:
            self.query_one(RatePanel).tell_written(path)

        self.app.push_screen(ExportScreen(event.name, event.document), written)

    @on(RunList.Deleting)
    def _ask_delete(self, event: RunList.Deleting) -> None:
        names = event.names

        def answer(key: str | None) -> None:
            if key == "delete":
                self._delete(names)

        what = names[0] if len(names) == 1 else f"{len(names)} runs"
        answers = {"keep": "Keep", "delete": "Delete"}
        self.app.push_screen(Question(f"Delete {what}?", "\n".join(names), answers), answer)

    @work(thread=True, exclusive=True, exit_on_error=False, group="list")
    def _delete(self, names: list[str]) -> None:
        store = FolderStore()
        try:
            for name in names:
                store.remove(name)
        except (RequestError, OSError) as error:
            self.post_message(self.Failed(str(error)))
        self.post_message(self.Listed(summaries(store, self.query_one(RunList).known)))

    @on(Failed)
    def _tell_failure(self, event: Failed) -> None:
        event.stop()
        self.app.push_screen(telling("That did not work", event.text))
