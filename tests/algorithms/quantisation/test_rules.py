"""Rules of quantisation, against what they promise."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.quantisation.rules import peak_rows, resolvability, suppression_window, widest_row
from algorithms.quantisation.spread import VoteDistribution

steady = settings(deadline=None, derandomize=True, max_examples=100)


def test_two_parallel_lines_in_noise_alone():
    votes = VoteDistribution(0.1, 0.0, 0.0)
    found = resolvability(votes, 1.0, confidence=0.95)
    assert found.half_width == pytest.approx(0.1959964)
    assert found.gap == pytest.approx(1.0 - 0.3919928)
    assert found.valley == pytest.approx(found.gap / 2)
    assert found.holding == pytest.approx(0.3919928)
    assert found.are_apart
    assert not resolvability(votes, 0.39).are_apart


@steady
@given(
    st.floats(0.01, 1),
    st.floats(0, 5),
    st.floats(1, 20),
    st.floats(0.5, 0.99),
    st.floats(0, 1),
)
def test_no_cell_of_the_width_is_within_reach_of_both_lines(sigma, ratio, apart, confidence, place):
    votes = VoteDistribution(sigma, -ratio * sigma, ratio * sigma)
    separation = apart * (sigma + votes.radius)
    found = resolvability(votes, separation, confidence)
    # Of the votes of one line so many lie beyond h to one side.
    beyond = 0.5 * (1 - confidence)
    assert float(votes.distribution(-found.half_width)) == pytest.approx(beyond, abs=1e-9)
    if found.are_apart:
        # A cell between the lines that reaches into the first line's votes ends before the second's.
        begin = found.half_width - place * found.gap
        assert begin + found.gap <= separation - found.half_width + 1e-12 * separation
    # A cell as wide as `holding` about the votes' centre holds their share.
    assert float(votes.share(0.0, found.holding)) == pytest.approx(confidence, abs=1e-9)


@steady
@given(st.floats(1e-3, 10), st.floats(1e-3, 1e4), st.floats(0.1, 5))
def test_the_widest_row_spreads_votes_by_kappa_sigma(sigma, extent, kappa):
    step = widest_row(sigma, extent, kappa)
    assert 0 < step <= math.pi
    radius = VoteDistribution.of_line(sigma, (-extent / 2, extent / 2), step / 2).radius
    if step < math.pi:
        assert radius == pytest.approx(kappa * sigma)
    else:
        assert radius <= kappa * sigma * (1 + 1e-12)
    if kappa * sigma < 0.05 * extent:
        assert step == pytest.approx(4 * kappa * sigma / extent, rel=0.01)


def test_beyond_its_rows_a_peak_is_below_the_threshold():
    expected, extent, votes, theta_step, rho_step = 18.0, 40.0, 9, 0.01, 0.4
    rows = peak_rows(expected, extent, votes, theta_step, rho_step)
    assert rows == pytest.approx(expected * rho_step / (extent * votes * theta_step), rel=1e-3)
    spread = VoteDistribution.of_line(0.0, (-extent / 2, extent / 2), rows * theta_step)
    assert expected * float(spread.share(0.0, rho_step)) == pytest.approx(votes)
    # A line shorter than a cell stays above the threshold in every row.
    assert peak_rows(18.0, 0.1, 9, 0.01, 0.4) == pytest.approx(0.5 * math.pi / 0.01)


def test_the_window_covers_the_votes_of_its_last_row():
    sigma, extent, along, theta_step, rho_step = 0.1, 40.0, 25.0, 0.01, 0.4
    window = suppression_window(1.7, sigma, extent, along, theta_step, rho_step)
    assert window.theta == 4
    ends = (along - extent / 2, along + extent / 2)
    votes = VoteDistribution.of_line(sigma, ends, window.theta * theta_step)
    for half, centre in ((window.rho, votes.centre), (window.rho_upright, 0.0)):
        within = votes.distribution([centre - half * rho_step, centre + half * rho_step])
        assert within[1] - within[0] > 0.97
    assert window.rho_upright > window.rho
