"""Tracks against truth: which targets were found, which tracks are false, which are duplicates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

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
    best : int64 (trials, targets), the row of the matching track with the highest score, of equals the
        first, which truth has no part in choosing; −1 where none
    confirmed : int64 (trials, targets), the first scan with which a matching track was confirmed; −1 where
        none, or where tracks do not say it
    """

    found: NDArray[np.bool_]
    false: NDArray[np.int64]
    duplicates: NDArray[np.int64]
    state: NDArray[np.int8]
    theta_error: NDArray[np.float64]
    rho_error: NDArray[np.float64]
    mixed: NDArray[np.int64]
    best: NDArray[np.int64]
    confirmed: NDArray[np.int64]


class Candidates(NamedTuple):
    """Tracks of a chunk as the kernel takes them.

    Attributes
    ----------
    offsets : int64 (trials + 1,), where each trial's tracks begin
    theta, rho, score : float64 (m,)
    confirmed_scan : int64 (m,), −1 where it is open
    shared : int64 (m, targets), plots of each track that came from each target; of length 0 where
        the criterion does not ask for plots
    """

    offsets: NDArray[np.int64]
    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    score: NDArray[np.float64]
    confirmed_scan: NDArray[np.int64]
    shared: NDArray[np.int64]


class TrueLines(NamedTuple):
    """The lines of the targets as the kernel takes them: see `Truth`."""

    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    middle: NDArray[np.float64]


class Bounds(NamedTuple):
    """A criterion as the kernel takes it: see `Criterion`; NaN and 0 for bounds that it does not have."""

    rho: float
    theta: float
    plots: int
    mid_track: bool
    nearest: bool


@kernel
def _differences(theta, rho, lines, trial, target, mid_track):  # type: ignore[no-untyped-def]
    """Return the signed differences of a line from a target's in θ and ρ, ρ about its middle if asked for."""
    angle, distance = separation(theta, rho, lines.theta[trial, target], lines.rho[trial, target])
    if mid_track:
        x, y = lines.middle[trial, target, 0], lines.middle[trial, target, 1]
        distance = rho - x * np.cos(theta) - y * np.sin(theta)
    return angle, distance


@kernel
def _nearest(theta, rho, lines, trial, bounds):  # type: ignore[no-untyped-def]
    """Return the nearest of the targets within both bounds, −1 where there is none."""
    best, least = -1, np.inf
    for target in range(lines.theta.shape[1]):
        angle, distance = _differences(theta, rho, lines, trial, target, bounds.mid_track)
        if abs(angle) <= bounds.theta and abs(distance) <= bounds.rho:
            apart = (angle / bounds.theta) ** 2 + (distance / bounds.rho) ** 2
            if apart < least:
                best, least = target, apart
    return best


@kernel
def _matches_line(angle, distance, plain, bounds):  # type: ignore[no-untyped-def]
    if np.isnan(bounds.theta):
        return abs(plain) <= bounds.rho
    return abs(angle) <= bounds.theta and abs(distance) <= bounds.rho


@kernel
def _score(tracks, lines, bounds):  # type: ignore[no-untyped-def]
    trials, targets = lines.theta.shape
    found = np.zeros((trials, targets), np.bool_)
    false, duplicates = np.zeros(trials, np.int64), np.zeros(trials, np.int64)
    state = np.full(len(tracks.theta), FALSE, np.int8)
    theta_error, rho_error = np.full((trials, targets), np.nan), np.full((trials, targets), np.nan)
    best = np.full((trials, targets), -1, np.int64)
    confirmed = np.full((trials, targets), -1, np.int64)
    for trial in range(trials):
        for track in range(tracks.offsets[trial], tracks.offsets[trial + 1]):
            theta, rho, scan = tracks.theta[track], tracks.rho[track], tracks.confirmed_scan[track]
            matches, is_new, only = False, False, -1
            if bounds.nearest:
                only = _nearest(theta, rho, lines, trial, bounds)
            for target in range(targets):
                angle, distance = _differences(theta, rho, lines, trial, target, bounds.mid_track)
                if bounds.plots > 0:
                    matched = tracks.shared[track, target] >= bounds.plots
                elif bounds.nearest:
                    matched = target == only
                else:
                    matched = _matches_line(angle, distance, rho - lines.rho[trial, target], bounds)
                if not matched:
                    continue
                matches = True
                is_new = is_new or not found[trial, target]
                found[trial, target] = True
                if scan >= 0 and (confirmed[trial, target] < 0 or scan < confirmed[trial, target]):
                    confirmed[trial, target] = scan
                before = best[trial, target]
                score, of_best = tracks.score[track], -np.inf
                if before >= 0:
                    of_best = tracks.score[before]
                nearer = score == of_best and abs(distance) < abs(rho_error[trial, target])
                if score > of_best:
                    best[trial, target] = track
                if score > of_best or nearer:
                    theta_error[trial, target] = angle
                    rho_error[trial, target] = distance
            if not matches:
                false[trial] += 1
            elif is_new:
                state[track] = FINDER
            else:
                state[track] = DUPLICATE
                duplicates[trial] += 1
    return found, false, duplicates, state, theta_error, rho_error, best, confirmed


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
            if state[track] == FALSE or plots[track, 0] < 0:
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
    shared = np.zeros((0, 0), np.int64)
    if criterion.plots is not None:
        assert tracks.plots is not None
        shared = _shared(tracks.plots, tracks.offsets, plot_offsets, truth.origin, truth.targets)
    confirmed_scan = tracks.confirmed_scan
    if confirmed_scan is None:
        confirmed_scan = np.full(len(tracks.theta), -1, np.int64)
    found, false, duplicates, state, theta_error, rho_error, best, confirmed = _score(
        Candidates(tracks.offsets, tracks.theta, tracks.rho, tracks.score, confirmed_scan, shared),
        TrueLines(truth.theta, truth.rho, truth.middle),
        Bounds(
            np.nan if criterion.rho is None else criterion.rho,
            np.nan if criterion.theta is None else criterion.theta,
            criterion.plots or 0,
            criterion.mid_track,
            criterion.nearest,
        ),
    )
    mixed = np.full(len(tracks.counts), -1, np.int64)
    if tracks.plots is not None and tracks.plots.shape[1] > 0:
        mixed = _mixed(tracks.plots, state, tracks.offsets, plot_offsets, truth.origin)
    return Scores(found, false, duplicates, state, theta_error, rho_error, mixed, best, confirmed)
