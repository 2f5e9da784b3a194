"""Tables in CSV: columns of numbers by their names, errors with file, line and column.

A file begins with a header; names count whatever their case and the spaces around them. Blank
lines are not rows. Columns that a table does not know are carried along as text; those that it
knows must hold a number in every row.
"""

from __future__ import annotations

import csv
import difflib
import io
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.parameters import listed, shortened

# Rows are converted by the block, since their text takes many times the room of their numbers. Blocks
# this small die before the garbage collector looks at them, which takes longer than all else.
BLOCK = 256
LARGEST_SCAN = 2**31 - 1

MOST_COMPARED = 200
"""The most columns among which a misspelt one is sought: a table of numbers alone may have very many."""

Numbers = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class NumberColumn:
    """What a column of numbers may hold.

    Attributes
    ----------
    allowed : that in words
    holds : which of finite numbers it may hold; None for all of them
    is_whole : whether these are whole numbers
    """

    allowed: str = "a finite number"
    holds: Callable[[Numbers], NDArray[np.bool_]] | None = None
    is_whole: bool = False


def within(farthest: float) -> NumberColumn:
    """Return a column of numbers up to so far from 0 on either side."""
    return NumberColumn(
        f"a number from {-farthest:g} to {farthest:g}", lambda values: np.abs(values) <= farthest
    )


SCAN = NumberColumn(
    f"a whole number from 0 to {LARGEST_SCAN}",
    lambda values: (values >= 0.0) & (values <= LARGEST_SCAN) & (values == np.floor(values)),
    is_whole=True,
)


@dataclass(frozen=True, slots=True)
class TableForm:
    """The columns of a table.

    Attributes
    ----------
    numbers : the columns that it knows, by their lower-case names
    needed : those that must be there
    either : two of which one must be there; None for no such pair
    rows : what its rows are called
    """

    numbers: Mapping[str, NumberColumn]
    needed: tuple[str, ...]
    either: tuple[str, str] | None = None
    rows: str = "points"

    @property
    def header(self) -> str:
        """What a header must have, in words."""
        *others, last = [*self.needed, *([" or ".join(self.either)] if self.either else [])]
        return f"{', '.join(others)} and {last}"


def parse_columns(
    text: str, source: str, form: TableForm
) -> tuple[dict[str, Numbers], dict[str, tuple[str, ...]]]:
    """Return the columns of numbers of a CSV text by their lower-case names, and the further ones as text.

    Parameters
    ----------
    text : the file's content
    source : what errors call the file
    form : the columns of the table

    Raises
    ------
    RequestError
        One line with the file's line and column, what is given and what is allowed.
    """
    text = text.removeprefix("\ufeff")
    _check_delimiter(text, source, form)
    records = read_records(text, source)
    names = _names(*next(records, (1, [""])), source, form)
    keys = [name.casefold() for name in names]
    numbers: dict[str, list[Numbers]] = {key: [] for key in keys if key in form.numbers}
    extra: dict[str, list[str]] = {name: [] for name in names if name.casefold() not in form.numbers}
    width, rows = len(names), 0
    while block := list(islice(records, BLOCK)):
        for line, cells in block:
            if len(cells) != width:
                hint = "; quote a text with a comma, write numbers with a point" if len(cells) > width else ""
                given = f"the header has {width} columns, this row {len(cells)}"
                raise RequestError(f"{source}:{line}: {given}{hint}")
        for at, column in enumerate(zip(*(cells for _, cells in block), strict=True)):
            if keys[at] not in numbers:
                extra[names[at]].extend(column)
                continue
            allowed = form.numbers[keys[at]]
            values = _numbers(column, allowed)
            if values is None:
                wrong = next(row for row, cell in enumerate(column) if _numbers([cell], allowed) is None)
                _refuse(source, *block[wrong], at, names[at], allowed)
            numbers[keys[at]].append(values)
        rows += len(block)
    if not rows:
        raise RequestError(f"{source}: the file has a header and no rows of {form.rows} below it")
    texts = {name: tuple(cells) for name, cells in extra.items()}
    return {key: np.concatenate(parts) for key, parts in numbers.items()}, texts


