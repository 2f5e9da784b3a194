"""What a set must satisfy across its parts: names are unique and known, sweeps reach fields, grids fit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

from algorithms.errors import RequestError
from algorithms.parameters import FieldError, Problem, unknown
from scenarios.entries import WITHOUT_CLUSTERING
from scenarios.experiments import Experiment, InitiationExperiment
from scenarios.model import ScenarioSet
from scenarios.sweeps import SINGULAR, points


class Named(Protocol):
    """Any element of a set."""

    @property
    def name(self) -> str:
        """What it is called."""


def inconsistencies(given: ScenarioSet) -> Iterator[Problem]:
    """Yield what is wrong across the parts of a set, each with its path in the set."""
    names = list(_repeated_names(given))
    yield from names
    if names:
        return
    for index, experiment in enumerate(given.experiments):
        path = ("experiments", index)
        found = [*_unknown_names(given, experiment)] or [
            *_unfit_criterion(given, experiment),
            *_unfit_clusterings(given, experiment),
        ]
        if not found:
            try:
                for _ in points(given, experiment):
                    continue
            except FieldError as error:
                found = [error.problem]
            except RequestError as error:
                found = [Problem((), str(error))]
        for problem in found:
            yield Problem((*path, *problem.path), problem.message, problem.on_key)


def _repeated_names(given: ScenarioSet) -> Iterator[Problem]:
    lists: dict[str, Sequence[Named]] = {
        **{part: getattr(given, part) for part in SINGULAR},
        "experiments": given.experiments,
    }
    for part, items in lists.items():
        first: dict[str, int] = {}
        for index, item in enumerate(items):
            if item.name in first:
                message = (
                    f"'{item.name}' is the name of {part}[{first[item.name]}] already; each needs its own"
                )
                yield Problem((part, index, "name"), message)
            first.setdefault(item.name, index)
    for index, entry in enumerate(given.clusterings):
        if entry.name in WITHOUT_CLUSTERING:
            message = f"'{entry.name}' says in experiments that points are not clustered; take another name"
            yield Problem(("clusterings", index, "name"), message)


def _unknown_names(given: ScenarioSet, experiment: Experiment) -> Iterator[Problem]:
    for part in experiment.parts:
        names, known = getattr(experiment, part) or (), [found.name for found in getattr(given, part)]
        if part == "clusterings" and isinstance(experiment, InitiationExperiment):
            known += WITHOUT_CLUSTERING
        for index, name in enumerate(names):
            if name not in known:
                yield Problem((part, index), unknown(name, known, SINGULAR[part]))
            elif name in names[:index]:
                yield Problem((part, index), f"'{name}' is listed already")
        if not known:
            yield Problem((part,), f"the set lists no {part}, so nothing can run; give at least one")


def _unfit_criterion(given: ScenarioSet, experiment: Experiment) -> Iterator[Problem]:
    if not isinstance(experiment, InitiationExperiment) or experiment.criterion.rho is None:
        return
    for scenario in given.chosen_scenarios(experiment):
        for index, target in enumerate(scenario.targets):
            if target.stands_still:
                message = (
                    f"target {index} of {scenario.name} stands still and has no line; match by shared plots: "
                    "{plots: 3}"
                )
                yield Problem(("criterion",), message)


def _unfit_clusterings(given: ScenarioSet, experiment: Experiment) -> Iterator[Problem]:
    """Yield what is wrong with clusterings between the draw and the initiators."""
    if not isinstance(experiment, InitiationExperiment):
        return
    for scenario in given.chosen_scenarios(experiment):
        if scenario.is_resolved == (experiment.clusterings is None):
            message = (
                f"{scenario.name} has sensors of high resolution: give how its points become plots, names of "
                "clusterings, none (every point is a plot) or ideal (each target is one point)"
                if scenario.is_resolved
                else f"{scenario.name} has no sensor of high resolution, so no points: leave it out"
            )
            yield Problem(("clusterings",), message, on_key=not scenario.is_resolved)
    for index, entry in enumerate(given.chosen(experiment, "clusterings")):
        if getattr(entry, "mode", None) == "k-means":
            message = f"{entry.name} is told how many targets there are, which no sensor knows: leave it out"
            yield Problem(("clusterings", index), message)
