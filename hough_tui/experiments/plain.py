"""Trials of an initiator in plain Python, one by one, in a worker process."""

from __future__ import annotations

import time

import numpy as np

from algorithms.context import Context
from algorithms.initiators.registry import initiator
from algorithms.parameters import Parameters
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk, Tracks


def initiate_trials(
    name: str, parameters: Parameters, context: Context, chunk: PlotChunk
) -> tuple[TrackChunk, float]:
    """Return the tracks of each trial of a chunk, with their plots, and the processor time that they took.

    Parameters
    ----------
    name : of the initiator
    parameters, context : as `Initiator.initiate` takes them
    chunk : plots
    """
    algorithm = initiator(name)
    began = time.thread_time()
    found = [algorithm.initiate(chunk.trial(index), context, parameters) for index in range(chunk.trials)]
    return gathered(found), time.thread_time() - began


def gathered(trials: list[Tracks]) -> TrackChunk:
    """Return the tracks of several trials as one chunk."""
    offsets = np.cumsum([0, *map(len, trials)], dtype=np.int64)
    every = [rows for tracks in trials for rows in tracks.plots]
    plots = np.full((len(every), max(map(len, every), default=1)), -1, np.int64)
    for line, rows in zip(plots, every, strict=True):
        line[: len(rows)] = rows
    return TrackChunk(
        offsets,
        np.concatenate([tracks.theta for tracks in trials]),
        np.concatenate([tracks.rho for tracks in trials]),
        np.concatenate([tracks.score for tracks in trials]),
        np.zeros(len(trials), np.int64),
        plots,
    )
