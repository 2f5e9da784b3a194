"""Writing a run to a file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

from textual import on, work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.screen import ModalScreen
from textual.widgets import Button, Input, RadioButton, RadioSet, Static

from hough_tui.reports.documents import FORMATS
from hough_tui.ui.forms.controls import LineInput
from scenarios.files.atomic import replace_file

Document = Mapping[str, Any]


class ExportScreen(ModalScreen[Path | None]):
    """Ask for path and format, and write; the result is the path, or None.

    Parameters
    ----------
    name : what the file is called unless another name is given
    document : a result document
    """

    DEFAULT_CSS = """
    ExportScreen { align: center middle; }
    ExportScreen > Vertical { width: 76; max-width: 95%; height: auto; padding: 1 2; background: $surface;
        border: round $primary; }
    ExportScreen .title { text-style: bold; }
    ExportScreen RadioSet { layout: horizontal; width: 100%; height: 1; border: none; margin: 1 0;
        background: $surface; padding: 0; }
    ExportScreen RadioButton { width: auto; margin-right: 3; background: $surface; }
    ExportScreen .note { color: $text-warning; height: auto; min-height: 1; margin: 1 0; }
    ExportScreen Horizontal { height: auto; }
    ExportScreen Button { margin-right: 2; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Back", id="export.leave")]

    class Done(Message):
        """The file is written, or not."""

        def __init__(self, path: Path, problem: str | None) -> None:
            super().__init__()
            self.path, self.problem = path, problem

    def __init__(self, name: str, document: Document) -> None:
        super().__init__()
        self._given = Path(f"{name}.csv")
        self._document = document
        self._confirmed: Path | None = None

    def compose(self) -> ComposeResult:
        """Lay out the path, the formats, a line for notes, the buttons."""
        with Vertical():
            yield Static("Export the run to", classes="title", markup=False)
            yield LineInput(str(self._given), id="path")
            with RadioSet():
                for ending, (called, _) in FORMATS.items():
                    yield RadioButton(f"{called} ({ending})", value=ending == ".csv", id=f"as-{ending[1:]}")
            yield Static(f"in {Path.cwd()} unless another folder is given", classes="note", markup=False)
            with Horizontal():
                yield Button("Write", id="write", variant="primary")
                yield Button("Back", id="back")

    @on(RadioSet.Changed)
    def _format_chosen(self, event: RadioSet.Changed) -> None:
        field, ending = self.query_one(Input), f".{(event.pressed.id or '').removeprefix('as-')}"
        path = Path(field.value)
        if path.suffix.lower() in FORMATS and path.suffix.lower() != ending:
            field.value = str(path.with_suffix(ending))

    @on(Input.Changed)
    def _path_edited(self, event: Input.Changed) -> None:
        self._confirmed = None
        ending = Path(event.value).suffix.lower()
        if ending in FORMATS:
            self.query_one(f"#as-{ending[1:]}", RadioButton).value = True

    @on(Input.Submitted)
    @on(Button.Pressed, "#write")
    def _write_asked(self) -> None:
        text = self.query_one(Input).value.strip()
        if not text:
            self._tell("give the path of a file")
            return
        path = Path(text).expanduser()
        if path.is_dir():
            self._tell(f"{path} is a folder; give a file in it")
        elif not path.parent.is_dir():
            self._tell(f"there is no folder {path.parent}")
        elif path.exists() and self._confirmed != path:
            self._confirmed = path
            self._tell(f"{path} exists; once more replaces it")
        else:
            chosen = self.query_one(RadioSet).pressed_button
            ending = f".{(chosen.id or '').removeprefix('as-')}" if chosen is not None else ".csv"
            self._write(path, ending)

    @work(thread=True, exclusive=True, exit_on_error=False, group="export")
    def _write(self, path: Path, ending: str) -> None:
        problem = None
        try:
            replace_file(path, FORMATS[ending][1](self._document))
        except OSError as error:
            problem = f"{path} cannot be written: {error.strerror or error}"
        self.post_message(self.Done(path, problem))

    @on(Done)
    def _written(self, event: Done) -> None:
        if event.problem is None:
            self.dismiss(event.path.absolute())
        else:
            self._tell(event.problem)

    @on(Button.Pressed, "#back")
    def _left(self) -> None:
        self.dismiss(None)

    def action_leave(self) -> None:
        """Write nothing."""
        self.dismiss(None)

    def _tell(self, text: str) -> None:
        self.query_one(".note", Static).update(text)
