"""Validation of data against declared models, and the words for what is wrong in them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeVar

from pydantic import BaseModel, TypeAdapter, ValidationError
from pydantic_core import PydanticCustomError

from algorithms.errors import RequestError
from algorithms.parameters.declaration import LARGEST, LEAST
from algorithms.parameters.paths import Path, dotted, fields_at, path_in, value_at
from algorithms.parameters.words import shortened, unknown

Model = TypeVar("Model", bound=BaseModel)

MISSING_EITHER: Final = "missing_either"

LONGEST_PATH = 160
"""The most characters of a field's path that a message repeats."""

MOST_PROBLEMS = 50
"""The most problems that are listed, one a line."""


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
        raise RequestError(lines([f"{what}: {join(problem)}" for problem in found], what)) from None


def checked(value: Any, declared: Any, what: str) -> Any:
    """Return a value that a declared type allows, such as that of an option.

    Parameters
    ----------
    value : as it was given
    declared : the type with its bounds, such as `Positive`
    what : what errors call it

    Raises
    ------
    RequestError
        Where the type does not allow it.
    """
    try:
        return TypeAdapter(declared).validate_python(value)
    except ValidationError as error:
        allowed = dict.fromkeys(_allowed(detail) for detail in error.errors(include_url=False))
        raise RequestError(f"{what} {_shown(value)}: it must be {' or '.join(allowed)}") from None


def join(problem: Problem) -> str:
    """Return a problem with its field before it."""
    return f"{shortened(problem.field, LONGEST_PATH)}: {problem.message}" if problem.path else problem.message


def lines(messages: Sequence[str], what: str) -> str:
    """Return messages one a line; of very many the first, and how many more there are in `what`."""
    more = len(messages) - MOST_PROBLEMS
    rest = [f"{what}: … {more:,} more"] if more > 0 else []
    return "\n".join([*messages[:MOST_PROBLEMS], *rest])


def problems(error: ValidationError, model: type[BaseModel], data: Any) -> list[Problem]:
    """Return what a validation found, in words, each with its place in the data.

    The alternatives of one field (a number, or `auto`) are one problem.
    """
    gathered: dict[Path, list[Any]] = {}
    for detail in error.errors(include_url=False):
        if detail["type"] == "missing" and isinstance(detail["loc"][-1], int):
            # A list that is too short is wrong itself, not the element that it lacks.
            path = path_in(data, detail["loc"][:-1], missing=False)
            detail["ctx"] = {"needed": detail["loc"][-1] + 1}
            detail["type"], detail["input"] = "too_few", value_at(data, path)
        else:
            path = path_in(data, detail["loc"], missing=detail["type"] in ("missing", MISSING_EITHER))
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


def _unknown(name: str, known: Sequence[str]) -> str:
    return unknown(name, known, "field")


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return repr(shortened(value))
    if isinstance(value, Mapping):
        return "a mapping"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    if value is None:
        return "nothing"
    return str(value).lower() if isinstance(value, bool) else shortened(repr(value))


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
    "string_too_long": "at most {max_length} characters long",
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
    if detail.get("ctx", {}).get("ge") == LEAST and detail["input"] <= 0:
        # The least of positive numbers is news only to those who came close to it.
        return "greater than 0"
    context = {name: _written(value) for name, value in detail.get("ctx", {}).items()}
    return words.format(**context) if words else str(detail["msg"])


def _written(value: Any) -> Any:
    if not isinstance(value, float):
        return value
    return f"{value:.15g}" if abs(value) < LARGEST else f"{value:g}"


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
