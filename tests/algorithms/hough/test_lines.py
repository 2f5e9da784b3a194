from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from algorithms.hough.lines import line_distance, line_through, normal_form, separation

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

any_angle = st.floats(-30.0, 30.0)
normal_angle = st.floats(0.0, math.pi, exclude_max=True)
length = st.floats(-1e4, 1e4)
coordinate = st.floats(-1e3, 1e3)
turns = st.integers(-4, 4)


def flipped(theta, rho, count):
    """Return the same line, turned by so many half turns."""
    return theta + count * math.pi, rho if count % 2 == 0 else -rho


@steady
@given(any_angle, length, st.floats(-1e3, 1e3))
def test_the_normal_form_is_the_same_line_with_theta_in_half_a_turn(theta, rho, along):
    found_theta, found_rho = normal_form(theta, rho)
    assert 0.0 <= found_theta < math.pi
    x = rho * math.cos(theta) - along * math.sin(theta)
    y = rho * math.sin(theta) + along * math.cos(theta)
    assert x * math.cos(found_theta) + y * math.sin(found_theta) == pytest.approx(found_rho, abs=1e-8)


@steady
@given(any_angle, length)
def test_the_normal_form_of_a_normal_form_is_itself(theta, rho):
    once = normal_form(theta, rho)
    assert normal_form(*once) == once


@pytest.mark.parametrize(
    ("theta", "expected_theta", "sign"),
    [
        (0.0, 0.0, 1),
        (-0.0, 0.0, 1),
        (math.pi, 0.0, -1),
        (-math.pi, 0.0, -1),
        (2 * math.pi, 0.0, 1),
        (-2 * math.pi, 0.0, 1),
        # So near to 0 that θ + π is π itself.
        (-1e-18, 0.0, 1),
        (np.nextafter(math.pi, 0.0), np.nextafter(math.pi, 0.0), 1),
        (np.nextafter(math.pi, 4.0), np.nextafter(math.pi, 4.0) - math.pi, -1),
        (-0.5, math.pi - 0.5, -1),
    ],
)
def test_the_normal_form_at_the_seam(theta, expected_theta, sign):
    found_theta, found_rho = normal_form(theta, 7.0)
    assert found_theta == expected_theta
    assert found_rho == 7.0 * sign


def test_the_normal_form_takes_arrays_of_one_shape_or_a_scalar():
    theta, rho = normal_form([[0.1, 4.0], [-1.0, 9.0]], 2.0)
    for index in np.ndindex(2, 2):
        assert (theta[index], rho[index]) == normal_form([[0.1, 4.0], [-1.0, 9.0]][index[0]][index[1]], 2.0)


@steady
@given(normal_angle, length, turns)
def test_a_line_is_at_no_distance_from_itself_turned_half_around(theta, rho, count):
    angle, distance = line_distance(theta, rho, *flipped(theta, rho, count))
    assert angle == pytest.approx(0.0, abs=1e-13)
    assert distance == 0.0


@steady
@given(any_angle, length, any_angle, length)
def test_the_distance_is_symmetric(theta, rho, other_theta, other_rho):
    there = line_distance(theta, rho, other_theta, other_rho)
    back = line_distance(other_theta, other_rho, theta, rho)
    assert there[0] == back[0]
    assert there[1] == back[1]
    assert 0.0 <= there[0] <= math.pi / 2 + 1e-12


@steady
@given(normal_angle, length, normal_angle, length, turns, turns)
def test_the_distance_does_not_depend_on_how_a_line_is_written(theta, rho, other_theta, other_rho, m, n):
    angle, distance = line_distance(theta, rho, other_theta, other_rho)
    # At a right angle both orientations are equally near.
    assume(angle < math.pi / 2 - 1e-6)
    turned = line_distance(*flipped(theta, rho, m), *flipped(other_theta, other_rho, n))
    assert turned[0] == pytest.approx(angle, abs=1e-12)
    assert turned[1] == distance


