from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.scoring.matching import DUPLICATE, FALSE, FINDER, Criterion, Truth, score
from algorithms.tracks import TrackChunk

steady = settings(
    deadline=None, derandomize=True, max_examples=300, suppress_health_check=[HealthCheck.too_slow]
)


def track_chunk(trials):
    """Return the tracks of trials, each a list of (theta, rho, score, plots)."""
    tracks = [track for trial in trials for track in trial]
    plots = np.full((len(tracks), 4), -1, np.int64)
    for row, (*_, held) in zip(plots, tracks, strict=True):
        row[: len(held)] = held
    theta, rho, rank = (np.array([track[part] for track in tracks], dtype=float) for part in range(3))
    offsets = np.cumsum([0, *map(len, trials)], dtype=np.int64)
    return TrackChunk(offsets, theta, rho, rank, np.zeros(len(trials), np.int64), plots)


ALONG = 7.0
"""How far the middle of each target's path lies along its line from the foot of the origin."""


def middle_of(theta, rho):
    return rho * np.cos(theta) - ALONG * np.sin(theta), rho * np.sin(theta) + ALONG * np.cos(theta)


def truth_of(targets, origins=(), trials=1):
    lines = np.tile(np.array(targets, dtype=float).reshape(-1, 2), (trials, 1, 1))
    theta, rho = np.ascontiguousarray(lines[..., 0]), np.ascontiguousarray(lines[..., 1])
    return Truth(theta, rho, np.stack(middle_of(theta, rho), axis=-1), np.array(origins, np.int32))


def apart(theta, rho, true_theta, true_rho):
    """Return the signed differences, the target's line written on the track's side of the seam."""
    ways = [(true_theta + turn * math.pi, -true_rho if turn else true_rho) for turn in (0, -1, 1)]
    nearest = min(ways, key=lambda way: abs(theta - way[0]))
    return theta - nearest[0], rho - nearest[1]


def brute_force(trials, targets, origins, criterion):
    """Return what `score` says, trial by trial, track by track."""
    results = []
    for trial, origin in zip(trials, origins, strict=True):
        matching = {target: [] for target in range(len(targets))}
        states, seen = [], set()
        for number, (theta, rho, rank, plots) in enumerate(trial):
            matched, apartness = set(), {}
            for target, line in enumerate(targets):
                angle, distance = apart(theta, rho, *line)
                if criterion.mid_track:
                    x, y = middle_of(*line)
                    distance = rho - x * math.cos(theta) - y * math.sin(theta)
                if criterion.plots is not None:
                    fits = sum(origin[row] == target for row in plots) >= criterion.plots
                elif criterion.theta is None:
                    fits = abs(rho - line[1]) <= criterion.rho
                else:
                    fits = abs(angle) <= criterion.theta and abs(distance) <= criterion.rho
                if fits:
                    matched.add(target)
                if fits and criterion.nearest:
                    apartness[target] = math.hypot(angle / criterion.theta, distance / criterion.rho)
            if criterion.nearest and matched:
                matched = {min(matched, key=apartness.__getitem__)}
            for target in matched:
                angle, distance = apart(theta, rho, *targets[target])
                if criterion.mid_track:
                    x, y = middle_of(*targets[target])
                    distance = rho - x * math.cos(theta) - y * math.sin(theta)
                matching[target].append((-rank, abs(distance), number, angle, distance))
            states.append(FALSE if not matched else DUPLICATE if matched <= seen else FINDER)
            seen |= matched
        best = [min(found)[3:] if found else (math.nan, math.nan) for found in matching.values()]
        results.append((seen, states, best))
    return results


# Few different values, so that ties in score and distance and criteria met exactly are common.
angles = st.sampled_from([0.0, 0.125, 0.25, 1.0, 1.5, 2.875, 3.0, 3.125])
lengths = st.integers(-6, 6).map(lambda half: half / 2)
tracks = st.tuples(
    angles, lengths, st.integers(1, 3).map(float), st.lists(st.integers(0, 7), max_size=4, unique=True)
)
target_lines = st.lists(st.tuples(angles, lengths), max_size=3)
criteria = st.one_of(
    st.builds(Criterion, rho=st.sampled_from([0.5, 1.0, 3.0])),
    st.builds(Criterion, rho=st.sampled_from([0.5, 1.0]), theta=st.sampled_from([0.125, 0.3, 0.5])),
    st.builds(
        Criterion,
        rho=st.sampled_from([0.5, 1.0]),
        theta=st.sampled_from([0.13, 0.3, 0.5]),
        mid_track=st.just(True),
        nearest=st.booleans(),
    ),
    st.builds(Criterion, plots=st.integers(1, 4)),
)


