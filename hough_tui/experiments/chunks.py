"""One chunk of trials: draw, find tracks, score, and the same for the control."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.initiators.base import ChunkInitiator
from algorithms.plots import PlotChunk
from algorithms.scoring import Scores, score
from algorithms.tracks import TrackChunk
from hough_tui.experiments.plan import Plan, SharedDraws, SharedTracks
from scenarios.simulate import Draw, draw, truth
from scenarios.world import World

PlainInitiation = Callable[[SharedDraws, SharedTracks, PlotChunk], tuple[TrackChunk, float]]
"""How the trials of an initiator in plain Python are run: elsewhere, in so many seconds."""


@dataclass(frozen=True, slots=True)
class CellChunk:
    """What the trials of a chunk gave for one cell.

    Attributes
    ----------
    cell : index of the cell in the plan
    tracks, scores : of the trials
    control_found : bool (trials, targets), or None without a control
    seconds : worker time from draw to score, the control left out
    """

    cell: int
    tracks: TrackChunk
    scores: Scores
    control_found: NDArray[np.bool_] | None
    seconds: float


def run_chunk(
    plan: Plan, shared: SharedDraws, world: World, first: int, trials: int, plain: PlainInitiation
) -> Iterator[CellChunk]:
    """Yield what consecutive trials give, cell by cell; to stop between two initiators, stop iterating.

    Parameters
    ----------
    plan, shared : the work
    world : the arrays of its scenario
    first, trials : which trials
    plain : runs an initiator that is not a `ChunkInitiator`
    """
    began = time.thread_time()
    drawn = draw(world, shared.seed, first, trials)
    drawing = time.thread_time() - began
    control: Draw | None = None
    for run in shared.runs:
        tracks, finding = _tracks(plan, shared, run, drawn.chunk, plain)
        controlled = [cell for cell in run.cells if plan.cells[cell].experiment.control]
        if controlled:
            control = control or drawn.without_targets()
            control_tracks, _ = _tracks(plan, shared, run, control.chunk, plain)
        for cell in run.cells:
            began = time.thread_time()
            scores = _scores(plan, cell, shared, tracks, drawn)
            scoring = time.thread_time() - began
            found = None
            if cell in controlled:
                assert control is not None
                found = _scores(plan, cell, shared, control_tracks, control).found
            yield CellChunk(cell, tracks, scores, found, drawing + finding + scoring)


def _scores(plan: Plan, cell: int, shared: SharedDraws, tracks: TrackChunk, drawn: Draw) -> Scores:
    known = truth(shared.scenario, drawn)
    return score(tracks, known, drawn.chunk.offsets, plan.cells[cell].criterion.value)


def _tracks(
    plan: Plan, shared: SharedDraws, run: SharedTracks, chunk: PlotChunk, plain: PlainInitiation
) -> tuple[TrackChunk, float]:
    """Return the tracks of a chunk, with their plots where a criterion asks for them, and the seconds."""
    algorithm, context = run.entry.algorithm, shared.scenario.context
    if not isinstance(algorithm, ChunkInitiator):
        return plain(shared, run, chunk)
    began = time.thread_time()
    tracks = algorithm.initiate_chunk(chunk, context, run.parameters)
    if any(plan.cells[cell].criterion.plots is not None for cell in run.cells):
        tracks = algorithm.associate_chunk(chunk, tracks, context, run.parameters)
    return tracks, time.thread_time() - began
