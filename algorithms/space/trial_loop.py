"""Trial loop of the initiators in space: pairs of plots, what takes clutter away, tracks along the pairs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.kinematics.least_squares import fit_track
from algorithms.kinematics.matrices import SPACE
from algorithms.kinematics.measured import part_of
from algorithms.kinematics.pairs import pairs_within_reach
from algorithms.kinematics.track_search import disjoint_tracks
from algorithms.tracks import TrackStates

STEPS = 3
"""The most scans between the plots of a pair."""

LEAST_PLOTS = 3
"""The least number of plots of a track: any two fit a constant velocity."""


class TrackTable(NamedTuple):
    """Tracks of a chunk as they are written, with room for more.

    Attributes
    ----------
    plots : int64 (≥ m, most plots), rows of the plots of each track in its trial, −1 beyond the last
    states : of the tracks, as many rows
    """

    plots: NDArray[np.int64]
    states: TrackStates


@kernel
def table_of(rows, most):  # type: ignore[no-untyped-def]
    """Return a table of so many rows, for tracks of at most so many plots."""
    return TrackTable(
        np.full((rows, most), -1, np.int64),
        TrackStates(
            np.full(rows, -1, np.int64),
            np.full(rows, np.nan),
            np.full((rows, 3), np.nan),
            np.full((rows, 3), np.nan),
            np.full((rows, 6, 6), np.nan),
        ),
    )


@kernel
def with_track(table, count, measured, rows, space):  # type: ignore[no-untyped-def]
    """Return the table, enlarged where it is full, with one more track at `count`.

    Parameters
    ----------
    rows : int64, its plots, −1 beyond the last
    space : `Fitting`
    """
    if count == len(table.plots):
        larger = table_of(2 * count + 8, table.plots.shape[1])
        larger.plots[:count] = table.plots
        larger.states.scan[:count] = table.states.scan
        larger.states.time[:count] = table.states.time
        larger.states.position[:count] = table.states.position
        larger.states.velocity[:count] = table.states.velocity
        larger.states.covariance[:count] = table.states.covariance
        table = larger
    held = fit_track(measured, rows, space, table.states, count, SPACE)
    table.plots[count, :held] = rows[:held]
    return table


@kernel
def fitted_tracks(measured, pairs, kept, usable, rule, made, table, count):  # type: ignore[no-untyped-def]
    """Append the best disjoint tracks of one batch; see `disjoint_tracks`.

    Returns
    -------
    table : `TrackTable`, as it was or enlarged
    count : number of tracks so far
    is_full : whether more tracks fit than can be compared
    """
    chosen, is_full = disjoint_tracks(measured, pairs, kept, usable, rule, made, SPACE)
    for track in chosen:
        table = with_track(table, count, measured, made.plots[track], made.fitting)
        count += 1
    return table, count, is_full


def trial_loop(usable_plots: Callable[..., Any], append_tracks: Callable[..., Any]) -> Callable[..., Any]:
    """Return a kernel that finds the tracks of each trial of a chunk.

    Parameters
    ----------
    usable_plots : kernel (measured, pairs, sieve) -> (usable bool (n,), pairs left): which plots of a batch
        are no clutter
    append_tracks : kernel with the arguments and the results of `fitted_tracks`
    """

    @kernel
    def tracks_of_trials(measured, offsets, rule, sieve, made):  # type: ignore[no-untyped-def]
        """Return the ends of trials in the table, the table, and the pairs tried and left in each trial.

        Parameters
        ----------
        measured : `Measured`, of the chunk
        offsets : int64 (trials + 1,)
        rule : `TrackRule`
        sieve : what `usable_plots` needs to know
        made : `Candidates`, working space
        """
        trials = len(offsets) - 1
        ends = np.zeros(trials + 1, np.int64)
        tried, left = np.zeros(trials, np.int64), np.zeros(trials, np.int64)
        table, count, is_full = table_of(trials + 8, made.plots.shape[1]), 0, False
        for trial in range(trials):
            own = part_of(measured, offsets[trial], offsets[trial + 1])
            pairs, tried[trial] = pairs_within_reach(own, rule.gate, STEPS, SPACE)
            usable, left[trial] = usable_plots(own, pairs, sieve)
            kept = np.empty(len(pairs), np.bool_)
            for pair in range(len(pairs)):
                kept[pair] = usable[pairs[pair, 0]] and usable[pairs[pair, 1]]
            table, count, full = append_tracks(own, pairs, kept, usable, rule, made, table, count)
            is_full = is_full or full
            ends[trial + 1] = count
        return ends, table, count, tried, left, is_full

    return tracks_of_trials
