"""Declaration of a parameter: a field of a validated model, with its type, unit, bounds and help line."""

from __future__ import annotations

import typing
from collections.abc import Callable, Mapping
from enum import StrEnum
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

from algorithms.context import Context

LARGEST, LEAST = 1e12, 1e-12
"""Bounds of every number, in whatever unit, and of those that are greater than 0.

No radar has a coordinate, a cell, a spread or a time beyond them. The numbers within them can be squared,
multiplied and divided several times over without becoming infinite or 0.
"""

# Strict: a number is never read out of text or out of true and false.
Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-LARGEST, le=LARGEST)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=LEAST, le=LARGEST)]
NotNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=LARGEST)]
Fraction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]


def _is_no_dust(value: float) -> float:
    if 0.0 < value < LEAST:
        raise PydanticCustomError("dust", "0 or at least {least}", {"least": f"{LEAST:g}"})
    return value


# Noise may be none, but is divided by where there is some.
Deviation = Annotated[
    float, Field(strict=True, allow_inf_nan=False, ge=0, le=LARGEST), AfterValidator(_is_no_dust)
]
# Kernels take whole numbers of a fixed width.
LARGEST_WHOLE = 2**31 - 1
Integer = Annotated[int, Field(strict=True, ge=-LARGEST_WHOLE, le=LARGEST_WHOLE)]
Whole = Annotated[int, Field(strict=True, ge=0, le=LARGEST_WHOLE)]
Count = Annotated[int, Field(strict=True, ge=1, le=LARGEST_WHOLE)]
NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
LONGEST_NAME = 200
Name = Annotated[str, Field(min_length=1, max_length=LONGEST_NAME, pattern=NAME)]
Flag = Annotated[bool, Field(strict=True)]
Auto = Literal["auto"]


class Dimension(StrEnum):
    """What a number measures; it decides the unit in which it is shown."""

    LENGTH = "length"
    SPEED = "speed"
    ACCELERATION = "acceleration"
    ANGLE = "angle"
    TURN_RATE = "turn-rate"
    TIME = "time"
    COUNT = "count"
    FRACTION = "fraction"


def parameter(
    default: Any = ...,
    *,
    help: str,
    dimension: Dimension | None = None,
    auto: str | None = None,
    default_factory: Callable[[], Any] | None = None,
    min_length: int | None = None,
    alias: str | None = None,
) -> Any:
    """Declare a parameter as a field of a model; the bounds of a number belong to its type.

    Parameters
    ----------
    default, default_factory : its value where none is given; without one it must be given
    help : one line for people
    dimension : what the number measures
    auto : how the value is worked out where `auto` is given
    min_length : least number of elements of a list
    alias : the field's name in data, where it differs
    """
    told: Any = {"dimension": dimension and dimension.value, "auto": auto}
    told = {key: value for key, value in told.items() if value} or None
    options: dict[str, Any] = {"description": help, "json_schema_extra": told, "alias": alias}
    if min_length is not None:
        options["min_length"] = min_length
    if default_factory is not None:
        return Field(default_factory=default_factory, **options)
    return Field(default, **options)


def with_default(model: type[BaseModel], name: str, default: Any) -> Any:
    """Declare a parameter of another model once more, with a default of its own."""
    declared = model.model_fields[name]
    told: Any = declared.json_schema_extra
    return Field(default, description=declared.description, json_schema_extra=told)


class Declared(BaseModel):
    """A model whose fields are declared parameters: frozen, and closed to unknown names."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data are meant for this one of several models, by its literals."""
        return all(
            data[name] in typing.get_args(field.annotation)
            for name, field in cls.model_fields.items()
            if typing.get_origin(field.annotation) is Literal and name in data
        )


class Parameters(Declared):
    """The parameters of an initiator."""

    def resolved(self, context: Context) -> Self:
        """Return these parameters with every `auto` worked out from the context."""
        return self
