"""The plan of a run: which cells there are, and how they share draws and tracks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from algorithms.errors import RequestError
from algorithms.parameters import Parameters, unknown
from scenarios.entries import InitiatorEntry
from scenarios.experiments import Experiment, MatchCriterion
from scenarios.model import Scenario, ScenarioSet
from scenarios.sweeps import points

LARGEST_CHUNK = 200
"""Trials of the largest chunk."""

PLOTS_A_CHUNK = 60_000
"""Plots that a chunk is expected to hold: some twenty milliseconds of work, not to be interrupted."""


MOST_BYTES = 4 * 2**30
"""The most memory that the per-trial columns may take."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One row of the result: an initiator on a scenario, both with the swept values put in.

    Attributes
    ----------
    set_name, experiment : where it comes from
    scenario, entry, parameters : what runs; the parameters are resolved
    swept : the swept values by their keys as they were written
    """

    set_name: str
    experiment: Experiment
    scenario: Scenario
    entry: InitiatorEntry
    parameters: Parameters
    swept: dict[str, int | float]

    @property
    def criterion(self) -> MatchCriterion:
        """When a track matches a target."""
        return self.experiment.criterion


@dataclass(frozen=True, slots=True)
class SharedTracks:
    """The cells that score the same tracks: one initiator with one set of parameters."""

    entry: InitiatorEntry
    parameters: Parameters
    cells: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class SharedDraws:
    """The cells that see the same draws: one scenario and one seed.

    Attributes
    ----------
    scenario, seed, trials : which draws
    runs : what runs on them
    """

    scenario: Scenario
    seed: int
    trials: int
    runs: tuple[SharedTracks, ...]

    @property
    def chunk(self) -> int:
        """Trials of a chunk; it depends on the scenario alone, never on the number of workers."""
        return max(1, min(LARGEST_CHUNK, int(PLOTS_A_CHUNK / max(1.0, self.scenario.expected_plots))))


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
    cells: tuple[Cell, ...]
    draws: tuple[SharedDraws, ...]

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
        Cell(given.name, experiment, point.scenario, point.entry, point.parameters, point.swept)
        for given in changed
        for experiment in given.experiments
        for point in points(given, experiment)
    )
    if not cells:
        names = ", ".join(given.name for given in sets)
        raise RequestError(
            f"{names}: the set has no experiments, so there is nothing to run; give one under `experiments`"
        )
    size = sum(cell.experiment.trials * (20 + 10 * len(cell.scenario.targets)) for cell in cells)
    if size > MOST_BYTES:
        raise RequestError(
            f"the trials of {len(cells)} cells would need {size / 2**30:,.1f} GiB; "
            f"the limit is {MOST_BYTES / 2**30:g} GiB; give fewer trials or fewer experiments"
        )
    return Plan(tuple(changed), cells, tuple(_shared(cells)))


def _shared(cells: Sequence[Cell]) -> list[SharedDraws]:
    """Return the work of cells: equal draws are made once, equal tracks are found once."""
    draws: dict[tuple[str, int, int], dict[tuple[str, str], list[int]]] = {}
    for index, cell in enumerate(cells):
        drawn = (cell.scenario.model_dump_json(), cell.experiment.seed, cell.experiment.trials)
        tracks = (cell.entry.initiator, cell.parameters.model_dump_json())
        draws.setdefault(drawn, {}).setdefault(tracks, []).append(index)
    found = []
    for (_, seed, trials), runs in draws.items():
        shared = tuple(
            SharedTracks(cells[indices[0]].entry, cells[indices[0]].parameters, tuple(indices))
            for indices in runs.values()
        )
        found.append(SharedDraws(cells[shared[0].cells[0]].scenario, seed, trials, shared))
    return found
