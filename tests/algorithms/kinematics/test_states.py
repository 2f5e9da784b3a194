from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.context import Context, Unit
from algorithms.kinematics.states import fitted_states, with_states
from algorithms.plots import PlotChunk, Plots
from algorithms.tracks import TrackChunk

steady = settings(
    deadline=None, derandomize=True, max_examples=100, suppress_health_check=[HealthCheck.too_slow]
)
seeds = st.integers(0, 2**32)
SENSOR = Context(scans=20, interval=4.0, sigma=(0.2, 0.05, 0.1))


def oracle(position, time, covariance):
    """Return state and covariance by one dense least squares, columns x, y[, z], vx, vy[, vz]."""
    count, dimensions = position.shape
    design = np.concatenate([np.hstack([np.eye(dimensions), np.eye(dimensions) * t]) for t in time - time[0]])
    weight = np.zeros((count * dimensions, count * dimensions))
    for plot in range(count):
        here = slice(plot * dimensions, (plot + 1) * dimensions)
        weight[here, here] = np.linalg.inv(covariance[plot])
    information = design.T @ weight @ design
    spread = np.linalg.inv(information)
    start = np.tile(position[0], count)
    state = spread @ design.T @ weight @ (position.ravel() - start)
    state[:dimensions] += position[0]
    return state, spread


def covariances_of(generator, count, dimensions):
    root = generator.normal(0, 0.3, (count, dimensions, dimensions))
    return root @ root.transpose(0, 2, 1) + 0.01 * np.eye(dimensions)


@steady
@given(seeds, st.integers(2, 12), st.sampled_from([2, 3]), st.booleans())
def test_states_are_the_weighted_least_squares_of_numpy(seed, count, dimensions, has_own_noise):
    generator = np.random.default_rng(seed)
    time = 100.0 + np.cumsum(generator.uniform(0.5, 6, count))
    place = generator.uniform(-50, 50, (count, 3))
    own = covariances_of(generator, count, 3)
    plots = Plots(np.arange(count, dtype=np.int32), time, place, covariance=own if has_own_noise else None)
    rows = np.sort(generator.choice(count, generator.integers(2, count + 1), replace=False))
    states = fitted_states(plots, [rows], SENSOR, dimensions)
    noise = own[rows] if has_own_noise else np.tile(np.diag(np.square(SENSOR.sigma)), (len(rows), 1, 1))
    state, covariance = oracle(
        place[rows, :dimensions], time[rows], noise[:, :dimensions, :dimensions] + 1e-12 * np.eye(dimensions)
    )
    assert (states.scan[0], states.time[0]) == (rows[0], time[rows[0]])
    assert states.position[0] == pytest.approx(state[:dimensions], abs=1e-7)
    assert states.velocity[0] == pytest.approx(state[dimensions:], abs=1e-7)
    assert states.covariance[0] == pytest.approx(covariance, rel=1e-6, abs=1e-9)
    assert np.linalg.eigvalsh(states.covariance[0]).min() > 0


def test_trials_of_a_chunk_are_fitted_as_alone():
    generator = np.random.default_rng(3)
    counts, columns = (4, 0, 7), ("scan", "time", "position")
    trials = [
        Plots(np.arange(n, dtype=np.int32), 4.0 * np.arange(n), generator.normal(0, 9, (n, 2)))
        for n in counts
    ]
    joined = (np.concatenate([getattr(plots, name) for plots in trials]) for name in columns)
    chunk = PlotChunk(*joined, np.array([0, 4, 4, 11]))
    rows = np.array([[0, 1, 2, 3, -1], [1, 3, -1, -1, -1], [-1] * 5, [0, 2, 3, 5, 6]])
    blank = np.zeros(4)
    tracks = TrackChunk(np.array([0, 2, 3, 4]), blank, blank, blank, np.zeros(3, np.int64), rows)
    together = with_states(chunk, tracks, SENSOR).states
    trial_of = [0, 0, 1, 2]
    for track, trial in enumerate(trial_of):
        alone = fitted_states(trials[trial], [rows[track][rows[track] >= 0]], SENSOR)
        for column, own in zip(together, alone, strict=True):
            np.testing.assert_array_equal(column[track], own[0])
    assert (together.scan[2], math.isnan(together.time[2])) == (-1, True)


def test_plots_of_one_time_leave_the_velocity_open():
    plots = Plots(np.zeros(2, np.int32), np.array([8.0, 8.0]), np.array([[1.0, 2.0], [3.0, 2.0]]))
    states = fitted_states(plots, [np.array([0, 1])], SENSOR)
    assert states.position.tolist() == [[2.0, 2.0]]
    assert np.isnan(states.velocity).all()
    assert states.covariance[0, 0, 0] == pytest.approx(0.2**2 / 2)
    assert np.isnan(states.covariance[0, 2:]).all()


def test_unknown_noise_gives_states_without_covariance():
    plots = Plots(np.arange(3, dtype=np.int32), 2.0 * np.arange(3), np.array([[0, 1.0], [2, 2], [4, 3]]))
    states = fitted_states(plots, [np.arange(3)], Context(3, 2.0))
    assert states.velocity[0] == pytest.approx([1.0, 0.5])
    assert np.isnan(states.covariance).all()


def test_a_sensor_without_noise_counts_as_one_of_a_millimetre():
    plots = Plots(np.arange(2, dtype=np.int32), np.array([0.0, 1.0]), np.array([[0.0, 0.0], [1.0, 1.0]]))
    states = fitted_states(plots, [np.arange(2)], Context(2, 1.0, sigma=(0.0, 0.0), unit=Unit.METRE))
    assert states.covariance[0, 0, 0] == pytest.approx(1e-6)
    assert states.velocity[0].tolist() == [1.0, 1.0]
