"""One trial looked at closely: its plots, its truth, an initiator's tracks and accumulator."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.voting import Accumulator
from algorithms.initiators.guard import located
from algorithms.parameters import Parameters
from algorithms.plots import Plots
from algorithms.scoring.matching import score
from algorithms.space.planes import PlaneVotes
from algorithms.tracks import Tracks
from hough_tui.experiments.chunks.plot_sources import plots_of
from hough_tui.experiments.engines.process_worker import gathered
from scenarios.entries import InitiatorEntry
from scenarios.experiments import MatchCriterion
from scenarios.model import Scenario
from scenarios.simulate import Draw, truth
from scenarios.sweeps import Stage

MOST_TRACKS = 500
"""How many tracks of a trial are looked at; nobody looks at more, and each must find its plots."""

_loaded: set[str] = set()
"""Initiators that have run in this process."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A draw of a scenario: what the sensor saw, and what was there.

    Attributes
    ----------
    scenario, seed, trial : which draw
    drawn : its plots, with what caused each
    stage : how points became plots, of a scenario whose sensors give points; None: every point is a plot
    """

    scenario: Scenario
    seed: int
    trial: int
    drawn: Draw
    stage: Stage = None

    @property
    def plots(self) -> Plots:
        """What the sensor saw."""
        return self.drawn.chunk.trial(0)

    @property
    def origin(self) -> NDArray[np.int32]:
        """The target that caused each plot, −1 for clutter: int32 (n,)."""
        return self.drawn.origin

    @property
    def paths(self) -> tuple[NDArray[np.float64], ...]:
        """The true positions of each target, float64 (scans it is there, d)."""
        return self.drawn.states.paths(0)


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
    plane_votes : the votes of pairs of plots in three planes; None for an initiator that has none
    seconds : of the initiator
    """

    picture: Picture
    entry: InitiatorEntry
    parameters: Parameters
    tracks: Tracks
    total: int
    state: NDArray[np.int8] | None
    accumulator: Accumulator | None
    plane_votes: PlaneVotes | None
    seconds: float


def picture(scenario: Scenario, seed: int, trial: int, stage: Stage = None) -> Picture:
    """Return a draw of a scenario.

    Parameters
    ----------
    stage : how points become plots, of a scenario whose sensors give points; None: every point is a plot
    """
    return Picture(scenario, seed, trial, plots_of(scenario, seed, trial, stage), stage)


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
    PlugInError
        Where a plug-in fails.
    """
    algorithm, context = entry.algorithm, seen.scenario.context
    with located(f"scenario {seen.scenario.name}, seed {seen.seed}, trial {seen.trial}"):
        if algorithm.name not in _loaded:
            # The first run also loads, or compiles, its code; the time told is that of the work.
            algorithm.strongest(seen.plots, context, parameters, MOST_TRACKS)
            _loaded.add(algorithm.name)
        began = time.perf_counter()
        tracks, total = algorithm.strongest(seen.plots, context, parameters, MOST_TRACKS)
        seconds = time.perf_counter() - began
        accumulator = algorithm.accumulator(seen.plots, context, parameters)
        plane_votes = algorithm.plane_votes(seen.plots, context, parameters)
    state = None if criterion is None else _states(seen, tracks, criterion)
    return TrialLook(seen, entry, parameters, tracks, total, state, accumulator, plane_votes, seconds)


def _states(seen: Picture, tracks: Tracks, criterion: MatchCriterion) -> NDArray[np.int8]:
    known = truth(seen.scenario, seen.drawn)
    return score(gathered([tracks]), known, seen.drawn.chunk.offsets, criterion.value).state
