"""Pairs, votes in planes and motions in space, each against a loop or a library."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from algorithms.initiators.hough_3d import across, directions
from algorithms.space.motion import chi_square_limits, write_track
from algorithms.space.pairs import by_first, components, pairs_within_reach
from algorithms.space.planes import PLANES, confirm, votes_of_pairs

steady = settings(deadline=None, derandomize=True, max_examples=60)


def batch(seed, counts=(5, 6, 4, 7), extent=1500.0):
    random = np.random.default_rng(seed)
    scan = np.repeat(np.arange(len(counts)), counts).astype(np.int32)
    position = random.uniform(0.0, extent, (len(scan), 3))
    spread = random.normal(size=(len(scan), 3, 3)) * 40.0
    covariance = spread @ spread.transpose(0, 2, 1) + np.eye(3)
    return position, scan.astype(np.float64), scan, covariance


@steady
@given(st.integers(0, 2**32), st.sampled_from([0.0, 3.0]), st.integers(1, 3))
def test_pairs_within_reach_are_those_of_a_loop_over_all(seed, allowance, steps):
    position, time, scan, covariance = batch(seed)
    pairs, every = pairs_within_reach(position, time, scan, covariance, 50.0, 400.0, allowance, steps)
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
        pairs, every = pairs_within_reach(position, time, scan, covariance, 50.0, 400.0, allowance, 3)
        assert (len(pairs), every) == (found, 1)


def test_the_latest_plot_of_a_scan_decides_how_far_is_searched():
    # Within a scan times need not rise; those of a recording are as they are.
    position = np.array([[0.0, 0.0, 0.0], [390.0, 0.0, 0.0], [790.0, 0.0, 0.0]])
    time, scan = np.array([0.0, 1.0, 2.0]), np.array([0, 1, 1], np.int32)
    for order in ([0, 1, 2], [0, 2, 1]):
        pairs, _ = pairs_within_reach(
            position[order], time[order], scan, np.zeros((3, 3, 3)), 50.0, 400.0, 0.0, 3
        )
        assert sorted(pairs.tolist()) == [[0, 1], [0, 2]]


def test_plots_of_one_time_are_within_reach_where_noise_may_part_them():
    # Of two sensors: their scans have two numbers and one time.
    time, scan = np.zeros(3), np.array([0, 1, 1], np.int32)
    position = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    covariance = np.tile(np.eye(3), (3, 1, 1))
    # The standard deviation of their distance is √2.
    pairs, every = pairs_within_reach(position, time, scan, covariance, 50.0, 400.0, 3.0, 3)
    assert (pairs.tolist(), every) == ([[0, 1]], 2)
    backwards = np.array([1.0, 0.0, 0.0])
    assert len(pairs_within_reach(position, backwards, scan, covariance, 0.0, 400.0, 3.0, 3)[0]) == 0


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


@steady
@given(st.integers(0, 2**32), st.sampled_from([0, 1, 2]))
def test_votes_are_the_lines_through_both_plots(seed, plane):
    position, _, _, _ = batch(seed)
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


@steady
@given(st.integers(0, 2**32), st.integers(3, 6))
def test_the_fit_is_that_of_weighted_least_squares(seed, count):
    random = np.random.default_rng(seed)
    time = np.sort(random.uniform(0.0, 10.0, count)) + np.arange(count)
    position = random.normal(size=(count, 3)) * 1e3
    spread = random.normal(size=(count, 3, 3)) * 30.0
    covariance = spread @ spread.transpose(0, 2, 1) + 25.0 * np.eye(3)
    weight = np.linalg.inv(covariance)
    plots, state = np.full((1, count), -1, np.int64), np.empty((1, 2, 3))
    write_track(position, time, weight, np.arange(count), plots, state, 0)
    design = np.concatenate(
        [np.concatenate([np.eye(3), elapsed * np.eye(3)], axis=1) for elapsed in time - time[0]]
    )
    whitening = np.zeros((3 * count, 3 * count))
    for k in range(count):
        whitening[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = np.linalg.cholesky(weight[k]).T
    expected = np.linalg.lstsq(whitening @ design, whitening @ position.ravel(), rcond=None)[0]
    np.testing.assert_allclose(state[0].ravel(), expected, rtol=1e-6, atol=1e-5)


def test_limits_are_those_of_chi_squared():
    limits = chi_square_limits(0.99, 5)
    assert np.isinf(limits[:, :3]).all()
    np.testing.assert_allclose(limits[0, 3:], stats.chi2([3, 6, 9]).ppf(0.99))
    np.testing.assert_allclose(limits[1, 3:], stats.chi2([3, 6, 9]).isf(1e-4))


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
