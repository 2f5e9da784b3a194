"""The table of rates: it fills while a run goes on, and sorts by any column."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from rich.cells import cell_len
from rich.text import Text
from textual.binding import Binding, BindingType
from textual.coordinate import Coordinate
from textual.widgets import DataTable

from hough_tui.reports.layout import REPEATED, Column
from hough_tui.reports.numerals import NONE
from hough_tui.reports.rates import rate_sheets
from hough_tui.ui.widgets.vim_table import VimTable, cell_text

Row = Mapping[str, Any]

LEADING_NUMBER = re.compile(r"[-+]?\d[\d,]*(\.\d+)?(e-?\d+)?")
SUCCESS, BY_TARGET = "success_rate", "success_by_target"
"""Keys of the columns that stand beside each other where success by target goes first."""

ARROWS = {False: "▲", True: "▼"}


class RateGrid(VimTable):
    """Rows of figures; a row keeps its key, its place in the plan, however the table is sorted.

    Parameters
    ----------
    opens : whether a row has trials to open
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "select_cursor", "Trials", id="grid.trials"),
        Binding("s", "sort(1)", "Sort", id="grid.sort", show=False),
        Binding("S", "turn", "Sort the other way", id="grid.turn", show=False),
    ]

    def __init__(self, *, opens: bool = True) -> None:
        super().__init__()
        self._opens = opens
        self._shown: tuple[Column, ...] = ()
        self._widths: list[int] = []
        self._sorted_by: str | None = None
        self._is_falling = False
        self._rows: Sequence[Row] = ()
        self._has_targets_first = False
        self.wanted: tuple[str, ...] | None = None

    @property
    def shown_keys(self) -> tuple[str, ...]:
        """Keys of the metrics and intervals that are shown."""
        return tuple(dict.fromkeys(column.key for column in self._shown if column.key))

    def want(self, keys: tuple[str, ...]) -> None:
        """Show the columns of some keys; of none: those that say something."""
        self.wanted = keys or None
        self.show_rows(self._rows)
        self.scroll_to(x=0, animate=False)

    @property
    def sorted_by(self) -> tuple[str, bool] | None:
        """Heading of the column that sorts the rows, and whether it falls; None in the plan's order."""
        return None if self._sorted_by is None else (self._sorted_by, self._is_falling)

    @property
    def chosen_index(self) -> int | None:
        """Place in the plan of the row under the cursor."""
        return None if self.chosen is None else int(self.chosen)

    def show_rows(self, rows: Sequence[Row]) -> None:
        """Show result rows; those that are there already keep their place on the screen."""
        self._rows = rows
        columns = rate_columns(rows, self.wanted)
        if self._has_targets_first:
            columns = with_targets_first(columns)
        self.show_columns(columns, identifying_columns(columns, rows))

    def show_columns(self, columns: Sequence[Column], identifying: int = 0) -> None:
        """Show columns of text.

        Parameters
        ----------
        columns : what to show
        identifying : how many at the left stay when the table is scrolled sideways, if there is room
        """
        columns = tuple(columns)
        widths = [_room(column) for column in columns]
        count = len(columns[0].cells) if columns else 0
        names = [column.name for column in columns]
        is_same = names == [column.name for column in self._shown] and widths == self._widths
        before, self._shown, self._widths = self._shown, columns, widths
        if is_same and count == self.row_count:
            self._change(before)
        else:
            self._build(count)
        fixed = sum(width + 2 * self.cell_padding for width in widths[:identifying])
        self.fixed_columns = identifying if 2 * fixed <= max(80, self.size.width) else 0
        if self._sorted_by is not None:
            self._sort()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Offer to open a row where it can be opened."""
        return self._opens or action != "select_cursor"

    def action_sort(self, step: int) -> None:
        """Sort by the next column; after the last one the plan's order comes back."""
        names = [None, *distinct_names(self._shown)]
        here = names.index(self._sorted_by) if self._sorted_by in names else 0
        self.sort_by(names[(here + step) % len(names)])

    def turn_targets(self) -> bool:
        """Put success by target beside success, or back to the end; return whether there is any."""
        columns = rate_columns(self._rows, self.wanted)
        if with_targets_first(columns) == columns:
            return False
        self._has_targets_first = not self._has_targets_first
        self.show_rows(self._rows)
        self.scroll_to(x=0, animate=False)
        return True

    def action_turn(self) -> None:
        """Sort the other way round."""
        if self._sorted_by is not None:
            self.sort_by(self._sorted_by, is_falling=not self._is_falling)

    def on_data_table_header_selected(self, event: DataTable.HeaderSelected) -> None:
        """Sort by the column that was clicked on; a second click turns it round, a third ends it."""
        name = distinct_names(self._shown)[event.column_index]
        if name != self._sorted_by:
            self.sort_by(name)
        else:
            self.sort_by(None if self._is_falling else name, is_falling=True)

    def sort_by(self, name: str | None, *, is_falling: bool = False) -> None:
        """Sort by the column of a heading; None: in the plan's order."""
        self._sorted_by, self._is_falling = name, is_falling
        for index, column in enumerate(self.ordered_columns):
            column.label = self._label(index)
        self._change(self._shown, is_restyled=True)
        self._sort()

    def _build(self, count: int) -> None:
        chosen, scroll = self.chosen, self.scroll_offset
        with self.app.batch_update():
            self.clear(columns=True)
            self.header_height = max((column.heading.count("\n") + 1 for column in self._shown), default=1)
            for index, width in enumerate(self._widths):
                self.add_column(self._label(index), width=width, key=str(index))
            for row in range(count):
                self.add_row(*(self._cell(index, row) for index in range(len(self._shown))), key=str(row))
        self.move_to(chosen)
        self.call_after_refresh(self.scroll_to, *scroll, animate=False)

    def _change(self, before: Sequence[Column], *, is_restyled: bool = False) -> None:
        for index, column in enumerate(self._shown):
            for row, text in enumerate(column.cells):
                if is_restyled or text != before[index].cells[row]:
                    self.update_cell(str(row), str(index), self._cell(index, row))

    def _cell(self, column: int, row: int) -> Text:
        cell = cell_text(self._shown[column], row, self._widths[column])
        if self._sorted_by is not None and cell.style == REPEATED and self._shown[column].prose:
            cell.style = ""  # in another order a name does not repeat the one above it
        return cell

    def _label(self, index: int) -> Text:
        column, width = self._shown[index], self._widths[index]
        lines = column.heading.split("\n")
        lines = [""] * (self.header_height - len(lines)) + lines
        if distinct_names(self._shown)[index] == self._sorted_by:
            arrow = ARROWS[self._is_falling]
            lines[-1] = lines[-1] + arrow if column.prose else arrow + lines[-1]
        if not column.prose:
            lines = [" " * (width - cell_len(line)) + line for line in lines]
        return Text("\n".join(lines), no_wrap=True)

    def _sort(self) -> None:
        chosen = self.chosen
        names = distinct_names(self._shown)
        if self._sorted_by in names:
            index = names.index(self._sorted_by)
            is_falling = self._is_falling

            def rank(cell: Text) -> tuple[bool, float, str]:
                missing, value, text = sort_value(cell.plain)
                # What is missing stands last either way.
                return missing != is_falling, value, text

            self.sort(str(index), key=rank, reverse=is_falling)
        else:
            self.sort(key=lambda _: 0)  # a stable sort: the rows as they were added
        if chosen is not None:
            self.cursor_coordinate = Coordinate(self.get_row_index(chosen), self.cursor_column)


