"""The steps by which points were split, as a tree of lines; the one under the cursor is told."""

from __future__ import annotations

from collections.abc import Sequence

from rich.text import Text
from textual.message import Message
from textual.widgets import DataTable

from hough_tui.reports.layout import Column
from hough_tui.ui.widgets.vim_table import VimTable, cell_text

CLUSTERS = "clusters"
"""The first line, and its key: what came out of all steps."""


class StepList(VimTable):
    """What came out, and below it the sets that were looked at, each under the one it is a part of."""

    DEFAULT_CSS = "StepList { height: 1fr; }"

    class Chosen(Message):
        """A step was chosen; None for what came out of all."""

        def __init__(self, listed: StepList, index: int | None) -> None:
            super().__init__()
            self.listed, self.index = listed, index

        @property
        def control(self) -> StepList:
            """The list."""
            return self.listed

    def __init__(self) -> None:
        super().__init__()
        self._is_filling = False
        self._shown: tuple[Column, ...] = ()

    def show(self, columns: Sequence[Column], count: int, out: str) -> None:
        """List steps.

        Parameters
        ----------
        columns : one line a step in each; the first holds the branches of the tree
        count : number of points of all
        out : what came out of the steps, in words
        """
        first = (CLUSTERS, str(count), out, "")
        columns = tuple(
            Column(column.heading, (head, *column.cells), prose=column.prose)
            for column, head in zip(columns, first, strict=True)
        )
        if columns == self._shown:
            return
        self._shown, self._is_filling = columns, True
        widths = [column.natural for column in columns]
        with self.app.batch_update():
            self.clear(columns=True)
            for column, width in zip(columns, widths, strict=True):
                label = Text(column.heading, justify="left" if column.prose else "right")
                self.add_column(label, width=width)
            for row in range(len(columns[0].cells)):
                cells = (cell_text(column, row, width) for column, width in zip(columns, widths, strict=True))
                self.add_row(*cells, key=CLUSTERS if row == 0 else str(row - 1))
        self._is_filling = False

    def turn_to(self, index: int | None) -> None:
        """Put the cursor on a step; None for what came out of all."""
        self.move_to(CLUSTERS if index is None else str(index))

    def on_data_table_row_highlighted(self, event: DataTable.RowHighlighted) -> None:
        """Tell which step the cursor is on."""
        event.stop()
        # Filling the list moves its cursor, which is nobody's choice; nor is it one where others move it.
        if not self._is_filling and self.has_focus and self.chosen is not None:
            self.post_message(self.Chosen(self, None if self.chosen == CLUSTERS else int(self.chosen)))
