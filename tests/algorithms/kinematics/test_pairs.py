"""Pairs of plots that one target can have caused, against a loop over all."""

from __future__ import annotations

import itertools
import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.kinematics.gates import SpeedGate
from algorithms.kinematics.matrices import PLANE, SPACE
from algorithms.kinematics.measured import Measured
from algorithms.kinematics.pairs import by_first, components, pairs_within_reach

steady = settings(deadline=None, derandomize=True, max_examples=60)


def measured_of(position, time, scan, covariance):
    """Return plots for the kernels of kinematics; their weights are not used here."""
    return Measured(position, time, scan, covariance, np.zeros_like(covariance))


def batch(seed, dimensions, counts=(5, 6, 4, 7), extent=1500.0):
    random = np.random.default_rng(seed)
    scan = np.repeat(np.arange(len(counts)), counts).astype(np.int32)
    position = random.uniform(0.0, extent, (len(scan), dimensions))
    spread = random.normal(size=(len(scan), dimensions, dimensions)) * 40.0
    covariance = spread @ spread.transpose(0, 2, 1) + np.eye(dimensions)
    return measured_of(position, scan.astype(np.float64), scan, covariance)


@steady
@given(st.integers(0, 2**32), st.sampled_from([0.0, 3.0]), st.integers(1, 3), st.sampled_from([PLANE, SPACE]))
def test_pairs_within_reach_are_those_of_a_loop_over_all(seed, allowance, steps, axes):
    measured = batch(seed, len(axes))
    position, _, scan, covariance, _ = measured
    pairs, every = pairs_within_reach(measured, SpeedGate(50.0, 400.0, allowance), steps, axes)
    expected, tried = set(), 0
    for first, second in itertools.product(range(len(scan)), repeat=2):
        apart = scan[second] - scan[first]
        if not 0 < apart <= steps:
            continue
        tried += 1
        moved = position[second] - position[first]
        distance = np.linalg.norm(moved)
        along = moved / distance
        noise = allowance * math.sqrt(along @ (covariance[first] + covariance[second]) @ along)
        if 50.0 * apart - noise <= distance <= 400.0 * apart + noise:
            expected.add((first, second))
    assert {tuple(pair) for pair in pairs.tolist()} == expected
    assert every == tried


def test_equal_places_are_within_reach_of_noise_alone():
    position, time, scan = np.zeros((2, 3)), np.array([0.0, 1.0]), np.array([0, 1], np.int32)
    covariance = np.tile(np.eye(3), (2, 1, 1))
    for allowance, found in ((0.0, 0), (3.0, 1)):
        measured = measured_of(position, time, scan, covariance)
        pairs, every = pairs_within_reach(measured, SpeedGate(50.0, 400.0, allowance), 3, SPACE)
        assert (len(pairs), every) == (found, 1)


def test_the_latest_plot_of_a_scan_decides_how_far_is_searched():
    # Within a scan times need not rise; those of a recording are as they are.
    position = np.array([[0.0, 0.0, 0.0], [390.0, 0.0, 0.0], [790.0, 0.0, 0.0]])
    time, scan = np.array([0.0, 1.0, 2.0]), np.array([0, 1, 1], np.int32)
    for order in ([0, 1, 2], [0, 2, 1]):
        measured = measured_of(position[order], time[order], scan, np.zeros((3, 3, 3)))
        pairs, _ = pairs_within_reach(measured, SpeedGate(50.0, 400.0), 3, SPACE)
        assert sorted(pairs.tolist()) == [[0, 1], [0, 2]]


def test_plots_of_one_time_are_within_reach_where_noise_may_part_them():
    # Of two sensors: their scans have two numbers and one time.
    time, scan = np.zeros(3), np.array([0, 1, 1], np.int32)
    position = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    # One covariance for all; the standard deviation of their distance is √2.
    measured, gate = measured_of(position, time, scan, np.eye(3)[None]), SpeedGate(50.0, 400.0, 3.0)
    pairs, every = pairs_within_reach(measured, gate, 3, SPACE)
    assert (pairs.tolist(), every) == ([[0, 1]], 2)
    backwards = measured._replace(time=np.array([1.0, 0.0, 0.0]))
    assert len(pairs_within_reach(backwards, gate._replace(slowest=0.0), 3, SPACE)[0]) == 0


@steady
@given(st.integers(0, 2**32))
def test_components_and_pairs_by_their_first_plot(seed):
    random = np.random.default_rng(seed)
    pairs = np.sort(random.integers(0, 12, (9, 2)), axis=1)
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    kept = random.random(len(pairs)) < 0.7
    groups = components(12, pairs, kept)
    graph = {node: {node} for node in range(12)}
    for first, second in pairs[kept].tolist():
        joined = graph[first] | graph[second]
        for node in joined:
            graph[node] = joined
    for first, second in itertools.combinations(range(12), 2):
        assert (groups[first] == groups[second]) == (second in graph[first])
    ordered, begins = by_first(pairs, kept, 12)
    assert sorted(map(tuple, ordered.tolist())) == sorted(map(tuple, pairs[kept].tolist()))
    for plot in range(12):
        assert (ordered[begins[plot] : begins[plot + 1], 0] == plot).all()
