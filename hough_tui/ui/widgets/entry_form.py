"""The form of a scene or of a clustering of the set."""

from __future__ import annotations

from collections.abc import Sequence

from pydantic import BaseModel
from textual import on
from textual.message import Message
from textual.widgets import Button

from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementRemoved
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.element_form import ElementForm


class EntryForm(ElementForm):
    """One element of a list of the set, to be edited; others are added and removed here too.

    Parameters
    ----------
    part : the list
    what : what an element of it is called
    """

    DEFAULT_CSS = """
    EntryForm Button { min-width: 5; }
    """

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

    def show(self, elements: Sequence[BaseModel], index: int, resolved: BaseModel | None = None) -> None:
        """Show one of the elements.

        Parameters
        ----------
        elements : all of the list; may be none
        index : which one
        resolved : it, or its parameters, with every `auto` worked out
        """
        self._elements, self._index = elements, index
        self.show_whether_any(bool(elements))
        if not elements:
            self.query_one(Caption).tell(f"no {self._what}")
            return
        place = f"{self._what} {index + 1} of {len(elements)}"
        self.query_one(Caption).tell(Part(place, short=self._what))
        self.query_one(ModelForm).load(elements[index], (self.part, index), resolved=resolved)

    @on(Button.Pressed)
    def _pressed(self, event: Button.Pressed) -> None:
        event.stop()
        if event.button.id == "remove":
            self.post_message(ElementRemoved((self.part, self._index)))
        else:
            like = self._elements[self._index] if event.button.id == "copy" else None
            self.post_message(self.Wanted(self.part, like))
