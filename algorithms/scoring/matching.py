"""Tracks against truth: which targets were found, which tracks are false, which are duplicates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.lines import separation
from algorithms.target_states import TargetStates
from algorithms.tracks import TrackChunk

FALSE, FINDER, DUPLICATE = 0, 1, 2
"""States of a track: it matches no target; it is the first to match one; others were before it."""


@dataclass(frozen=True, slots=True)
class Criterion:
    """When a track matches a target: by its line, or by the plots that they share.

    Attributes
    ----------
    rho : greatest difference in ρ; None to match by plots
    theta : greatest difference in θ, radians; None compares ρ alone, as it stands in normal
        form, which is how the course report counts
    plots : least number of a track's plots that came from the target; None to match by line
    mid_track : whether ρ is compared about the middle of the target's path, not about the origin,
        where a difference in θ moves it by the distance of the target; asks for `theta`
    nearest : whether a track matches, of the targets within both bounds, only the one that is
        nearest in them (by the sum of squares of the two differences, each in its bound)
    """

    rho: float | None = None
    theta: float | None = None
    plots: int | None = None
    mid_track: bool = False
    nearest: bool = False


@dataclass(frozen=True, slots=True)
class Truth:
    """The targets of a chunk.

    Attributes
    ----------
    theta, rho : float64 (trials, targets), their lines in normal form; NaN for a target that
        stands still
    middle : float64 (trials, targets, 2), the middle of each target's path
    origin : int32 (plots of the chunk,), the target that caused each plot, −1 for clutter
    states : where each target is at every scan of each trial; None where lines and plots alone are judged
    """

    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    middle: NDArray[np.float64]
    origin: NDArray[np.int32]
    states: TargetStates | None = None

    @property
    def targets(self) -> int:
        """Number of targets."""
        return int(self.theta.shape[1])


@dataclass(frozen=True, slots=True)
class Scores:
    """What a criterion says of the tracks of a chunk, one row a trial.

    Attributes
    ----------
    found : bool (trials, targets), whether at least one track matches
    false : int64 (trials,), tracks that match no target
    duplicates : int64 (trials,), tracks that match only targets that an earlier track matched
    state : int8 (tracks,), `FALSE`, `FINDER` or `DUPLICATE`, of each track
    theta_error, rho_error : float64 (trials, targets), of the matching track with the highest
        score (of equals, the nearest in ρ), signed, across the seam at 0 and π; NaN where none
    mixed : int64 (trials,), tracks that match a target and hold plots of more than one origin,
        such as clutter; −1 where the tracks' plots are not known
    """

    found: NDArray[np.bool_]
    false: NDArray[np.int64]
    duplicates: NDArray[np.int64]
    state: NDArray[np.int8]
    theta_error: NDArray[np.float64]
    rho_error: NDArray[np.float64]
    mixed: NDArray[np.int64]


@kernel
def _matches_line(angle, distance, plain, tolerance_rho, tolerance_theta):  # type: ignore[no-untyped-def]
    if np.isnan(tolerance_theta):
        return abs(plain) <= tolerance_rho
    return abs(angle) <= tolerance_theta and abs(distance) <= tolerance_rho


@kernel
def _line_differences(theta, rho, true_theta, true_rho, x, y, mid_track):  # type: ignore[no-untyped-def]
    """Return the signed differences of two lines in θ and in ρ, ρ about (x, y) where that is asked for."""
    angle, distance = separation(theta, rho, true_theta, true_rho)
    if mid_track:
        distance = rho - x * np.cos(theta) - y * np.sin(theta)
    return angle, distance


@kernel
def _nearest(theta, rho, true_theta, true_rho, middle, tolerance_rho, tolerance_theta, mid_track):  # type: ignore[no-untyped-def]
    """Return the nearest of the targets within both tolerances, −1 where there is none."""
    best, least = -1, np.inf
    for target in range(len(true_theta)):
        angle, distance = _line_differences(
            theta, rho, true_theta[target], true_rho[target], middle[target, 0], middle[target, 1], mid_track
        )
        if abs(angle) <= tolerance_theta and abs(distance) <= tolerance_rho:
            apart = (angle / tolerance_theta) ** 2 + (distance / tolerance_rho) ** 2
            if apart < least:
                best, least = target, apart
    return best


@kernel
def _score(  # type: ignore[no-untyped-def]
    offsets, theta, rho, rank, shared, true_theta, true_rho, middle, tolerance_rho, tolerance_theta,
    least_plots, mid_track, nearest,
):  # fmt: skip
    trials, targets = true_theta.shape
    found = np.zeros((trials, targets), np.bool_)
    false, duplicates = np.zeros(trials, np.int64), np.zeros(trials, np.int64)
    state = np.full(len(theta), FALSE, np.int8)
    theta_error = np.full((trials, targets), np.nan)
    rho_error = np.full((trials, targets), np.nan)
    best = np.empty(targets, np.float64)
    for trial in range(trials):
        best[:] = -np.inf
        for track in range(offsets[trial], offsets[trial + 1]):
            matches, is_new, only = False, False, -1
            if nearest:
                only = _nearest(
                    theta[track], rho[track], true_theta[trial], true_rho[trial], middle[trial],
                    tolerance_rho, tolerance_theta, mid_track,
                )  # fmt: skip
            for target in range(targets):
                angle, distance = _line_differences(
                    theta[track], rho[track], true_theta[trial, target], true_rho[trial, target],
                    middle[trial, target, 0], middle[trial, target, 1], mid_track,
                )  # fmt: skip
                if least_plots > 0:
                    matched = shared[track, target] >= least_plots
                elif nearest:
                    matched = target == only
                else:
                    plain = rho[track] - true_rho[trial, target]
                    matched = _matches_line(angle, distance, plain, tolerance_rho, tolerance_theta)
                if not matched:
                    continue
                matches = True
                is_new = is_new or not found[trial, target]
                found[trial, target] = True
                nearer = rank[track] == best[target] and abs(distance) < abs(rho_error[trial, target])
                if rank[track] > best[target] or nearer:
                    best[target] = rank[track]
                    theta_error[trial, target] = angle
                    rho_error[trial, target] = distance
            if not matches:
                false[trial] += 1
            elif is_new:
                state[track] = FINDER
            else:
                state[track] = DUPLICATE
                duplicates[trial] += 1
    return found, false, duplicates, state, theta_error, rho_error


@kernel
def _shared(plots, track_offsets, plot_offsets, origin, targets):  # type: ignore[no-untyped-def]
    shared = np.zeros((len(plots), targets), np.int64)
    for trial in range(len(track_offsets) - 1):
        for track in range(track_offsets[trial], track_offsets[trial + 1]):
            for row in plots[track]:
                if row >= 0 and origin[plot_offsets[trial] + row] >= 0:
                    shared[track, origin[plot_offsets[trial] + row]] += 1
    return shared


@kernel
def _mixed(plots, state, track_offsets, plot_offsets, origin):  # type: ignore[no-untyped-def]
    mixed = np.zeros(len(track_offsets) - 1, np.int64)
    for trial in range(len(track_offsets) - 1):
        for track in range(track_offsets[trial], track_offsets[trial + 1]):
            if state[track] == FALSE:
                continue
            first = origin[plot_offsets[trial] + plots[track, 0]]
            for row in plots[track]:
                if row >= 0 and origin[plot_offsets[trial] + row] != first:
                    mixed[trial] += 1
                    break
    return mixed


def score(tracks: TrackChunk, truth: Truth, plot_offsets: NDArray[np.int64], criterion: Criterion) -> Scores:
    """Return what a criterion says of the tracks of a chunk.

    Parameters
    ----------
    tracks : the tracks; with their plots where the criterion asks for plots
    truth : the targets
    plot_offsets : int64 (trials + 1,), where each trial's plots begin
    criterion : when a track matches a target
    """
    least = 0 if criterion.plots is None else criterion.plots
    if least:
        assert tracks.plots is not None
        shared = _shared(tracks.plots, tracks.offsets, plot_offsets, truth.origin, truth.targets)
    else:
        shared = np.zeros((0, 0), np.int64)
    found, false, duplicates, state, theta_error, rho_error = _score(
        tracks.offsets, tracks.theta, tracks.rho, tracks.score, shared, truth.theta, truth.rho, truth.middle,
        np.nan if criterion.rho is None else criterion.rho,
        np.nan if criterion.theta is None else criterion.theta,
        least, criterion.mid_track, criterion.nearest,
    )  # fmt: skip
    mixed = np.full(len(tracks.counts), -1, np.int64)
    if tracks.plots is not None and tracks.plots.shape[1] > 0:
        mixed = _mixed(tracks.plots, state, tracks.offsets, plot_offsets, truth.origin)
    return Scores(found, false, duplicates, state, theta_error, rho_error, mixed)
