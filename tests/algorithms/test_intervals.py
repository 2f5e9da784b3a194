from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.stats import binomtest, chi2, norm

from algorithms.intervals import Z95, count_interval, effective_count, mean_interval, normal_interval, wilson

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

counts = st.integers(1, 5000).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n)))
zeros_and_ones = st.lists(st.sampled_from([0.0, 1.0]), min_size=1, max_size=200)


# R. G. Newcombe, Statistics in Medicine 17, 1998, table I, method 3.
@pytest.mark.parametrize(
    ("found", "count", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_published_wilson_intervals(found, count, low, high):
    assert wilson(found / count, count) == pytest.approx((low, high), abs=5e-5)


@steady
@given(counts)
def test_the_wilson_interval_is_that_of_scipy(count):
    found, trials = count
    expected = binomtest(found, trials).proportion_ci(method="wilson")
    assert wilson(found / trials, trials) == pytest.approx((expected.low, expected.high), abs=1e-12)


@steady
@given(counts, st.floats(0.1, 5))
def test_the_wilson_interval_holds_the_rate_and_stays_in_bounds(count, z):
    found, trials = count
    low, high = wilson(found / trials, trials, z)
    assert 0.0 <= low <= found / trials <= high <= 1.0
    assert low < high


@steady
@given(counts)
def test_bounds_are_mirrored_for_the_opposite_rate(count):
    found, trials = count
    low, high = wilson(found / trials, trials)
    mirrored = wilson((trials - found) / trials, trials)
    assert mirrored == pytest.approx((1.0 - high, 1.0 - low), abs=1e-12)


def test_the_quantile_is_that_of_95_percent():
    assert pytest.approx(norm.ppf(0.975), abs=1e-14) == Z95


@steady
@given(zeros_and_ones)
def test_values_of_zero_and_one_count_once_each(values):
    assert effective_count(values) == pytest.approx(len(values))
    expected = binomtest(round(sum(values)), len(values)).proportion_ci(method="wilson")
    assert mean_interval(values) == pytest.approx((expected.low, expected.high), abs=1e-9)


def test_means_of_two_independent_targets_count_twice():
    # All four outcomes of two targets at even odds.
    values = [0.0, 0.5, 0.5, 1.0] * 25
    assert effective_count(values) == pytest.approx(200)
    assert mean_interval(values) == pytest.approx(wilson(0.5, 200))


def test_means_of_two_targets_found_together_count_once():
    values = np.repeat([[0.0, 0.0], [1.0, 1.0]], 30, axis=0).mean(axis=1)
    assert effective_count(values) == pytest.approx(60)


@pytest.mark.parametrize("value", [0.0, 0.25, 1.0])
def test_values_without_spread_count_once_each(value):
    assert effective_count([value] * 12) == 12
    low, high = mean_interval([value] * 12)
    assert low <= value <= high


def test_the_interval_covers_the_truth_as_often_as_it_says():
    # Over every outcome of 100 trials, weighted by its chance; Wilson's interval is within 2 points of 95 %.
    trials, rate = 100, 0.3
    covered = 0.0
    for found in range(trials + 1):
        low, high = wilson(found / trials, trials)
        if low <= rate <= high:
            covered += math.comb(trials, found) * rate**found * (1 - rate) ** (trials - found)
    assert covered == pytest.approx(0.95, abs=0.02)


@pytest.mark.parametrize("trials", [1, 20, 1000])
def test_what_was_not_seen_may_still_happen(trials):
    low, high = count_interval(np.zeros(trials))
    # The exact interval of a Poisson mean, by its relation to chi-squared.
    assert (low, high) == pytest.approx((0.0, chi2(2).ppf(0.975) / 2 / trials), rel=1e-12)


def test_what_was_seen_has_the_interval_of_the_normal_distribution_above_0():
    many, few = np.random.default_rng(1).poisson(4.0, 500), np.zeros(1000)
    few[7] = 1
    assert count_interval(many) == normal_interval(many)
    assert count_interval(few) == (0.0, normal_interval(few)[1])
