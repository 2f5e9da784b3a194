"""Sweeps: one experiment into its points, a scenario and an initiator with every swept value put in."""

from __future__ import annotations

import difflib
import itertools
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from algorithms.errors import RequestError
from algorithms.parameters import (
    FieldError,
    Parameters,
    Path,
    Problem,
    numeric_paths,
    replaced,
)
from scenarios.model import Experiment, InitiatorEntry, Scenario, ScenarioSet

MOST_POINTS = 20_000
"""The most points of one experiment."""

PARTS = ("scenario", "initiator")


@dataclass(frozen=True, slots=True)
class Point:
    """One cell of an experiment's table.

    Attributes
    ----------
    scenario : with the swept values put in
    entry : the initiator entry as the set lists it
    parameters : its parameters with the swept values put in and every `auto` worked out
    swept : the swept values by their keys as they were written
    """

    scenario: Scenario
    entry: InitiatorEntry
    parameters: Parameters
    swept: dict[str, int | float]


def points(given: ScenarioSet, experiment: Experiment) -> Iterator[Point]:
    """Yield the points of an experiment, scenario by scenario, initiator by initiator.

    Raises
    ------
    FieldError
        Where a swept key names no numeric field, or a value is not allowed; its path begins
        at the experiment.
    """
    scenarios, entries = given.chosen_scenarios(experiment), given.chosen_entries(experiment)
    total = len(scenarios) * len(entries)
    for values in experiment.sweep.values():
        total *= len(values)
    if total > MOST_POINTS:
        raise FieldError(
            Problem(
                ("sweep",), f"{total:,} points are given; the limit is {MOST_POINTS:,}; sweep fewer values"
            )
        )
    for scenario, entry in itertools.product(scenarios, entries):
        places = [place(key, scenario, entries) for key in experiment.sweep]
        for key, found in zip(experiment.sweep, places, strict=True):
            first = list(experiment.sweep)[places.index(found)]
            if first != key:
                message = f"'{key}' is the field that '{first}' is; sweep it once"
                raise FieldError(Problem(("sweep", key), message, on_key=True))
        for combination in itertools.product(*experiment.sweep.values()):
            yield _point(scenario, entry, experiment, places, combination)


def _point(
    scenario: Scenario,
    entry: InitiatorEntry,
    experiment: Experiment,
    places: Sequence[tuple[str, Path]],
    values: Sequence[int | float],
) -> Point:
    parts: dict[str, dict[Path, int | float]] = {"scenario": {}, "initiator": {}}
    for (part, path), value in zip(places, values, strict=True):
        parts[part][path] = value
    keys = dict(zip(places, experiment.sweep, strict=True))
    try:
        part = "scenario"
        scenario = replaced(scenario, parts[part])
        part = "initiator"
        entry = replaced(entry, parts[part])
    except FieldError as error:
        raise _placed(error, part, keys, experiment, values) from None
    try:
        parameters = entry.parameters.resolved(scenario.context)
    except RequestError as error:
        raise FieldError(Problem((), f"initiator {entry.name} on {scenario.name}: {error}")) from None
    return Point(scenario, entry, parameters, dict(zip(experiment.sweep, values, strict=True)))


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
    """Return which part a swept key reaches into, `scenario` or `initiator`, and the path in it.

    A key that begins with neither is matched with the ends of all paths; list indices may be
    left out where there is only one element.

    Raises
    ------
    FieldError
        Where there is no such numeric field, or more than one.
    """
    wanted = parts_of(key)
    known = {"scenario": list(numeric_paths(scenario)), "initiator": _common(entries)}
    if wanted[0] in PARTS and len(wanted) > 1:
        part, rest = str(wanted[0]), wanted[1:]
        matches = [(part, path, path) for path in known[part]]
    else:
        rest = wanted
        matches = [(part, path, path[-len(rest) :]) for part in PARTS for path in known[part]]
    # A path as it stands goes before one with its indices left out, the whole of it before its end.
    found = [(part, path) for part, path, end in matches if end == rest]
    found = found or [
        (part, path) for part, path, _ in matches if _is_named(path, rest, whole=rest != wanted)
    ]
    found = [match for match in found if match[1] == rest] or found
    if len(found) == 1:
        return found[0]
    if found:
        names = ", ".join(written(part, path) for part, path in found)
        raise FieldError(Problem(("sweep", key), f"'{key}' may mean {names}; write one of them", on_key=True))
    every = [written(part, path) for part in PARTS for path in known[part]]
    ends = [str(path[-1]) for part in PARTS for path in known[part] if isinstance(path[-1], str)]
    near = difflib.get_close_matches(key, [*every, *ends], n=1, cutoff=0.5)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    message = f"there is no numeric field '{key}'{hint} (known: {', '.join(every)})"
    if len(entries) > 1 and wanted[0] != "scenario":
        message += "; a swept parameter must belong to every initiator of the experiment"
    raise FieldError(Problem(("sweep", key), message, on_key=True))


def parts_of(key: str) -> Path:
    """Return a dotted path, `clutter.0.rate` or `clutter[0].rate`, as its parts."""
    names = re.sub(r"\[(\d+)\]", r".\1", key).split(".")
    return tuple(int(name) if name.isdecimal() else name for name in names)


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


def _common(entries: Iterable[InitiatorEntry]) -> list[Path]:
    """Return the numeric parameters that all entries have."""
    paths = [list(numeric_paths(entry.parameters)) for entry in entries]
    return [path for path in paths[0] if all(path in others for others in paths)] if paths else []
