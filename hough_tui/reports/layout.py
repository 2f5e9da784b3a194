"""Sheets: columns of text with a title and notes, and how they fit into a terminal's width."""

from __future__ import annotations

import re
import sys
import textwrap
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

from rich import box
from rich.cells import cell_len
from rich.table import Table
from rich.text import Text

from hough_tui.reports.look_alikes import spelled
from hough_tui.reports.visible import visible, visible_line

GAP = 2
COMFORTABLE_PROSE = 16
NARROWEST_PROSE = 11
LUXURY = 40
"""Columns from this rank on leave before names are broken into narrow lines."""

MOST_NAMED = 6
"""So many columns that are left out are named, where they can be asked for."""

WIDEST_NOTES = 100
"""Longer lines of running text are hard to read."""

KEPT_TOGETHER = re.compile(r"(?<=[θρ≤]) | (?=[≤%°])")
REPEATED = "dim"
NO_BREAK = "\N{NO-BREAK SPACE}"


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a sheet.

    Attributes
    ----------
    heading : one to three lines
    cells : one text a row; those of figures are lined up already
    rank : 0 for a column that always stays; of the others the greatest leaves first; columns of
        one rank leave together
    prose : text, flush left, that may be broken into lines; else figures, flush right, never broken
    quiet : drawn dim
    called : what a note calls the column when there is no room for it; by default its heading
    styles : the style of single cells, by row; empty for none
    key : of the metric, or of the interval, that it shows; empty for any other column
    """

    heading: str
    cells: tuple[str, ...]
    rank: int = 0
    prose: bool = False
    quiet: bool = False
    called: str = ""
    styles: tuple[str, ...] = ()
    key: str = ""

    def __post_init__(self) -> None:
        # What is shown is measured: characters that act are escapes before any width is worked out.
        object.__setattr__(self, "heading", visible(self.heading))
        object.__setattr__(self, "cells", tuple(map(visible_line, self.cells)))

    @property
    def name(self) -> str:
        """The heading in one line."""
        return re.sub(r"(?<=[-._])\n(?!/)", "", self.heading).replace("\n", " ")

    @property
    def natural(self) -> int:
        """Width without any line break."""
        return max(_width(self.heading), *map(_width, self.cells), 1)

    def least(self, prose: int) -> int:
        """Return the smallest width, given the one that prose may be broken at."""
        return min(self.natural, max(_width(self.heading), prose)) if self.prose else self.natural


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table before it has a width.

    Attributes
    ----------
    title : one line
    columns : all that there is to show
    notes : sentences below it
    warnings : sentences below it that change how it is to be read
    """

    title: str
    columns: tuple[Column, ...]
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "title", visible_line(self.title))
        object.__setattr__(self, "notes", tuple(map(visible, self.notes)))
        object.__setattr__(self, "warnings", tuple(map(visible, self.warnings)))


def sheet_table(sheet: Sheet, width: int) -> Table:
    """Return the table of a sheet, with the columns that the width has room for.

    Parameters
    ----------
    sheet : what to show
    width : of the terminal, in cells
    """
    sheet = _encodable(sheet, sys.stdout.encoding)
    shown, left_out = chosen(sheet.columns, width)
    widths = _widths(shown, width)
    notes = list(sheet.notes)
    if left_out:
        notes.append(f"A wider terminal also shows {_left_out_words(left_out)}.")
    # The empty line keeps the notes apart from the last row where there is no colour.
    below = ["", *notes, *sheet.warnings] if notes or sheet.warnings else []
    styles = ["", *["dim"] * len(notes), *[""] * len(sheet.warnings)]
    table = Table(
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, GAP - 1, 0, 0),
        header_style="bold",
        title=_lines([sheet.title], width, ["bold"]) if sheet.title else None,
        title_justify="left",
        title_style="",
        caption=_lines(below, width, styles),
        caption_justify="left",
        caption_style="",
    )
    depth = max((column.heading.count("\n") + 1 for column in shown), default=0)
    for column, room in zip(shown, widths, strict=True):
        lines = column.heading.split("\n")
        heading = [""] * (depth - len(lines)) + [
            line if column.prose else _right(line, room) for line in lines
        ]
        style = "dim" if column.quiet else ""
        table.add_column(Text("\n".join(heading)), width=room, overflow="fold", style=style)
    columns = [_cells(column, room) for column, room in zip(shown, widths, strict=True)]
    for cells in zip(*columns, strict=True):
        table.add_row(*cells)
    return table


def _encodable(sheet: Sheet, encoding: str) -> Sheet:
    """Return a sheet in the characters of an encoding."""
    columns = tuple(
        replace(
            column,
            heading=spelled(column.heading, encoding),
            cells=tuple(spelled(cell, encoding) for cell in column.cells),
            called=spelled(column.called, encoding),
        )
        for column in sheet.columns
    )
    sentences = [tuple(spelled(text, encoding) for text in texts) for texts in (sheet.notes, sheet.warnings)]
    return Sheet(spelled(sheet.title, encoding), columns, *sentences)


