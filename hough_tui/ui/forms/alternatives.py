"""What the annotation of a declared field allows: its alternatives, their choices and their bounds."""

from __future__ import annotations

import enum
import types
import typing
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union

from annotated_types import Ge, Gt, Le, Lt, MinLen
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from algorithms.parameters import LARGEST, LARGEST_WHOLE, LEAST
from hough_tui.ui.forms.numbers import number_text


@dataclass(frozen=True, slots=True)
class Alternative:
    """One of the types that a field may be of, with what is said of it."""

    kind: Any
    metadata: tuple[Any, ...] = ()

    @property
    def choices(self) -> tuple[str, ...]:
        """The values of a literal or an enumeration."""
        if typing.get_origin(self.kind) is Literal:
            return tuple(str(choice) for choice in typing.get_args(self.kind))
        if isinstance(self.kind, type) and issubclass(self.kind, enum.Enum):
            return tuple(str(choice.value) for choice in self.kind)
        return ()

    @property
    def elements(self) -> tuple[Alternative, ...]:
        """What the elements of a list or a tuple may be."""
        if typing.get_origin(self.kind) not in (list, tuple):
            return ()
        arguments = typing.get_args(self.kind)
        return tuple(
            inner for argument in arguments if argument is not Ellipsis for inner in alternatives(argument)
        )

    @property
    def length(self) -> int | None:
        """How many elements a tuple has; None where there may be any number."""
        arguments = typing.get_args(self.kind)
        is_fixed = typing.get_origin(self.kind) is tuple and Ellipsis not in arguments
        return len(arguments) if is_fixed else None


def alternatives(annotation: Any, metadata: tuple[Any, ...] = ()) -> Iterator[Alternative]:
    """Yield what an annotation may stand for, unions and annotations opened.

    Parameters
    ----------
    metadata : what is said of all of them
    """
    origin = typing.get_origin(annotation)
    if origin is Annotated:
        base, *said = typing.get_args(annotation)
        inner = (part for one in said for part in (one.metadata if isinstance(one, FieldInfo) else [one]))
        yield from alternatives(base, (*metadata, *inner))
    elif origin in (Union, types.UnionType):
        for argument in typing.get_args(annotation):
            yield from alternatives(argument, metadata)
    else:
        yield Alternative(annotation, metadata)


def models(found: Iterable[Alternative]) -> tuple[type[BaseModel], ...]:
    """Return those alternatives that are models."""
    kinds = (one.kind for one in found)
    return tuple(kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel))


def tag(model: type[BaseModel], name: str) -> str | None:
    """Return the one value that a field of a model can have; None where it has more."""
    field = model.model_fields.get(name)
    choices = Alternative(field.annotation).choices if field else ()
    return choices[0] if len(choices) == 1 else None


def discriminator(found: tuple[type[BaseModel], ...]) -> str | None:
    """Return the field whose one value says which of several models it is; None for a single model."""
    if len(found) < 2:
        return None
    for name in found[0].model_fields:
        tags = [tag(model, name) for model in found]
        if None not in tags and len(set(tags)) == len(tags):
            return name
    return None


def number_bounds(numbers: Iterable[Alternative]) -> str:
    """Return the tightest of the bounds that the types and the field itself set, in words."""
    said: list[Any] = [part for number in numbers for part in number.metadata]
    lows: list[tuple[Any, int]] = [_low(part.ge) for part in said if isinstance(part, Ge)]
    lows += [(part.gt, 1) for part in said if isinstance(part, Gt)]
    highs: list[tuple[Any, int]] = [(part.le, 0) for part in said if isinstance(part, Le)]
    highs += [(part.lt, -1) for part in said if isinstance(part, Lt)]
    # Where two are at one number, the strict one is the tighter.
    low, high = max(lows, default=None), min(highs, default=None)
    words = []
    # Those of all numbers are bounds that nobody meets.
    if low is not None and low[0] not in (-LARGEST, -LARGEST_WHOLE):
        words.append(f"{'greater than' if low[1] else 'at least'} {number_text(low[0])}")
    if high is not None and high[0] not in (LARGEST, LARGEST_WHOLE):
        words.append(f"{'less than' if high[1] else 'at most'} {number_text(high[0])}")
    return ", ".join(words)


def _low(bound: Any) -> tuple[Any, int]:
    return (0, 1) if bound == LEAST else (bound, 0)


def text_bounds(found: Iterable[Alternative]) -> str:
    """Return what a text must look like, in words."""
    said: list[Any] = [part for one in found for part in one.metadata]
    patterns = [part.pattern for part in said if getattr(part, "pattern", None)]
    if patterns:
        return f"of the form {patterns[0]}"
    lengths = [part.min_length for part in said if isinstance(part, MinLen)]
    return f"at least {max(lengths)} characters long" if lengths else ""
