"""The columns of a table of models: their fields side by side, groups and vectors opened."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from pydantic import BaseModel
from rich.text import Text

from algorithms.context import Unit
from algorithms.parameters import Path
from hough_tui.ui.forms.alternatives import discriminator
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
    return tuple(_told_apart(_of_kinds(tuple(models), (), unit, elements)))


def _of_kinds(
    kinds: tuple[type[BaseModel], ...], path: Path, unit: Unit | None, elements: Sequence[BaseModel]
) -> list[FieldDescription]:
    """Return the columns of what stands at a path in elements and may be of several kinds."""
    columns: list[FieldDescription] = []
    values = [value_in(element, path) for element in elements]
    for kind in kinds:
        model = next((value for value in values if type(value) is kind), kind)
        # What only some kinds have stands before what follows it there, as in the declaration.
        place = len(columns)
        own = told_apart(ordered(described(model, path, unit)), kinds)
        for column in reversed(list(_opened(own, unit, elements))):
            paths = [other.path for other in columns]
            if column.path in paths:
                place = paths.index(column.path)
            else:
                columns.insert(place, column)
    return columns


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
    """Return whether an element has the field of a column: not every kind has every field.

    What a group has that is not there at all counts as had: to give it is to begin the group.
    """
    here: Any = element
    for part in column.path:
        if isinstance(here, BaseModel) and part not in type(here).model_fields:
            return False
        here = value_in(here, (part,))
    return True


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


def _label_within(group: FieldDescription, inner: FieldDescription) -> str:
    """Return what a field of a group is called in a table: what the group is, by the group's name alone."""
    if inner.path == (*group.path, discriminator(group.models)):
        return group.label
    if isinstance(inner.path[-1], int):
        # A symbol, such as ax, needs no more.
        return inner.label
    return f"{group.label} {within(inner.label)}"


def _opened(
    fields: Sequence[FieldDescription], unit: Unit | None, elements: Sequence[BaseModel]
) -> Iterator[FieldDescription]:
    for field in fields:
        if field.kind is Kind.GROUP:
            inside: Iterable[FieldDescription] = _opened(field.fields, unit, elements)
            if len(field.models) > 1:
                inside = _of_kinds(field.models, field.path, unit, elements)
            for inner in inside:
                yield replace(inner, label=_label_within(field, inner))
        elif field.kind in (Kind.LIST, Kind.MAPPING) or field.is_constant:
            # Lists within lists have tables of their own, and one value need not be repeated.
            continue
        else:
            yield from components(field) or (field,)
