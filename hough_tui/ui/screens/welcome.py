"""The first screen: bundled sets, unsaved work, or a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen
from textual.widgets import Button, OptionList, Static
from textual.widgets.option_list import Option

from hough_tui.ui.screens.path_prompt import PathPrompt


class Welcome(ModalScreen[Any]):
    """Choose what to open; the result is a name or path, unsaved work, or None."""

    DEFAULT_CSS = """
    Welcome { align: center middle; }
    Welcome > Vertical { width: 78; max-width: 96%; height: auto; max-height: 94%; padding: 1 2;
        background: $surface; border: round $primary; }
    Welcome .title { text-style: bold; }
    Welcome .text { color: $text-muted; margin-bottom: 1; }
    Welcome OptionList { height: auto; max-height: 45vh; background: $surface; }
    Welcome OptionList, Welcome OptionList:focus { border: none; padding: 0; }
    Welcome Button { margin: 1 0 0 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Back", id="welcome.leave"),
        Binding("j", "move(1)", "Next", id="welcome.next", show=False),
        Binding("k", "move(-1)", "Previous", id="welcome.previous", show=False),
        Binding("o", "file", "Open a file", id="welcome.file"),
    ]

    def __init__(self, bundled: list[Any], kept: list[Any]) -> None:
        super().__init__()
        self._bundled, self._kept = bundled, kept

    def compose(self) -> ComposeResult:
        """Lay out the choices."""
        with Vertical():
            yield Static("hough-tui", classes="title", markup=False)
            yield Static(
                "Design and judge track initiation. Choose a bundled set to begin with: it opens as a "
                "copy, which you save under a name of your own. F1 explains each view, Ctrl+P lists "
                "every action.",
                classes="text",
                markup=False,
            )
            yield OptionList(*self._options())
            # Beside the list, which may be longer than the screen is high.
            yield Button("Open a file …  (o)", compact=True)

    def _options(self) -> list[Option | None]:
        options: list[Option | None] = []
        for index, kept in enumerate(self._kept):
            text = Text.assemble(("unsaved ", "bold yellow"), (kept.given.name, "bold"), f"  of {kept.when}")
            options.append(Option(text, id=f"kept-{index}"))
        if self._kept:
            options.append(None)
        for found in self._bundled:
            text = Text.assemble((found.name, "bold"), "\n  ", (found.description, "dim"))
            options.append(Option(text, id=f"set-{found.name}"))
        return options

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Open what is chosen."""
        chosen = event.option.id or ""
        kind, _, name = chosen.partition("-")
        self.dismiss(self._kept[int(name)] if kind == "kept" else name)

    def on_button_pressed(self) -> None:
        """Ask for a file."""
        self.action_file()

    def action_file(self) -> None:
        """Ask for a file."""
        self.app.push_screen(PathPrompt("Open a set", "", is_new=False), self._file_chosen)

    def _file_chosen(self, path: Path | None) -> None:
        if path is not None:
            self.dismiss(str(path))

    def action_move(self, step: int) -> None:
        """Move the choice."""
        options = self.query_one(OptionList)
        (options.action_cursor_down if step > 0 else options.action_cursor_up)()

    def action_leave(self) -> None:
        """Choose nothing."""
        self.dismiss(None)
