"""The list of the runs that were kept."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.message import Message

from hough_tui.ui.runs.run_summaries import KeptSummary, summary_columns
from hough_tui.ui.widgets.vim_table import VimTable, cell_text


class RunList(VimTable):
    """Runs by name; some of them may be marked."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "select_cursor", "Show", id="runs.show"),
        Binding("space", "mark", "Mark", id="runs.mark"),
        Binding("equals_sign", "compare", "Compare", id="runs.compare"),
        Binding("e", "export", "Export", id="runs.export", show=False),
        Binding("delete", "delete", "Delete", id="runs.delete", show=False),
    ]

    class Marked(Message):
        """Other runs are marked."""

    class Asked(Message):
        """Something is to be done with runs.

        Attributes
        ----------
        names : of the runs, the oldest first
        """

        def __init__(self, names: list[str]) -> None:
            super().__init__()
            self.names = names

    class Comparing(Asked):
        """Runs are to be compared."""

    class Exporting(Asked):
        """A run is to be exported."""

    class Deleting(Asked):
        """Runs are to be deleted."""

    def __init__(self) -> None:
        super().__init__()
        self.known: dict[str, KeptSummary] = {}
        self.marked: set[str] = set()

    def show_runs(self, found: list[KeptSummary]) -> None:
        """Show runs; the cursor stays on its run, or at its place where that is gone."""
        known = {summary.name: summary for summary in found}
        if known == self.known and self.columns:
            return
        chosen, place = self.chosen, self.cursor_row
        self.known = known
        self.marked &= set(known)
        self.clear(columns=True)
        columns = summary_columns(found, self.marked)
        widths = [column.natural for column in columns]
        for index, (column, width) in enumerate(zip(columns, widths, strict=True)):
            heading = column.heading if column.prose else f"{column.heading:>{width}}"
            self.add_column(heading, width=width, key=str(index))
        for row, summary in enumerate(found):
            cells = (cell_text(column, row, width) for column, width in zip(columns, widths, strict=True))
            self.add_row(*cells, key=summary.name)
        if chosen in known:
            self.move_to(chosen)
        elif found:
            self.move_cursor(row=min(place, len(found) - 1))

    @property
    def _marked_names(self) -> list[str]:
        # The list has the newest run first.
        return [name for name in reversed(self.known) if name in self.marked]

    def action_mark(self) -> None:
        """Mark the run under the cursor, or take its mark away, and go on to the next one."""
        name = self.chosen
        if name is None:
            return
        self.marked ^= {name}
        (mark, *_) = summary_columns([self.known[name]], self.marked)
        self.update_cell(name, "0", cell_text(mark, 0, 1))
        self.action_cursor_down()
        self.post_message(self.Marked())

    def action_compare(self) -> None:
        """Compare the marked runs."""
        self.post_message(self.Comparing(self._marked_names))

    def action_export(self) -> None:
        """Export the run under the cursor."""
        if self.chosen is not None:
            self.post_message(self.Exporting([self.chosen]))

    def action_delete(self) -> None:
        """Delete the marked runs, or the one under the cursor where none is marked."""
        names = self._marked_names or ([self.chosen] if self.chosen is not None else [])
        if names:
            self.post_message(self.Deleting(names))
