"""The fields of a declared model, as a form shows them: all of it taken from the declaration."""

from __future__ import annotations

import enum
import typing
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from algorithms.context import Unit
from algorithms.parameters import Dimension, Path
from hough_tui.ui.forms.alternatives import (
    Alternative,
    alternatives,
    discriminator,
    models,
    number_bounds,
    tag,
    text_bounds,
)
from hough_tui.ui.forms.labels import component_names, label_of
from hough_tui.ui.forms.numbers import ONE_NUMBER, Wanted

NAME = "name"
"""The field by which the elements of a list are told apart."""


class Kind(enum.StrEnum):
    """How a field is edited."""

    NUMBER = "number"
    WHOLE = "whole"
    VECTOR = "vector"
    CHOICE = "choice"
    TEXT = "text"
    FLAG = "flag"
    VECTORS = "vectors"
    """Several vectors, such as places."""
    TEXTS = "texts"
    """Several texts, such as names."""
    MAPPING = "mapping"
    """Names, each with numbers."""
    GROUP = "group"
    """A model within the model."""
    LIST = "list"
    """Several models."""


@dataclass(frozen=True, slots=True)
class FieldDescription:
    """A field as a form shows it.

    Attributes
    ----------
    path : where it stands
    label : what it is called
    kind : how it is edited
    help : its help line
    unit : the unit in which it is shown; empty where it has none
    bounds : what its values may be, in words; empty where they may be anything
    default : the value where none is given; meaningless where it is `required`
    auto : how its value is worked out where it is `auto`; empty where it has no such value
    optional : whether it may be empty
    required : whether it has no default
    choices : the values of a choice
    wanted : what numbers are read for it
    parts : what the numbers of a vector are called, where the declaration says so
    fields : the fields of a group
    models : the models that a group or the elements of a list may be of
    """

    path: Path
    label: str
    kind: Kind
    help: str
    unit: str = ""
    bounds: str = ""
    default: Any = None
    auto: str = ""
    optional: bool = False
    required: bool = False
    choices: tuple[str, ...] = ()
    wanted: Wanted = ONE_NUMBER
    parts: tuple[str, ...] = ()
    fields: tuple[FieldDescription, ...] = ()
    models: tuple[type[BaseModel], ...] = ()

    @property
    def title(self) -> str:
        """The label with its unit."""
        return f"{self.label} [{self.unit}]" if self.unit else self.label

    @property
    def is_numeric(self) -> bool:
        """Whether it is typed as numbers."""
        return self.kind in (Kind.NUMBER, Kind.WHOLE, Kind.VECTOR)

    @property
    def is_constant(self) -> bool:
        """Whether it has but one value."""
        return self.kind is Kind.CHOICE and len(self.choices) == 1 and not self.optional


def described(
    model: type[BaseModel] | BaseModel, path: Path = (), unit: Unit | None = None
) -> tuple[FieldDescription, ...]:
    """Return the fields of a model, or of an instance, which says itself what its unions are.

    Parameters
    ----------
    path : where the model stands
    unit : the unit of lengths; a model that has a unit uses its own
    """
    declared = model if isinstance(model, type) else type(model)
    own = getattr(model, "unit", None)
    unit = own if isinstance(own, Unit) else unit
    return tuple(
        _described(name, field, (*path, name), unit, getattr(model, name, None))
        for name, field in declared.model_fields.items()
    )


def walk(fields: Sequence[FieldDescription]) -> Iterator[FieldDescription]:
    """Yield fields and, after each group, its fields."""
    for field in fields:
        yield field
        yield from walk(field.fields)


def ordered(fields: Sequence[FieldDescription]) -> list[FieldDescription]:
    """Return fields as people look for them: what it is, then its values, its groups, its lists."""

    def place(field: FieldDescription) -> tuple[bool, bool, bool]:
        says_what = field.path[-1] == NAME or field.is_constant
        return field.kind is Kind.LIST, field.kind is Kind.GROUP, not says_what

    return [replace(field, fields=tuple(ordered(field.fields))) for field in sorted(fields, key=place)]


def components(field: FieldDescription) -> tuple[FieldDescription, ...]:
    """Return the numbers of a vector as fields of their own; none where they have no names."""
    kind = Kind.WHOLE if field.wanted.whole else Kind.NUMBER
    one = Wanted(field.wanted.whole)
    return tuple(
        replace(field, path=(*field.path, index), label=part, kind=kind, wanted=one, parts=())
        for index, part in enumerate(field.parts)
    )


