"""A question with a few answers, over the main screen."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Button, Static


class Question(ModalScreen[str | None]):
    """Ask something, or tell something with one answer; the result is the answer's key, or None."""

    DEFAULT_CSS = """
    Question { align: center middle; }
    Question > Vertical {
        width: auto; max-width: 90%; min-width: 40; height: auto; max-height: 90%;
        padding: 1 2; background: $surface; border: round $primary;
    }
    Question VerticalScroll { height: auto; max-height: 20; width: auto; max-width: 100%; }
    Question .text { width: auto; max-width: 76; }
    Question .title { text-style: bold; margin-bottom: 1; width: auto; }
    Question Horizontal { height: auto; width: auto; margin-top: 1; }
    Question Button { margin-right: 2; min-width: 10; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Back", id="question.leave"),
        Binding("left", "app.focus_previous", "Previous answer", id="question.previous", show=False),
        Binding("right", "app.focus_next", "Next answer", id="question.next", show=False),
    ]

    def __init__(self, title: str, text: str, answers: dict[str, str]) -> None:
        super().__init__()
        self._title, self._text, self._answers = title, text, answers

    def compose(self) -> ComposeResult:
        """Lay out the text above the answers."""
        with Vertical():
            yield Static(self._title, classes="title", markup=False)
            with VerticalScroll(can_focus=False):
                yield Static(self._text, classes="text", markup=False)
            with Horizontal():
                for index, (key, label) in enumerate(self._answers.items()):
                    yield Button(label, id=key, variant="primary" if index == 0 else "default")

    def on_button_pressed(self, event: Button.Pressed) -> None:
        """Answer."""
        self.dismiss(event.button.id)

    def action_leave(self) -> None:
        """Answer nothing."""
        self.dismiss(None)


def telling(title: str, text: str) -> Question:
    """Return a screen that only tells something."""
    return Question(title, text, {"ok": "OK"})
