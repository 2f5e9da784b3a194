"""A table with the keys of vim beside the arrows."""

from __future__ import annotations

from typing import ClassVar

from rich.cells import cell_len
from rich.text import Text
from textual.binding import Binding, BindingType
from textual.widgets import DataTable

from hough_tui.reports.layout import Column


class VimTable(DataTable[Text]):
    """A table whose cursor is a row."""

    DEFAULT_CSS = """
    VimTable { background: $surface; scrollbar-size: 1 1; }
    VimTable:focus { background-tint: $foreground 0%; }
    VimTable > .datatable--header { background: $panel; color: $foreground; text-style: bold; }
    VimTable > .datatable--cursor { background: $primary 30%; color: $foreground; text-style: none; }
    VimTable:focus > .datatable--cursor { background: $primary; color: $text; }
    VimTable > .datatable--fixed { background: $surface; color: $foreground; }
    VimTable > .datatable--fixed-cursor { background: $primary 30%; color: $foreground; }
    VimTable:focus > .datatable--fixed-cursor { background: $primary; color: $text; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("down,j", "cursor_down", "Down", id="table.down", show=False),
        Binding("up,k", "cursor_up", "Up", id="table.up", show=False),
        Binding("left,h", "cursor_left", "Left", id="table.left", show=False),
        Binding("right,l", "cursor_right", "Right", id="table.right", show=False),
        Binding("g,home,ctrl+home", "scroll_top", "First row", id="table.first", show=False),
        Binding("G,end,ctrl+end", "scroll_bottom", "Last row", id="table.last", show=False),
        Binding("pageup,ctrl+b", "page_up", "Page up", id="table.page-up", show=False),
        Binding("pagedown,ctrl+f", "page_down", "Page down", id="table.page-down", show=False),
        Binding("enter", "select_cursor", "Open", id="table.open", show=False),
    ]

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(cursor_type="row", id=id, classes=classes)

    @property
    def chosen(self) -> str | None:
        """The key of the row under the cursor."""
        if not self.is_valid_row_index(self.cursor_row) or not self.columns:
            return None
        return self.coordinate_to_cell_key(self.cursor_coordinate).row_key.value

    def move_to(self, key: str | None) -> None:
        """Put the cursor on the row of a key, if it is there."""
        if key is not None and key in self.rows and self.chosen != key:
            self.move_cursor(row=self.get_row_index(key))


def cell_text(column: Column, row: int, width: int) -> Text:
    """Return a cell: prose flush left, figures flush right with their points in line."""
    text = column.cells[row]
    if not column.prose:
        # rich's own flush right strips the blanks at the end that keep decimal points in line.
        text = " " * (width - cell_len(text)) + text
    style = column.styles[row] if column.styles else ""
    return Text(text, style=style or ("dim" if column.quiet else ""), no_wrap=True)
