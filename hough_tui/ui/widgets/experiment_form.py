"""The form of an experiment: what runs on what, what is swept, and what counts as success."""

from __future__ import annotations

from typing import Any

from textual import on
from textual.message import Message
from textual.widgets import Button

from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementAdded, ElementRemoved
from hough_tui.ui.naming import free_name
from hough_tui.ui.screens.choose_one import Choice
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.element_form import ElementForm
from scenarios.experiments import Experiment
from scenarios.model import ScenarioSet

LEAST_PLOTS = 3
"""Plots of a target that a track must hold by the criterion of a new experiment."""

KINDS = {
    "initiation": "initiation: initiators on scenarios, how often they find targets",
    "clustering": "clustering: clusterings on scenes, how often they count the targets right",
}
"""The kinds of experiment."""


class ExperimentForm(ElementForm):
    """One experiment of the set, to be edited; others are added and removed here too."""

    class Added(Message):
        """An experiment was added, under a name."""

        def __init__(self, name: str) -> None:
            super().__init__()
            self.name = name

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._index = 0

    def show(self, given: ScenarioSet, chosen: Experiment | None) -> None:
        """Show an experiment of the set; None where it has none."""
        self._given = given
        self.show_whether_any(chosen is not None)
        if chosen is None:
            self.query_one(Caption).tell("The set has no experiment")
            return
        self.query_one(Caption).tell(Part("Names as in the tree", 1), "a sweep: scans: 5, 10, 15")
        self._index = list[Experiment](given.experiments).index(chosen)
        scenarios = given.chosen_scenarios(chosen)
        unit = scenarios[0].unit if scenarios else None
        self.query_one(ModelForm).load(chosen, ("experiments", self._index), unit=unit)

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
