"""Initiator: which initiators the set has, the parameters of each, and what its quantisation leads to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Vertical
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from algorithms.errors import RequestError, WorkFailedError
from algorithms.initiators.accumulating import AccumulatingParameters
from algorithms.initiators.registry import initiators
from algorithms.parameters import Problem
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementAdded, ElementRemoved, FieldEdited
from hough_tui.ui.naming import free_name
from hough_tui.ui.screens.choose_one import Choice
from hough_tui.ui.widgets.prediction_density import PredictionDensity
from hough_tui.ui.widgets.prediction_panel import PredictionPanel
from scenarios.entries import InitiatorEntry
from scenarios.files.set_files import set_data
from scenarios.model import Scenario, ScenarioSet
from scenarios.selection import ignores_z, why_not_in_plane

WIDE, MEDIUM = 118, 88
"""Columns from which list, form and prediction stand side by side, and from which the prediction stands
beneath the list."""

TALL = 26
"""Rows from which the prediction has room beneath the list."""


class InitiatorView(Widget):
    """The set's initiators, the form of the chosen one, and what is predicted of its quantisation."""

    HELP = (
        "The initiators of the set. The list chooses one; its form holds its parameters and its "
        "quantisation. A parameter that is `auto` shows what it is worked out to for the scenario that the "
        "prediction names, the first that it runs on; F10 takes the next one. In the list, a adds an "
        "initiator, c copies the chosen one and d removes it.\n\n"
        "The prediction follows every edit of an initiator that accumulates votes: how the votes of one "
        "target lie about its peak, with the edges of the bins of ρ and the home cell filled in (n takes the "
        "next target), and what the quantisation leads to, beside what is recommended for a bound on the "
        "expected number of false cells. P_D is that of the home cell, the one that the target's line lies "
        "in; the time is an estimate from what a vote costs on this machine. Ctrl+T, or t outside of a "
        "field, takes the recommendation: Δθ, Δρ, the range of ρ and the threshold, as one edit, which "
        "Ctrl+Z takes back. F9 goes from the form to the prediction; Look shows at once what a change does "
        "to the accumulator."
    )
    DEFAULT_CSS = """
    InitiatorView { layout: vertical; height: 1fr; }
    InitiatorView #initiator-parts { layout: grid; height: 1fr; }
    InitiatorView #initiator-parts { grid-size: 3 1; grid-columns: 24 1fr 46; grid-rows: 1fr; }
    InitiatorView OptionList { width: 100%; height: 100%; border: none; border-right: solid $panel; }
    InitiatorView OptionList:focus { border: none; border-right: solid $border; }
    InitiatorView #initiator-form { width: 100%; height: 100%; }
    InitiatorView PredictionPanel { width: 100%; height: 100%; border-left: solid $panel; }
    InitiatorView .caption { height: auto; max-height: 3; color: $text-muted; padding: 0 1; }
    InitiatorView.without-prediction PredictionPanel { display: none; }
    InitiatorView.without-prediction #initiator-parts { grid-size: 2 1; grid-columns: 26 1fr; }
    InitiatorView.medium #initiator-parts {
        grid-size: 2 2; grid-columns: 41 1fr; grid-rows: auto 1fr;
    }
    InitiatorView.medium OptionList { height: auto; max-height: 10; }
    InitiatorView.medium #initiator-form { row-span: 2; }
    InitiatorView.medium PredictionPanel {
        border-left: none; border-right: solid $panel; border-top: solid $panel;
    }
    InitiatorView.medium.without-prediction OptionList { row-span: 2; height: 100%; max-height: 100%; }
    InitiatorView.narrow #initiator-parts { grid-size: 2 1; grid-columns: 26 1fr; }
    InitiatorView.narrow PredictionPanel { border-left: none; }
    InitiatorView.narrow.form PredictionPanel { display: none; }
    InitiatorView.narrow.prediction #initiator-form { display: none; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("a", "add", "Add an initiator", id="initiator.add", show=False),
        Binding("c", "copy", "Copy the initiator", id="initiator.copy", show=False),
        Binding("d,delete", "remove", "Remove the initiator", id="initiator.remove", show=False),
        Binding("j", "move(1)", "Next initiator", id="initiator.next", show=False),
        Binding("k", "move(-1)", "Previous initiator", id="initiator.previous", show=False),
        # A letter would be typed where a field has the focus; the other key works there, too.
        Binding("ctrl+t,t", "take", "Take the recommendation", id="initiator.take", show=False),
        Binding("f9", "next_panel", "Form or prediction", id="initiator.panel", show=False),
        Binding("f10", "next_scenario", "Next scenario", id="initiator.next-scenario", show=False),
    ]

    panel: reactive[str] = reactive("form")

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._index = 0
        self._scenario: str | None = None
        self._names: list[tuple[str, str]] = []

    def compose(self) -> ComposeResult:
        """Lay out the list, the form and the prediction."""
        with Container(id="initiator-parts"):
            yield OptionList()
            with Vertical(id="initiator-form"):
                yield Static("", classes="caption", markup=False)
                yield ModelForm()
            yield PredictionPanel()

    # Which of the parts are seen

    def on_mount(self) -> None:
        """Show the form first where there is room for one of the two only."""
        self._arrange()

    def on_resize(self) -> None:
        """Put as much side by side as there is room for."""
        self._arrange()

    def on_hide(self) -> None:
        """Let the view that is seen instead have the processor."""
        self.query_one(PredictionPanel).pause()

    def on_show(self) -> None:
        """Go on with what was held back."""
        self.query_one(PredictionPanel).resume()

    def watch_panel(self) -> None:
        """Show the form or the prediction where there is room for one only."""
        self._arrange()

    def _arrange(self) -> None:
        width, height = self.size
        is_medium = MEDIUM <= width < WIDE and height >= TALL
        self.set_class(is_medium, "medium")
        self.set_class(width < WIDE and not is_medium, "narrow")
        # Where nothing is predicted there is the form alone.
        shown = "form" if self.has_class("without-prediction") else self.panel
        for name in ("form", "prediction"):
            self.set_class(shown == name, name)

    def action_next_panel(self) -> None:
        """Go from the form to the prediction, or back."""
        if self.has_class("without-prediction"):
            self.notify("This initiator accumulates no votes: nothing is predicted of it", markup=False)
            return
        self.panel = "prediction" if self.panel == "form" else "form"
        if self.panel == "prediction":
            self.query_one(PredictionDensity).focus()
        else:
            self.query_one(ModelForm).focus_first()

    # What is shown

    def show_set(self, given: ScenarioSet) -> None:
        """Show the set as it is now."""
        self._given = given
        self._index = max(0, min(self._index, len(given.initiators) - 1))
        self._list()
        caption, form = self.query_one(".caption", Static), self.query_one(ModelForm)
        form.display = bool(given.initiators)
        if not given.initiators:
            caption.update("The set has no initiators; press a in the list to add one.")
            self._predict(None)
            return
        entry = given.initiators[self._index]
        scenario = self._scenario_of(entry)
        summary = f"{entry.initiator}: {entry.algorithm.summary} ({entry.algorithm.source})"
        if scenario is None:
            caption.update(summary)
            form.load(entry, ("initiators", self._index))
            self._predict(None)
            return
        refusal = why_not_in_plane(entry, scenario)
        if ignores_z(entry, scenario):
            summary = f"Works in the plane: z of {scenario.name} is ignored. {summary}"
        caption.update(refusal or summary)
        resolved: Any = None
        try:
            resolved = entry.parameters.resolved(scenario.context)
        except (RequestError, WorkFailedError) as error:
            caption.update(str(error))
        form.load(entry, ("initiators", self._index), unit=scenario.unit, resolved=resolved)
        self._predict(entry)

    def _predict(self, entry: InitiatorEntry | None) -> None:
        """Have the quantisation of an entry judged, where it has one."""
        accumulates = entry is not None and isinstance(entry.parameters, AccumulatingParameters)
        self.set_class(not accumulates, "without-prediction")
        self._arrange()
        scenario = self._scenario_of(entry) if entry is not None and accumulates else None
        if entry is not None and scenario is not None:
            others = len(self._scenarios_of(entry)) - 1
            self.query_one(PredictionPanel).ask(entry, scenario, others)

    def _scenarios_of(self, entry: InitiatorEntry) -> list[Scenario]:
        """Return the scenarios that experiments run the entry on, or else all that the set has."""
        assert self._given is not None
        found = {
            scenario.name: scenario
            for experiment in self._given.experiments
            if entry in self._given.chosen_entries(experiment)
            for scenario in self._given.chosen_scenarios(experiment)
        }
        return list(found.values()) or list(self._given.scenarios)

    def _scenario_of(self, entry: InitiatorEntry) -> Scenario | None:
        """Return the scenario that was chosen for a look, where the entry runs on it, or else its first."""
        found = self._scenarios_of(entry)
        first = found[0] if found else None
        return next((scenario for scenario in found if scenario.name == self._scenario), first)

    def action_next_scenario(self) -> None:
        """Predict for the next scenario that the initiator runs on."""
        if self._given is None or not self._given.initiators:
            return
        entry = self._given.initiators[self._index]
        found, now = self._scenarios_of(entry), self._scenario_of(entry)
        if now is None or len(found) < 2:
            only = "no scenario" if now is None else f"{now.name} only"
            self.notify(f"{entry.name} runs on {only}", markup=False)
            return
        self._scenario = found[(found.index(now) + 1) % len(found)].name
        self.show_set(self._given)

    def action_take(self) -> None:
        """Write the recommendation into the initiator, as one edit."""
        if self._given is None or not self._given.initiators or self.has_class("without-prediction"):
            return
        advice = self.query_one(PredictionPanel).advice
        if advice is None or isinstance(advice, str):
            self.notify(
                "The recommendation is not ready yet"
                if advice is None
                else f"Nothing is recommended: {advice}",
                markup=False,
            )
            return
        from hough_tui.quantisation.apply_advice import adopt

        entry = self._given.initiators[self._index]
        adoption = adopt(self._given, advice, [entry.name])
        if adoption.changed == self._given:
            self.notify(f"{entry.name} has what is recommended already", markup=False)
            return
        at = ("initiators", self._index)
        self.post_message(FieldEdited(at, set_data(adoption.changed)["initiators"][self._index]))
        # No word of the edit itself: form and figures show it, and it would cover them.
        for note in adoption.notes:
            self.notify(f"Note: {note}", markup=False)

    def _list(self) -> None:
        assert self._given is not None
        names = [(entry.name, entry.initiator) for entry in self._given.initiators]
        options = self.query_one(OptionList)
        if names != self._names:
            self._names = names
            options.clear_options()
            for name, algorithm in names:
                text = Text(name, style="bold")
                if algorithm != name:
                    text.append(f"\n  {algorithm}", style="dim")
                options.add_option(Option(text))
        if names and options.highlighted != self._index:
            options.highlighted = self._index

    def choose(self, index: int) -> None:
        """Show another initiator of the set."""
        self._index = index
        if self._given is not None:
            self.show_set(self._given)

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken."""
        self.query_one(ModelForm).problems(found)

    def take_focus(self) -> None:
        """Put the focus on the list."""
        self.query_one(OptionList).focus()

    @on(OptionList.OptionHighlighted)
    def _highlighted(self, event: OptionList.OptionHighlighted) -> None:
        event.stop()
        # What was told before the list moved on is stale: two such would chase each other for ever.
        is_stale = event.option_index != event.option_list.highlighted
        if self._given is not None and event.option_index != self._index and not is_stale:
            self.choose(event.option_index)

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        if self._given is not None and self._given.initiators:
            self.query_one(ModelForm).focus_first()

    def action_move(self, step: int) -> None:
        """Move the choice in the list."""
        options = self.query_one(OptionList)
        if options.has_focus:
            (options.action_cursor_down if step > 0 else options.action_cursor_up)()

    def action_add(self) -> None:
        """Choose an algorithm and add it to the set."""
        known = {name: f"{name}: {algorithm.summary}" for name, algorithm in initiators().items()}
        self.app.push_screen(Choice("Add an initiator", known), self._add)

    def _add(self, name: str | None) -> None:
        if name is not None:
            self._insert({"initiator": name}, name)

    def action_copy(self) -> None:
        """Add a copy of the chosen initiator."""
        if self._given is not None and self._given.initiators:
            entry = self._given.initiators[self._index]
            self._insert(entry.model_dump(mode="json", exclude_unset=True), entry.name)

    def _insert(self, data: dict[str, Any], name: str) -> None:
        assert self._given is not None
        taken = {entry.name for entry in self._given.initiators}
        free = free_name(name, taken)
        algorithm = data.get("initiator", name)
        at = len(self._given.initiators)
        self._index = at
        self.post_message(ElementAdded(("initiators", at), {**data, "name": free, "initiator": algorithm}))

    def action_remove(self) -> None:
        """Take the chosen initiator out of the set."""
        if self._given is not None and self._given.initiators:
            self.post_message(ElementRemoved(("initiators", self._index)))
