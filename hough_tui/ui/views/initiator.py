"""Initiator: which initiators the set has, and the parameters of each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.widget import Widget
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from algorithms.errors import RequestError
from algorithms.initiators.registry import initiators
from algorithms.parameters import Problem
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementAdded, ElementRemoved
from hough_tui.ui.naming import free_name
from hough_tui.ui.screens.choice import Choice
from scenarios.model import InitiatorEntry, Scenario, ScenarioSet


class InitiatorView(Widget):
    """The set's initiators, and the form of the chosen one."""

    HELP = (
        "The initiators of the set. The list at the left chooses one; its form holds its parameters and "
        "its quantisation. A parameter that is `auto` shows what it is worked out to for the first scenario "
        "that it runs on. In the list, a adds an initiator, c copies the chosen one and d removes it. Look "
        "shows at once what a change does to the accumulator."
    )
    DEFAULT_CSS = """
    InitiatorView { layout: vertical; height: 1fr; }
    InitiatorView #initiator-parts { height: 1fr; }
    InitiatorView OptionList { width: 26; height: 1fr; border: none; border-right: solid $panel; }
    InitiatorView #initiator-form { width: 1fr; height: 1fr; }
    InitiatorView .caption { height: auto; max-height: 3; color: $text-muted; padding: 0 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("a", "add", "Add an initiator", id="initiator.add", show=False),
        Binding("c", "copy", "Copy the initiator", id="initiator.copy", show=False),
        Binding("d,delete", "remove", "Remove the initiator", id="initiator.remove", show=False),
        Binding("j", "move(1)", "Next initiator", id="initiator.next", show=False),
        Binding("k", "move(-1)", "Previous initiator", id="initiator.previous", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._index = 0
        self._names: list[tuple[str, str]] = []

    def compose(self) -> ComposeResult:
        """Lay out the list beside the form."""
        with Horizontal(id="initiator-parts"):
            yield OptionList()
            with Vertical(id="initiator-form"):
                yield Static("", classes="caption", markup=False)
                yield ModelForm()

    def show_set(self, given: ScenarioSet) -> None:
        """Show the set as it is now."""
        self._given = given
        self._index = max(0, min(self._index, len(given.initiators) - 1))
        self._list()
        caption, form = self.query_one(".caption", Static), self.query_one(ModelForm)
        form.display = bool(given.initiators)
        if not given.initiators:
            caption.update("The set has no initiators; press a in the list to add one.")
            return
        entry, scenario = given.initiators[self._index], self._scenario_of(given.initiators[self._index])
        caption.update(f"{entry.initiator}: {entry.algorithm.summary} ({entry.algorithm.source})")
        resolved: Any = None
        try:
            resolved = entry.parameters.resolved(scenario.context)
        except RequestError as error:
            caption.update(str(error))
        form.load(entry, ("initiators", self._index), unit=scenario.unit, resolved=resolved)

    def _scenario_of(self, entry: InitiatorEntry) -> Scenario:
        """Return the first scenario that an experiment runs the entry on, or else the set's first."""
        assert self._given is not None
        for experiment in self._given.experiments:
            if entry in self._given.chosen_entries(experiment):
                return self._given.chosen_scenarios(experiment)[0]
        return self._given.scenarios[0]

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
