"""The form of one element of a list of the set, below what can be done to the list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.widgets import Button

from algorithms.parameters import Problem
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.widgets.caption import Caption


class ElementForm(Vertical):
    """A form with a caption and buttons above it; its subclasses say of what, and what the buttons do."""

    DEFAULT_CSS = """
    ElementForm { height: 1fr; }
    ElementForm Horizontal { height: 1; padding: 0 1; }
    ElementForm Caption { padding: 0; }
    ElementForm Button { min-width: 8; margin-left: 1; }
    """
    ACTIONS: ClassVar[dict[str, str]] = {"add": "New", "copy": "Copy", "remove": "Remove"}

    def compose(self) -> ComposeResult:
        """Lay out what can be done to the list above the form."""
        with Horizontal():
            yield Caption()
            for action, label in self.ACTIONS.items():
                yield Button(label, id=action, compact=True)
        yield ModelForm()

    def show_whether_any(self, is_any: bool) -> None:
        """Offer the form, and what is done to its element, where there is an element."""
        self.query_one(ModelForm).display = is_any
        for action in ("copy", "remove"):
            self.query_one(f"#{action}", Button).disabled = not is_any

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken."""
        self.query_one(ModelForm).problems(found)

    def take_focus(self) -> None:
        """Put the focus where one can go on at once."""
        form = self.query_one(ModelForm)
        if form.display:
            form.focus_first()
        else:
            self.query_one("#add", Button).focus()
