"""A field for a whole number that goes before the one of the experiment, for one run."""

from __future__ import annotations

from algorithms.parameters import FieldError, replaced
from hough_tui.ui.forms.controls import NumberInput
from hough_tui.ui.forms.fields import described
from hough_tui.ui.forms.numbers import Unreadable, Wanted, read
from scenarios.experiments import Experiment

WHOLE = Wanted(whole=True, optional=True)


class RunField(NumberInput):
    """Text that is read as a whole number; empty leaves the experiment's own.

    Parameters
    ----------
    field : name of the field of an experiment
    """

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
                replaced(experiment, {(self.field,): found})
        except FieldError as error:
            return None, str(error)
        return found, None

    def action_explain(self) -> None:
        """Say what the field is, and what it takes."""
        (field,) = (known for known in described(Experiment) if known.path == (self.field,))
        text = f"{field.help}: {field.bounds or 'a whole number'}. Empty: as the experiment has it."
        self.notify(text, title=field.label, markup=False)