@steady
@given(any_angle, any_angle, any_angle)
def test_angles_satisfy_the_triangle_inequality(a, b, c):
    whole = line_distance(a, 0.0, c, 0.0)[0]
    assert whole <= line_distance(a, 0.0, b, 0.0)[0] + line_distance(b, 0.0, c, 0.0)[0] + 1e-12


@steady
@given(normal_angle, length, length, length, turns, turns, turns)
def test_parallel_lines_satisfy_the_triangle_inequality(theta, a, b, c, i, j, k):
    first, second, third = flipped(theta, a, i), flipped(theta, b, j), flipped(theta, c, k)
    whole = line_distance(*first, *third)[1]
    assert whole == pytest.approx(abs(a - c), abs=1e-9)
    assert whole <= line_distance(*first, *second)[1] + line_distance(*second, *third)[1] + 1e-9


@steady
@given(st.floats(-10, 10), st.floats(1e-3, 0.5))
def test_lines_on_both_sides_of_the_seam_are_near(rho, gap):
    angle, distance = line_distance(gap, rho, math.pi - gap, -rho)
    assert angle == pytest.approx(2 * gap)
    assert distance == 0.0


@steady
@given(normal_angle, length, normal_angle, length)
def test_the_separation_is_the_signed_distance(theta, rho, other_theta, other_rho):
    angle, distance = separation(theta, rho, other_theta, other_rho)
    absolute = line_distance(theta, rho, other_theta, other_rho)
    assume(absolute[0] < math.pi / 2 - 1e-9)
    assert abs(angle) == pytest.approx(absolute[0], abs=1e-12)
    assert abs(distance) == absolute[1]
    back = line_distance(theta - angle, rho - distance, other_theta, other_rho)
    assert back == pytest.approx((0.0, 0.0), abs=1e-8)


@pytest.mark.parametrize(
    ("line", "other", "expected"),
    [
        ((0.3, 5.0), (0.2, 4.0), (0.1, 1.0)),
        ((0.2, 4.0), (0.3, 5.0), (-0.1, -1.0)),
        ((math.pi - 0.1, 5.0), (0.1, -4.0), (-0.2, 1.0)),
        ((0.1, 5.0), (math.pi - 0.1, -4.0), (0.2, 1.0)),
    ],
)
def test_the_signs_of_the_separation(line, other, expected):
    assert separation(*line, *other) == pytest.approx(expected)


@steady
@given(coordinate, coordinate, any_angle, st.floats(0.01, 100.0), st.floats(-100.0, 100.0))
def test_a_line_through_a_point_holds_every_point_along_its_direction(x, y, heading, speed, time):
    velocity = np.array([speed * math.cos(heading), speed * math.sin(heading)])
    theta, rho = line_through([x, y], velocity)
    assert 0.0 <= theta < math.pi
    later = np.array([x, y]) + time * velocity
    assert later @ [math.cos(theta), math.sin(theta)] == pytest.approx(rho, abs=1e-6)
    back = line_distance(theta, rho, *line_through(later, -velocity))
    assert back == pytest.approx((0.0, 0.0), abs=1e-6)


def test_a_line_without_direction_is_not_a_number():
    theta, rho = line_through([[1.0, 2.0], [3.0, 4.0]], [[0.0, 0.0], [0.0, 1.0]])
    assert np.isnan(theta[0])
    assert np.isnan(rho[0])
    assert (theta[1], abs(rho[1])) == (0.0, 3.0)


@pytest.mark.parametrize(
    ("position", "velocity", "theta_deg", "rho"),
    [([40, 20], [0.3, 0.18], 120.96, -3.43), ([20, 80], [0.3, -0.18], 59.04, 78.89)],
)
def test_the_lines_of_the_course_report(position, velocity, theta_deg, rho):
    found_theta, found_rho = line_through(position, velocity)
    assert math.degrees(found_theta) == pytest.approx(theta_deg, abs=0.005)
    assert found_rho == pytest.approx(rho, abs=0.005)
