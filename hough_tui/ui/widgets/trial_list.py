"""A list of trials that draws only the lines that are seen."""

from __future__ import annotations

from typing import Any, ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual import events, work
from textual.binding import Binding, BindingType
from textual.geometry import Region, Size
from textual.message import Message
from textual.reactive import reactive
from textual.scroll_view import ScrollView
from textual.strip import Strip

from hough_tui.ui.widgets.trial_table import FAILED_FIRST, QUIET, WRONG, Rows, TrialTable

HEADER = 2
"""Lines of the headings."""

GAP = 2


class TrialList(ScrollView, can_focus=True):
    """Trials, the failed ones first; Enter opens one."""

    DEFAULT_CSS = """
    TrialList { background: $surface; scrollbar-size: 1 1; }
    TrialList > .trial-list--header { background: $panel; color: $foreground; text-style: bold; }
    TrialList > .trial-list--cursor { background: $primary 30%; }
    TrialList:focus > .trial-list--cursor { background: $primary; color: $text; }
    TrialList > .trial-list--wrong { color: $text-error; text-style: bold; }
    TrialList > .trial-list--quiet { text-style: dim; }
    """
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "trial-list--header",
        "trial-list--cursor",
        "trial-list--wrong",
        "trial-list--quiet",
    }
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("down,j", "move(1)", "Down", id="trials.down", show=False),
        Binding("up,k", "move(-1)", "Up", id="trials.up", show=False),
        Binding("left,h", "scroll_left", "Left", id="trials.left", show=False),
        Binding("right,l", "scroll_right", "Right", id="trials.right", show=False),
        Binding("pagedown,ctrl+f", "page(1)", "Page down", id="trials.page-down", show=False),
        Binding("pageup,ctrl+b", "page(-1)", "Page up", id="trials.page-up", show=False),
        Binding("g,home", "go(0)", "First", id="trials.first", show=False),
        Binding("G,end", "go(-1)", "Last", id="trials.last", show=False),
        Binding("enter", "open", "Look at it", id="trials.open"),
        Binding("s", "sort", "Sort", id="trials.sort"),
    ]

    cursor: reactive[int] = reactive(0, repaint=False)

    class Opened(Message):
        """A trial is to be opened."""

        def __init__(self, trial: int) -> None:
            super().__init__()
            self.trial = trial

    class Ordered(Message):
        """The trials stand in another order."""

        def __init__(self, by: str, order: Rows) -> None:
            super().__init__()
            self.by, self.order = by, order

    def __init__(self, table: TrialTable[Any, Any], order: Rows) -> None:
        super().__init__()
        self._table = table
        self._order = order
        self.sorted_by = FAILED_FIRST
        # The order that was asked for last, which may still be on its way.
        self._wanted = self.sorted_by
        widths = [column.width + GAP for column in table.columns]
        self.virtual_size = Size(sum(widths), len(table) + HEADER)

    @property
    def trial(self) -> int:
        """The number of the trial under the cursor."""
        return int(self._table.trials.numbers[self._order[self.cursor]])

    def validate_cursor(self, cursor: int) -> int:
        """Return the nearest line that there is."""
        return max(0, min(cursor, len(self._table) - 1))

    def watch_cursor(self, before: int, now: int) -> None:
        """Draw the two lines anew, and keep the cursor in sight."""
        for line in (before, now):
            self.refresh(Region(0, HEADER + line - self.scroll_offset.y, self.size.width, 1))
        room = max(1, self.scrollable_content_region.height - HEADER)
        top = self.scroll_offset.y
        if now < top:
            self.scroll_to(y=now, animate=False)
        elif now >= top + room:
            self.scroll_to(y=now - room + 1, animate=False)

    def action_move(self, step: int) -> None:
        """Move the cursor by lines."""
        self.cursor += step

    def action_page(self, step: int) -> None:
        """Move the cursor by pages."""
        self.cursor += step * max(1, self.scrollable_content_region.height - HEADER)

    def action_go(self, line: int) -> None:
        """Move the cursor to the first or the last line."""
        self.cursor = line % max(1, len(self._table))

    def action_open(self) -> None:
        """Open the trial under the cursor."""
        if len(self._table):
            self.post_message(self.Opened(self.trial))

    def action_sort(self) -> None:
        """Sort by the next of the orders."""
        names = [
            name
            for name in self._table.orders
            if name == FAILED_FIRST or any(column.order == name for column in self._table.columns)
        ]
        self._want(names[(names.index(self._wanted) + 1) % len(names)])

    def _want(self, by: str) -> None:
        self._wanted = by
        self._sort(by)

    @work(thread=True, exclusive=True, exit_on_error=False, group="order")
    def _sort(self, by: str) -> None:
        # A million trials take a second.
        self.post_message(self.Ordered(by, self._table.order(by)))

    def on_trial_list_ordered(self, event: Ordered) -> None:
        """Show the trials in their new order, unless another one has been asked for since."""
        if event.by != self._wanted:
            return
        self.sorted_by, self._order = event.by, event.order
        self.cursor = 0
        self.scroll_to(y=0, animate=False)
        self.refresh()

    def on_click(self, event: events.Click) -> None:
        """Sort by a heading; move to a line, and open it where the cursor is already."""
        place = event.get_content_offset(self)
        if place is None:
            return
        if place.y < HEADER:
            edge = self.scroll_offset.x + place.x
            for column in self._table.columns:
                edge -= column.width + GAP
                if edge < 0:
                    if column.order is not None:
                        self._want(column.order)
                    return
            return
        line = self.scroll_offset.y + place.y - HEADER
        if line == self.cursor:
            self.action_open()
        elif line < len(self._table):
            self.cursor = line

    def render_line(self, y: int) -> Strip:
        """Return a line: a heading, or a trial."""
        left, top = self.scroll_offset
        width = self.size.width
        if y < HEADER:
            strip, style = self._heading(y), self.get_component_rich_style("trial-list--header")
        else:
            line, style = top + y - HEADER, self.rich_style
            is_cursor = line == self.cursor
            strip = self._trial(line, is_cursor) if line < len(self._table) else Strip([])
            if is_cursor:
                style = self.get_component_rich_style("trial-list--cursor")
        return strip.crop_extend(left, left + width, style).apply_style(style)

    def _heading(self, line: int) -> Strip:
        segments = []
        for column in self._table.columns:
            lines = column.heading.split("\n")
            text = ([""] * (HEADER - len(lines)) + lines)[line]
            if line == HEADER - 1 and column.order == self.sorted_by:
                text = f"▼{text}"
            segments.append(Segment(_right(text, column.width + GAP)))
        return Strip(segments)

    def _trial(self, line: int, is_cursor: bool) -> Strip:
        row = int(self._order[line])
        styles = {
            WRONG: self.get_component_rich_style("trial-list--wrong", partial=True),
            QUIET: self.get_component_rich_style("trial-list--quiet", partial=True),
        }
        segments = []
        for column in self._table.columns:
            text, kind = column.cell(row)
            style = styles.get(kind, Style.null())
            if is_cursor and kind:
                style = Style(bold=kind == WRONG)
            segments.append(Segment(_right(text, column.width + GAP), style))
        return Strip(segments)


def _right(text: str, width: int) -> str:
    return " " * max(0, width - cell_len(text)) + text
