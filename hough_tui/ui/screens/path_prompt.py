"""A prompt for a file's path."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Input, Static

from hough_tui.ui.forms.controls import LineInput


class PathPrompt(ModalScreen[Path | None]):
    """Ask for the path of a file; with `is_new`, an existing file is confirmed by a second Enter."""

    DEFAULT_CSS = """
    PathPrompt { align: center middle; }
    PathPrompt > Vertical { width: 76; max-width: 95%; height: auto; padding: 1 2; background: $surface;
        border: round $primary; }
    PathPrompt .title { text-style: bold; }
    PathPrompt .note { color: $warning; height: auto; min-height: 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Back", id="path.leave")]

    def __init__(self, title: str, given: str, *, is_new: bool) -> None:
        super().__init__()
        self._title, self._given, self._is_new = title, given, is_new
        self._confirmed: Path | None = None

    def compose(self) -> ComposeResult:
        """Lay out the title, the path and a line for notes."""
        with Vertical():
            yield Static(self._title, classes="title", markup=False)
            yield LineInput(self._given, placeholder="path of a YAML file")
            yield Static("", classes="note", markup=False)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Answer with the path, if it can be one."""
        note = self.query_one(".note", Static)
        text = event.value.strip()
        if not text:
            note.update("give the path of a file")
            return
        path = Path(text).expanduser()
        if self._is_new and path.is_dir():
            note.update(f"{path} is a folder; give a file in it")
        elif self._is_new and not path.parent.is_dir():
            note.update(f"there is no folder {path.parent}")
        elif self._is_new and path.exists() and self._confirmed != path:
            self._confirmed = path
            note.update(f"{path} exists; Enter again replaces its content (comments and order stay)")
        elif not self._is_new and not path.is_file():
            note.update(f"there is no file {path}")
        else:
            self.dismiss(path)

    def action_leave(self) -> None:
        """Answer nothing."""
        self.dismiss(None)
