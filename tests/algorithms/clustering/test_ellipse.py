"""The ellipse against numpy's eigen-decomposition, and against bisection along the chord."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy import optimize

from algorithms.clustering.ellipse import Ellipse, moments, squared_distance


def ellipse_of(r, d):
    mean_r, mean_d, a, b, c = moments(np.asarray(r, float), np.asarray(d, float), np.arange(len(r)))
    return Ellipse((mean_r, mean_d), a, b, c)


@st.composite
def slanted(draw):
    """Return points of either slope, far from round."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    slope = draw(st.sampled_from([-1.0, 1.0])) * draw(st.floats(0.2, 5.0))
    count = draw(st.integers(4, 40))
    r = draw(st.floats(0.5, 20.0)) * random.standard_normal(count)
    d = slope * r + draw(st.floats(0.3, 5.0)) * random.standard_normal(count)
    return r + draw(st.floats(-1e3, 1e3)), d + draw(st.floats(-1e3, 1e3))


def value(ellipse, r, d):
    """Return the source's polynomial (8) at a place."""
    first, second, third, fourth = ellipse.coefficients
    x, y = r - ellipse.centre[0], d - ellipse.centre[1]
    return first * x * x + second * x * y + third * y * y + fourth


@given(slanted())
def test_axes_and_angle_are_those_of_the_covariance(points):
    ellipse = ellipse_of(*points)
    values, vectors = np.linalg.eigh(np.cov(*points, bias=True))
    assert ellipse.centre == pytest.approx([np.mean(points[0]), np.mean(points[1])])
    assert ellipse.semi_axes == pytest.approx(np.sqrt(2.0 * values[::-1]), rel=1e-6)
    major = np.array([math.cos(ellipse.angle), math.sin(ellipse.angle)])
    assume(values[1] > 1.01 * values[0])
    assert abs(major @ vectors[:, 1]) == pytest.approx(1.0, abs=1e-9)


@given(slanted())
def test_the_coefficients_vanish_all_around(points):
    ellipse = ellipse_of(*points)
    values, vectors = np.linalg.eigh(np.cov(*points, bias=True))
    turn = np.linspace(0.0, 2.0 * np.pi, 40)
    around = vectors @ (np.sqrt(2.0 * values)[:, None] * np.array([np.cos(turn), np.sin(turn)]))
    off = value(ellipse, ellipse.centre[0] + around[0], ellipse.centre[1] + around[1])
    assert np.abs(off).max() <= 1e-7 * abs(ellipse.coefficients[3])
    drawn = value(ellipse, *ellipse.outline())
    assert np.abs(drawn).max() <= 1e-6 * abs(ellipse.coefficients[3])


@given(slanted())
def test_the_chord_is_found_by_bisection(points):
    ellipse = ellipse_of(*points)
    inverse = np.linalg.inv(np.cov(*points, bias=True))

    def beyond(x):
        return inverse[0, 0] * x * x - 2.0

    far = 10.0 * math.sqrt(ellipse.range_variance)
    assert ellipse.chord == pytest.approx(2.0 * optimize.brentq(beyond, 0.0, far), rel=1e-6)


@pytest.mark.parametrize("covariance", [3.0, -3.0])
def test_a_mirrored_ellipse_would_measure_doppler(covariance):
    ellipse = Ellipse((0.0, 0.0), 16.0, 1.0, covariance)
    assert ellipse.coefficients == (2.0, -4.0 * covariance, 32.0, -28.0)
    assert ellipse.chord == pytest.approx(2.0 * math.sqrt(14.0))
    assert ellipse.chord != pytest.approx(Ellipse((0.0, 0.0), 1.0, 16.0, covariance).chord)
    # It leans as its points do: to the right and up for a positive covariance.
    assert math.copysign(1.0, ellipse.angle) == math.copysign(1.0, covariance)
    assert abs(math.degrees(ellipse.angle)) < 45.0


@given(slanted(), st.floats(1e-3, 1e3))
def test_the_chord_does_not_change_with_the_unit_of_doppler(points, unit):
    assert ellipse_of(points[0], unit * points[1]).chord == pytest.approx(ellipse_of(*points).chord, rel=1e-6)


def test_points_of_one_doppler_have_their_whole_width_as_chord():
    r = np.array([1.0, 2.0, 5.0, 9.0])
    for doppler in (0.0, 0.1, 1e14 / 3.0):
        ellipse = ellipse_of(r, np.full(4, doppler))
        assert ellipse.doppler_variance == 0.0
        assert ellipse.chord == pytest.approx(2.0 * math.sqrt(2.0) * np.std(r))
    assert ellipse_of(np.full(3, 0.1), [1.0, 2.0, 4.0]).chord == 0.0
    assert ellipse_of([1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]).chord == pytest.approx(0.0, abs=1e-6)


@given(slanted())
def test_distances_are_mahalanobis_distances(points):
    ellipse = ellipse_of(*points)
    away = np.stack(points) - np.array(ellipse.centre)[:, None]
    expected = np.einsum("in,ij,jn->n", away, np.linalg.inv(np.cov(*points, bias=True)), away)
    shape = (ellipse.range_variance, ellipse.doppler_variance, ellipse.covariance)
    found = [squared_distance(r, d, *shape) for r, d in away.T]
    assert found == pytest.approx(expected, rel=1e-5, abs=1e-9)
    assert np.mean(found) == pytest.approx(2.0, rel=1e-5)


@given(
    st.lists(st.integers(-50, 50), min_size=2, max_size=20, unique=True), st.sampled_from([-3.0, 0.0, 0.1])
)
def test_points_of_one_line_are_measured_along_it(places, slope):
    r = np.array(places, float)
    for along, doppler in ((r, slope * r), (slope * r, r)):
        ellipse = ellipse_of(along, doppler)
        shape = (ellipse.range_variance, ellipse.doppler_variance, ellipse.covariance)
        away = zip(along - ellipse.centre[0], doppler - ellipse.centre[1], strict=True)
        expected = ((r - r.mean()) / r.std()) ** 2
        assert [squared_distance(x, y, *shape) for x, y in away] == pytest.approx(
            expected, rel=1e-6, abs=1e-9
        )
