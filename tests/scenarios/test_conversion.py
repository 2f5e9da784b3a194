"""Polar measurements as cartesian positions with their covariance."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from scenarios.conversion import converted, polar

steady = settings(deadline=None, derandomize=True, max_examples=100)

PRECISION_APPROACH = np.array([50.0, np.radians(0.3), np.radians(0.2)])
"""Noise of a precision approach radar: 50 m, .3°, .2°."""


@steady
@given(
    st.floats(1.0, 1e5),
    st.floats(-np.pi, np.pi, exclude_min=True),
    st.floats(-1.5, 1.5),
)
def test_polar_coordinates_and_back(distance, azimuth, elevation):
    position, covariance = converted(np.array([[distance, azimuth, elevation]]), np.zeros(3))
    ground = distance * np.cos(elevation)
    expected = ground * np.sin(azimuth), ground * np.cos(azimuth), distance * np.sin(elevation)
    np.testing.assert_allclose(position[0], expected, rtol=1e-9, atol=1e-9 * distance)
    assert np.abs(covariance).max() <= 1e-18 * distance**2
    np.testing.assert_allclose(polar(position)[0], (distance, azimuth, elevation), rtol=1e-6, atol=1e-7)


def test_azimuth_is_clockwise_from_north():
    assert polar(np.array([[0.0, 5.0], [5.0, 0.0], [0.0, -5.0]]))[:, 1] == pytest.approx(
        [0.0, np.pi / 2, np.pi]
    )


@steady
@given(st.floats(10.0, 100.0), st.floats(-3.0, 3.0), st.floats(-1.2, 1.2))
def test_small_noise_is_turned_as_by_the_jacobian(distance, azimuth, elevation):
    sigma = np.array([1e-3, 1e-5, 2e-5])
    _, covariance = converted(np.array([[distance, azimuth, elevation]]), sigma)
    steps = 1e-6 * np.eye(3)
    around = [
        converted(np.array([[distance, azimuth, elevation]]) + sign * steps, np.zeros(3))[0]
        for sign in (1, -1)
    ]
    jacobian = ((around[0] - around[1]) / 2e-6).T
    np.testing.assert_allclose(
        covariance[0], jacobian @ np.diag(sigma**2) @ jacobian.T, rtol=1e-3, atol=1e-12
    )


def normalised(truth, sigma, count, seed):
    """Return the normalised squared errors (NEES) of converted measurements of one place."""
    return normalised_of(truth, sigma, np.random.default_rng(seed).normal(size=(count, len(sigma))))


def normalised_of(truth, sigma, noise):
    """Return those errors for noise in standard deviations."""
    position, covariance = converted(truth + noise * sigma, sigma)
    miss = position - converted(truth[None], np.zeros(len(sigma)))[0]
    return np.einsum("ni,nij,nj->n", miss, np.linalg.inv(covariance), miss)


@pytest.mark.parametrize("distance", [1e3, 5e3, 15e3, 40e3])
@pytest.mark.parametrize(("azimuth", "elevation"), [(0.0, 0.05), (0.35, 0.17), (-0.3, 0.0), (2.0, 1.0)])
def test_errors_are_as_large_as_the_covariance_says(distance, azimuth, elevation):
    # Those of a consistent estimate in space have a mean of three; their sum is chi-squared. Sixteen such
    # tests: each at 99.9 %.
    count = 4000
    squares = normalised(np.array([distance, azimuth, elevation]), PRECISION_APPROACH, count, 5)
    low, high = stats.chi2(3 * count).ppf([0.0005, 0.9995])
    assert low < squares.sum() < high


@pytest.mark.parametrize("distance", [1e3, 2e3, 5e3, 10e3, 20e3, 40e3])
def test_their_mean_lies_in_the_interval_of_a_hundred_thousand_draws(distance):
    # The same draws at each distance: all lie in the interval of 95 %, or it was bad luck for all.
    count = 100_000
    squares = normalised(np.array([distance, 0.2, 0.1]), PRECISION_APPROACH, count, 5)
    low, high = stats.chi2(3 * count).ppf([0.025, 0.975])
    assert low < squares.sum() < high


@pytest.mark.parametrize(("distance", "margin"), [(500.0, 0.005), (1e3, 5e-4), (5e3, 5e-4), (40e3, 5e-4)])
def test_their_mean_is_that_of_chi_squared_close_at_hand_too(distance, margin):
    # By quadrature, not by draws. At 500 m the range is off by a tenth, and what the measured range says
    # of the errors across would be too little by two percent.
    nodes, weights = np.polynomial.hermite_e.hermegauss(15)
    noise = np.stack(np.meshgrid(nodes, nodes, nodes), axis=-1).reshape(-1, 3)
    share = np.prod(np.meshgrid(weights, weights, weights), axis=0).ravel() / weights.sum() ** 3
    squares = normalised_of(np.array([distance, 0.2, 0.1]), PRECISION_APPROACH, noise)
    assert share @ squares == pytest.approx(3.0, abs=margin)


@pytest.mark.parametrize(("sigma_range", "distance"), [(50.0, 20e3), (50.0, 500.0)])
def test_in_the_plane_too(sigma_range, distance):
    count, sigma = 100_000, np.array([sigma_range, np.radians(1.0)])
    squares = normalised(np.array([distance, 1.0]), sigma, count, 6)
    low, high = stats.chi2(2 * count).ppf([0.0005, 0.9995])
    assert low < squares.sum() < high


def test_wide_noise_bends_the_mean_inwards():
    # With 20° on azimuth the mean lies at exp(-σ²/2) = .941 of the range.
    sigma = np.array([0.0, np.radians(20.0)])
    position, _ = converted(np.array([[100.0, 0.0]]), sigma)
    assert position[0] == pytest.approx([0.0, 94.1], abs=0.1)
