"""The form of one element of a list of the set, with what can be done to the list above it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from pydantic import BaseModel
from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Button

from algorithms.parameters import Problem
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementRemoved
from hough_tui.ui.widgets.caption import Caption


class EntryForm(Vertical):
    """One element of a list of the set, to be edited; others are added and removed here too.

    Parameters
    ----------
    part : the list
    what : what an element of it is called
    """

    DEFAULT_CSS = """
    EntryForm { height: 1fr; }
    EntryForm Horizontal { height: 1; padding: 0 1; }
    EntryForm Caption { padding: 0; }
    EntryForm Button { min-width: 5; margin-left: 1; }
    """
    ACTIONS: ClassVar[dict[str, str]] = {"add": "New", "copy": "Copy", "remove": "Remove"}

    class Wanted(Message):
        """A new element of the list is wanted, like one that is there where that is given."""

        def __init__(self, part: str, like: BaseModel | None) -> None:
            super().__init__()
            self.part, self.like = part, like

    def __init__(self, part: str, what: str) -> None:
        super().__init__(id=f"form-{part}")
        self.part, self._what = part, what
        self._elements: Sequence[BaseModel] = ()
        self._index = 0

    def compose(self) -> ComposeResult:
        """Lay out what can be done to the list above the form."""
        with Horizontal():
            yield Caption()
            for action, label in self.ACTIONS.items():
                yield Button(label, id=action, compact=True)
        yield ModelForm()

    def show(self, elements: Sequence[BaseModel], index: int, resolved: BaseModel | None = None) -> None:
        """Show one of the elements.

        Parameters
        ----------
        elements : all of the list; may be none
        index : which one
        resolved : it, or its parameters, with every `auto` worked out
        """
        self._elements, self._index = elements, index
        form = self.query_one(ModelForm)
        form.display = bool(elements)
        for action in ("copy", "remove"):
            self.query_one(f"#{action}", Button).disabled = not elements
        if not elements:
            self.query_one(Caption).tell(f"no {self._what}")
            return
        place = f"{self._what} {index + 1} of {len(elements)}"
        self.query_one(Caption).tell(Part(place, short=self._what))
        form.load(elements[index], (self.part, index), resolved=resolved)

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken."""
        self.query_one(ModelForm).problems(found)

    def take_focus(self) -> None:
        """Put the focus where one can go on at once."""
        if self._elements:
            self.query_one(ModelForm).focus_first()
        else:
            self.query_one("#add", Button).focus()

    @on(Button.Pressed)
    def _pressed(self, event: Button.Pressed) -> None:
        event.stop()
        if event.button.id == "remove":
            self.post_message(ElementRemoved((self.part, self._index)))
        else:
            like = self._elements[self._index] if event.button.id == "copy" else None
            self.post_message(self.Wanted(self.part, like))
