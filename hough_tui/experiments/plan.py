"""The plan of a run: which cells there are, and how they share draws and what is found in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from algorithms.errors import RequestError
from algorithms.parameters import unknown
from hough_tui.experiments.cases import AnyCell, SharedDraws, SharedRun
from hough_tui.experiments.chunks.clustering import ClusteringCell
from hough_tui.experiments.chunks.initiation import InitiationCell
from scenarios.experiments import ClusteringExperiment, Experiment, InitiationExperiment
from scenarios.model import ScenarioSet
from scenarios.sweeps import points

MOST_BYTES = 4 * 2**30
"""The most memory that the per-trial columns may take."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What a run is to do.

    Attributes
    ----------
    sets : the sets with every override put in
    cells : the rows of the result, in order
    draws : the work, in order
    """

    sets: tuple[ScenarioSet, ...]
    cells: tuple[AnyCell, ...]
    draws: tuple[SharedDraws[Any, Any], ...]

    @property
    def trials(self) -> int:
        """Trials of all cells."""
        return sum(cell.experiment.trials for cell in self.cells)


def plan_run(
    sets: Sequence[ScenarioSet],
    *,
    experiments: Sequence[str] = (),
    trials: int | None = None,
    seed: int | None = None,
) -> Plan:
    """Return the plan of the experiments of scenario sets.

    Parameters
    ----------
    sets : validated sets
    experiments : names of the experiments to run; none: all
    trials, seed : in place of those of every experiment, where given

    Raises
    ------
    RequestError
        Where there is no experiment to run, or none of a given name.
    """
    names = [given.name for given in sets]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise RequestError(f"two sets are named '{twice}': their rows could not be told apart; rename one")
    overrides = {key: value for key, value in (("trials", trials), ("seed", seed)) if value is not None}
    known = [experiment.name for given in sets for experiment in given.experiments]
    for name in experiments:
        if name not in known:
            raise RequestError(unknown(name, known, "experiment"))
    changed = []
    for given in sets:
        chosen = [
            experiment.model_copy(update=overrides)
            for experiment in given.experiments
            if not experiments or experiment.name in experiments
        ]
        changed.append(given.model_copy(update={"experiments": chosen}))
    cells = tuple(
        cell
        for scenario_set in changed
        for experiment in scenario_set.experiments
        for cell in cells_of(scenario_set, experiment)
    )
    if not cells:
        raise RequestError(
            f"{', '.join(names)}: the set has no experiments, so there is nothing to run; give one under "
            "`experiments`"
        )
    size = sum(cell.experiment.trials * cell.bytes_a_trial for cell in cells)
    if size > MOST_BYTES:
        raise RequestError(
            f"the trials of {len(cells)} cells would need {size / 2**30:,.1f} GiB; "
            f"the limit is {MOST_BYTES / 2**30:g} GiB; give fewer trials or fewer experiments"
        )
    return Plan(tuple(changed), cells, tuple(_shared(cells)))


def cells_of(scenario_set: ScenarioSet, experiment: Experiment) -> Iterator[AnyCell]:
    """Yield the cells of an experiment, in order."""
    if isinstance(experiment, InitiationExperiment):
        for initiation in points(scenario_set, experiment):
            yield InitiationCell(scenario_set.name, experiment, initiation)
    elif isinstance(experiment, ClusteringExperiment):
        for clustering in points(scenario_set, experiment):
            yield ClusteringCell(scenario_set.name, experiment, clustering)


def _shared(cells: Sequence[AnyCell]) -> Iterator[SharedDraws[Any, Any]]:
    """Group cells by shared draws, then by identical runs on them."""
    draws: dict[tuple[str, int, int], dict[str, dict[int, AnyCell]]] = {}
    for index, cell in enumerate(cells):
        drawn = (cell.draws_key, cell.experiment.seed, cell.experiment.trials)
        draws.setdefault(drawn, {}).setdefault(cell.run_key, {})[index] = cell
    for runs in draws.values():
        shared = tuple(SharedRun(run) for run in runs.values())
        yield shared[0].first.shared(shared)
