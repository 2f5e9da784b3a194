"""The form of an experiment: what runs on what, what is swept, and what counts as success."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Button

from algorithms.parameters import Problem
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementAdded, ElementRemoved
from hough_tui.ui.naming import free_name
from hough_tui.ui.screens.choice import Choice
from hough_tui.ui.widgets.caption import Caption
from scenarios.experiments import Experiment
from scenarios.model import ScenarioSet

LEAST_PLOTS = 3
"""Plots of a target that a track must hold by the criterion of a new experiment."""

KINDS = {
    "initiation": "initiation: initiators on scenarios, how often they find targets",
    "clustering": "clustering: clusterings on scenes, how often they count the targets right",
}
"""The kinds of experiment."""


class ExperimentForm(Vertical):
    """One experiment of the set, to be edited; others are added and removed here too."""

    DEFAULT_CSS = """
    ExperimentForm { height: 1fr; }
    ExperimentForm Horizontal { height: 1; padding: 0 1; }
    ExperimentForm Caption { padding: 0; }
    ExperimentForm Button { min-width: 8; margin-left: 1; }
    """
    ACTIONS: ClassVar[dict[str, str]] = {"add": "New", "copy": "Copy", "remove": "Remove"}

    class Added(Message):
        """An experiment was added, under a name."""

        def __init__(self, name: str) -> None:
            super().__init__()
            self.name = name

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._index = 0

    def compose(self) -> ComposeResult:
        """Lay out what can be done to the list above the form."""
        with Horizontal():
            yield Caption()
            for action, label in self.ACTIONS.items():
                yield Button(label, id=action, compact=True)
        yield ModelForm()

    def show(self, given: ScenarioSet, chosen: Experiment | None) -> None:
        """Show an experiment of the set; None where it has none."""
        self._given = given
        form = self.query_one(ModelForm)
        form.display = chosen is not None
        for action in ("copy", "remove"):
            self.query_one(f"#{action}", Button).disabled = chosen is None
        if chosen is None:
            self.query_one(Caption).tell("The set has no experiment")
        else:
            self.query_one(Caption).tell(Part("Names as in the tree", 1), "a sweep: scans: 5, 10, 15")
        if chosen is not None:
            self._index = given.experiments.index(chosen)
            scenarios = given.chosen_scenarios(chosen)
            unit = scenarios[0].unit if scenarios else None
            form.load(chosen, ("experiments", self._index), unit=unit)

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken."""
        self.query_one(ModelForm).problems(found)

    def take_focus(self) -> None:
        """Put the focus where one can go on at once."""
        if self._given is not None and self._given.experiments:
            self.query_one(ModelForm).focus_first()
        else:
            self.query_one("#add", Button).focus()

    @on(Button.Pressed)
    def _pressed(self, event: Button.Pressed) -> None:
        event.stop()
        if self._given is None:
            return
        if event.button.id == "remove":
            self.post_message(ElementRemoved(("experiments", self._index)))
        elif event.button.id == "copy":
            before = self._given.experiments[self._index]
            self._add(before.model_dump(mode="json", exclude_unset=True))
        elif self._given.scenes and self._given.scenarios:
            self.app.push_screen(Choice("Add an experiment", KINDS), self._add_kind)
        else:
            self._add_kind("clustering" if self._given.scenes else "initiation")

    def _add_kind(self, kind: str | None) -> None:
        if kind == "initiation":
            self._add({"name": "experiment", "criterion": {"plots": LEAST_PLOTS}})
        elif kind is not None:
            self._add({"name": "experiment", "kind": kind})

    def _add(self, data: dict[str, Any]) -> None:
        assert self._given is not None
        name = free_name(data["name"], [experiment.name for experiment in self._given.experiments])
        self.post_message(ElementAdded(("experiments", len(self._given.experiments)), {**data, "name": name}))
        self.post_message(self.Added(name))
