"""A table with a cell cursor that shows models, and keeps its place when they change."""

from __future__ import annotations

from collections.abc import Sequence

from rich.text import Text
from textual.actions import SkipAction
from textual.binding import Binding
from textual.coordinate import Coordinate
from textual.geometry import Region
from textual.widgets import DataTable

NARROWEST = 4
"""The least width of a column, so that an empty one can be seen and clicked."""


class CellTable(DataTable[Text], inherit_bindings=False):
    """Rows of cells, with a cursor that is moved by the mouse, by arrows and by the keys of vim."""

    DEFAULT_CSS = """
    CellTable {
        height: auto;
        max-height: 14;
        & > .datatable--header { background: $surface; color: $text-muted; text-style: none; }
        &:focus > .datatable--header { background: $surface; }
    }
    """

    BINDINGS = [
        Binding("enter", "select_cursor", "Edit", id="table.edit"),
        Binding("up,k", "cursor_up", "Row above", show=False, id="table.up"),
        Binding("down,j", "cursor_down", "Row below", show=False, id="table.down"),
        Binding("left,h", "cursor_left", "Column before", show=False, id="table.left"),
        Binding("right,l", "cursor_right", "Column after", show=False, id="table.right"),
        Binding("pageup,ctrl+b", "page_up", "Page up", show=False, id="table.page_up"),
        Binding("pagedown,ctrl+f", "page_down", "Page down", show=False, id="table.page_down"),
        Binding("home,0", "scroll_home", "First column", show=False, id="table.first_column"),
        Binding("end,dollar_sign", "scroll_end", "Last column", show=False, id="table.last_column"),
        Binding("ctrl+home,g", "scroll_top", "First row", show=False, id="table.first_row"),
        Binding("ctrl+end,G", "scroll_bottom", "Last row", show=False, id="table.last_row"),
    ]

    def __init__(self) -> None:
        super().__init__(cell_padding=1)
        self._headings: tuple[Text, ...] = ()
        self._shown: list[tuple[Text, ...]] = []

    def show(self, headings: Sequence[Text], rows: Sequence[Sequence[Text]]) -> None:
        """Show rows under headings; the cursor stays where it is, as far as there are rows.

        Without rows there are no headings either, which would look like a row of nothing.
        """
        self.show_header = bool(rows)
        headings = headings if rows else ()
        place, taken = self.cursor_coordinate, tuple(headings)
        if taken != self._headings:
            self.clear(columns=True)
            self._shown = []
            self.header_height = 2 if any("\n" in text.plain for text in taken) else 1
            for index, text in enumerate(taken):
                self.add_column(text, key=str(index))
            self._headings = taken
        cells = [tuple(row) for row in rows]
        if len(cells) == len(self._shown):
            for row, (now, before) in enumerate(zip(cells, self._shown, strict=True)):
                for column, (text, old) in enumerate(zip(now, before, strict=True)):
                    if (text, text.style) != (old, old.style):
                        self.update_cell_at(Coordinate(row, column), text, update_width=True)
        else:
            self.clear()
            for row, now in enumerate(cells):
                self.add_row(*now, key=str(row), label=Text(str(row), "dim"))
            self.move_cursor(row=min(place.row, len(cells) - 1), column=place.column, animate=False)
        self._shown = cells

    def action_cursor_up(self) -> None:
        """Go to the row above; of no rows, let the form go to the field before."""
        self._skip_if_empty()
        super().action_cursor_up()

    def action_cursor_down(self) -> None:
        """Go to the row below; of no rows, let the form go to the next field."""
        self._skip_if_empty()
        super().action_cursor_down()

    def _skip_if_empty(self) -> None:
        if not self.row_count:
            raise SkipAction

    def cell_region(self, place: Coordinate) -> Region:
        """Return where a cell is now, within the table."""
        labels = len(str(len(self._shown) - 1)) + 2 * self.cell_padding
        columns = self.ordered_columns
        left = labels + sum(column.get_render_width(self) for column in columns[: place.column])
        top = self.header_height + place.row
        width = columns[place.column].get_render_width(self)
        return Region(left - self.scroll_offset.x, top - self.scroll_offset.y, width, 1)
