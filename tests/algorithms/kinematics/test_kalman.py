from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.context import Context
from algorithms.kinematics.constant_velocity import ConstantVelocity, start_from_pair
from algorithms.kinematics.gates import chi_square_gate
from algorithms.kinematics.kalman import Estimate, Innovation, innovate, predicted, updated
from algorithms.kinematics.matrices import axes_of
from algorithms.kinematics.measured import Measured
from algorithms.kinematics.states import fitted_states
from algorithms.plots import PlotChunk, Plots

steady = settings(deadline=None, derandomize=True, max_examples=60)
dimensions_of = st.sampled_from([2, 3])
seeds = st.integers(0, 2**32)


def positive(generator, size):
    root = generator.normal(size=(size, size))
    return root @ root.T + 0.1 * np.eye(size)


def estimate_of(generator, dimensions):
    state = generator.normal(0, 10, 2 * dimensions)
    return Estimate.of(
        state[:dimensions], state[dimensions:], positive(generator, 2 * dimensions), generator.uniform(0, 100)
    )


@steady
@given(seeds, dimensions_of, st.floats(0.1, 20.0), st.floats(0.0, 3.0))
def test_prediction_is_that_of_matrices(seed, dimensions, elapsed, variance):
    estimate = estimate_of(np.random.default_rng(seed), dimensions)
    moved = predicted(estimate, estimate.time + elapsed, ConstantVelocity(variance))
    eye, elapsed = np.eye(dimensions), moved.time - estimate.time
    step = np.block([[eye, elapsed * eye], [0 * eye, eye]])
    push = np.vstack([0.5 * elapsed**2 * eye, elapsed * eye])
    np.testing.assert_allclose(moved.state, step @ estimate.state, rtol=1e-12, atol=1e-9)
    expected = step @ estimate.covariance @ step.T + variance * push @ push.T
    np.testing.assert_allclose(moved.covariance, expected, rtol=1e-9, atol=1e-9)


@steady
@given(seeds, dimensions_of)
def test_update_is_that_of_information(seed, dimensions):
    generator = np.random.default_rng(seed)
    estimate, noise = estimate_of(generator, dimensions), positive(generator, dimensions)
    place = estimate.state[:dimensions] + generator.normal(size=dimensions)
    better, square = updated(estimate, place, noise)
    look = np.hstack([np.eye(dimensions), np.zeros((dimensions, dimensions))])
    information = np.linalg.inv(estimate.covariance) + look.T @ np.linalg.inv(noise) @ look
    right = np.linalg.inv(estimate.covariance) @ estimate.state + look.T @ np.linalg.inv(noise) @ place
    np.testing.assert_allclose(better.state, np.linalg.solve(information, right), rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(better.covariance, np.linalg.inv(information), rtol=1e-5, atol=1e-6)
    np.testing.assert_array_equal(better.covariance, better.covariance.T)
    spread = estimate.covariance[:dimensions, :dimensions] + noise
    miss = place - estimate.state[:dimensions]
    assert square == pytest.approx(miss @ np.linalg.solve(spread, miss), rel=1e-6)
    _, determinant = innovate(
        estimate.state, estimate.covariance, place, noise, Innovation.of(dimensions, 2 * dimensions),
        axes_of(dimensions),
    )  # fmt: skip
    assert determinant == pytest.approx(np.linalg.det(spread), rel=1e-9)


@steady
@given(seeds, dimensions_of, st.integers(3, 8))
def test_filtering_all_plots_is_least_squares(seed, dimensions, count):
    # Without process noise a filter started from two plots ends where the fit to all plots is.
    generator = np.random.default_rng(seed)
    time = np.cumsum(generator.uniform(1.0, 5.0, count))
    covariance = np.array([positive(generator, dimensions) for _ in range(count)])
    plots = Plots(
        np.arange(count, dtype=np.int32),
        time,
        generator.normal(0, 5, (count, dimensions)),
        covariance=covariance,
    )
    context = Context(count, 2.0)
    started, fitted = (
        Estimate.of(state.position[0], state.velocity[0], state.covariance[0], state.time[0])
        for state in (
            fitted_states(plots, [rows], context, dimensions) for rows in (np.arange(2), np.arange(count))
        )
    )
    estimate = predicted(started, time[1], ConstantVelocity())
    for plot in range(2, count):
        estimate = predicted(estimate, time[plot], ConstantVelocity())
        estimate, _ = updated(estimate, plots.position[plot], covariance[plot])
    end = predicted(fitted, time[-1], ConstantVelocity())
    np.testing.assert_allclose(estimate.state, end.state, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(estimate.covariance, end.covariance, rtol=1e-4, atol=1e-5)


@steady
@given(seeds, dimensions_of)
def test_a_start_from_two_plots_is_their_fit(seed, dimensions):
    generator = np.random.default_rng(seed)
    time, covariance = np.array([3.0, 7.0]), np.array([positive(generator, dimensions) for _ in range(2)])
    place = generator.normal(0, 5, (2, dimensions))
    plots = Plots(np.arange(2, dtype=np.int32), time, place, covariance=covariance)
    chunk: PlotChunk = plots.chunk()
    state, spread = np.empty(2 * dimensions), np.empty((2 * dimensions, 2 * dimensions))
    start_from_pair(Measured.of(chunk, covariance, dimensions), 0, 1, state, spread, axes_of(dimensions))
    fitted = fitted_states(plots, [np.arange(2)], Context(2, 4.0), dimensions)
    estimate = Estimate.of(fitted.position[0], fitted.velocity[0], fitted.covariance[0], 3.0)
    end = predicted(estimate, 7.0, ConstantVelocity())
    np.testing.assert_allclose(state, end.state, atol=1e-5)
    np.testing.assert_allclose(spread, end.covariance, atol=1e-5)


def test_the_gate_keeps_its_share_of_own_plots():
    estimate = Estimate.of([0.0, 0.0], [1.0, 0.0], np.diag([4.0, 1.0, 1.0, 1.0]), 0.0)
    noise = np.diag([1.0, 3.0])
    inside = np.sqrt(chi_square_gate(0.9, 2) * 5.0)
    assert updated(estimate, [0.999 * inside, 0.0], noise, gate=0.9) is not None
    assert updated(estimate, [1.001 * inside, 0.0], noise, gate=0.9) is None


def test_what_starts_no_filter_is_refused():
    with pytest.raises(ValueError, match="not finite"):
        Estimate.of([0, 0], [np.nan, 0], np.eye(4), 0.0)
    with pytest.raises(ValueError, match=r"shape \(2, 2\) is given with a state of 4"):
        Estimate.of([0, 0], [0, 0], np.eye(2), 0.0)
    with pytest.raises(ValueError, match="2 or 3"):
        Estimate.of([0], [0], np.eye(2), 0.0)
    with pytest.raises(ValueError, match="in 2 dimensions"):
        updated(Estimate.of([0, 0], [0, 0], np.eye(4), 0.0), [0, 0, 0], np.eye(3))
