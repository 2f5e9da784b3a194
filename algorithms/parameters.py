"""The one declaration of a parameter, and the words for what is wrong with a given value.

A parameter's name, type, unit, bounds, default and help line are declared once, as a field
of a validated model. Forms, command line, YAML, JSON Schema, error texts and documentation
are derived from that field.
"""

from __future__ import annotations

import difflib
import types
import typing
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any, Final, Literal, Self, TypeVar, Union

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from algorithms.context import Context
from algorithms.errors import RequestError

Path = tuple[str | int, ...]

Model = TypeVar("Model", bound=BaseModel)

# Strict: a number is never read out of text or out of true and false.
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0)]
NotNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0)]
Fraction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=1)]
# Kernels take whole numbers of a fixed width.
LARGEST_WHOLE = 2**31 - 1
Integer = Annotated[int, Field(strict=True, ge=-LARGEST_WHOLE, le=LARGEST_WHOLE)]
Whole = Annotated[int, Field(strict=True, ge=0, le=LARGEST_WHOLE)]
Count = Annotated[int, Field(strict=True, ge=1, le=LARGEST_WHOLE)]
NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
Name = Annotated[str, Field(min_length=1, pattern=NAME)]
Flag = Annotated[bool, Field(strict=True)]
Auto = Literal["auto"]


MISSING_EITHER: Final = "missing_either"


class Dimension(StrEnum):
    """What a number measures; it decides the unit in which it is shown."""

    LENGTH = "length"
    SPEED = "speed"
    ANGLE = "angle"
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
    def is_meant(cls, data: Mapping[str, Any]) -> bool:
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


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong with given data.

    Attributes
    ----------
    path : where in the data
    message : what was given and what is allowed
    on_key : whether the key is wrong, rather than its value
    """

    path: Path
    message: str
    on_key: bool = False

    @property
    def field(self) -> str:
        """The path as people write it, `targets[0].position[1]`."""
        return dotted(self.path)


class FieldError(RequestError):
    """A wrong request whose place in the given data is known."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(join(problem))
        self.problem = problem


def dotted(path: Path) -> str:
    """Return a path as people write it, `targets[0].position[1]`."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.lstrip(".")


def missing_either(other: str) -> PydanticCustomError:
    """Return the error of a validator of a field that must be given, or something else in its place."""
    return PydanticCustomError(MISSING_EITHER, "missing, and {other} is missing, too", {"other": other})


def validated(model: type[Model], data: Any, what: str) -> Model:
    """Return data as a model.

    Raises
    ------
    RequestError
        One line a problem, each beginning with `what`, where the data are not as declared.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        found = problems(error, model, data)
        raise RequestError("\n".join(f"{what}: {join(problem)}" for problem in found)) from None


def join(problem: Problem) -> str:
    """Return a problem with its field before it."""
    return f"{problem.field}: {problem.message}" if problem.path else problem.message


def problems(error: ValidationError, model: type[BaseModel], data: Any) -> list[Problem]:
    """Return what a validation found, in words, each with its place in the data.

    The alternatives of one field (a number, or `auto`) are one problem.
    """
    gathered: dict[Path, list[Any]] = {}
    for detail in error.errors(include_url=False):
        if detail["type"] == "missing" and isinstance(detail["loc"][-1], int):
            # A list that is too short is wrong itself, not the element that it lacks.
            path = _path_in(data, detail["loc"][:-1], missing=False)
            detail["ctx"] = {"needed": detail["loc"][-1] + 1}
            detail["type"], detail["input"] = "too_few", _value_at(data, path)
        else:
            path = _path_in(data, detail["loc"], missing=detail["type"] in ("missing", MISSING_EITHER))
        gathered.setdefault(path, []).append(detail)
    # Where one alternative fails deeper inside, the failure of the others says nothing more.
    outer = {path[:length] for path in gathered for length in range(len(path))}
    return [_problem(path, details, model, data) for path, details in gathered.items() if path not in outer]


def _problem(path: Path, details: list[Any], model: type[BaseModel], data: Any) -> Problem:
    first = details[0]
    if first["type"] == "extra_forbidden":
        return Problem(path, _unknown(str(path[-1]), fields_at(model, data, path[:-1])), on_key=True)
    if first["type"] == "invalid_key":
        return Problem(path, f"the name {_shown(first['input'])} is no text", on_key=True)
    if first["type"] == "missing":
        return Problem(path, "is missing; it must be given", on_key=True)
    if first["type"] == MISSING_EITHER:
        return Problem(path, f"is missing; it must be given, or {first['ctx']['other']}", on_key=True)
    if first["type"] == "value_error":
        return Problem(path, str(first["ctx"]["error"]))
    if first["type"] == "union_tag_invalid":
        tags = [tag.strip("'") for tag in first["ctx"]["expected_tags"].split(", ")]
        return Problem(path, unknown(first["ctx"]["tag"], tags, "kind"))
    allowed = list(dict.fromkeys(_allowed(detail) for detail in details))
    return Problem(path, f"{_shown(first['input'])} is given; it must be {' or '.join(allowed)}")


def unknown(name: str, known: Sequence[str], what: str) -> str:
    """Return the words for a name that is not known, with the nearest known one."""
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    return f"there is no {what} '{name}'{hint} (known: {', '.join(known) or 'none'})"


def _unknown(name: str, known: Sequence[str]) -> str:
    return unknown(name, known, "field")


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return repr(value)
    if isinstance(value, Mapping):
        return "a mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    if value is None:
        return "nothing"
    return str(value).lower() if isinstance(value, bool) else repr(value)


