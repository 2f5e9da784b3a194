"""One trial looked at closely: its plots, its truth, an initiator's tracks and accumulator."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.voting import Accumulator
from algorithms.parameters import Parameters
from algorithms.plots import Plots
from algorithms.scoring import score
from algorithms.tracks import Tracks
from hough_tui.experiments.plain import gathered
from scenarios.model import InitiatorEntry, MatchCriterion, Scenario
from scenarios.simulate import Draw, World, draw, truth

MOST_TRACKS = 500
"""How many tracks of a trial are looked at; nobody looks at more, and each must find its plots."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A draw of a scenario: what the sensor saw, and what was there.

    Attributes
    ----------
    scenario, seed, trial : which draw
    plots : what the sensor saw
    origin : int32 (n,), the target that caused each plot, −1 for clutter
    paths : for each target its true positions, float64 (scans it is there, 2)
    """

    scenario: Scenario
    seed: int
    trial: int
    plots: Plots
    origin: NDArray[np.int32]
    paths: tuple[NDArray[np.float64], ...]


@dataclass(frozen=True, slots=True)
class TrialLook:
    """What an initiator made of a draw.

    Attributes
    ----------
    picture : the draw
    entry, parameters : the initiator; its parameters are resolved
    tracks : the strongest, `MOST_TRACKS` at most, strongest first
    total : number of all tracks
    state : int8 (tracks,), `FALSE`, `FINDER` or `DUPLICATE`; None without a criterion
    accumulator : the votes; None for an initiator that has none
    seconds : of the initiator
    """

    picture: Picture
    entry: InitiatorEntry
    parameters: Parameters
    tracks: Tracks
    total: int
    state: NDArray[np.int8] | None
    accumulator: Accumulator | None
    seconds: float


def picture(scenario: Scenario, seed: int, trial: int) -> Picture:
    """Return a draw of a scenario."""
    drawn = draw(World.of(scenario), seed, trial)
    return Picture(scenario, seed, trial, drawn.chunk.trial(0), drawn.origin, true_paths(scenario))


def true_paths(scenario: Scenario) -> tuple[NDArray[np.float64], ...]:
    """Return the true positions of each target in the scans in which it is there."""
    paths = []
    for target in scenario.targets:
        last = scenario.scans - 1 if target.death is None else min(target.death, scenario.scans - 1)
        elapsed = np.arange(max(0, last - target.birth + 1)) * scenario.interval
        paths.append(np.array(target.position) + elapsed[:, None] * np.array(target.velocity))
    return tuple(paths)


def look(
    seen: Picture, entry: InitiatorEntry, parameters: Parameters, criterion: MatchCriterion | None
) -> TrialLook:
    """Return what an initiator makes of a draw.

    Parameters
    ----------
    seen : the draw
    entry, parameters : the initiator; the parameters are resolved
    criterion : by which tracks are called false or duplicate

    Raises
    ------
    RequestError
        Where the initiator refuses the parameters or the plots.
    """
    algorithm, context = entry.algorithm, seen.scenario.context
    began = time.perf_counter()
    tracks, total = algorithm.strongest(seen.plots, context, parameters, MOST_TRACKS)
    seconds = time.perf_counter() - began
    state = None if criterion is None else _states(seen, tracks, criterion)
    accumulator = algorithm.accumulator(seen.plots, context, parameters)
    return TrialLook(seen, entry, parameters, tracks, total, state, accumulator, seconds)


def _states(seen: Picture, tracks: Tracks, criterion: MatchCriterion) -> NDArray[np.int8]:
    chunk = seen.plots.chunk()
    known = truth(seen.scenario, Draw(chunk, seen.origin))
    return score(gathered([tracks]), known, chunk.offsets, criterion.value).state