@steady
@given(st.data(), st.lists(st.lists(tracks, max_size=5), min_size=1, max_size=3), target_lines, criteria)
def test_scores_are_those_of_a_loop_over_trials_tracks_and_targets(data, trials, targets, criterion):
    origin = st.lists(st.integers(-1, len(targets) - 1), min_size=8, max_size=8)
    origins = [data.draw(origin) for _ in trials]
    plot_offsets = np.arange(len(trials) + 1) * 8
    found = score(
        track_chunk(trials), truth_of(targets, np.ravel(origins), len(trials)), plot_offsets, criterion
    )
    expected = brute_force(trials, targets, origins, criterion)
    assert found.found.shape == (len(trials), len(targets))
    assert found.state.tolist() == [state for _, states, _ in expected for state in states]
    for trial, (seen, states, best) in enumerate(expected):
        assert set(np.flatnonzero(found.found[trial]).tolist()) == seen
        assert found.false[trial] == states.count(FALSE)
        assert found.duplicates[trial] == states.count(DUPLICATE)
        for target, (angle, distance) in enumerate(best):
            assert found.theta_error[trial, target] == pytest.approx(angle, abs=1e-12, nan_ok=True)
            # At equal score and distance either sign may stand.
            assert abs(found.rho_error[trial, target]) == pytest.approx(abs(distance), nan_ok=True)


def scored(tracks, targets, criterion):
    return score(track_chunk([tracks]), truth_of(targets), np.zeros(2, np.int64), criterion)


def test_the_second_track_on_a_target_is_a_duplicate_and_no_false_one():
    line = (1.0, 5.0, 3.0, [])
    found = scored([line, line, (1.0, 50.0, 9.0, [])], [(1.0, 5.2)], Criterion(rho=1.0, theta=0.1))
    assert (found.false[0], found.duplicates[0]) == (1, 1)
    assert found.found.tolist() == [[True]]


def test_a_track_between_two_targets_finds_both():
    found = scored([(1.0, 5.0, 1.0, [])], [(1.0, 4.5), (1.0, 5.5)], Criterion(rho=1.0, theta=0.1))
    assert found.found.tolist() == [[True, True]]
    assert (found.false[0], found.duplicates[0]) == (0, 0)
    assert found.rho_error.tolist() == [[0.5, -0.5]]


def test_the_error_is_that_of_the_track_with_the_highest_score():
    candidates = [(1.0, 5.0, 4.0, []), (1.0, 5.4, 9.0, []), (1.0, 5.1, 5.0, [])]
    found = scored(candidates, [(1.0, 5.0)], Criterion(rho=1.0, theta=0.1))
    assert found.rho_error[0, 0] == pytest.approx(0.4)


def test_of_equal_scores_the_nearest_gives_the_error():
    candidates = [(1.0, 5.4, 9.0, []), (1.02, 4.8, 9.0, []), (1.0, 5.3, 9.0, [])]
    found = scored(candidates, [(1.0, 5.0)], Criterion(rho=1.0, theta=0.1))
    assert found.rho_error[0, 0] == pytest.approx(-0.2)
    assert found.theta_error[0, 0] == pytest.approx(0.02)


def test_lines_are_compared_across_the_seam_where_theta_counts():
    across = [(math.pi - 0.02, -5.1, 1.0, [])]
    found = scored(across, [(0.01, 5.0)], Criterion(rho=1.0, theta=0.1))
    assert found.found.tolist() == [[True]]
    assert found.theta_error[0, 0] == pytest.approx(-0.03)
    assert found.rho_error[0, 0] == pytest.approx(-0.1)


def test_rho_alone_is_compared_as_it_stands():
    tracks_at = [(math.pi - 0.02, -5.1, 1.0, []), (2.0, 5.1, 1.0, [])]
    found = scored(tracks_at, [(0.01, 5.0)], Criterion(rho=1.0))
    assert found.found.tolist() == [[True]]
    assert found.false.tolist() == [1]


def test_bounds_of_a_criterion_belong_to_it():
    targets = [(1.0, 5.0)]
    assert scored([(1.125, 6.0, 1.0, [])], targets, Criterion(rho=1.0, theta=0.125)).found.all()
    beyond = Criterion(rho=np.nextafter(1.0, 0.0), theta=0.125)
    assert not scored([(1.125, 6.0, 1.0, [])], targets, beyond).found.any()


