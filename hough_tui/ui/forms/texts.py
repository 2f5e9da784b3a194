"""The value of a field as text, and back."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from hough_tui.ui.forms.fields import FieldDescription, Kind
from hough_tui.ui.forms.numbers import Unreadable, number_text, numbers_text, read

YES, NO = "yes", "no"


def text_of(field: FieldDescription, value: Any) -> str:
    """Return a value as the text that reads as it; empty where there is none."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return YES if value else NO
    if isinstance(value, Mapping):
        return "; ".join(f"{name}: {numbers_text(numbers)}" for name, numbers in value.items())
    if field.kind is Kind.VECTORS and isinstance(value, list | tuple):
        return "; ".join(map(numbers_text, value))
    if isinstance(value, list | tuple):
        return ", ".join(text_of(field, element) for element in value)
    if isinstance(value, int | float):
        return number_text(value)
    return str(value)


def value_of(field: FieldDescription, text: str) -> Any | Unreadable:
    """Return what a text means for a field.

    Text itself is kept as it was typed: whether it will do is for the model to say.
    """
    match field.kind:
        case Kind.NUMBER | Kind.WHOLE | Kind.VECTOR:
            return read(text, field.wanted)
        case Kind.VECTORS:
            return _vectors(field, text)
        case Kind.TEXTS:
            names = re.split(r"[,;\s]+", text.strip(" \t,;"))
            return [name for name in names if name] or (None if field.optional else [])
        case Kind.MAPPING:
            return _mapping(field, text)
        case _:
            return None if field.optional and not text.strip() else text


def next_of(field: FieldDescription, value: Any) -> Any:
    """Return the value after this one, of a flag or a choice."""
    if field.kind is Kind.FLAG:
        return not value
    at = field.choices.index(str(value)) if value is not None else -1
    return field.choices[(at + 1) % len(field.choices)]


def shown(value: Any) -> str:
    """Return a value that was worked out, as short as it can be read."""
    if isinstance(value, list | tuple):
        return ", ".join(map(shown, value))
    if isinstance(value, float) and not isinstance(value, bool):
        return number_text(float(f"{value:.6g}"))
    return str(value)


def _vectors(field: FieldDescription, text: str) -> list[Any] | Unreadable:
    vectors = [read(part, field.wanted) for part in text.strip(" \t;").split(";")]
    unreadable = next((vector for vector in vectors if isinstance(vector, Unreadable)), None)
    return vectors if unreadable is None else unreadable


def _mapping(field: FieldDescription, text: str) -> dict[str, list[float | int]] | Unreadable:
    found: dict[str, list[float | int]] = {}
    for entry in filter(None, (part.strip() for part in re.split(r"[;\n]", text))):
        name, colon, numbers = (part.strip() for part in entry.partition(":"))
        if not colon or not name:
            return Unreadable(
                f"'{entry}' is given; it must be a name with its values, as in 'scans: 5, 10, 15'"
            )
        if name in found:
            return Unreadable(f"'{name}' is given twice")
        value = read(numbers, field.wanted)
        if isinstance(value, Unreadable):
            return Unreadable(f"{name}: {value.message}")
        assert isinstance(value, tuple)
        found[name] = list(value)
    return found
