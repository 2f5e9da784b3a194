"""What an edit asks of the set: which value at which path, and what a new element of a list is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import BaseModel

from algorithms.parameters import Path
from hough_tui.ui.forms.alternatives import alternatives, discriminator, models, tag
from hough_tui.ui.forms.fields import NAME, FieldDescription, Kind, described

Edit = tuple[Path, Any]
"""A path of the set, and the value that is to stand there."""


def value_in(model: Any, path: Path) -> Any:
    """Return what stands at a path within a model; None where there is nothing."""
    here = model
    for part in path:
        if isinstance(part, str):
            here = here.get(part) if isinstance(here, Mapping) else getattr(here, part, None)
        else:
            here = here[part] if isinstance(here, list | tuple) and part < len(here) else None
    return here


def data_of(value: Any) -> Any:
    """Return a value as plain data, with the fields that were given and none that were not."""
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json", by_alias=True, exclude_unset=True)
    return [data_of(element) for element in value] if isinstance(value, list | tuple) else value


def edit_of(
    model: BaseModel,
    base: Path,
    path: Path,
    value: Any,
    *,
    holder: BaseModel | None = None,
    found: Sequence[type[BaseModel]] = (),
) -> Edit:
    """Return what to ask of the set for the edit of one field.

    The field itself, mostly. A group that is not there is given as a whole, what was not typed
    taken over from the field of that name around it; one that loses what it needs goes; and
    where the edit makes a thing another kind of thing, what both have is kept.

    Parameters
    ----------
    model : what the field is part of
    base : the path of the model
    path : the path of the field
    holder : what is around the model
    found : the models that the model may be of
    """
    inner = path[len(base) :]
    for depth in range(1, len(inner)):
        group = inner[:depth]
        if value_in(model, group) is None:
            return (*base, *group), None if value is None else _begun(model, inner, depth, value, holder)
    parent = value_in(model, inner[:-1])
    if isinstance(parent, BaseModel):
        kinds = tuple(found) if len(inner) == 1 else _declared(value_in(model, inner[:-2]), inner[-2])
        if inner[-1] == discriminator(kinds):
            chosen = next(kind for kind in kinds if tag(kind, str(inner[-1])) == value)
            return path[:-1], _converted(parent, chosen, {str(inner[-1]): value})
        if value is None and len(inner) > 1 and not _may_be_none(parent, inner[-1]):
            if _may_be_none(value_in(model, inner[:-2]), inner[-2]):
                return path[:-1], None
    return path, value


def together(model: BaseModel, base: Path, edits: Mapping[Path, Any]) -> Edit:
    """Return one edit that makes several at once: they may be allowed only together."""
    common = list(next(iter(edits))[:-1])
    for path in edits:
        while tuple(common) != path[: len(common)] or len(common) >= len(path):
            common.pop()
    data = data_of(model)
    for path, value in edits.items():
        _put(data, model, path[len(base) :], value)
    return tuple(common), value_in(data, tuple(common[len(base) :]))


def starter(model: type[BaseModel], taken: Iterable[str] = ()) -> dict[str, Any]:
    """Return data with which a new instance of a model begins: what it needs and no more.

    Parameters
    ----------
    taken : names that others have
    """
    data = {str(field.path[-1]): _start(field) for field in described(model) if field.required}
    return {**data, NAME: unused(data[NAME], taken)} if NAME in data else data


def duplicate(element: BaseModel, taken: Iterable[str]) -> dict[str, Any]:
    """Return the data of an element with a name of its own, where it has one."""
    # What it is may be known by its name alone, which changes.
    kinds = {name: kind for name in type(element).model_fields if (kind := tag(type(element), name))}
    data: dict[str, Any] = {**kinds, **data_of(element)}
    return {**data, NAME: unused(data[NAME], taken)} if data.get(NAME) else data


def names_of(elements: Iterable[BaseModel]) -> list[str]:
    """Return the names of those elements that have one."""
    return [name for element in elements if (name := getattr(element, NAME, None))]


def unused(name: str, taken: Iterable[str]) -> str:
    """Return a name, numbered if another has it already."""
    known = set(taken)
    stem, _, number = name.rpartition("-")
    stem = stem if stem and number.isdigit() else name
    candidates = [name, *(f"{stem}-{count}" for count in range(2, len(known) + 3))]
    return next(candidate for candidate in candidates if candidate not in known)


def _begun(model: BaseModel, inner: Path, depth: int, value: Any, holder: BaseModel | None) -> Any:
    """Return the data of a group that is not there yet, with one value put in."""
    kinds = _declared(value_in(model, inner[: depth - 1]), inner[depth - 1])
    around = getattr(holder, str(inner[depth - 1]), None)
    data = data_of(around) if isinstance(around, kinds) else starter(kinds[0])
    _put(data, around, inner[depth:], value)
    return data


def _put(data: Any, model: Any, inner: Path, value: Any) -> None:
    for depth, part in enumerate(inner[:-1], start=1):
        if isinstance(data, dict) and part not in data:
            data[part] = data_of(value_in(model, inner[:depth])) or {}
        data = data[part]
    parent = value_in(model, inner[:-1])
    if value is None and isinstance(parent, BaseModel) and _default(parent, inner[-1]) is None:
        data.pop(inner[-1], None)
    else:
        data[inner[-1]] = value


def _converted(current: BaseModel, chosen: type[BaseModel], told: dict[str, Any]) -> dict[str, Any]:
    kept = {name: value for name, value in data_of(current).items() if name in chosen.model_fields}
    return {**starter(chosen), **kept, **told}


def _start(field: FieldDescription) -> Any:
    match field.kind:
        case Kind.NUMBER | Kind.WHOLE:
            return 1
        case Kind.VECTOR:
            # Bounds must rise and a target must move: no two numbers are equal.
            return 1 if field.wanted.single else list(range(field.wanted.size or 1))
        case Kind.VECTORS:
            return [list(range(field.wanted.size or 1))]
        case Kind.CHOICE:
            return field.choices[0]
        case Kind.FLAG:
            return False
        case Kind.MAPPING:
            return {}
        case Kind.TEXTS:
            return ["new"]
        case Kind.LIST:
            return [_tagged(field.models)]
        case Kind.GROUP:
            return _tagged(field.models)
        case Kind.TEXT:
            return "new"


def _tagged(kinds: tuple[type[BaseModel], ...]) -> dict[str, Any]:
    name = discriminator(kinds)
    return {**({name: tag(kinds[0], name)} if name else {}), **starter(kinds[0])}


def _declared(parent: Any, name: str | int) -> tuple[type[BaseModel], ...]:
    field = type(parent).model_fields.get(str(name)) if isinstance(parent, BaseModel) else None
    if field is None:
        return ()
    return models(alternatives(field.annotation))


def _may_be_none(parent: Any, name: str | int) -> bool:
    field = type(parent).model_fields.get(str(name)) if isinstance(parent, BaseModel) else None
    return field is not None and any(one.kind is type(None) for one in alternatives(field.annotation))


def _default(parent: BaseModel, name: str | int) -> Any:
    return type(parent).model_fields[str(name)].get_default(call_default_factory=True)
