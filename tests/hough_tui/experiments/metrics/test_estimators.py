"""Estimators against the formulas that they stand for, worked out with numpy alone."""

import numpy as np
import pytest
from scipy.stats import chi2

from algorithms.intervals import Z95, wilson
from hough_tui.experiments.metrics.estimators import (
    NOTHING,
    Mean,
    MeanCount,
    MeanSquare,
    PooledShare,
    Quantile,
    RootMeanSquare,
    Share,
    Squares,
    Total,
    mean_over_targets,
)

RANDOM = np.random.default_rng(2)
NAN = float("nan")


@pytest.mark.parametrize(
    ("estimator", "values"),
    [
        (Share(), [NAN, NAN]),
        (MeanCount(), []),
        (Mean(), [[NAN, NAN], [NAN, NAN]]),
        (RootMeanSquare(), np.zeros((3, 0))),
        (PooledShare(), [[0.0, 0.0], [NAN, NAN]]),
    ],
)
def test_without_values_there_is_no_figure(estimator, values):
    assert estimator.estimate(np.array(values)) == NOTHING


def test_trials_that_say_nothing_are_left_out():
    estimate = Share().estimate(np.array([1.0, NAN, 0.0, 1.0]))
    assert estimate.value == pytest.approx(2 / 3)
    assert estimate.interval == pytest.approx(wilson(2 / 3, 3))
    assert estimate.trials == 3


def test_squares_are_pooled_over_targets_and_their_error_over_trials():
    values = RANDOM.exponential(size=(400, 3))
    values[RANDOM.random(values.shape) < 0.3] = NAN
    estimate = RootMeanSquare().estimate(values)
    finite = values[np.isfinite(values)]
    assert estimate.value == pytest.approx(np.sqrt(finite.mean()))
    # The jackknife over trials knows nothing of ratios of means.
    sums, counts = np.nansum(values, axis=1), np.isfinite(values).sum(axis=1)
    without = (sums.sum() - sums) / (counts.sum() - counts)
    error = np.sqrt(399 / 400 * ((without - without.mean()) ** 2).sum())
    low, high = (end**2 for end in estimate.interval)
    assert (high - low) / 2 == pytest.approx(Z95 * error, rel=0.02)


def test_targets_that_go_together_widen_the_interval():
    alone = RANDOM.normal(size=(500, 1))
    together, apart = np.repeat(alone, 4, axis=1), RANDOM.normal(size=(500, 4))
    widths = [np.ptp(Mean().estimate(values).interval) for values in (alone, together, apart)]
    assert widths[1] == pytest.approx(widths[0], rel=1e-6)
    assert widths[2] == pytest.approx(widths[0] / 2, rel=0.15)


def test_a_pooled_share_counts_every_one_of_the_whole():
    values = np.array([[1.0, 1.0], [5.0, 10.0], [0.0, 0.0], [NAN, NAN]])
    estimate = PooledShare().estimate(values)
    assert estimate.value == pytest.approx(6 / 11)
    assert estimate.interval[0] < 6 / 11 < estimate.interval[1]
    np.testing.assert_array_equal(PooledShare().per_trial(values), [1.0, 0.5, NAN, NAN])


def test_counts_never_fall_below_zero_and_end_above_it():
    low, high = MeanCount().estimate(np.zeros(100)).interval
    assert (low, high) == (0.0, pytest.approx(3.69 / 100, abs=1e-4))
    assert MeanCount().estimate(np.array([0.0] * 99 + [9.0])).interval[0] == 0.0
    assert Total().estimate(np.array([True, False, True])).value == 2


def test_the_mean_over_targets_leaves_out_what_is_missing():
    values = np.array([[1.0, NAN, 3.0], [NAN, NAN, NAN]])
    np.testing.assert_array_equal(mean_over_targets(values), [2.0, NAN])


@pytest.mark.parametrize(("scale", "is_right"), [(1.0, True), (1.3, False), (0.75, False)])
def test_the_interval_of_squares_holds_their_components_where_they_are_right(scale, is_right):
    values = scale * RANDOM.chisquare(4, size=(300, 2))
    values[RANDOM.random(values.shape) < 0.2] = NAN
    low, high = MeanSquare().estimate(Squares(values, 4)).interval
    assert (low <= 4 <= high) is is_right
    # The usual test: the sum within the quantiles of the χ² distribution.
    count = np.isfinite(values).sum()
    bounds = chi2.ppf([0.025, 0.975], 4 * count)
    assert (bounds[0] <= np.nansum(values) <= bounds[1]) is np.bool_(is_right)


def test_a_quantile_is_the_least_value_that_so_many_do_not_exceed():
    values = np.array([[3.0, 1.0], [NAN, 2.0], [5.0, 4.0]])
    assert Quantile(0.9).estimate(values).value == 5.0
    assert Quantile(0.8).estimate(values).value == 4.0
    hits = 0
    for _ in range(300):
        low, high = Quantile(0.9).estimate(RANDOM.random(400)).interval
        hits += low <= 0.9 <= high
    assert hits / 300 >= 0.92
