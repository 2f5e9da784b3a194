from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from algorithms.hough.grid import Grid
from algorithms.hough.moments import moments
from algorithms.hough.voting import accumulate
from algorithms.hough.weighting import LEAST_DEVIATION, Weighting, accumulate_weighted, line_weight

steady = settings(
    deadline=None, derandomize=True, max_examples=100, suppress_health_check=[HealthCheck.too_slow]
)

places = arrays(np.float64, st.tuples(st.integers(0, 40), st.just(2)), elements=st.floats(-60, 60))
grids = st.builds(
    Grid,
    theta_bins=st.integers(1, 12),
    rho_bins=st.integers(1, 12),
    rho_min=st.floats(-60, 0),
    rho_step=st.floats(2, 30),
    theta_offset=st.floats(0, 0.999),
)
weightings = st.builds(
    Weighting, several=st.booleans(), eta=st.floats(0.1, 50), least_votes=st.integers(0, 6)
)


def brute_force(votes, deviation, weighting, step):
    """Return s (NaN where not defined) and the weighted votes, one cell after another."""
    s = {}
    for cell in np.ndindex(votes.shape):
        if votes[cell] > weighting.least_votes and votes[cell] >= 2:
            s[cell] = max(deviation[cell], LEAST_DEVIATION * step)
    std, weighted = np.full(votes.shape, np.nan), np.zeros(votes.shape)
    for (theta, rho), own in s.items():
        std[theta, rho] = own
        if weighting.several:
            by_theta = (min(other for (t, _), other in s.items() if t == theta) / own) ** 2
            by_rho = (min(other for (_, r), other in s.items() if r == rho) / own) ** 2
            weight = 0.5 * sum(
                alpha ** (1 / alpha) if alpha > 1e-300 else 0.0 for alpha in (by_theta, by_rho)
            )
        else:
            weight = (min(s.values()) / own) ** (2 * weighting.eta)
        weighted[theta, rho] = votes[theta, rho] * weight
    return std, weighted


@steady
@given(places, grids, weightings)
def test_weights_are_those_of_a_loop_over_all_cells(position, grid, weighting):
    found = accumulate_weighted(position, grid, weighting)
    known = moments(position, grid)
    std, weighted = brute_force(known.votes, known.deviation, weighting, grid.rho_step)
    np.testing.assert_allclose(found.std, std, rtol=1e-9)
    np.testing.assert_allclose(found.weighted, weighted, rtol=1e-7, atol=1e-12)
    plain = accumulate(position, grid)
    np.testing.assert_array_equal(found.votes, plain.votes)
    assert found.votes_outside == plain.votes_outside


@steady
@given(places, grids, weightings)
def test_no_cell_weighs_more_than_its_votes_and_the_least_deviation_weighs_them_all(
    position, grid, weighting
):
    found = accumulate_weighted(position, grid, weighting)
    assert (found.weighted >= 0).all()
    assert (found.weighted <= found.votes).all()
    assert (found.weighted[np.isnan(found.std)] == 0).all()
    if not np.isnan(found.std).all():
        least = np.unravel_index(np.nanargmin(found.std), found.std.shape)
        assert found.weighted[least] == found.votes[least]


# θ = 0 and 90°: columns of x, then of y.
CROSS = Grid(2, 4, -2.0, 1.0, theta_offset=0.0)


def weigh(rows, **given_values):
    position = np.array(rows, dtype=float).reshape(-1, 2)
    return accumulate_weighted(position, CROSS, Weighting(**{"several": True, "eta": 2.0, **given_values}))


@pytest.mark.parametrize("several", [True, False])
def test_where_no_cell_has_more_votes_than_the_floor_every_weight_is_zero(several):
    found = weigh([(0.5, 0.5), (0.5, 0.6), (0.5, -0.5)], several=several, least_votes=3)
    assert found.votes.max() == 3
    assert np.isnan(found.std).all()
    assert (found.weighted == 0).all()


def test_the_floor_must_be_exceeded():
    rows = [(0.5, 0.5), (0.6, 0.6), (0.7, -0.5)]
    assert np.isfinite(weigh(rows, least_votes=2).std).sum() == 1
    assert np.isnan(weigh(rows, least_votes=3).std).all()


def test_one_vote_has_no_deviation_whatever_the_floor():
    found = weigh([(0.5, 0.5)], least_votes=0)
    assert np.isnan(found.std).all()
    assert (found.weighted == 0).all()


def test_a_row_without_a_qualified_cell_weighs_nothing():
    # Two plots share a column of x and none of y; the thesis's constant would leave y its votes.
    found = weigh([(0.5, -1.5), (0.6, 1.5)], least_votes=1)
    assert found.votes[1].tolist() == [1, 0, 0, 1]
    assert found.weighted[1].tolist() == [0, 0, 0, 0]
    assert found.weighted[0].tolist() == [0, 0, 2, 0]


def test_equal_rho_count_as_a_billionth_of_a_column():
    found = weigh([(0.5, 0.1), (0.5, 0.6), (-0.5, -1.5), (-0.6, -0.5)], least_votes=1)
    assert found.std[0, 2] == LEAST_DEVIATION
    assert found.weighted[0, 2] == 2
    # Beside it, α is 2e-16 and its power 0, without a warning and without a number that is none.
    assert found.std[0, 1] == pytest.approx(0.1 / math.sqrt(2))
    assert found.weighted[0, 1] == 1


@pytest.mark.parametrize("exponent", [2, 10, 100, 154, 160, 300])
def test_the_power_of_a_vanishing_ratio_is_zero(exponent):
    assert line_weight(10.0**-exponent, 1.0) == 0
    assert line_weight(1.0, 1.0) == 1


def test_the_weight_of_several_lines_at_a_few_ratios():
    for ratio in (1.0, 0.9, 0.5, 0.2):
        alpha = ratio**2
        assert line_weight(ratio, 1.0) == pytest.approx(alpha ** (1 / alpha), rel=1e-12)


def test_a_great_exponent_leaves_the_cell_of_the_least_deviation_alone():
    generator = np.random.default_rng(2)
    position = generator.uniform(-2, 2, (60, 2))
    found = accumulate_weighted(position, CROSS, Weighting(False, 1e6, 3))
    assert found.weighted.argmax() == np.nanargmin(found.std)
    assert (found.weighted > 1e-6).sum() == 1


def test_numbers_far_from_the_origin_weigh_like_those_near_it():
    generator = np.random.default_rng(8)
    position = generator.normal(0, 1e-3, (200, 2))
    near = accumulate_weighted(position, Grid(9, 12, -6e-3, 1e-3), Weighting(True, 2.0, 3))
    far = accumulate_weighted(position + 1e6, Grid(9, 12, -6e-3, 1e-3, (1e6, 1e6)), Weighting(True, 2.0, 3))
    np.testing.assert_array_equal(far.votes, near.votes)
    np.testing.assert_allclose(far.weighted, near.weighted, rtol=1e-3, atol=1e-6)