def unit_text(dimension: Dimension | None, unit: Unit | None) -> str:
    """Return the unit of what is measured; lengths have the scenario's, where it is known."""
    length = "length" if unit is None else unit.value
    units = {
        Dimension.LENGTH: length,
        Dimension.SPEED: f"{length}/s",
        Dimension.ACCELERATION: f"{length}/s²",
        Dimension.ANGLE: "°",
        Dimension.TURN_RATE: "°/s",
        Dimension.TIME: "s",
    }
    return units.get(dimension, "") if dimension else ""


def _described(name: str, field: FieldInfo, path: Path, unit: Unit | None, value: Any) -> FieldDescription:
    found = list(alternatives(field.annotation, tuple(field.metadata)))
    extra: Any = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    dimension = Dimension(extra["dimension"]) if "dimension" in extra else None
    plain = FieldDescription(
        path=path,
        label=label_of(name),
        kind=Kind.TEXT,
        help=field.description or "",
        unit=unit_text(dimension, unit),
        default=None if field.is_required() else field.get_default(call_default_factory=True),
        auto=extra.get("auto", ""),
        optional=any(one.kind is type(None) for one in found),
        required=field.is_required(),
    )
    given = [one for one in found if one.kind is not type(None)]
    if models(given):
        return _group(plain, models(given), unit, value)
    return _of_kind(plain, given, value)


def _group(
    plain: FieldDescription, found: tuple[type[BaseModel], ...], unit: Unit | None, value: Any
) -> FieldDescription:
    inside = described(value if isinstance(value, BaseModel) else found[0], plain.path, unit)
    if plain.optional:
        # Nothing in a field of such a group means that the group is not there.
        inside = tuple(
            replace(field, optional=True, wanted=replace(field.wanted, optional=True)) for field in inside
        )
    return replace(plain, kind=Kind.GROUP, models=found, fields=told_apart(inside, found))


def told_apart(
    fields: Sequence[FieldDescription], found: tuple[type[BaseModel], ...]
) -> tuple[FieldDescription, ...]:
    """Return the fields of one of several models; the one that tells them apart offers them all."""
    name = discriminator(found)
    return tuple(
        replace(field, choices=tuple(tag(model, name) or "" for model in found))
        if name and field.path[-1] == name
        else field
        for field in fields
    )


def _of_kind(plain: FieldDescription, found: list[Alternative], value: Any) -> FieldDescription:
    elements = [element for one in found for element in one.elements]
    words = tuple(word for one in found for word in one.choices)
    others = [one for one in found if not one.choices]
    kinds = [one.kind for one in found]
    if models(elements):
        return replace(plain, kind=Kind.LIST, models=models(elements))
    if words and not others:
        return replace(plain, kind=Kind.CHOICE, choices=words)
    if bool in kinds:
        return replace(plain, kind=Kind.FLAG)
    if any(typing.get_origin(kind) is dict for kind in kinds):
        return replace(plain, kind=Kind.MAPPING, wanted=Wanted(size=None))
    sizes = [element.length for element in elements if element.elements and element.length is not None]
    if sizes:
        return replace(plain, kind=Kind.VECTORS, wanted=Wanted(size=sizes[0], others=tuple(sizes[1:])))
    if any(element.kind is str for element in elements):
        return replace(plain, kind=Kind.TEXTS)
    return _numeric(plain, others, words, value)


def _numeric(
    plain: FieldDescription, found: list[Alternative], words: tuple[str, ...], value: Any
) -> FieldDescription:
    several = [one for one in found if one.elements]
    # Of vectors of several sizes, the one that is there.
    several.sort(key=lambda one: not (isinstance(value, tuple) and one.length == len(value)))
    single = [one for one in found if one.kind in (int, float)]
    elements = [element for one in several for element in one.elements]
    numbers = single + [element for element in elements if element.kind in (int, float)]
    if not numbers:
        return replace(plain, bounds=text_bounds(found))
    whole = all(number.kind is int for number in numbers)
    size = several[0].length if several else 0
    others = tuple(one.length for one in several[1:] if one.length is not None)
    wanted = Wanted(whole, size, others, bool(several and single), words, plain.optional)
    # A vector that may be one number, a word or nothing is typed as a whole.
    names = () if wanted.single or words or plain.optional else component_names(plain.help)
    parts = names[:size] if others else names
    return replace(
        plain,
        kind=Kind.VECTOR if several else Kind.WHOLE if whole else Kind.NUMBER,
        bounds=number_bounds(numbers),
        wanted=wanted,
        parts=parts if several and len(parts) == size else (),
    )
