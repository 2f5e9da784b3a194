"""Paths: places in declared models and in data for them, and the fields that stand there."""

from __future__ import annotations

import types
import typing
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Union

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from algorithms.parameters.declaration import Declared

Path = tuple[str | int, ...]


def dotted(path: Path) -> str:
    """Return a path as people write it, `targets[0].position[1]`."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.lstrip(".")


def path_in(data: Any, location: Sequence[str | int], *, missing: bool) -> Path:
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


def value_at(data: Any, path: Path) -> Any:
    """Return what stands at a path of data."""
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
    meant = [found for found in models if not issubclass(found, Declared) or found.matches_tag(here)]
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
