"""GOSPA: one distance between all tracks of a trial and all its targets, with its parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.target_states import TargetStates
from algorithms.tracks import TrackStates

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Gospa:
    """Squares of the GOSPA distance (order 2, α 2) of each trial: its three parts, which add up.

    Attributes
    ----------
    localisation : float64 (trials,), sum of the squared distances of assigned tracks and targets
    missed, false : float64 (trials,), half the squared cutoff for each target without a track, and for
        each track without a target
    """

    localisation: Array
    missed: Array
    false: Array

    @property
    def square(self) -> Array:
        """The square of the distance, float64 (trials,)."""
        total: Array = self.localisation + self.missed + self.false
        return total


@kernel
def _squared_distance(states, track, position, present, trial, target):  # type: ignore[no-untyped-def]
    """Return the squared distance of a track from a target at the track's first scan."""
    scan = states.scan[track]
    if scan < 0 or not present[scan, target]:
        return np.inf
    square = 0.0
    for axis in range(states.position.shape[1]):
        square += (states.position[track, axis] - position[trial, scan, target, axis]) ** 2
    return square


@kernel
def _assign(cost, rows, columns, potential, other_potential, assigned, came_from, slack, is_used):  # type: ignore[no-untyped-def]
    """Assign each row to a column of its own, at the least sum of costs: shortest augmenting paths.

    Parameters
    ----------
    cost : float64 (≥ rows, ≥ columns), rows ≤ columns
    potential, other_potential, came_from, slack, is_used : working space, one longer than rows or columns
    assigned : int64, to which row each column goes, −1 for none; the result
    """
    potential[:rows], other_potential[: columns + 1], assigned[: columns + 1] = 0.0, 0.0, -1
    for row in range(rows):
        # The column beyond the last stands for the row that still seeks one.
        here = columns
        assigned[here] = row
        slack[: columns + 1], is_used[: columns + 1] = np.inf, False
        while assigned[here] >= 0:
            is_used[here] = True
            own, step, following = assigned[here], np.inf, -1
            for column in range(columns):
                if is_used[column]:
                    continue
                reduced = cost[own, column] - potential[own] - other_potential[column]
                if reduced < slack[column]:
                    slack[column], came_from[column] = reduced, here
                if slack[column] < step:
                    step, following = slack[column], column
            for column in range(columns + 1):
                if is_used[column]:
                    potential[assigned[column]] += step
                    other_potential[column] -= step
                else:
                    slack[column] -= step
            here = following
        while here != columns:
            assigned[here] = assigned[came_from[here]]
            here = came_from[here]


@kernel
def _localised(offsets, states, position, present, square_of_cutoff):  # type: ignore[no-untyped-def]
    """Return the sum of squared distances of the best assignment of each trial, and how many it assigns."""
    trials, targets = position.shape[0], position.shape[2]
    most = 0
    for trial in range(trials):
        most = max(most, offsets[trial + 1] - offsets[trial])
    # A target may go to a track, or to a place of its own that says it is missed.
    cost = np.empty((targets, most + targets))
    size = most + targets + 1
    potential, other_potential = np.empty(targets + 1), np.empty(size)
    assigned, came_from = np.empty(size, np.int64), np.empty(size, np.int64)
    slack, is_used = np.empty(size), np.empty(size, np.bool_)
    localisation, count = np.zeros(trials), np.zeros(trials, np.int64)
    for trial in range(trials):
        near = 0
        for track in range(offsets[trial], offsets[trial + 1]):
            is_near = False
            for target in range(targets):
                square = _squared_distance(states, track, position, present, trial, target)
                cost[target, near] = min(square, square_of_cutoff)
                is_near = is_near or square < square_of_cutoff
            # A track that is near no target is false whatever the others do.
            near += is_near
        cost[:, near : near + targets] = square_of_cutoff
        _assign(
            cost, targets, near + targets, potential, other_potential, assigned, came_from, slack, is_used
        )
        for column in range(near):
            target = assigned[column]
            if target >= 0 and cost[target, column] < square_of_cutoff:
                localisation[trial] += cost[target, column]
                count[trial] += 1
    return localisation, count


def gospa(offsets: NDArray[np.int64], states: TrackStates, targets: TargetStates, cutoff: float) -> Gospa:
    """Return the generalised optimal sub-pattern assignment of the tracks and targets of each trial.

    Parameters
    ----------
    offsets : int64 (trials + 1,), where each trial's tracks begin, and the end of the last
    states : of the tracks; a track is compared with targets at its own first scan, where it holds
    targets : true states; tracks in the plane are compared in x and y alone
    cutoff : c > 0; a track and a target farther apart are a false track and a missed target

    Notes
    -----
    The squared distance is the least, over all assignments γ of tracks to targets, of
    Σ d² over γ + ½ c² (targets + tracks − 2 |γ|). Targets that are there in no scan do not count.

    References
    ----------
    A. S. Rahmathullah, Á. F. García-Fernández and L. Svensson, 20th International Conference on
    Information Fusion, 2017.
    """
    if not cutoff > 0.0:
        raise ValueError(f"the cutoff of GOSPA is {cutoff}; it must be above 0")
    position = np.ascontiguousarray(targets.position[..., : states.dimensions])
    localisation, count = _localised(offsets, states, position, targets.present, cutoff**2)
    half, there = 0.5 * cutoff**2, int(targets.present.any(axis=0).sum())
    return Gospa(localisation, half * (there - count), half * (np.diff(offsets) - count))
