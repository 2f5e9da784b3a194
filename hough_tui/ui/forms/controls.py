"""The controls of a form: inputs that leave alone what is typed, and a flag that reads without colour."""

from __future__ import annotations

from typing import Any

from rich.cells import cell_len
from rich.text import Text
from textual.binding import Binding
from textual.message import Message
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import Input, Select

from hough_tui.reports.visible import visible_in_place
from hough_tui.ui.forms.fields import FieldDescription
from hough_tui.ui.forms.texts import NO, YES

EXPLAIN = "field.explain"
"""The id of the binding that explains a field, wherever it is."""


class ExplanationWanted(Message):
    """Someone asks what a field is."""


class LineInput(Input):
    """A line of text, in which a character that acts on a terminal is a picture in its own place."""

    @property
    def _value(self) -> Text:
        return Text(visible_in_place(self.value), no_wrap=True, overflow="ignore", end="")

    def _position_to_cell(self, position: int) -> int:
        return cell_len(visible_in_place(self.value[:position]))


class NumberInput(LineInput):
    """A line of text for numbers.

    It is no input of type "number": that one drops the characters that it does not know, so that
    a typed 1,5 becomes 15.
    """

    BINDINGS = [
        # Before the key is typed: no number has a question mark.
        Binding(
            "question_mark,ctrl+question_mark",
            "explain",
            "Explain",
            key_display="?",
            priority=True,
            id=EXPLAIN,
        )
    ]

    def action_explain(self) -> None:
        """Ask what the field is."""
        self.post_message(ExplanationWanted())


class TextInput(LineInput):
    """A line of text, in which a question mark is text too."""

    BINDINGS = [
        Binding("f1,ctrl+question_mark", "explain", "Explain", key_display="F1", id="field.explain-text")
    ]

    def action_explain(self) -> None:
        """Ask what the field is."""
        self.post_message(ExplanationWanted())


class Menu(Select[str], inherit_bindings=False):
    """A choice, whose menu is opened on purpose only: up and down go to the fields around it."""

    BINDINGS = [Binding("enter,space", "show_overlay", "Open the menu", show=False, id="menu.open")]

    def _watch_value(self, value: Any) -> None:
        # Textual's own looks for a label that a menu does not have before it is laid out.
        if self.query("SelectCurrent > #label"):
            super()._watch_value(value)
        else:
            self._value = value
            self.call_after_refresh(self._show_value)

    def _show_value(self) -> None:
        with self.prevent(Select.Changed):
            super()._watch_value(self.value)


def input_for(field: FieldDescription, text: str, placeholder: str, classes: str) -> Input:
    """Return the input in which a field is typed."""
    kind = NumberInput if field.is_numeric else TextInput
    made = kind(text, placeholder, compact=True, select_on_focus=field.is_numeric, classes=classes)
    # A cursor that blinks would write to the terminal for ever, also where that is far away.
    made.cursor_blink = False
    return made


class Flag(Widget, can_focus=True):
    """A yes or a no, in words: it reads the same without colours."""

    DEFAULT_CSS = """
    Flag {
        width: auto;
        height: 1;
        background: $surface;
        color: $foreground;
        pointer: pointer;
        &:focus {
            background: $block-cursor-background;
            color: $block-cursor-foreground;
            text-style: $block-cursor-text-style;
        }
    }
    """

    BINDINGS = [Binding("enter,space", "turn", "Yes or no", show=False, id="flag.toggle")]

    value: reactive[bool] = reactive(False)

    class Changed(Message):
        """Someone turned the flag."""

    def __init__(self, value: bool, *, classes: str | None = None) -> None:
        super().__init__(classes=classes)
        self.set_reactive(Flag.value, value)

    def render(self) -> Text:
        return Text(f"[x] {YES}" if self.value else f"[ ] {NO}", no_wrap=True)

    def get_content_width(self, container: object, viewport: object) -> int:
        return 7

    def action_turn(self) -> None:
        """Turn the flag."""
        self.value = not self.value
        self.post_message(self.Changed())

    def on_click(self) -> None:
        self.action_turn()
