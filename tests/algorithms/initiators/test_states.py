"""States of tracks against the truth of simulated scenes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from algorithms.initiators.registry import initiator
from scenarios.model import Scenario
from scenarios.simulate import draw
from scenarios.world import World

PLANE = {
    "name": "plane",
    "unit": "km",
    "scans": 8,
    "interval": 4,
    "region": {"x": [0, 100], "y": [0, 100]},
    "sensor": {"kind": "cartesian", "sigma": [0.1, 0.1], "detection_probability": 0.9},
    "clutter": [{"rate": 5}],
    "targets": [
        {"position": [40, 20], "velocity": [0.3, 0.18]},
        {"position": [20, 80], "velocity": [0.3, -0.18]},
    ],
}
THREE = {**PLANE, "scans": 3, "sensor": {**PLANE["sensor"], "sigma": [0.05, 0.05]}}
"""One window of `modified`: a later one is looked at where its plots did not pass in an earlier one."""

SPACE = {
    "name": "space",
    "unit": "m",
    "scans": 4,
    "interval": 1,
    "region": {"x": [-10000, 10000], "y": [0, 40000], "z": [0, 5000]},
    "sensor": {"kind": "cartesian", "sigma": [50, 30, 40], "detection_probability": 0.9},
    "clutter": [{"rate": 5}],
    "targets": [
        {"position": [0, 30000, 2500], "velocity": [0, -250, -20]},
        {"position": [5000, 25000, 3000], "velocity": [-200, -200, 0]},
    ],
}


def pure_tracks(scenario, name, seed, trials, **parameters):
    """Return errors squared in units of their covariance, and the tracks, best pure one of each target.

    A track is pure where all its plots are one target's.
    """
    algorithm = initiator(name)
    resolved = algorithm.parameters.model_validate(parameters).resolved(scenario.context)
    drawn = draw(World.of(scenario), seed, 0, trials)
    tracks = algorithm.tracks_of_chunk(drawn.chunk, scenario.context, resolved, plots=True, states=True)
    trial_of = np.repeat(np.arange(trials), tracks.counts)
    squares, seen = [], {}
    for track in np.argsort(-tracks.score, kind="stable"):
        rows = tracks.plots[track]
        held = drawn.chunk.offsets[trial_of[track]] + rows[rows >= 0]
        own = set(drawn.origin[held].tolist())
        if len(own) > 1 or own == {-1} or len(held) < 2 or (trial_of[track], *own) in seen:
            continue
        seen[trial_of[track], own.pop()] = int(track), drawn.chunk.scan[held]
    for (_, target), (track, _) in seen.items():
        states, true = tracks.states, scenario.targets[target]
        velocity = np.array(true.velocity)
        place = np.array(true.position) + velocity * states.time[track]
        miss = np.concatenate([states.position[track] - place, states.velocity[track] - velocity])
        squares.append(miss @ np.linalg.solve(states.covariance[track], miss))
    return np.array(squares), tracks, seen


@pytest.mark.parametrize(
    ("name", "scene", "changes"),
    [
        ("standard", PLANE, {"fraction": 0.7}),
        ("sequential", PLANE, {"maxima": 4}),
        ("weighted", PLANE, {}),
        ("modified", THREE, {}),
        ("combinatorial-3d", SPACE, {}),
        ("hough-logic-3d", SPACE, {"plots": 3}),
        ("hough-3d", SPACE, {}),
    ],
)
def test_errors_of_states_are_as_their_covariances_say(name, scene, changes):
    scenario, trials = Scenario.model_validate(scene), 300
    squares, tracks, seen = pure_tracks(scenario, name, 11, trials, **changes)
    assert len(squares) > 0.5 * trials
    low, high = stats.chi2(2 * tracks.states.dimensions * len(squares)).ppf([0.025, 0.975])
    assert low < squares.sum() < high
    for track, scans in seen.values():
        assert tracks.states.scan[track] == scans[0]
        last = {"standard": 7, "sequential": 7, "weighted": 7, "hough-3d": 3}
        assert tracks.confirmed_scan[track] == (last[name] if name in last else scans[2])
