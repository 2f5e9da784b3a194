"""Sweeps: one experiment into its points, what runs on what with every swept value put in."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar, overload

from algorithms.errors import RequestError
from algorithms.parameters import (
    Declared,
    FieldError,
    Path,
    Problem,
    listed,
    nearest,
    numeric_paths,
    replaced,
    shortened,
)
from scenarios.entries import ClusteringEntry, InitiatorEntry, WithoutClustering
from scenarios.experiments import ClusteringExperiment, Experiment, InitiationExperiment
from scenarios.model import Scenario, ScenarioSet
from scenarios.scenes import Scene

MOST_POINTS = 20_000
"""The most points of one experiment."""

MOST_SHOWN = 20
"""The most fields of a part that a message lists: their paths are long."""

LONGEST_INDEX = 9
"""The most digits of an index in a list."""

SINGULAR = {
    "scenarios": "scenario",
    "scenes": "scene",
    "clusterings": "clustering",
    "initiators": "initiator",
}
"""How an element of a list of a set is called, and a swept field of it begins."""

Elements = Mapping[str, Sequence[Declared]]
"""The elements of each part, `scenario`, `initiator` and so on, in which a swept field may be."""


WorldT = TypeVar("WorldT", bound=Scenario | Scene)
EntryT = TypeVar("EntryT", bound=InitiatorEntry | ClusteringEntry)

Stage = ClusteringEntry | WithoutClustering | None
"""How points become plots; None where plots are drawn."""


@dataclass(frozen=True, slots=True)
class Point(Generic[WorldT, EntryT]):
    """One cell of an experiment's table.

    Attributes
    ----------
    world : what is drawn, with the swept values put in
    entry : what runs on it, likewise
    stage : how the points of a scenario become plots before an initiator runs
    parameters : those of the entry, with every `auto` worked out
    swept : the swept values by their keys as they were written
    names : of what was combined, by part (`scenario`, `initiator` and so on)
    """

    world: WorldT
    entry: EntryT
    stage: Stage
    parameters: Any
    swept: dict[str, int | float]
    names: Mapping[str, str]


@overload
def points(
    scenario_set: ScenarioSet, experiment: InitiationExperiment
) -> Iterator[Point[Scenario, InitiatorEntry]]: ...
@overload
def points(
    scenario_set: ScenarioSet, experiment: ClusteringExperiment
) -> Iterator[Point[Scene, ClusteringEntry]]: ...
@overload
def points(scenario_set: ScenarioSet, experiment: Experiment) -> Iterator[Point[Any, Any]]: ...
def points(scenario_set: ScenarioSet, experiment: Experiment) -> Iterator[Point[Any, Any]]:
    """Yield the points of an experiment, scenario by scenario, initiator by initiator.

    Raises
    ------
    FieldError
        Where a swept key names no numeric field, or a value is not allowed; its path begins
        at the experiment.
    """
    parts: Elements = {SINGULAR[part]: scenario_set.chosen(experiment, part) for part in experiment.parts}
    total = 1
    for several in (*parts.values(), *experiment.sweep.values()):
        total *= len(several)
    if total > MOST_POINTS:
        raise FieldError(
            Problem(
                ("sweep",), f"{total:,} points are given; the limit is {MOST_POINTS:,}; sweep fewer values"
            )
        )
    world = next(iter(parts))
    for chosen in itertools.product(*parts.values()):
        elements = dict(zip(parts, chosen, strict=True))
        # What is drawn is swept in the one at hand, a parameter in all that are compared.
        within = {**parts, world: [elements[world]]}
        places = [place_among(key, within) for key in experiment.sweep]
        for key, found in zip(experiment.sweep, places, strict=True):
            first = list(experiment.sweep)[places.index(found)]
            if first != key:
                message = f"'{key}' is the field that '{first}' is; sweep it once"
                raise FieldError(Problem(("sweep", key), message, on_key=True))
        for combination in itertools.product(*experiment.sweep.values()):
            yield _point(elements, experiment, places, combination)


def _point(
    elements: Mapping[str, Any],
    experiment: Experiment,
    places: Sequence[tuple[str, Path]],
    values: Sequence[int | float],
) -> Point[Any, Any]:
    changes: dict[str, dict[Path, int | float]] = {part: {} for part in elements}
    for (part, path), value in zip(places, values, strict=True):
        changes[part][path] = value
    keys = dict(zip(places, experiment.sweep, strict=True))
    combined: dict[str, Any] = {}
    for part, element in elements.items():
        try:
            combined[part] = replaced(element, changes[part])
        except FieldError as error:
            raise _placed(error, part, keys, experiment, values) from None
    world, *stages, entry = combined.values()
    try:
        parameters = entry.resolved_on(world)
    except RequestError as error:
        what = f"{list(combined)[-1]} {entry.name} on {world.name}"
        raise FieldError(Problem((), f"{what}: {error}")) from None
    swept = dict(zip(experiment.sweep, values, strict=True))
    names = {part: element.name for part, element in combined.items()}
    return Point(world, entry, stages[0] if stages else None, parameters, swept, names)


def _placed(
    error: FieldError,
    part: str,
    keys: dict[tuple[str, Path], str],
    experiment: Experiment,
    values: Sequence[int | float],
) -> FieldError:
    """Return a refused value with its place among the swept values."""
    where = error.problem.path
    for (swept, path), key in keys.items():
        if swept == part and (where[: len(path)] == path or path[: len(where)] == where):
            index = experiment.sweep[key].index(values[list(experiment.sweep).index(key)])
            return FieldError(Problem(("sweep", key, index), str(error)))
    return FieldError(Problem(("sweep",), str(error)))


def place(key: str, scenario: Scenario, entries: Sequence[InitiatorEntry]) -> tuple[str, Path]:
    """Return which part a key reaches into, `scenario` or `initiator`, and the path in it.

    Raises
    ------
    FieldError
        As `place_among` does.
    """
    return place_among(key, {"scenario": [scenario], "initiator": entries})


def place_among(key: str, elements: Elements) -> tuple[str, Path]:
    """Return which part a swept key reaches into, and the path in it.

    A key that begins with no part is matched with the ends of all paths; list indices may be
    left out where there is only one element.

    Raises
    ------
    FieldError
        Where there is no such numeric field that all elements of a part have, or more than one.
    """
    wanted = parts_of(key)
    known = {part: _common(several) for part, several in elements.items()}
    if wanted[0] in known and len(wanted) > 1:
        part, rest = str(wanted[0]), wanted[1:]
        matches = [(part, path, path) for path in known[part]]
    else:
        rest = wanted
        matches = [(part, path, path[-len(rest) :]) for part in known for path in known[part]]
    # A path as it stands goes before one with its indices left out, the whole of it before its end.
    found = [(part, path) for part, path, end in matches if end == rest]
    found = found or [
        (part, path) for part, path, _ in matches if _is_named(path, rest, whole=rest != wanted)
    ]
    found = [match for match in found if match[1] == rest] or found
    if len(found) == 1:
        return found[0]
    if found:
        names = listed([written(part, path) for part, path in found], MOST_SHOWN)
        message = f"'{shortened(key)}' may mean {names}; write one of them"
        raise FieldError(Problem(("sweep", key), message, on_key=True))
    every = [written(part, path) for part in known for path in known[part]]
    ends = [str(path[-1]) for part in known for path in known[part] if isinstance(path[-1], str)]
    hint = nearest(key, [*every, *ends])
    # Of each part some, where a part has very many.
    fields = ", ".join(listed([written(part, path) for path in known[part]], MOST_SHOWN) for part in known)
    message = f"there is no numeric field '{shortened(key)}'{hint} (known: {fields})"
    asked = [wanted[0]] if wanted[0] in known else list(known)
    shared = " and every ".join(str(part) for part in asked if len(elements[str(part)]) > 1)
    if shared:
        message += f"; a swept parameter must belong to every {shared} of the experiment"
    raise FieldError(Problem(("sweep", key), message, on_key=True))


def parts_of(key: str) -> Path:
    """Return a dotted path, `clutter.0.rate` or `clutter[0].rate`, as its parts."""
    names = re.sub(r"\[(\d+)\]", r".\1", key).split(".")
    return tuple(int(name) if name.isdecimal() and len(name) <= LONGEST_INDEX else name for name in names)


def written(part: str, path: Path) -> str:
    """Return a path as it is written in a sweep."""
    return ".".join(map(str, (part, *path)))


def _is_named(path: Path, wanted: Path, *, whole: bool) -> bool:
    """Return whether a path, or its end, is the wanted one with indices left out."""
    left = list(path)
    for part in reversed(wanted):
        while left and left[-1] != part and isinstance(left[-1], int):
            left.pop()
        if not left or left.pop() != part:
            return False
    return not whole or not any(isinstance(name, str) for name in left)


def _common(elements: Sequence[Declared]) -> list[Path]:
    """Return the numeric fields that all elements have."""
    paths = [list(numeric_paths(element)) for element in elements]
    shared = set.intersection(*map(set, paths)) if paths else set()
    return [path for path in paths[0] if path in shared] if paths else []
