"""Kinematic errors, GOSPA and latency against numpy and against all assignments."""

import itertools

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.scoring.gospa import gospa
from algorithms.scoring.kinematics import kinematic_errors
from algorithms.scoring.latency import scans_to_initiate
from algorithms.target_states import TargetStates
from algorithms.tracks import TrackStates

steady = settings(
    deadline=None, derandomize=True, max_examples=300, suppress_health_check=[HealthCheck.too_slow]
)


def truth_of(random, trials, targets, dimensions, scans=5):
    """Return true states of steady targets, each there from a scan of its own on."""
    time = 4.0 * np.arange(scans)
    present = np.arange(scans)[:, None] >= random.integers(0, 2, targets)
    start = random.uniform(-9, 9, (trials, 1, targets, dimensions))
    velocity = np.broadcast_to(
        random.normal(size=(1, 1, targets, dimensions)), (trials, scans, targets, dimensions)
    )
    position = start + velocity * time[:, None, None]
    away = ~present[None, :, :, None] & np.ones(position.shape, bool)
    position, velocity = np.where(away, np.nan, position), np.where(away, np.nan, velocity)
    return TargetStates(time, present, position, velocity, np.zeros((trials, targets, dimensions)))


def states_of(random, tracks, dimensions, scans=5):
    """Return states of tracks with covariances of any shape; one in five is without plots."""
    half = random.normal(size=(tracks, 2 * dimensions, 2 * dimensions))
    scan = np.where(random.random(tracks) < 0.2, -1, random.integers(0, scans, tracks))
    is_open = (scan < 0)[:, None]
    return TrackStates(
        scan,
        4.0 * scan,
        np.where(is_open, np.nan, random.uniform(-9, 9, (tracks, dimensions))),
        np.where(is_open, np.nan, random.normal(size=(tracks, dimensions))),
        half @ half.transpose(0, 2, 1) + 0.1 * np.eye(2 * dimensions),
    )


@pytest.mark.parametrize(("axes", "of_tracks"), [(2, 2), (3, 3), (3, 2)])
def test_errors_are_those_of_numpy(axes, of_tracks):
    random = np.random.default_rng(axes + of_tracks)
    truth, states = truth_of(random, 40, 3, axes), states_of(random, 60, of_tracks)
    best = random.integers(-1, 60, (40, 3))
    errors = kinematic_errors(best, states, truth)
    for trial, target in itertools.product(range(40), range(3)):
        track, found = best[trial, target], [one[trial, target] for one in vars_of(errors)]
        scan = states.scan[track] if track >= 0 else -1
        if scan < 0 or not truth.present[scan, target]:
            assert np.isnan(found[:2]).all()
            assert np.isnan(found[3])
            continue
        position = states.position[track] - truth.position[trial, scan, target, :of_tracks]
        velocity = states.velocity[track] - truth.velocity[trial, scan, target, :of_tracks]
        both = np.concatenate([position, velocity])
        scans = np.flatnonzero(truth.present[:, target])
        middle = (scans[0] + scans[-1]) // 2
        ahead = states.position[track] + (truth.time[middle] - states.time[track]) * states.velocity[track]
        away = ahead - truth.position[trial, middle, target, :of_tracks]
        course = truth.velocity[trial, middle, target, :of_tracks]
        course = course / np.linalg.norm(course)
        expected = [
            np.linalg.norm(position),
            np.linalg.norm(velocity),
            np.linalg.norm(away - (away @ course) * course),
            both @ np.linalg.solve(states.covariance[track], both),
        ]
        np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-9)


def vars_of(errors):
    return errors.position, errors.velocity, errors.cross_track, errors.nees


def test_open_states_have_no_error():
    random = np.random.default_rng(1)
    truth, states = truth_of(random, 1, 1, 2), states_of(random, 1, 2)
    states = states._replace(scan=np.array([4]), velocity=np.full((1, 2), np.nan))
    states.covariance[:] = np.nan
    errors = kinematic_errors(np.zeros((1, 1), np.int64), states, truth)
    assert np.isnan([errors.velocity, errors.cross_track, errors.nees]).all()
    with pytest.raises(ValueError, match="no truth of 2"):
        kinematic_errors(np.zeros((1, 1), np.int64), states_of(random, 1, 3), truth)


