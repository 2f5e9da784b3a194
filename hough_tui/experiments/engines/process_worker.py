"""Trials of an initiator in plain Python, one by one, in a worker process."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time

import numpy as np

from algorithms.context import Context
from algorithms.initiators.guard import located
from algorithms.initiators.registry import initiator
from algorithms.parameters import Parameters
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk, Tracks, TrackStates


def initiate_trials(
    name: str, parameters: Parameters, context: Context, chunk: PlotChunk, first: int, where: str
) -> tuple[TrackChunk, float]:
    """Return the tracks of each trial of a chunk, with their plots, and the processor time that they took.

    Parameters
    ----------
    name : of the initiator
    parameters, context : as `Initiator.initiate` takes them
    chunk : plots
    first : number of the first trial
    where : set and scenario, to be named where the initiator fails
    """
    algorithm = initiator(name)
    began = time.thread_time()
    batches = []
    for index in range(chunk.trials):
        with located(f"{where}, trial {first + index}"):
            batches.append(algorithm.initiate(chunk.trial(index), context, parameters))
    return gathered(batches), time.thread_time() - began


def begin_worker() -> None:
    """Prepare a worker process: it ends when its parent does, and leaves interrupts to it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def gathered(trials: list[Tracks]) -> TrackChunk:
    """Return the tracks of several trials, or of none, as one chunk."""
    offsets = np.cumsum([0, *map(len, trials)], dtype=np.int64)
    every = [rows for tracks in trials for rows in tracks.plots]
    plots = np.full((len(every), max(map(len, every), default=1)), -1, np.int64)
    for line, rows in zip(plots, every, strict=True):
        line[: len(rows)] = rows
    nothing, no_scan = np.empty(0), np.empty(0, np.int64)
    states = [tracks.states for tracks in trials] or [TrackStates.open(0, 2)]
    return TrackChunk(
        offsets,
        np.concatenate([nothing, *(tracks.theta for tracks in trials)]),
        np.concatenate([nothing, *(tracks.rho for tracks in trials)]),
        np.concatenate([nothing, *(tracks.score for tracks in trials)]),
        np.zeros(len(trials), np.int64),
        plots,
        confirmed_scan=np.concatenate([no_scan, *(tracks.confirmed_scan for tracks in trials)]),
        states=TrackStates(*map(np.concatenate, zip(*states, strict=True))),
    )