def distinct_names(columns: Sequence[Column]) -> list[str]:
    """Return the headings of columns in one line, those that several have with the column's key."""
    names = [column.name for column in columns]
    return [
        name if names.count(name) == 1 else f"{name} {column.key}"
        for name, column in zip(names, columns, strict=True)
    ]


def sort_value(text: str) -> tuple[bool, float, str]:
    """Return what a cell is sorted by: whether it has no value, its number, its text.

    What is sorted by is what is seen, so that rows that show the same figure keep their order.
    """
    text = text.strip()
    found = LEADING_NUMBER.match(text)
    return text in ("", NONE), float(found.group().replace(",", "")) if found else 0.0, text


def rate_columns(rows: Sequence[Row], wanted: Sequence[str] | None = None) -> list[Column]:
    """Return the columns of result rows, of several experiments or sets in one table.

    Parameters
    ----------
    rows : of any kind
    wanted : keys of the metrics and intervals to show; None for those that say something
    """
    if not rows:
        return []
    (sheet,) = rate_sheets([{**row, "set": "", "experiment": ""} for row in rows], wanted)
    columns = list(sheet.columns)
    for key in ("experiment", "set"):
        names = tuple(str(row[key]) for row in rows)
        if len(set(names)) > 1:
            columns.insert(0, Column(key, names, prose=True))
    if len({row["trials"] for row in rows}) > 1:
        counts = tuple(f"{row['trials']:,}" for row in rows)
        columns.insert(identifying_columns(columns, rows), Column("trials", counts, quiet=True))
    return columns


def with_targets_first(columns: Sequence[Column]) -> list[Column]:
    """Return columns with those of success by target beside that of success."""
    targets = [column for column in columns if column.key == BY_TARGET]
    others = [column for column in columns if column.key != BY_TARGET]
    place = 1 + next((index for index, column in enumerate(others) if column.key == SUCCESS), -1)
    return [*others[:place], *targets, *others[place:]]


def identifying_columns(columns: Sequence[Column], rows: Sequence[Row]) -> int:
    """Return how many columns at the left say what a row is about."""
    swept = {key for row in rows for key in row.get("swept") or {}}
    return sum(column.prose for column in columns) + len(swept)


def _room(column: Column) -> int:
    # Beside the last line of a heading there is room for the arrow of a sorted column.
    return max(column.natural, cell_len(column.heading.split("\n")[-1]) + 1)