def _check_delimiter(text: str, source: str, form: TableForm) -> None:
    """Refuse an empty file and another delimiter, beside which quotes would be reported instead."""
    if not text.strip():
        raise RequestError(f"{source}: the file is empty; it must have a header with {form.header}")
    line, header = next((line, part) for line, part in enumerate(_lines(text), 1) if part.strip())
    other = "';'" if ";" in header else "a tab" if "\t" in header else None
    if other and not {part.strip(' "\t\r\n').casefold() for part in header.split(",")} & set(form.numbers):
        raise RequestError(f"{source}:{line}: the delimiter is {other}; it must be a comma")


def _names(line: int, header: Sequence[str], source: str, form: TableForm) -> list[str]:
    """Return the names of the columns, spaces stripped."""
    names = [cell.strip() for cell in header]
    keys = [name.casefold() for name in names]
    places: dict[str, int] = {}
    for at, key in enumerate(keys):
        if (first := places.setdefault(key, at)) < at:
            both = f"columns {first + 1} and {at + 1} are both called {shortened(names[at])!r}"
            raise RequestError(f"{source}:{line}: {both}; names must differ, in more than case")
    lacks = {f"no column {name!r}": [name] for name in form.needed if name not in keys}
    if form.either and not set(form.either) & set(keys):
        lacks["neither {!r} nor {!r}".format(*form.either)] = list(form.either)
    if lacks:
        near = [found for wanted in lacks.values() for name in wanted if (found := _nearest(name, names))]
        hint = (
            "; rename " + " and ".join(map(repr, map(shortened, dict.fromkeys(near)))) + ", if that is it"
            if near
            else ""
        )
        has = listed([repr(shortened(name)) for name in names], 20)
        raise RequestError(f"{source}:{line}: there is {' and '.join(lacks)}; the header has {has}{hint}")
    return names


def _nearest(wanted: str, names: Sequence[str]) -> str | None:
    """Return the name most like a wanted one: one that has it as a word (`x_km`), or is spelt alike."""
    keys = {name.casefold(): name for name in names[:MOST_COMPARED]}
    alike = [key for key in keys if wanted in re.findall(r"[a-z]+", key)]
    return next((keys[key] for key in alike or difflib.get_close_matches(wanted, keys, 1)), None)


def _lines(text: str) -> io.TextIOWrapper:
    """Return the lines of a text, their ends kept."""
    # A quarter of the room of StringIO; splitlines would split inside fields, as at U+2028.
    data = io.BytesIO(text.encode("utf-8", "surrogatepass"))
    return io.TextIOWrapper(data, "utf-8", "surrogatepass", newline="")


def read_records(text: str, source: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the header and each row that is not blank, with the line on which it begins."""
    reader = csv.reader(_lines(text), strict=True)
    line = 1
    try:
        for cells in reader:
            if len(cells) > 1 or (cells and cells[0].strip()):
                yield line, cells
            line = reader.line_num + 1
    except csv.Error as error:
        raise RequestError(
            f"{source}:{line}: the row that begins here cannot be read ({error}); a field that opens with a "
            "quote must end with one, and a quote inside it must be doubled"
        ) from None


def _numbers(cells: Sequence[str], column: NumberColumn) -> Numbers | None:
    """Return cells as numbers, or None where one is not a number that the column allows."""
    try:
        values = np.fromiter(map(float, cells), np.float64, len(cells))
    except ValueError:
        return None
    good = np.isfinite(values)
    if column.holds is not None:
        good &= column.holds(values)
    # To Python 1_2 is 12; in a file it is more likely a number of two parts.
    return values if good.all() and "_" not in "".join(cells) else None


def _refuse(
    source: str, line: int, cells: Sequence[str], at: int, name: str, column: NumberColumn
) -> NoReturn:
    """Say what is wrong with one field of the row that begins on a line."""
    line += sum(len(re.findall(r"\r\n?|\n", cell)) for cell in cells[:at])
    cell = cells[at].strip()
    given = f"{shortened(cell, 40)!r} is given" if cell else "nothing is given"
    allowed = "a number" + (" with a decimal point" if "," in cell else "")
    if column.is_whole:
        allowed = column.allowed
    else:
        with suppress(ValueError):
            # A number that is good in itself was refused for how it is written.
            is_good = _numbers([repr(float(cell))], column) is not None
            allowed = allowed if is_good else column.allowed
    raise RequestError(f"{source}:{line}: column {shortened(name)!r}: {given}; it must be {allowed}")
