"""A field for the bound on the expected number of false cells, within which is recommended."""

from __future__ import annotations

from hough_tui.ui.forms.controls import NumberInput
from hough_tui.ui.forms.numbers import ONE_NUMBER, Unreadable, number_text, read

DEFAULT_BOUND = 1.0


class FalseCellField(NumberInput):
    """Text that is read as a number greater than 0."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(number_text(DEFAULT_BOUND), id=id, compact=True, select_on_focus=True)
        # A cursor that blinks would write to the terminal for ever, also where that is far away.
        self.cursor_blink = False

    def read(self) -> float | str:
        """Return the number, or what is wrong."""
        found = read(self.value, ONE_NUMBER)
        if isinstance(found, Unreadable):
            return found.message
        assert isinstance(found, float | int)
        return float(found) if found > 0 else f"{self.value.strip()} is given; it must be greater than 0"

    def action_explain(self) -> None:
        """Say what the field is, and what it takes."""
        self.notify(
            "the expected number of cells a batch that clutter alone may lift to the threshold: what is "
            "recommended finds the most targets within it. A number greater than 0.",
            title="False cells",
            markup=False,
        )