def chosen(columns: Sequence[Column], width: int) -> tuple[list[Column], list[Column]]:
    """Return the columns that fit, in their order, and those that do not, the most wanted first."""
    ranks = sorted({column.rank for column in columns if column.rank > 0})
    kept = {0, *ranks}
    for rank in reversed(ranks):
        if _fit(columns, kept, COMFORTABLE_PROSE if rank >= LUXURY else NARROWEST_PROSE, width):
            break
        kept.discard(rank)
    # What is less wanted may be narrower, and have room where a wider group has none.
    for rank in ranks:
        if rank not in kept and _fit(columns, {*kept, rank}, COMFORTABLE_PROSE, width):
            kept.add(rank)
    left_out = [column for rank in ranks for column in columns if column.rank == rank and rank not in kept]
    return [column for column in columns if column.rank in kept], left_out


def _fit(columns: Sequence[Column], ranks: Collection[int], prose: int, width: int) -> bool:
    """Return whether the columns of some ranks fit, prose broken at a width."""
    needed = [column.least(prose) for column in columns if column.rank in ranks]
    return sum(needed) + GAP * (len(needed) - 1) <= width


def _left_out_words(columns: Sequence[Column]) -> str:
    """Return what is left out: all names, or the first of many where an option chooses among them."""
    names = list(dict.fromkeys(column.called or column.name for column in columns))
    if len(names) <= MOST_NAMED or not all(column.key for column in columns):
        return enumerated(names)
    return f"{', '.join(names[: MOST_NAMED - 1])} and {len(names) - MOST_NAMED + 1} more; --columns chooses"


def enumerated(names: Sequence[str]) -> str:
    """Return names as a list in a sentence."""
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} and {names[-1]}"


def broken(name: str, width: int) -> str:
    """Return a name broken into lines after its hyphens, dots, underscores and blanks.

    Parameters
    ----------
    name : such as `sequential-200` or `grid.theta_bins`
    width : of a line; a piece that is longer stays whole
    """
    pieces, begin = [], 0
    for index, letter in enumerate(name):
        if letter in "-._ /":
            pieces.append(name[begin : index + 1])
            begin = index + 1
    pieces.append(name[begin:])
    lines = [""]
    for piece in pieces:
        if lines[-1] and cell_len(lines[-1] + piece.rstrip()) > width:
            lines.append("")
        lines[-1] += piece
    return "\n".join(line.rstrip() for line in lines)


def repeats(names: Iterable[str]) -> tuple[str, ...]:
    """Return styles that dim a name which only repeats the one above it."""
    styles, above = [], None
    for name in names:
        styles.append(REPEATED if name == above else "")
        above = name
    return tuple(styles)


def _width(text: str) -> int:
    return max((cell_len(line) for line in text.split("\n")), default=0)


def _widths(columns: Sequence[Column], width: int) -> list[int]:
    """Share what the figures leave among the columns of prose, cell by cell."""
    widths = [column.least(NARROWEST_PROSE) for column in columns]
    spare = width - sum(widths) - GAP * (len(columns) - 1)
    growing = True
    while growing and spare > 0:
        growing = False
        for index, column in enumerate(columns):
            if spare > 0 and widths[index] < column.natural:
                widths[index] += 1
                spare -= 1
                growing = True
    # A terminal too narrow even for what must stay breaks names harder.
    while spare < 0:
        prose = [index for index, column in enumerate(columns) if column.prose and widths[index] > 4]
        if not prose:
            break
        widths[max(prose, key=widths.__getitem__)] -= 1
        spare += 1
    return widths


def _cells(column: Column, room: int) -> list[Text]:
    is_broken = room < column.natural
    cells = []
    for text, style in zip(column.cells, column.styles or [""] * len(column.cells), strict=True):
        if is_broken and style == REPEATED:
            # A name of several lines, over and over, would drown the figures.
            text = ""
        elif not column.prose:
            text = _right(text, room)
        elif " " not in text and cell_len(text) > room:
            text = broken(text, room)
        cells.append(Text(text, style=style))
    return cells


def _right(text: str, room: int) -> str:
    """Return a text filled up on the left.

    rich's own flush right strips the blanks at the end that keep decimal points in line.
    """
    return " " * (room - cell_len(text)) + text


def _lines(sentences: Sequence[str], width: int, styles: Sequence[str]) -> Text | None:
    """Return sentences broken for the terminal.

    rich would break them at the width of the table, which may be a narrow one in a wide terminal.
    """
    if not sentences:
        return None
    text = Text(no_wrap=True, overflow="ignore")
    for index, (sentence, style) in enumerate(zip(sentences, styles, strict=False)):
        kept = KEPT_TOGETHER.sub(NO_BREAK, sentence)
        lines = textwrap.wrap(kept, min(width, WIDEST_NOTES), break_on_hyphens=False)
        text.append("\n" if index else "").append("\n".join(lines).replace(NO_BREAK, " "), style=style)
    return text
