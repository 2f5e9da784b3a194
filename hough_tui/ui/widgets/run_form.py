"""What is to run: the experiment, and the trials and the seed for this run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Button, Input, Select, Static

from hough_tui.reports.field_names import field_name
from hough_tui.reports.numerals import as_given
from hough_tui.ui.runs.run_controller import RunRequest
from hough_tui.ui.widgets.run_field import RunField
from scenarios.experiments import Experiment
from scenarios.model import ScenarioSet

ALL = ""
"""Stands for all experiments: none can have an empty name."""


class RunForm(Horizontal):
    """One line: experiment, trials, seed, and a button to run."""

    DEFAULT_CSS = """
    RunForm { height: 1; padding: 0 1; }
    RunForm Static { width: auto; color: $text-muted; padding-right: 1; }
    RunForm Select { width: 1fr; min-width: 16; max-width: 44; margin-right: 2; }
    RunForm RunField { width: 11; margin-right: 2; background: $boost; }
    RunForm RunField:focus { background: $primary 20%; }
    RunForm Button { min-width: 10; width: 10; }
    """
    LABELS: ClassVar[dict[str, str]] = {"trials": "Trials", "seed": "Seed"}

    class Changed(Message):
        """Something else is asked for."""

    class Go(Message):
        """It is to run, or to stop."""

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None

    def compose(self) -> ComposeResult:
        """Lay out the fields."""
        yield Static("Experiment", markup=False)
        yield Select[str]([], id="experiment", compact=True, prompt="none")
        for field, label in self.LABELS.items():
            yield Static(label, markup=False)
            yield RunField(field)
        yield Button("Run", id="go", compact=True, variant="primary")

    def show_set(self, given: ScenarioSet) -> None:
        """Offer the experiments of the set as it is now."""
        before = [experiment.name for experiment in self.experiments_of_set]
        is_first, self._given = self._given is None, given
        names = [experiment.name for experiment in given.experiments]
        if is_first or names != before:
            values = names if len(names) < 2 else [*names, ALL]
            select = self.query_one(Select)
            chosen = select.value
            if chosen in before and len(names) == len(before):
                chosen = names[before.index(chosen)]  # one that was renamed stays chosen
            with self.prevent(Select.Changed):
                select.set_options([(name or f"all {len(names)} experiments", name) for name in values])
                if values:
                    select.value = chosen if chosen in values else values[0]
        self.show_own()

    def show_own(self) -> None:
        """Show in the empty fields what the experiment has itself."""
        chosen = self.experiments
        for field in self.query(RunField):
            values = {getattr(experiment, field.field) for experiment in chosen}
            field.placeholder = str(values.pop()) if len(values) == 1 else "as set"

    def show_running(self, is_busy: bool) -> None:
        """Let the button stop the run, or start one."""
        self.query_one(Button).label = "Cancel" if is_busy else "Run"

    def choose(self, index: int) -> None:
        """Choose an experiment by its place in the set."""
        if self._given is not None and index < len(self._given.experiments):
            self.choose_name(self._given.experiments[index].name)

    def choose_name(self, name: str) -> None:
        """Choose an experiment by its name, if the set has it."""
        if any(experiment.name == name for experiment in self.experiments_of_set):
            self.query_one(Select).value = name

    @property
    def experiments_of_set(self) -> Sequence[Experiment]:
        """All experiments of the set."""
        return self._given.experiments if self._given is not None else ()

    @property
    def experiments(self) -> list[Experiment]:
        """The experiments that are chosen."""
        name = self.query_one(Select).value
        return [experiment for experiment in self.experiments_of_set if name in (ALL, experiment.name)]

    def read(self) -> RunRequest | str:
        """Return what is asked for, or what is wrong."""
        chosen = self.experiments
        if self._given is None or not chosen:
            return "the set has no experiments, so there is nothing to run"
        given: dict[str, int | None] = {}
        for field in self.query(RunField):
            given[field.field], problem = field.read(chosen)
            if problem is not None:
                return problem
        return RunRequest(self._given, tuple(experiment.name for experiment in chosen), **given)

    @on(Select.Changed)
    @on(Input.Changed)
    def _edited(self, event: Message) -> None:
        event.stop()
        self.show_own()
        self.post_message(self.Changed())

    @on(Input.Submitted)
    @on(Button.Pressed)
    def _asked(self, event: Message) -> None:
        event.stop()
        self.post_message(self.Go())


def request_words(request: RunRequest) -> str:
    """Return how much is asked for."""
    chosen = [
        experiment
        for experiment in request.scenario_set.experiments
        if experiment.name in request.experiments
    ]
    cells = [
        math.prod(len(request.scenario_set.chosen(experiment, part)) for part in experiment.parts)
        * math.prod(map(len, experiment.sweep.values()))
        for experiment in chosen
    ]
    trials = sum(
        count * (request.trials or experiment.trials) for count, experiment in zip(cells, chosen, strict=True)
    )
    return f"{request_name(request)}: {sum(cells):,} cell{'s' * (sum(cells) != 1)}, {trials:,} trials"


def request_text(request: RunRequest) -> str:
    """Return what would run, in a few lines."""
    lines = []
    for experiment in request.scenario_set.experiments:
        if experiment.name not in request.experiments:
            continue
        entries, *_, worlds = (
            ", ".join(element.name for element in request.scenario_set.chosen(experiment, part))
            for part in reversed(experiment.parts)
        )
        swept = "".join(
            f" · {field_name(key)} {', '.join(map(as_given, values))}"
            for key, values in experiment.sweep.items()
        )
        lines += [experiment.name, experiment.description, f"{entries} on {worlds}{swept}", ""]
    return "\n".join([*lines, request_words(request), "", "r runs it"])


def request_name(request: RunRequest) -> str:
    """Return what it is called."""
    names = request.experiments
    return names[0] if len(names) == 1 else f"{len(names)} experiments"
