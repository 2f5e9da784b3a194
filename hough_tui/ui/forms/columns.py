"""The columns of a table of models: their fields side by side, groups and vectors opened."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from pydantic import BaseModel
from rich.text import Text

from algorithms.context import Unit
from hough_tui.ui.forms.edits import value_in
from hough_tui.ui.forms.fields import FieldDescription, Kind, components, described, ordered, told_apart
from hough_tui.ui.forms.labels import label_of, within
from hough_tui.ui.forms.texts import text_of

INHERITED = "dim italic"
"""The style of a value that is not given here but taken from around."""

SYMBOL = 2
"""The most letters of a symbol."""


def columns_of(
    models: Sequence[type[BaseModel]], unit: Unit | None, elements: Sequence[BaseModel] = ()
) -> tuple[FieldDescription, ...]:
    """Return the columns of elements of some models; their paths begin within the element.

    Parameters
    ----------
    elements : those that there are: they say which of several sizes their vectors have
    """
    found: list[FieldDescription] = []
    for kind in models:
        model = next((element for element in elements if type(element) is kind), kind)
        # What only some kinds of elements have stands before what follows it there, as in the declaration.
        place = len(found)
        own = told_apart(ordered(described(model, (), unit)), tuple(models))
        for column in reversed(list(_opened(own))):
            paths = [known.path for known in found]
            if column.path in paths:
                place = paths.index(column.path)
            else:
                found.insert(place, column)
    return tuple(_told_apart(found))


def _told_apart(columns: Sequence[FieldDescription]) -> Iterator[FieldDescription]:
    """Yield columns, those of vectors with the vector's name where theirs alone would not tell which.

    Symbols, such as vx, tell it unless there are two of them; words, such as nearest or first, do not.
    """
    labels = [column.label.casefold() for column in columns]
    for column in columns:
        is_component = isinstance(column.path[-1], int)
        if is_component and (labels.count(column.label.casefold()) > 1 or len(column.label) > SYMBOL):
            yield replace(column, label=f"{label_of(str(column.path[-2]))} {column.label}")
        else:
            yield column


def has(element: BaseModel, column: FieldDescription) -> bool:
    """Return whether an element has the field of a column: not every kind has every field."""
    return column.path[0] in type(element).model_fields


def heading(label: str, unit: str, *, right: bool) -> Text:
    """Return the heading of a column, its unit below it."""
    return Text(f"{label}\n[{unit}]" if unit else label, justify="right" if right else "left")


def cell(column: FieldDescription, element: BaseModel, holder: BaseModel | None) -> Text:
    """Return the cell of an element.

    Parameters
    ----------
    holder : what the list is part of: a group that an element lacks is taken from there
    """
    value, style = value_in(element, column.path), ""
    if value is None and len(column.path) > 1:
        value, style = inherited(column, holder), INHERITED
    return Text(text_of(column, value), style, justify="right" if is_right(column) else "left", no_wrap=True)


def inherited(column: FieldDescription, holder: BaseModel | None) -> Any:
    """Return what stands for an empty cell; None where nothing does."""
    return value_in(holder, column.path) if holder is not None and column.optional else None


def is_right(column: FieldDescription) -> bool:
    """Return whether the cells of a column stand at its right."""
    return column.kind in (Kind.NUMBER, Kind.WHOLE)


def _opened(fields: Sequence[FieldDescription]) -> Iterator[FieldDescription]:
    for field in fields:
        if field.kind is Kind.GROUP:
            for inner in _opened(field.fields):
                yield replace(inner, label=f"{field.label} {within(inner.label)}")
        elif field.kind in (Kind.LIST, Kind.MAPPING) or field.is_constant:
            # Lists within lists have tables of their own, and one value need not be repeated.
            continue
        else:
            yield from components(field) or (field,)