_ALLOWED = {
    "float_type": "a number",
    "float_parsing": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "finite_number": "a finite number",
    "string_type": "text",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "greater_than": "greater than {gt}",
    "greater_than_equal": "at least {ge}",
    "less_than": "less than {lt}",
    "less_than_equal": "at most {le}",
    "literal_error": "{expected}",
    "enum": "{expected}",
    "too_few": "a list of {needed}",
    "too_short": "a list of at least {min_length}",
    "too_long": "a list of at most {max_length}",
    "string_too_short": "at least {min_length} characters long",
    "string_pattern_mismatch": "of the form {pattern}",
    "list_type": "a list",
    "tuple_type": "a list",
    "dict_type": "a mapping of names to values",
    "model_type": "a mapping of names to values",
    "model_attributes_type": "a mapping of names to values",
    "union_tag_not_found": "a mapping that says which kind it is",
    "none_required": "null",
    "int_parsing_size": "a smaller whole number",
}


def _allowed(detail: Any) -> str:
    words = _ALLOWED.get(detail["type"])
    context = {name: _written(value) for name, value in detail.get("ctx", {}).items()}
    return words.format(**context) if words else str(detail["msg"])


def _written(value: Any) -> Any:
    return f"{value:.15g}" if isinstance(value, float) else value


def _path_in(data: Any, location: Sequence[str | int], *, missing: bool) -> Path:
    """Return the part of a pydantic location that the data have: the tags of unions are no part of it."""
    path: list[str | int] = []
    here = data
    for position, part in enumerate(location):
        if isinstance(here, BaseModel):
            here = here.__dict__
        if isinstance(here, Mapping) and part in here:
            here = here[part]
        elif isinstance(here, list | tuple) and isinstance(part, int) and part < len(here):
            here = here[part]
        elif not (missing and position == len(location) - 1):
            continue
        path.append(part)
    return tuple(path)


def _value_at(data: Any, path: Path) -> Any:
    for part in path:
        data = data[part]
    return data


def numeric_paths(model: BaseModel) -> Iterator[Path]:
    """Yield the path of every field of a model that takes a number, and of every number in its lists."""
    for name, field in type(model).model_fields.items():
        if any(kind in (int, float) for kind in _alternatives(field.annotation)):
            yield (name,)
        value = getattr(model, name)
        for index, element in [((), value)] if isinstance(value, BaseModel) else _numbered(value):
            if isinstance(element, BaseModel):
                yield from ((name, *index, *path) for path in numeric_paths(element))
            elif isinstance(element, int | float) and not isinstance(element, bool):
                yield (name, *index)


def _numbered(value: Any) -> list[tuple[tuple[int, ...], Any]]:
    return [((i,), element) for i, element in enumerate(value)] if isinstance(value, list | tuple) else []


def replaced(model: Model, values: Mapping[Path, Any]) -> Model:
    """Return a model with the values at some paths replaced together, validated anew.

    Raises
    ------
    FieldError
        Where a value is not allowed at its place.
    """
    data = model.model_dump(mode="json")
    for path, value in values.items():
        here: Any = data
        for part in path[:-1]:
            here = here[part]
        here[path[-1]] = value
    try:
        return type(model).model_validate(data)
    except ValidationError as error:
        raise FieldError(problems(error, type(model), data)[0]) from None


def fields_at(model: type[BaseModel], data: Any, path: Path) -> list[str]:
    """Return the names that a mapping at a place of the data may have."""
    return list(
        dict.fromkeys(
            field.alias or name
            for found in _models_at(model, data, path)
            for name, field in found.model_fields.items()
        )
    )


def field_at(model: type[BaseModel], path: Path) -> FieldInfo | None:
    """Return the declaration of the field at a path; None where there is none."""
    candidates: list[Any] = [model]
    field: FieldInfo | None = None
    for part in path:
        inner: list[Any] = []
        for candidate in candidates:
            if isinstance(part, str) and isinstance(candidate, type) and issubclass(candidate, BaseModel):
                if part in candidate.model_fields:
                    field = candidate.model_fields[part]
                    inner.extend(_alternatives(field.annotation))
            elif isinstance(part, int):
                inner.extend(_elements(candidate, part))
        if not inner:
            return None
        candidates = inner
    return field


def _models_at(model: type[BaseModel], data: Any, path: Path) -> list[type[BaseModel]]:
    candidates: list[Any] = [model]
    here = data
    for part in path:
        inner: list[Any] = []
        for candidate in candidates:
            if isinstance(part, int):
                inner.extend(_elements(candidate, part))
            elif isinstance(candidate, type) and issubclass(candidate, BaseModel):
                declared = candidate.model_fields.get(part)
                inner.extend(_alternatives(declared.annotation) if declared else ())
        candidates = inner
        try:
            here = here[part]
        except (KeyError, IndexError, TypeError):
            here = None
    models = [found for found in candidates if isinstance(found, type) and issubclass(found, BaseModel)]
    if not isinstance(here, Mapping):
        return models
    meant = [found for found in models if not issubclass(found, Declared) or found.is_meant(here)]
    return meant or models


def _alternatives(annotation: Any) -> Iterator[Any]:
    """Yield what an annotation may stand for, unions and annotations opened."""
    origin = typing.get_origin(annotation)
    if origin is Annotated:
        yield from _alternatives(typing.get_args(annotation)[0])
    elif origin in (Union, types.UnionType):
        for argument in typing.get_args(annotation):
            yield from _alternatives(argument)
    else:
        yield annotation


def _elements(annotation: Any, index: int) -> Iterator[Any]:
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is list:
        yield from _alternatives(arguments[0])
    elif origin is tuple and arguments:
        if len(arguments) == 2 and arguments[1] is Ellipsis:
            yield from _alternatives(arguments[0])
        elif index < len(arguments):
            yield from _alternatives(arguments[index])
