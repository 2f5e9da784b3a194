"""Kinematic states of tracks: least squares over the plots of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.kinematics.least_squares import Fitting, fit_tracks
from algorithms.kinematics.matrices import axes_of
from algorithms.kinematics.measured import Measured
from algorithms.kinematics.noise import covariances
from algorithms.plots import PlotChunk, Plots
from algorithms.tracks import TrackChunk, TrackStates


def with_states(chunk: PlotChunk, tracks: TrackChunk, context: Context, dimensions: int = 2) -> TrackChunk:
    """Return tracks with their kinematic states: the constant velocities that fit their plots best.

    Each plot is weighted by the inverse of its covariance (see `noise.covariances`); where the noise is
    not known all weigh the same, and the states have no covariance. Tracks that have states keep them.

    Parameters
    ----------
    chunk : the plots
    tracks : with their plots
    context : what is known of the sensor
    dimensions : of the states: 2 in the plane (x, y), 3 in space
    """
    if tracks.states is not None:
        return tracks
    assert tracks.plots is not None
    noise = covariances(chunk, context, dimensions)
    states = TrackStates.open(len(tracks.theta), dimensions)
    fit_tracks(
        Measured.of(chunk, noise, dimensions), chunk.offsets, tracks.offsets, tracks.plots,
        Fitting.of(dimensions), states, axes_of(dimensions),
    )  # fmt: skip
    if noise is None:
        states.covariance[:] = np.nan
    return replace(tracks, states=states)


def fitted_states(
    plots: Plots, rows: Sequence[NDArray[np.int64]], context: Context, dimensions: int = 2
) -> TrackStates:
    """Return the states that fit sets of plots best, as `with_states` works them out.

    Parameters
    ----------
    plots : the batch
    rows : for each track the rows of its plots, in order of scan
    context : what is known of the sensor
    dimensions : of the states: 2 in the plane (x, y), 3 in space
    """
    held = np.full((len(rows), max(map(len, rows), default=0)), -1, np.int64)
    for line, own in zip(held, rows, strict=True):
        line[: len(own)] = own
    blank = np.zeros(len(rows))
    offsets = np.array([0, len(rows)], dtype=np.int64)
    tracks = TrackChunk(offsets, blank, blank, blank, np.zeros(1, np.int64), held)
    states = with_states(plots.chunk(), tracks, context, dimensions).states
    assert states is not None
    return states
