"""Choosing a scenario of a set by name, changing its fields, and the seed that its experiments use."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from algorithms.errors import RequestError
from algorithms.parameters import FieldError, Path, replaced, unknown
from scenarios.entries import WITHOUT_CLUSTERING, ClusteringEntry, InitiatorEntry, WithoutClustering
from scenarios.files.marked_yaml import read
from scenarios.model import Scenario, ScenarioSet
from scenarios.sweeps import place


def chosen_scenario(given: ScenarioSet, name: str | None) -> Scenario:
    """Return a scenario of a set; without a name the only one.

    Raises
    ------
    RequestError
        Where there is none of that name, or several and no name is given.
    """
    names = [scenario.name for scenario in given.scenarios]
    if not names:
        raise RequestError(f"{given.name} has scenes alone, and no scenario")
    if name is None:
        if len(names) > 1:
            raise RequestError(f"{given.name} has {len(names)} scenarios; choose one: {', '.join(names)}")
        return given.scenarios[0]
    if name not in names:
        raise RequestError(unknown(name, names, "scenario"))
    return given.scenario(name)


def known_stages(given: ScenarioSet) -> dict[str, ClusteringEntry | WithoutClustering]:
    """Return by name what can stand between the points of a scenario and initiators, clusterings last."""
    able = {entry.name: entry for entry in given.clusterings if entry.mode != "k-means"}
    return {**WITHOUT_CLUSTERING, **able}


def chosen_clustering(
    given: ScenarioSet, scenario: Scenario, name: str | None
) -> ClusteringEntry | WithoutClustering | None:
    """Return how the points of a scenario become plots; None where they are left as they are.

    Raises
    ------
    RequestError
        Where there is no such clustering, it cannot stand before initiators, or there are no points.
    """
    if name is None or name == "none":
        return None
    if not scenario.is_resolved:
        raise RequestError(f"--clustering {name}: {scenario.name} has no sensor of high resolution")
    known = known_stages(given)
    if name not in known:
        raise RequestError(f"--clustering: {unknown(name, list(known), 'clustering')}")
    return known[name]


def changed(scenario: Scenario, assignments: Sequence[str]) -> Scenario:
    """Return a scenario with numeric fields changed by `key=value`, keys as in a sweep.

    Raises
    ------
    RequestError
        Where a key names no numeric field, or the value is not allowed.
    """
    values: dict[Path, Any] = {}
    for assignment in assignments:
        key, equals, value = assignment.partition("=")
        if not equals:
            raise RequestError(f"--set {assignment}: this is not of the form key=value")
        try:
            _, path = place(key, scenario, [])
        except FieldError as error:
            raise RequestError(f"--set {assignment}: {error.problem.message}") from None
        values[path] = read(value, f"--set {key}").data
    try:
        return replaced(scenario, values)
    except FieldError as error:
        raise RequestError(f"--set {' '.join(assignments)}: {error}") from None


def seed_of(given: ScenarioSet, scenario: Scenario) -> int:
    """Return the seed of the first experiment on a scenario; 1 where there is none."""
    for experiment in given.experiments:
        if scenario.name in (found.name for found in given.chosen_scenarios(experiment)):
            return experiment.seed
    return 1


def ignores_z(entry: InitiatorEntry, scenario: Scenario) -> bool:
    """Return whether an initiator works in the plane (x, y) of a scenario in space."""
    return entry.algorithm.dimensions < scenario.dimensions


def why_not_in_plane(entry: InitiatorEntry, scenario: Scenario) -> str | None:
    """Return why an initiator in space cannot work on a scenario in the plane; None where it can."""
    if entry.algorithm.dimensions <= scenario.dimensions:
        return None
    return (
        f"{entry.initiator} works in space, and {scenario.name} lies in the plane: it cannot run there; give "
        "sensor and targets a z"
    )
