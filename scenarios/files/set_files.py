"""Scenario sets as YAML files, and files in general: errors name file, line, column and field."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from algorithms.errors import RequestError
from algorithms.parameters import Problem, join, lines, problems, unknown
from scenarios.checks import inconsistencies
from scenarios.files.atomic import replace_file
from scenarios.files.bundled import bundled_paths
from scenarios.files.marked_yaml import MarkedDocument, read, rewrite, write
from scenarios.model import ScenarioSet

LARGEST_FILE = 2 * 2**20
"""The largest scenario set that is read, in bytes."""

LARGEST_TEXT = 128 * 2**20
"""The largest file that is read at all, in bytes; tables take some eight times their size in memory."""


@dataclass(frozen=True, slots=True)
class BundledSet:
    """A set that comes with the product."""

    name: str
    path: Path
    description: str


def bundled_sets() -> list[BundledSet]:
    """Return the bundled sets with what they say they are for."""
    loaded = {name: (path, load_set(path)) for name, path in bundled_paths().items()}
    return [BundledSet(name, path, found.description) for name, (path, found) in loaded.items()]


def locate(name: str) -> Path:
    """Return the path of a set: a file, or the bare name of a bundled set.

    Raises
    ------
    RequestError
        Where there is neither.
    """
    path = Path(name)
    bundled = bundled_paths()
    if path.exists() or name not in bundled:
        if not path.exists() and not path.suffix and len(path.parts) == 1:
            raise RequestError(unknown(name, list(bundled), "file or bundled set"))
        return path
    return bundled[name]


def read_text(path: Path, largest: int = LARGEST_TEXT) -> str:
    """Return the text of a file.

    Raises
    ------
    RequestError
        Where it is missing, a folder, unreadable, too large, or not UTF-8.
    """
    try:
        with path.open("rb") as file:
            # A device may have no size and no end.
            data = file.read(largest + 1)
            size = max(len(data), os.fstat(file.fileno()).st_size)
    except FileNotFoundError:
        raise RequestError(f"{path}: there is no such file") from None
    except IsADirectoryError:
        raise RequestError(f"{path}: this is a folder; give a file") from None
    except OSError as error:
        raise RequestError(f"{path}: cannot be read: {error.strerror or error}") from None
    if len(data) > largest:
        raise RequestError(
            f"{path}: the file has {size / 2**20:,.1f} MiB; the limit is {largest / 2**20:g} MiB"
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise RequestError(
            f"{path}:{line}: the file is not UTF-8 text (byte {data[error.start]:#04x}); save it as UTF-8"
        ) from None


def load_set(name: str | Path) -> ScenarioSet:
    """Return a scenario set from a file, or a bundled one by its bare name.

    Raises
    ------
    RequestError
        One line a problem, with file, line, column, field, what is given and what is allowed.
    """
    path = locate(name) if isinstance(name, str) else name
    return parse_set(read_text(path, LARGEST_FILE), str(path))


def parse_set(text: str, source: str) -> ScenarioSet:
    """Return a scenario set from its YAML; `source` is what errors call it."""
    document = read(text, source)
    if document.data is None:
        raise RequestError(f"{source}: the file is empty; `hough-tui schema` says what a set holds")
    try:
        given = ScenarioSet.model_validate(document.data)
    except ValidationError as error:
        found = problems(error, ScenarioSet, document.data)
    else:
        found = list(inconsistencies(given))
        if not found:
            return given
    raise RequestError(lines([located(problem, document) for problem in found], source))


def located(problem: Problem, document: MarkedDocument) -> str:
    """Return a problem as one line with its place in the file."""
    return f"{document.where(problem.path, key=problem.on_key)}: {join(problem)}"


def set_data(given: ScenarioSet) -> dict[str, Any]:
    """Return a set as plain data, with the fields that were given and none that were not."""
    data: dict[str, Any] = given.model_dump(mode="json", by_alias=True, exclude_unset=True)
    return data


def save_set(given: ScenarioSet, path: Path) -> None:
    """Write a set to a file; over an existing set, its comments, key order and layout are kept.

    Raises
    ------
    RequestError
        Where the existing file cannot be read as YAML, or the folder cannot be written.
    """
    data = set_data(given)
    if path.is_file():
        old = read_text(path, LARGEST_FILE)
        text = rewrite(old, _as_written(data, read(old, str(path)).data), str(path))
    else:
        text = write(_as_written(data, None))
    try:
        replace_file(path, text)
    except OSError as error:
        raise RequestError(f"{path}: cannot be written: {error.strerror or error}") from None


def _as_written(data: Any, old: Any) -> Any:
    """Return data with numbers as the file has them where they are equal: 4, not 4.0; new ones short."""
    if isinstance(data, dict):
        before = old if isinstance(old, dict) else {}
        return {key: _as_written(value, before.get(key)) for key, value in data.items()}
    if isinstance(data, list):
        items = old if isinstance(old, list) and len(old) == len(data) else [None] * len(data)
        return [_as_written(value, item) for value, item in zip(data, items, strict=True)]
    if isinstance(data, bool) or not isinstance(data, int | float):
        return data
    if isinstance(old, int | float) and not isinstance(old, bool) and old == data:
        return old
    return int(data) if isinstance(data, float) and data.is_integer() and abs(data) < 1e15 else data
