"""Checks of the tracks that a plug-in returns: what kernels, scores and tables could not take, in words."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.plots import PlotChunk, Plots
from algorithms.tracks import TrackChunk, Tracks, TrackStates


class ReturnedTracksError(ValueError):
    """Tracks that are not as an initiator must return them; the message says which and why."""


def checked_tracks(tracks: object, plots: Plots, context: Context, dimensions: int) -> Tracks:
    """Return the tracks of a batch with their columns as arrays of their types.

    Raises
    ------
    ReturnedTracksError
        Where they are not as `Tracks` declares.
    """
    if not isinstance(tracks, Tracks):
        raise ReturnedTracksError(f"it returned {type(tracks).__name__}, not Tracks")
    count = _length(tracks.theta, "theta")
    theta, rho, score = _lines(tracks, count, dimensions)
    rows = _columns(tracks.plots, count)
    track = np.repeat(np.arange(count), [len(own) for own in rows])
    _require_rows(track, np.concatenate([np.empty(0, np.int64), *rows]), plots.chunk(), np.zeros_like(track))
    return replace(
        tracks,
        theta=theta,
        rho=rho,
        score=score,
        plots=rows,
        states=_states(tracks.states, count, dimensions),
        confirmed_scan=_confirmed(tracks.confirmed_scan, count, context),
    )


def checked_chunk(tracks: object, chunk: PlotChunk, context: Context, dimensions: int) -> TrackChunk:
    """Return the tracks of a chunk with their columns as arrays of their types.

    Raises
    ------
    ReturnedTracksError
        Where they are not as `TrackChunk` declares.
    """
    if not isinstance(tracks, TrackChunk):
        raise ReturnedTracksError(f"it returned {type(tracks).__name__}, not a TrackChunk")
    count = _length(tracks.theta, "theta")
    theta, rho, score = _lines(tracks, count, dimensions)
    offsets = _whole(tracks.offsets, "offsets", (chunk.trials + 1,))
    if offsets[0] != 0 or offsets[-1] != count or (np.diff(offsets) < 0).any():
        raise ReturnedTracksError(f"its offsets must rise from 0 to the number of tracks, {count}")
    plots, confirmed, states = tracks.plots, tracks.confirmed_scan, tracks.states
    if plots is not None:
        plots = _whole(plots, "plots", (count, np.shape(plots)[-1] if np.ndim(plots) == 2 else 1))
        track, place = np.nonzero(plots != -1)
        trial = np.repeat(np.arange(chunk.trials), np.diff(offsets))
        _require_rows(track, plots[track, place], chunk, trial[track])
    return replace(
        tracks,
        offsets=offsets,
        theta=theta,
        rho=rho,
        score=score,
        votes_outside=_whole(tracks.votes_outside, "votes_outside", (chunk.trials,)),
        plots=plots,
        effort={
            name: _whole(counted, f"effort {name}", (chunk.trials,))
            for name, counted in tracks.effort.items()
        },
        confirmed_scan=None if confirmed is None else _confirmed(confirmed, count, context),
        states=None if states is None else _states(states, count, dimensions),
    )


def _lines(tracks: Tracks | TrackChunk, count: int, dimensions: int) -> tuple[NDArray[np.float64], ...]:
    theta, rho, score = (
        _numbers(getattr(tracks, name), name, (count,)) for name in ("theta", "rho", "score")
    )
    # A motion straight up or down has no line on the ground.
    is_line = np.ones(count, np.bool_) if dimensions == 2 else ~(np.isnan(theta) & np.isnan(rho))
    for is_wrong, symbol, values, allowed in (
        (is_line & ~((theta >= 0) & (theta < np.pi)), "θ", theta, "lie in [0, π), as normal_form brings it"),
        (is_line & ~np.isfinite(rho), "ρ", rho, "be a finite number"),
        (~np.isfinite(score), "the score", score, "be a finite number"),
    ):
        if is_wrong.any():
            track = int(np.argmax(is_wrong))
            raise ReturnedTracksError(f"track {track} has {symbol} = {values[track]:g}; it must {allowed}")
    return theta, rho, score


def _require_rows(
    track: NDArray[np.int64], row: NDArray[np.int64], chunk: PlotChunk, trial: NDArray[np.int64]
) -> None:
    """Refuse rows that are none of a batch's plots, or not at most one a scan in the order of scans.

    Parameters
    ----------
    track, row, trial : int64 (k,), of each plot of all tracks, in the order of tracks; rows count from the
        beginning of the trial
    """
    size = np.diff(chunk.offsets)[trial]
    for wrong in np.flatnonzero((row < 0) | (row >= size))[:1]:
        raise ReturnedTracksError(
            f"track {track[wrong]} names plot {row[wrong]}, and the batch has {size[wrong]} plots"
        )
    scan = chunk.scan[chunk.offsets[trial] + row]
    step = np.diff(scan)
    is_same_track = np.diff(track) == 0
    for twice in np.flatnonzero(is_same_track & (step == 0))[:1]:
        raise ReturnedTracksError(f"track {track[twice]} has two plots of scan {scan[twice]}; one is allowed")
    for back in np.flatnonzero(is_same_track & (step < 0))[:1]:
        raise ReturnedTracksError(f"the plots of track {track[back]} are not in the order of their scans")


def _columns(plots: Any, count: int) -> tuple[NDArray[np.int64], ...]:
    if _length(plots, "plots") != count:
        raise ReturnedTracksError(f"it returned {count} tracks and the plots of {len(plots)}")
    return tuple(
        _whole(rows, f"list of plots of track {track}", np.shape(rows)[:1])
        for track, rows in enumerate(plots)
    )


def _confirmed(values: object, count: int, context: Context) -> NDArray[np.int64]:
    scans = _whole(values, "confirmed_scan", (count,))
    is_wrong = (scans < 0) | (scans >= context.scans)
    if is_wrong.any():
        track = int(np.argmax(is_wrong))
        raise ReturnedTracksError(
            f"track {track} is confirmed in scan {scans[track]}; it must be one of 0 to {context.scans - 1}"
        )
    return scans


def _states(states: object, count: int, dimensions: int) -> TrackStates:
    if not isinstance(states, TrackStates):
        raise ReturnedTracksError(f"its states are {type(states).__name__}, not TrackStates")
    vector, matrix = (count, dimensions), (count, 2 * dimensions, 2 * dimensions)
    shapes = {"time": (count,), "position": vector, "velocity": vector, "covariance": matrix}
    numbers = {name: _numbers(getattr(states, name), name, shape) for name, shape in shapes.items()}
    for name, values in numbers.items():
        if np.isinf(values).any():
            track = int(np.argmax(np.isinf(values).reshape(count, -1).any(axis=1)))
            raise ReturnedTracksError(f"the {name} of track {track} is infinite; NaN stands for an open one")
    return TrackStates(scan=_whole(states.scan, "states.scan", (count,)), **numbers)


def _length(column: Any, name: str) -> int:
    try:
        return len(column)
    except TypeError:
        raise ReturnedTracksError(f"its {name} is {type(column).__name__}, not a column") from None


def _numbers(values: object, name: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
    try:
        column = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ReturnedTracksError(f"its {name} holds something else than numbers") from None
    return cast("NDArray[np.float64]", _shaped(column, name, shape))


def _whole(values: object, name: str, shape: tuple[int, ...]) -> NDArray[np.int64]:
    try:
        column = np.asarray(values)
    except ValueError:
        raise ReturnedTracksError(f"its {name} holds rows of different lengths") from None
    if column.size and not np.issubdtype(column.dtype, np.integer):
        raise ReturnedTracksError(f"its {name} holds {column.dtype}, not whole numbers")
    return cast("NDArray[np.int64]", _shaped(column.astype(np.int64, copy=False), name, shape))


def _shaped(column: NDArray[Any], name: str, shape: tuple[int, ...]) -> NDArray[Any]:
    if column.shape != shape:
        raise ReturnedTracksError(f"its {name} has the shape {column.shape}; it must be {shape}")
    return column
