"""Lines of targets: what a track that is a line is compared with.

A target of constant velocity has its line, whatever part of it is seen. One that turns, accelerates, flies
through waypoints or is disturbed has none: as its line stands the least-squares fit of a constant velocity to
its true positions in the scans in which it is there, which is what the fit to its plots tends to.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.lines import line_through
from algorithms.target_states import TargetStates
from scenarios.model import Scenario

Array = NDArray[np.float64]


def true_lines(scenario: Scenario, states: TargetStates) -> tuple[Array, Array, Array]:
    """Return the lines of targets in the plane (x, y), and the middles of their paths.

    Returns
    -------
    theta, rho : float64 (trials, targets); NaN for a target that stands still there
    middle : float64 (trials, targets, 2); on the line
    """
    shift = states.shift[..., :2]
    anchor, velocity, middle = np.empty_like(shift), np.empty_like(shift), np.empty_like(shift)
    for index, target in enumerate(scenario.targets):
        if target.motion.is_straight:
            ends = target.ends(scenario.interval, scenario.last_time)[:, :2]
            anchor[:, index] = np.array(target.position[:2]) + shift[:, index]
            velocity[:, index] = target.velocity[:2]
            middle[:, index] = ends.mean(axis=0) + shift[:, index]
        else:
            middle[:, index], velocity[:, index] = fitted_motion(states, index)
            anchor[:, index] = middle[:, index]
    return *line_through(anchor, velocity), middle


def fitted_motion(states: TargetStates, target: int) -> tuple[Array, Array]:
    """Return the least-squares fit of a constant velocity to the true positions of a target in each trial.

    Returns
    -------
    middle, velocity : float64 (trials, 2), in the plane (x, y): the mean of its positions, which is where the
        fit has it at their mean time, and its velocity; that of its state where it is there in one scan only,
        NaN where in none
    """
    present = states.present[:, target]
    place, time = states.position[:, present, target, :2], states.time[present]
    if not len(time):
        nowhere = np.full((len(place), 2), np.nan)
        return nowhere, nowhere
    centred = time - time.mean()
    spread = centred @ centred
    velocity = states.velocity[:, present, target, :2][:, 0]
    if spread > 0.0:
        velocity = np.einsum("s,tsd->td", centred, place) / spread
    return place.mean(axis=1), velocity
