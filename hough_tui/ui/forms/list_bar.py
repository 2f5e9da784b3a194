"""The line above a table: what it lists, and what can be done to the list, for the mouse."""

from __future__ import annotations

from textual import on
from textual.app import ComposeResult
from textual.content import Content
from textual.message import Message
from textual.widget import Widget
from textual.widgets import Button, Static

from hough_tui.ui.forms.fields import FieldDescription

ACTIONS = {"add": "a add", "duplicate": "c copy", "remove": "d remove"}
"""What the buttons do, and what stands on them."""


class ListBar(Widget):
    """The title of a list, and its buttons; they take no focus, for the keys do the same."""

    DEFAULT_CSS = """
    ListBar {
        layout: horizontal;
        height: 1;
        & > Static { width: 1fr; height: 1; text-style: bold; }
        & > Button.bar--button { margin-left: 1; min-width: 5; background: $panel; }
        & > Button.bar--button { color: $text-muted; text-style: none; }
        & > Button.bar--button:hover { color: $foreground; }
    }
    """

    class Pressed(Message):
        """A button was pressed; `action` is what it does."""

        def __init__(self, action: str) -> None:
            super().__init__()
            self.action = action

    def __init__(self, field: FieldDescription) -> None:
        super().__init__()
        self._field = field

    def compose(self) -> ComposeResult:
        title = Static(self._field.label, markup=False)
        title.tooltip = Content(self._field.help)
        yield title
        for action, label in ACTIONS.items():
            button = Button(Content(label), name=action, classes="bar--button", compact=True)
            button.can_focus = False
            yield button

    @on(Button.Pressed)
    def _pressed(self, event: Button.Pressed) -> None:
        event.stop()
        self.post_message(self.Pressed(event.button.name or ""))
