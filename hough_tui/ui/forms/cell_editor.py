"""The line of text in which a cell of a table is edited, in its place."""

from __future__ import annotations

from typing import Any

from textual import on
from textual.app import ComposeResult
from textual.coordinate import Coordinate
from textual.geometry import Region
from textual.widget import Widget
from textual.widgets import Input

from algorithms.parameters import Path
from hough_tui.ui.forms.controls import input_for
from hough_tui.ui.forms.fields import FieldDescription
from hough_tui.ui.forms.numbers import Unreadable
from hough_tui.ui.forms.texts import text_of, value_of

ROOM = 14
"""The least width of the line: most numbers are longer than what stands in their column."""


class CellEditor(Widget):
    """A cell under edit.

    Attributes
    ----------
    column : what the cell is
    place : where it is in the table
    path : where its value stands in the set
    value : its value when editing began
    asked : the value that was posted and is not answered yet, in a tuple; None where there is none
    step : by how many cells to go on when it is taken
    is_wrong : whether what is typed was said to be wrong
    """

    DEFAULT_CSS = """
    CellEditor {
        position: absolute;
        layer: editor;
        height: 1;
        & > Input.cell--line { padding: 0 1; background: $panel; }
        & > Input.-wrong { background-tint: $error 25%; }
    }
    """

    def __init__(
        self, column: FieldDescription, place: Coordinate, path: Path, value: Any, placeholder: str = ""
    ) -> None:
        super().__init__()
        self.column, self.place, self.path, self.value = column, place, path, value
        self.asked: tuple[Any] | None = None
        self.step = 0
        self.is_wrong = False
        self._input = input_for(column, text_of(column, value), placeholder, "cell--line")

    def compose(self) -> ComposeResult:
        yield self._input

    @on(Input.Changed)
    def _typed(self, event: Input.Changed) -> None:
        # What is typed counts when it is finished.
        event.stop()

    @property
    def line(self) -> Input:
        """The line of text itself."""
        return self._input

    @property
    def text(self) -> str:
        """What is typed."""
        return self._input.value

    @property
    def meaning(self) -> Any | Unreadable:
        """What that means, or why it means nothing."""
        return value_of(self.column, self.text)

    def refuse(self) -> None:
        """Mark what is typed as wrong: it waits for no answer any more."""
        self.asked, self.is_wrong = None, True
        self._input.add_class("-wrong")

    def put(self, cell: Region, table: Region) -> None:
        """Lie over a cell of a table, as wide as needed and no farther than the table reaches."""
        width = min(max(cell.width, ROOM), table.width)
        left = max(0, min(cell.x, table.width - width))
        self.styles.width = width
        self.styles.offset = (table.x + left, table.y + cell.y)
        self.display = 0 < cell.y < table.height
