"""Kinematic errors: the initial states of tracks against the true states of the targets that they match."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.target_states import TargetStates
from algorithms.tracks import TrackStates

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class KinematicErrors:
    """Errors of one track for each target of each trial; NaN where there is no track, or its state is open.

    Attributes
    ----------
    position, velocity : float64 (trials, targets), lengths of the errors at the track's first scan
    cross_track : float64 (trials, targets), distance across the target's course in the middle of its path
    nees : float64 (trials, targets), normalised estimation error squared, eᵀ P⁻¹ e of the error e of
        position and velocity together, P their covariance; its mean is the number of their
        components, 4 in the plane and 6 in space, where the covariances are right
    """

    position: Array
    velocity: Array
    cross_track: Array
    nees: Array


class Truth(NamedTuple):
    """True states as the kernels take them: see `TargetStates`."""

    time: Array
    present: NDArray[np.bool_]
    position: Array
    velocity: Array

    @classmethod
    def of(cls, states: TargetStates, dimensions: int) -> Truth:
        """Return the true states in the first axes."""
        axes = slice(dimensions)
        return cls(
            states.time,
            states.present,
            np.ascontiguousarray(states.position[..., axes]),
            np.ascontiguousarray(states.velocity[..., axes]),
        )


@kernel
def _normalised_square(error, covariance, factor):  # type: ignore[no-untyped-def]
    """Return eᵀ P⁻¹ e by Cholesky's factor of P, NaN where P is no covariance; the error is spent."""
    size, total = len(error), 0.0
    for row in range(size):
        for column in range(row + 1):
            rest = covariance[row, column]
            for other in range(column):
                rest -= factor[row, other] * factor[column, other]
            if row != column:
                factor[row, column] = rest / factor[column, column]
            elif rest > 0.0:
                factor[row, row] = np.sqrt(rest)
            else:
                return np.nan
        for other in range(row):
            error[row] -= factor[row, other] * error[other]
        error[row] /= factor[row, row]
        total += error[row] * error[row]
    return total


@kernel
def _middle(present):  # type: ignore[no-untyped-def]
    """Return the scan in the middle of those from the first to the last in which a target is there."""
    first, last = -1, -1
    for scan in range(len(present)):
        if present[scan]:
            last = scan
            if first < 0:
                first = scan
    return (first + last) // 2 if first >= 0 else -1


@kernel
def _across(states, track, truth, trial, target, scan):  # type: ignore[no-untyped-def]
    """Return how far from a target's place at a scan a track passes across the target's course."""
    along, square, speed = 0.0, 0.0, 0.0
    elapsed = truth.time[scan] - states.time[track]
    for axis in range(truth.position.shape[3]):
        at = states.position[track, axis] + elapsed * states.velocity[track, axis]
        error = at - truth.position[trial, scan, target, axis]
        course = truth.velocity[trial, scan, target, axis]
        along += error * course
        square += error * error
        speed += course * course
    if speed == 0.0:
        return np.nan
    # Not max: an open velocity must stay open.
    return np.sqrt(np.maximum(0.0, square - along * along / speed))


@kernel
def _length(vector):  # type: ignore[no-untyped-def]
    square = 0.0
    for part in vector:
        square += part * part
    return np.sqrt(square)


@kernel
def _errors(best, states, truth):  # type: ignore[no-untyped-def]
    trials, targets = best.shape
    axes = truth.position.shape[3]
    position, velocity = np.full((trials, targets), np.nan), np.full((trials, targets), np.nan)
    cross_track, nees = np.full((trials, targets), np.nan), np.full((trials, targets), np.nan)
    error, factor = np.empty(2 * axes), np.empty((2 * axes, 2 * axes))
    for target in range(targets):
        middle = _middle(truth.present[:, target])
        for trial in range(trials):
            track = best[trial, target]
            if track < 0 or states.scan[track] < 0:
                continue
            scan = states.scan[track]
            for axis in range(axes):
                error[axis] = states.position[track, axis] - truth.position[trial, scan, target, axis]
                error[axes + axis] = states.velocity[track, axis] - truth.velocity[trial, scan, target, axis]
            position[trial, target] = _length(error[:axes])
            velocity[trial, target] = _length(error[axes:])
            cross_track[trial, target] = _across(states, track, truth, trial, target, middle)
            nees[trial, target] = _normalised_square(error, states.covariance[track], factor)
    return position, velocity, cross_track, nees


def kinematic_errors(best: NDArray[np.int64], states: TrackStates, targets: TargetStates) -> KinematicErrors:
    """Return the errors of the tracks that stand for targets.

    Parameters
    ----------
    best : int64 (trials, targets), which track stands for each target, −1 for none
    states : of the tracks, each at the scan of its first plot
    targets : true states; those of tracks in the plane are compared in x and y alone
    """
    dimensions = states.dimensions
    if dimensions > targets.position.shape[3]:
        raise ValueError(f"states of {dimensions} axes have no truth of {targets.position.shape[3]}")
    return KinematicErrors(*_errors(best, states, Truth.of(targets, dimensions)))
