"""A field for a whole number that goes before the one of the experiment, for one run."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.widgets import Input

from algorithms.parameters import FieldError, replaced
from hough_tui.ui.forms.fields import described
from hough_tui.ui.forms.numbers import Sort, Unreadable, Wanted, read
from scenarios.model import Experiment

WHOLE = Wanted(Sort.WHOLE, optional=True)


class RunField(Input):
    """Text that is read as a whole number; empty leaves the experiment's own.

    Parameters
    ----------
    field : name of the field of an experiment
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f9", "explain_field", "Explain the field", id="run-field.explain", show=False),
    ]

    def __init__(self, field: str) -> None:
        super().__init__(id=f"run-{field}", compact=True, select_on_focus=True)
        self.field = field

    def read(self, experiments: list[Experiment]) -> tuple[int | None, str | None]:
        """Return the number, or None for the experiments' own; and what is wrong, if anything is."""
        found = read(self.value, WHOLE)
        if isinstance(found, Unreadable):
            return None, f"{self.field}: {found.message}"
        if not isinstance(found, int):
            return None, None
        try:
            for experiment in experiments:
                replaced(experiment, (self.field,), found)
        except FieldError as error:
            return None, str(error)
        return found, None

    def action_explain_field(self) -> None:
        """Say what the field is, and what it takes."""
        (field,) = (known for known in described(Experiment) if known.path == (self.field,))
        text = f"{field.help}. A {field.bounds or 'whole number'}; empty: as the experiment has it."
        self.notify(text, title=field.label, markup=False)

    async def _on_key(self, event: events.Key) -> None:
        if event.character == "?":  # no number has one
            event.stop()
            event.prevent_default()
            self.action_explain_field()
            return
        await super()._on_key(event)
