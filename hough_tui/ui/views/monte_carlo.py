"""Monte Carlo: run experiments, and read their rates while they run."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import ClassVar

from textual import on, work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.timer import Timer
from textual.widget import Widget
from textual.widgets import Static

from algorithms.parameters import Problem
from hough_tui.ui.drawing.shortening import BETWEEN
from hough_tui.ui.runs.pace import Pace, duration
from hough_tui.ui.runs.run_controller import Ended, Event, Filled, Running, RunRequest, Started, keep
from hough_tui.ui.runs.shown_run import LiveRun
from hough_tui.ui.screens.question import telling
from hough_tui.ui.widgets.experiment_form import ExperimentForm
from hough_tui.ui.widgets.rate_panel import RatePanel
from hough_tui.ui.widgets.run_form import RunForm, request_name, request_text, request_words
from hough_tui.ui.widgets.run_line import RunLine
from scenarios.model import ScenarioSet

LOOKS = 5
"""How often a second the progress is read."""


class Hint(Static, can_focus=True):
    """What stands in place of results; it takes the focus, so that the keys of the view work."""


class MonteCarloView(Widget):
    """Choose an experiment, run it, cancel it; the table and the chart fill meanwhile."""

    HELP = (
        "Runs an experiment of the set. Trials and seed are the experiment's own unless others are given for "
        "this run. The table fills while it runs; success is read against control, the same draws without "
        "the targets. Enter opens the trials behind a row, the failed ones first, and from there one trial "
        "in Look. s sorts by the next column, S the other way. The chart shows any metric (m) against the "
        "swept field, with its 95 % interval, or the ratio of false tracks by trial of the row under the "
        "cursor (t). C chooses which metrics and intervals the table shows. F9 shows the form of the "
        "experiment: what runs, what is swept, what counts. "
        "e exports a finished run, y copies the table. A finished run is kept: see Results."
    )
    DEFAULT_CSS = """
    MonteCarloView { layout: vertical; height: 1fr; background: $surface; }
    MonteCarloView Hint { height: 1fr; content-align: center middle; text-align: center; padding: 0 4;
        color: $text-muted; }
    MonteCarloView Hint:focus { color: $foreground; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("r", "run", "Run", id="monte-carlo.run", show=False),
        Binding("f9", "edit", "Form of the experiment, or rates", id="monte-carlo.form", show=False),
        Binding("x,escape", "cancel", "Cancel", id="monte-carlo.cancel"),
        Binding("w", "keep", "Keep the run", id="monte-carlo.keep"),
    ]

    class Progress(Message):
        """How far the run is, for the status line; None when nothing runs."""

        def __init__(self, text: str | None) -> None:
            super().__init__()
            self.text = text

    class Finished(Message):
        """A run is in the store, under a name."""

        def __init__(self, name: str) -> None:
            super().__init__()
            self.name = name

    class Happened(Message):
        """A run says what it does."""

        def __init__(self, running: Running, event: Event) -> None:
            super().__init__()
            self.running, self.event = running, event

    class Kept(Message):
        """A run that was not in the store is there now, or cannot be."""

        def __init__(self, name: str | None, problem: str | None) -> None:
            super().__init__()
            self.name, self.problem = name, problem

    def __init__(self) -> None:
        super().__init__()
        self._is_filled = self._is_editing = False
        self._given: ScenarioSet | None = None
        self._added = ""
        self._reason: str | None = None
        self._request: RunRequest | None = None
        self._current: Running | None = None
        self._live: LiveRun | None = None
        self._pace = Pace(0)
        self._result = ""
        self._unkept: LiveRun | None = None
        self._timer: Timer | None = None

    def compose(self) -> ComposeResult:
        """Lay out the request, how far it is, and the results."""
        yield RunForm()
        yield RunLine()
        yield Hint(markup=False)
        yield RatePanel()
        yield ExperimentForm()

    def on_mount(self) -> None:
        """Prepare to look at the progress of a run."""
        self._arrange()
        self._timer = self.set_interval(1 / LOOKS, self._look, pause=True)

    def on_unmount(self) -> None:
        """Leave nothing running."""
        self.stop_work()

    def _arrange(self) -> None:
        """Show the form, the rates or the hint."""
        # Not by classes of the view: all that stands in it would have its style worked out anew.
        self.query_one(ExperimentForm).display = self._is_editing
        self.query_one(RatePanel).display = self._is_filled and not self._is_editing
        self.query_one(Hint).display = not self._is_filled and not self._is_editing

    # What the application says

    def show_set(self, given: ScenarioSet) -> None:
        """Offer the experiments of the set as it is now; results stay."""
        self._given = given
        self.query_one(RunForm).show_set(given)
        if self._added in (experiment.name for experiment in given.experiments):
            self.query_one(RunForm).choose_name(self._added)
            self._added = ""
        self._show_form()
        self._tell_idle()

    def set_runnable(self, reason: str | None) -> None:
        """Take note of why nothing may run; None where all is well."""
        self._reason = reason
        self._tell_idle()

    def choose(self, index: int) -> None:
        """Choose an experiment by its place in the set."""
        self.query_one(RunForm).choose(index)

    def take_focus(self) -> None:
        """Put the focus where the keys of the view work."""
        if self._is_editing:
            self.query_one(ExperimentForm).take_focus()
        elif self._is_filled:
            self.query_one(RatePanel).take_focus()
        else:
            self.query_one(Hint).focus()

    def stop_work(self) -> None:
        """Stop the run and hear no more of it, since the view is taken down."""
        if self._current is not None:
            self._current.cancel(is_leaving=True)
            # What it still tells would find a view that is taken down in parts.
            self._current = None

    # Running

    @property
    def is_at_work(self) -> bool:
        """Whether a run is under way."""
        return self._current is not None

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Offer what can be done now."""
        if action == "cancel":
            return self.is_at_work
        return action != "keep" or (self._unkept is not None and not self.is_at_work)

    def action_run(self) -> None:
        """Run the experiment, unless something is wrong."""
        if self.is_at_work:
            return
        request = self._read()
        if isinstance(request, str):
            self.query_one(RunLine).tell(request, is_problem=True)
            self.app.bell()
            return

        def tell(event: Event) -> None:
            self.post_message(self.Happened(running, event))

        running = Running(request, tell)
        self._request, self._unkept, self._result, self._current = request, None, "", running
        self._pace = Pace(0)
        self.query_one(RunForm).show_running(True)
        self._show_running("preparing")
        self.refresh_bindings()
        self._work(running)

    @work(thread=True, exclusive=True, exit_on_error=False, group="monte-carlo")
    def _work(self, running: Running) -> None:
        running.work()

    def action_cancel(self) -> None:
        """Stop the run; what it has found stays."""
        if self._current is not None:
            self._current.cancel()
            self._show_running("cancelling")

    @on(RunForm.Go)
    def _go(self) -> None:
        if self.is_at_work:
            self.action_cancel()
        else:
            self.action_run()
        self.take_focus()

    @on(Happened)
    def _take(self, message: Happened) -> None:
        message.stop()
        if message.running is not self._current:
            return
        match message.event:
            case Started(live):
                self._start(live)
            case Filled(rows):
                self.query_one(RatePanel).fill(rows)
            case Ended() as ended:
                self._end(ended)

    def _start(self, live: LiveRun) -> None:
        self._live, self._pace = live, Pace(live.job.plan.trials)
        is_focused = bool(self.query("Hint:focus, ExperimentForm:focus-within"))
        # And no form any more: whoever runs wants to see the rates.
        self._is_filled, self._is_editing = True, False
        self._arrange()
        self.query_one(RatePanel).show(live)
        if is_focused:
            self.call_after_refresh(self.take_focus)
        if self._timer is not None:
            self._timer.resume()

    def _look(self) -> None:
        if self._live is None or self._current is None:
            return
        progress = self._live.job.progress
        self._pace.look(time.monotonic(), int(progress.done.sum()))
        self._show_running(self._pace.words(progress.cells_done, len(progress.done)))

    def _end(self, ended: Ended) -> None:
        self._current = None
        if self._timer is not None:
            self._timer.pause()
        self.query_one(RunForm).show_running(False)
        if self._live is not None and ended.rows:
            self.query_one(RatePanel).fill(ended.rows)
            done = sum(row["trials"] for row in ended.rows)
            speed = f" · {done / ended.seconds:,.0f}/s" if ended.seconds > 0.0 and done else ""
            if ended.is_complete:
                self._result = f"{done:,} trials in {duration(ended.seconds)}{speed}"
            else:
                self._result = f"cancelled after {done:,} of {self._pace.total:,} trials{speed}"
            if ended.kept_as is None:
                self._unkept = self._live if done else None
            else:
                self._result += f" · kept as {ended.kept_as}"
                self.post_message(self.Finished(ended.kept_as))
        elif ended.problem is None:
            self._result = "cancelled before the first trial"
        self.post_message(self.Progress(None))
        self._tell_idle()
        self.refresh_bindings()
        if ended.problem is not None:
            self.app.push_screen(telling("The run did not come to a good end", ended.problem))

    def action_keep(self) -> None:
        """Keep a run that was cancelled, or could not be kept."""
        if self._unkept is not None:
            self._keep(self._unkept)

    @work(thread=True, exclusive=True, exit_on_error=False, group="keep")
    def _keep(self, live: LiveRun) -> None:
        self.post_message(self.Kept(*keep(live)))

    @on(Kept)
    def _tell_kept(self, event: Kept) -> None:
        if event.name is None:
            self.app.push_screen(telling("The run is not kept", event.problem or ""))
            return
        self._unkept = None
        self._result = f"{self._result.partition(' · ')[0]} · kept as {event.name}"
        self._tell_idle()
        self.refresh_bindings()
        self.post_message(self.Finished(event.name))

    # What is asked

    def action_edit(self) -> None:
        """Show the form of the experiment in place of the rates, or the rates again."""
        self._is_editing = not self._is_editing
        self._arrange()
        self.take_focus()

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken."""
        self.query_one(ExperimentForm).refuse(found)

    def _show_form(self) -> None:
        if self._given is not None:
            chosen = self.query_one(RunForm).experiments
            self.query_one(ExperimentForm).show(self._given, chosen[0] if chosen else None)

    @on(ExperimentForm.Added)
    def _choose_added(self, event: ExperimentForm.Added) -> None:
        event.stop()
        self._added = event.name  # the set that has it is yet to come

    @on(RunForm.Changed)
    def _request_changed(self) -> None:
        self._show_form()
        self._tell_idle()

    def _read(self) -> RunRequest | str:
        """Return what is to run, or why nothing can."""
        return f"a field is wrong: {self._reason}" if self._reason else self.query_one(RunForm).read()

    def _show_running(self, words: str) -> None:
        is_begun = self._live is not None and self._live.job.plan.trials == self._pace.total
        self.query_one(RunLine).tell(words, self._pace.done / self._pace.total if is_begun else 0.0)
        self.post_message(
            self.Progress(f"{request_name(self._request)}: {words}" if self._request else words)
        )

    def _tell_idle(self) -> None:
        """Say what would run, or what ran."""
        if self.is_at_work:
            return
        request, line = self._read(), self.query_one(RunLine)
        if isinstance(request, str):
            line.tell(request, is_problem=True)
            self.query_one(Hint).update(request)
            return
        self.query_one(Hint).update(request_text(request))
        result, is_stale = (
            self._result,
            self._request is not None and self._request.scenario_set != request.scenario_set,
        )
        if result and is_stale:
            what, *others = result.split(BETWEEN)
            result = BETWEEN.join((what, "the set has changed since", *others))
        line.tell(result or f"{request_words(request)}{BETWEEN}r runs it")
