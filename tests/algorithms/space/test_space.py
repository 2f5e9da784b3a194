"""Votes in planes and lines in space, each against a loop or a library."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.initiators.hough_3d import across, directions
from algorithms.space.planes import PLANES, confirm, votes_of_pairs

steady = settings(deadline=None, derandomize=True, max_examples=60)


@steady
@given(st.integers(0, 2**32), st.sampled_from([0, 1, 2]))
def test_votes_are_the_lines_through_both_plots(seed, plane):
    position = np.random.default_rng(seed).uniform(0.0, 1500.0, (22, 3))
    pairs = np.array([[0, 7], [3, 20], [5, 12]])
    axes, centre = PLANES[plane], np.array([700.0, 800.0, 600.0])
    theta, distance = np.empty(3), np.empty(3)
    votes_of_pairs(position, pairs, np.arange(3), axes[0], axes[1], centre, theta, distance)
    assert ((theta >= 0.0) & (theta < math.pi)).all()
    for vote, pair in enumerate(pairs):
        x, y = (position[pair][:, axes] - centre[axes]).T
        np.testing.assert_allclose(
            x * np.sin(theta[vote]) - y * np.cos(theta[vote]), distance[vote], atol=1e-6
        )


def test_coincident_projections_do_not_vote():
    position = np.array([[1.0, 2.0, 0.0], [1.0, 2.0, 5.0]])
    theta, distance = np.empty(1), np.empty(1)
    votes_of_pairs(position, np.array([[0, 1]]), np.arange(1), 0, 1, np.zeros(3), theta, distance)
    assert np.isnan(theta[0])
    votes_of_pairs(position, np.array([[0, 1]]), np.arange(1), 0, 2, np.zeros(3), theta, distance)
    assert theta[0] == pytest.approx(math.pi / 2)


def test_a_direction_is_below_a_half_turn_however_it_is_rounded():
    # atan2 gives a negative angle so small that with π added it is π.
    position = np.array([[0.0, 0.0, 3.0], [1.0, -1e-300, 4.0]])
    theta, distance = np.empty(1), np.empty(1)
    votes_of_pairs(
        position, np.array([[0, 1]]), np.arange(1), 0, 1, np.array([0.0, 2.0, 0.0]), theta, distance
    )
    assert (theta[0], distance[0]) == (0.0, 2.0)


def test_a_window_holds_both_its_edges():
    theta, distance = np.array([0.5, 1.0]), np.array([1.0, 3.0])
    for width, height, expected in ((0.5, 2.0, True), (0.4, 2.0, False), (0.5, 1.9, False)):
        confirmed = np.zeros(2, bool)
        confirm(theta, distance, 2, width, height, False, 2, confirmed, np.empty(2, np.int64), np.empty(2))
        assert confirmed.all() == confirmed.any() == expected


def test_fixed_cells_are_half_open():
    theta, distance = np.array([0.5, 0.999, 1.0]), np.zeros(3)
    confirmed = np.zeros(3, bool)
    confirm(theta, distance, 3, 0.5, 1.0, True, 2, confirmed, np.empty(3, np.int64), np.empty(3))
    assert confirmed.tolist() == [True, True, False]


def confirmed_by_loop(theta, distance, width, height, least):
    """Return the votes of every window that begins at a vote in θ and at one in d, by brute force."""
    found = np.zeros(len(theta), bool)
    known = np.flatnonzero(~np.isnan(theta))
    for begin, base in itertools.product(known, known):
        inside = []
        for vote in known:
            beyond, sign = theta[vote] - theta[begin], 1.0
            if beyond < 0.0:
                beyond, sign = beyond + math.pi, -1.0
            lowest = distance[base] if theta[base] >= theta[begin] else -distance[base]
            if beyond <= width and lowest <= sign * distance[vote] <= lowest + height:
                inside.append(vote)
        if len(inside) >= least:
            found[inside] = True
    return found


@steady
@given(
    st.lists(st.tuples(st.floats(0.0, 3.1415), st.floats(-10.0, 10.0)), max_size=8),
    st.sampled_from([0.2, 1.0, 1.5]),
    st.integers(1, 4),
)
def test_windows_are_those_of_a_loop_also_across_the_seam(votes, width, least):
    theta = np.array([vote[0] for vote in votes] + [np.nan])
    distance = np.array([vote[1] for vote in votes] + [np.nan])
    confirmed, count = np.zeros(len(theta), bool), len(theta)
    confirm(
        theta,
        distance,
        count,
        width,
        4.0,
        False,
        least,
        confirmed,
        np.empty(count, np.int64),
        np.empty(count),
    )
    # A window may begin at a vote beyond its own width, so the loop tries at least as many.
    expected = confirmed_by_loop(theta, distance, width, 4.0, least)
    np.testing.assert_array_equal(confirmed, expected)


def test_two_votes_on_both_sides_of_the_seam_are_one_line():
    theta, distance = np.array([0.02, math.pi - 0.02]), np.array([5.0, -5.1])
    for is_fixed, expected in ((False, True), (True, False)):
        confirmed = np.zeros(2, bool)
        confirm(theta, distance, 2, 0.1, 1.0, is_fixed, 2, confirmed, np.empty(2, np.int64), np.empty(2))
        assert confirmed.all() == expected


@pytest.mark.parametrize("tessellation", [1, 2, 3])
def test_directions_cover_half_the_sphere_evenly(tessellation):
    found = directions(tessellation)
    assert len(found) == 5 * 4**tessellation + 1
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    cosines = np.abs(found @ found.T)
    np.fill_diagonal(cosines, 0.0)
    nearest = np.degrees(np.arccos(cosines.max(axis=1)))
    assert nearest.max() < 1.35 * nearest.min()


@steady
@given(st.integers(0, 2**32))
def test_a_line_meets_the_plane_across_it_at_one_place(seed):
    random = np.random.default_rng(seed)
    direction = directions(2)[random.integers(0, 81)]
    place = random.normal(size=3)
    first = across(direction, place)
    np.testing.assert_allclose(across(direction, place + 3.7 * direction), first, atol=1e-9)
    # The two coordinates tell the distance of the line from the origin.
    foot = place - (place @ direction) * direction
    assert math.hypot(*first) == pytest.approx(np.linalg.norm(foot))