def every_assignment(distances, cutoff):
    """Return the least GOSPA square over all ways to pair some tracks with some targets."""
    tracks, targets = distances.shape
    least = np.inf
    for count in range(min(tracks, targets) + 1):
        for rows in itertools.permutations(range(tracks), count):
            for columns in itertools.combinations(range(targets), count):
                near = sum(distances[row, column] ** 2 for row, column in zip(rows, columns, strict=True))
                least = min(least, near + 0.5 * cutoff**2 * (tracks + targets - 2 * count))
    return least


@steady
@given(st.integers(0, 2**32 - 1), st.integers(0, 4), st.integers(0, 4), st.sampled_from([1.0, 6.0, 50.0]))
def test_gospa_is_the_least_over_all_assignments(seed, tracks, targets, cutoff):
    random = np.random.default_rng(seed)
    truth, states = truth_of(random, 2, targets, 2), states_of(random, 2 * tracks, 2)
    parts = gospa(np.array([0, tracks, 2 * tracks]), states, truth, cutoff)
    for trial in range(2):
        distances = np.full((tracks, targets), np.inf)
        for row, column in itertools.product(range(tracks), range(targets)):
            track = trial * tracks + row
            scan = states.scan[track]
            if scan >= 0 and truth.present[scan, column]:
                away = states.position[track] - truth.position[trial, scan, column]
                distances[row, column] = np.linalg.norm(away)
        assert parts.square[trial] == pytest.approx(every_assignment(distances, cutoff))
        assert parts.localisation[trial] >= 0.0
        half = 0.5 * cutoff**2
        assigned = targets - parts.missed[trial] / half
        assert parts.false[trial] == pytest.approx(half * (tracks - assigned))


def test_gospa_of_many_tracks_is_that_of_scipy():
    from scipy.optimize import linear_sum_assignment

    random = np.random.default_rng(4)
    truth, states = truth_of(random, 1, 6, 3), states_of(random, 40, 3)
    parts = gospa(np.array([0, 40]), states, truth, 8.0)
    distances = np.full((40, 6), 64.0)
    for track, target in itertools.product(range(40), range(6)):
        scan = states.scan[track]
        if scan >= 0 and truth.present[scan, target]:
            away = states.position[track] - truth.position[0, scan, target]
            distances[track, target] = min(64.0, away @ away)
    rows, columns = linear_sum_assignment(distances)
    chosen = distances[rows, columns]
    near = chosen < 64.0
    expected = chosen[near].sum() + 32.0 * (46 - 2 * near.sum())
    assert parts.square[0] == pytest.approx(expected)


def test_targets_that_never_come_do_not_count():
    random = np.random.default_rng(5)
    truth = truth_of(random, 1, 2, 2)
    truth.present[:, 1] = False
    parts = gospa(np.array([0, 0]), states_of(random, 0, 2), truth, 2.0)
    assert (parts.localisation[0], parts.missed[0], parts.false[0]) == (0.0, 2.0, 0.0)
    with pytest.raises(ValueError, match="above 0"):
        gospa(np.array([0, 0]), states_of(random, 0, 2), truth, 0.0)


def test_latency_counts_scans_from_the_target_on():
    present = np.array([[1, 0], [1, 0], [1, 1], [1, 1]], dtype=bool)
    confirmed = np.array([[3, 3], [0, 1], [-1, 2]])
    assert scans_to_initiate(confirmed, present).tolist() == [[4, 2], [1, 1], [-1, 1]]
    assert scans_to_initiate(np.zeros((2, 0), np.int64), np.zeros((4, 0), bool)).shape == (2, 0)
    with pytest.raises(ValueError, match="2 targets have confirmations, 1 have scans"):
        scans_to_initiate(confirmed, present[:, :1])
