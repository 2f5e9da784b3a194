"""The search for motions, and the choice among them, against plain recursion and counting."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.kinematics.gates import SpeedGate
from algorithms.kinematics.matrices import SPACE
from algorithms.kinematics.measured import Measured
from algorithms.kinematics.track_search import Candidates, TrackRule, choose_disjoint, search_motions

steady = settings(deadline=None, derandomize=True, max_examples=40)

SLOWEST, FASTEST = 50.0, 400.0
LIMITS = np.array([[np.inf, np.inf, np.inf, 6.0, 10.0, 14.0], [np.inf, np.inf, np.inf, 7.0, 11.0, 15.0]])
PLANES = np.array([[0, 2], [1, 2]])


def fitted(position, time, covariance, rows):
    """Return χ², speed and the standard deviation of the speed of a constant velocity, by lstsq."""
    weight = np.linalg.inv(covariance[rows])
    elapsed = time[rows] - time[rows[0]]
    design = np.concatenate([np.concatenate([np.eye(3), t * np.eye(3)], axis=1) for t in elapsed])
    white = np.zeros((3 * len(rows), 3 * len(rows)))
    for k in range(len(rows)):
        white[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = np.linalg.cholesky(weight[k]).T
    place = (position[rows] - position[rows[0]]).ravel()
    state = np.linalg.lstsq(white @ design, white @ place, rcond=None)[0]
    square = float(((white @ (place - design @ state)) ** 2).sum())
    spread = np.linalg.inv(design.T @ white.T @ white @ design)[3:, 3:]
    speed = float(np.linalg.norm(state[3:]))
    along = state[3:] / speed
    return square, speed, math.sqrt(along @ spread @ along), state[3:]


def motions_by_recursion(position, time, covariance, follows, usable, least, allowance, planes):
    """Return the tracks that `search_motions` shall find: plots and χ²."""
    found = {}

    def go_on(path):
        for plot in follows[path[-1]]:
            if not usable[plot]:
                continue
            longer = [*path, plot]
            if len(longer) > 2:
                square, speed, deviation, velocity = fitted(position, time, covariance, longer)
                noise = allowance * deviation
                if square > LIMITS[1, len(longer)] or not SLOWEST - noise <= speed <= FASTEST + noise:
                    continue
                across = [np.linalg.norm(velocity[plane]) >= SLOWEST for plane in planes]
                if len(longer) >= least and square <= LIMITS[0, len(longer)] and all(across):
                    found[tuple(longer)] = square
            if len(longer) < LIMITS.shape[1] - 1:
                go_on(longer)

    for start in np.flatnonzero(usable):
        go_on([int(start)])
    return found


@steady
@given(st.integers(0, 2**32), st.sampled_from([0.0, 1.0, 3.0]), st.sampled_from([3, 4]), st.booleans())
def test_motions_are_those_of_plain_recursion(seed, allowance, least, in_planes):
    random = np.random.default_rng(seed)
    # Two targets about which the limits decide: near the bounds of speed, and with noise as of radar.
    scans, time = np.repeat(np.arange(5), 3), np.repeat(np.arange(5.0), 3)
    speeds = random.choice([45.0, 60.0, 200.0, 390.0, 410.0], 2)
    courses = random.normal(size=(2, 3)) * [1.0, 1.0, 0.2]
    courses[0, 0] *= 0.2
    velocity = speeds[:, None] * courses / np.linalg.norm(courses, axis=1, keepdims=True)
    spread = random.normal(size=(15, 3, 3)) * 8.0
    covariance = spread @ spread.transpose(0, 2, 1) + 100.0 * np.eye(3)
    start = np.array([[0.0, 0.0, 0.0], [900.0, 0.0, 0.0]])
    position = random.uniform(-500.0, 1500.0, (15, 3))
    for target in range(2):
        for scan in range(5):
            plot = 3 * scan + target
            noise = np.linalg.cholesky(covariance[plot]) @ random.normal(size=3)
            position[plot] = start[target] + velocity[target] * scan + noise
    usable = random.random(15) < 0.9
    pairs = np.array(
        [(a, b) for a in range(15) for b in range(15) if 0 < scans[b] - scans[a] <= 2], dtype=np.int64
    )
    begins = np.searchsorted(pairs[:, 0], np.arange(16))
    follows = [pairs[begins[plot] : begins[plot + 1], 1].tolist() for plot in range(15)]
    planes = PLANES if in_planes else PLANES[:0]
    made = Candidates.of(5, 3)
    rule = TrackRule(SpeedGate(SLOWEST, FASTEST, allowance), least, LIMITS, planes)
    measured = Measured(position, time, scans.astype(np.int32), covariance, np.linalg.inv(covariance))
    count = search_motions(measured, pairs, begins, usable, rule, made, SPACE)
    expected = motions_by_recursion(position, time, covariance, follows, usable, least, allowance, planes)
    tracks = {
        tuple(row[row >= 0].tolist()): square
        for row, square in zip(made.plots[:count], made.squares[:count], strict=True)
    }
    assert tracks.keys() == expected.keys()
    for track, square in expected.items():
        assert tracks[track] == pytest.approx(square, rel=1e-6, abs=1e-6)


@steady
@given(st.integers(0, 2**32))
def test_the_best_tracks_without_a_plot_in_common_are_chosen(seed):
    random = np.random.default_rng(seed)
    found, squares = np.full((12, 5), -1, np.int64), random.choice([0.0, 0.5, 3.0, 40.0, 1e6], 12)
    for track in range(12):
        length = random.integers(3, 6)
        found[track, :length] = random.choice(20, length, replace=False)
    taken, chosen = np.zeros(20, bool), np.empty(12, np.int64)
    taken[7] = True
    number = choose_disjoint(found, squares, 12, taken, chosen)
    lengths = (found >= 0).sum(axis=1)
    free, expected = set(range(20)) - {7}, []
    for track in sorted(range(12), key=lambda track: (-lengths[track], squares[track])):
        own = set(found[track, : lengths[track]].tolist())
        if own <= free:
            free -= own
            expected.append(track)
    assert chosen[:number].tolist() == expected
    assert set(np.flatnonzero(taken)) == set(range(20)) - free


def test_plots_of_one_time_wait_for_a_later_one():
    # Three sensors at one time: no velocity fits their plots alone.
    time = np.array([0.0, 0.0, 0.0, 1.0])
    position = np.array([[0.0, 0, 0], [1.0, 0, 0], [-1.0, 0, 0], [100.0, 0, 0]])
    pairs, begins = np.array([[0, 1], [1, 2], [2, 3]]), np.array([0, 1, 2, 3, 3])
    limits = np.full((2, 5), np.inf)
    limits[:, 4] = 2.5
    rule, made = TrackRule(SpeedGate(50.0, 400.0), 4, limits, PLANES[:0]), Candidates.of(4, 3)
    measured = Measured(position, time, np.array([0, 0, 0, 1], np.int32), np.eye(3)[None], np.eye(3)[None])
    count = search_motions(measured, pairs, begins, np.ones(4, bool), rule, made, SPACE)
    assert made.plots[:count].tolist() == [[0, 1, 2, 3]]
    assert made.squares[0] == pytest.approx(2.0)
