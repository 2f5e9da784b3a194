from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.hough.grid import Grid
from algorithms.hough.peaks.sequential import Sequential
from algorithms.hough.peaks.threshold import Threshold
from algorithms.hough.search import search
from algorithms.hough.voting import accumulate

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

GRID = Grid(18, 40, -10.0, 0.5, (1.0, 2.0))
THRESHOLD = Threshold(3)
SUCCESSIVE = Sequential(2, maxima=4, rows=2, columns=3)

quarter = st.integers(-40, 40).map(lambda quarters: quarters / 4)
point = st.tuples(st.integers(0, 3), quarter, quarter)
batches = st.lists(point, max_size=25).map(sorted)


@steady
@given(st.lists(batches, min_size=1, max_size=5), st.sampled_from([THRESHOLD, SUCCESSIVE]))
def test_a_trial_gives_the_same_in_a_chunk_as_alone(chunk_of, trials, peaks):
    found = search(chunk_of(*trials), GRID, peaks)
    assert len(found.counts) == len(found.votes_outside) == len(trials)
    for index, trial in enumerate(trials):
        alone = search(chunk_of(trial), GRID, peaks)
        tracks = slice(found.offsets[index], found.offsets[index + 1])
        np.testing.assert_array_equal(found.theta[tracks], alone.theta)
        np.testing.assert_array_equal(found.rho[tracks], alone.rho)
        np.testing.assert_array_equal(found.score[tracks], alone.score)
        assert found.votes_outside[index] == alone.votes_outside[0]


@steady
@given(batches, st.integers(1, 6))
def test_tracks_at_a_threshold_are_the_cells_of_the_accumulator(chunk_of, trial, least):
    chunk = chunk_of(trial)
    votes = accumulate(chunk.position, GRID)
    found = search(chunk, GRID, Threshold(least))
    rows, columns = np.nonzero(votes.votes >= least)
    theta, rho = GRID.lines(rows, columns)
    np.testing.assert_array_equal(found.theta, theta)
    np.testing.assert_array_equal(found.rho, rho)
    np.testing.assert_array_equal(found.score, votes.votes[rows, columns])
    assert found.votes_outside.tolist() == [votes.votes_outside]


@pytest.mark.parametrize("peaks", [THRESHOLD, SUCCESSIVE])
def test_trials_without_plots_between_others_have_no_tracks(chunk_of, peaks):
    line = [(scan, 0.5 + 0.25 * scan, 2.0) for scan in range(4)]
    found = search(chunk_of([], line, [], [], line, []), GRID, peaks)
    counts = found.counts
    assert (counts[[0, 2, 3, 5]] == 0).all()
    assert counts[1] == counts[4] > 0
    assert (found.votes_outside[[0, 2, 3, 5]] == 0).all()


@pytest.mark.parametrize("peaks", [THRESHOLD, SUCCESSIVE])
def test_a_chunk_without_trials_or_plots_has_no_tracks(chunk_of, peaks):
    assert len(search(chunk_of(), GRID, peaks).counts) == 0
    assert search(chunk_of([]), GRID, peaks).counts.tolist() == [0]


def test_a_great_number_of_tracks_is_kept_whole(chunk_of):
    # One plot votes in every row: 18 tracks a trial, beyond the room made at first.
    found = search(chunk_of(*[[(0, 0.1, 0.2)]] * 200), GRID, Threshold(1))
    assert found.counts.tolist() == [18] * 200
    assert np.ptp(found.rho.reshape(200, 18), axis=0).max() == 0


def test_windows_larger_than_the_accumulator_leave_one_maximum(chunk_of):
    trial = [(0, 1.0, 1.0), (1, 1.0, 2.0), (2, -3.0, 4.0)]
    peaks = Sequential(1, maxima=9, rows=10**12, columns=10**12)
    assert search(chunk_of(trial), GRID, peaks).counts.tolist() == [1]