def test_rows_of_plots_count_from_the_beginning_of_their_trial():
    trials = [[(1.0, 0.0, 3.0, [0, 1])], [(1.0, 0.0, 3.0, [0, 1])]]
    truth = truth_of([(0.0, 0.0), (0.0, 9.0)], [0, 0, -1, 1, 1], 2)
    found = score(track_chunk(trials), truth, np.array([0, 3, 5]), Criterion(plots=2))
    assert found.found.tolist() == [[True, False], [False, True]]


def test_plots_of_different_targets_do_not_add_up():
    truth = truth_of([(0.0, 0.0), (0.0, 9.0)], [0, 1, -1])
    found = score(track_chunk([[(1.0, 0.0, 3.0, [0, 1, 2])]]), truth, np.array([0, 3]), Criterion(plots=2))
    assert found.false.tolist() == [1]


def test_a_target_that_stands_still_is_matched_by_plots_alone():
    truth = truth_of([(math.nan, math.nan)], [0, 0])
    line = track_chunk([[(1.0, 0.0, 3.0, [0, 1])]])
    by_plots = score(line, truth, np.array([0, 2]), Criterion(plots=2))
    assert by_plots.found.tolist() == [[True]]
    assert np.isnan(by_plots.theta_error).all()
    for criterion in (Criterion(rho=1e9), Criterion(rho=1e9, theta=9.0)):
        assert not score(line, truth, np.array([0, 2]), criterion).found.any()


def test_trials_without_tracks_and_truth_without_targets():
    nothing = score(
        track_chunk([[], [(1.0, 0.0, 1.0, [])], []]),
        truth_of([], trials=3),
        np.zeros(4, np.int64),
        Criterion(rho=1.0),
    )
    assert nothing.found.shape == (3, 0)
    assert nothing.false.tolist() == [0, 1, 0]
    missed = score(
        track_chunk([[], []]), truth_of([(1.0, 2.0)], trials=2), np.zeros(3, np.int64), Criterion(rho=1.0)
    )
    assert missed.found.tolist() == [[False], [False]]
    assert np.isnan(missed.rho_error).all()


def test_about_the_middle_of_the_path_a_small_turn_moves_the_line_little():
    # One degree of turn about a middle 100 away from the origin moves ρ about the origin by 1.7.
    line = (1.0, 5.0)
    truth = Truth(*(np.array([[value]]) for value in line), np.array([[[100.0, 0.0]]]), np.zeros(0, np.int32))
    truth.middle[0, 0] = [
        5.0 * math.cos(1.0) - 100.0 * math.sin(1.0),
        5.0 * math.sin(1.0) + 100.0 * math.cos(1.0),
    ]
    turned = 1.0 + math.radians(1.0)
    rho = truth.middle[0, 0] @ [math.cos(turned), math.sin(turned)]
    chunk = track_chunk([[(turned, rho, 1.0, [])]])
    assert not score(chunk, truth, np.zeros(2, np.int64), Criterion(rho=0.6, theta=0.05)).found.any()
    found = score(chunk, truth, np.zeros(2, np.int64), Criterion(rho=0.6, theta=0.05, mid_track=True))
    assert found.found.all()
    assert found.rho_error[0, 0] == pytest.approx(0.0, abs=1e-9)


def test_each_trial_has_its_own_lines():
    truth = truth_of([(1.0, 5.0)], trials=2)
    truth.rho[1, 0] = 9.0
    found = score(
        track_chunk([[(1.0, 5.0, 1.0, [])], [(1.0, 5.0, 1.0, [])]]),
        truth,
        np.zeros(3, np.int64),
        Criterion(rho=1.0),
    )
    assert found.found.ravel().tolist() == [True, False]


def test_tracks_with_plots_of_others_are_mixed():
    # Of target 0 alone; with clutter; with a plot of target 1; false ones do not count.
    trial = [
        (1.0, 0.0, 1.0, [0, 1, 2]),
        (1.0, 0.0, 1.0, [0, 1, 2, 3]),
        (1.0, 0.0, 1.0, [0, 1, 2, 4]),
        (1.0, 0.0, 1.0, [3, 4]),
    ]
    truth = truth_of([(0.0, 0.0), (0.0, 9.0)], [0, 0, 0, -1, 1])
    found = score(track_chunk([trial]), truth, np.array([0, 5]), Criterion(plots=3))
    assert found.mixed.tolist() == [2]
    assert found.false.tolist() == [1]
    unknown = TrackChunk(np.array([0, 1]), np.ones(1), np.zeros(1), np.ones(1), np.zeros(1, np.int64))
    assert score(unknown, truth, np.array([0, 5]), Criterion(rho=1.0)).mixed.tolist() == [-1]
