"""The vote distribution, against numerical integration and real votes."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, stats

from algorithms.quantisation.spread import VoteDistribution

steady = settings(deadline=None, derandomize=True, max_examples=150)

# Around the change from the series to the differences, and far to both sides of it.
RATIOS = [0.0, 1e-12, 1e-6, 9.9e-4, 1.01e-3, 0.03, 1.0, 4.0, 30.0, 1e3]

spreads = st.builds(
    lambda sigma, ratio, middle, rho: VoteDistribution(
        sigma, middle - sigma * ratio, middle + sigma * ratio, rho
    ),
    sigma=st.floats(1e-3, 1e3),
    ratio=st.floats(0, 100),
    middle=st.floats(-10, 10),
    rho=st.floats(-1e3, 1e3),
)


def integrated_density(votes, x):
    """Return the density by integrating the normal density over the uniform offsets."""
    if votes.radius == 0.0:
        return stats.norm.pdf(x, votes.centre, votes.sigma)

    def part(offset):
        return stats.norm.pdf(x, votes.rho + offset, votes.sigma)

    # The integrand is a spike where σ is small beside the stretch.
    near = np.clip(x - votes.rho + votes.sigma * np.array([-9, -3, 0, 3, 9]), votes.lower, votes.upper)
    edges = np.unique([votes.lower, *near, votes.upper])
    pieces = [
        integrate.quad(part, *ends, epsabs=1e-14, epsrel=1e-13)[0] for ends in itertools.pairwise(edges)
    ]
    return sum(pieces) / (votes.upper - votes.lower)


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_density_is_the_convolution(ratio):
    votes = VoteDistribution(0.2, 0.3 - 0.2 * ratio, 0.3 + 0.2 * ratio, rho=-7.0)
    for place in (0.0, 0.5, 1.0, 2.5, 6.0):
        x = votes.centre + place * 0.2 + math.copysign(min(place, 1.0), place) * votes.radius
        expected = integrated_density(votes, x)
        assert float(votes.density(x)) == pytest.approx(expected, abs=1e-9, rel=1e-8)
        assert float(votes.density(2 * votes.centre - x)) == pytest.approx(expected, abs=1e-9, rel=1e-6)


@pytest.mark.parametrize("ratio", RATIOS)
def test_the_distribution_function_is_the_integral_of_the_density(ratio):
    votes = VoteDistribution(0.2, 0.3 - 0.2 * ratio, 0.3 + 0.2 * ratio, rho=-7.0)
    reach = votes.radius + 9 * votes.sigma
    for share in (-0.98, -0.6, -0.2, 0.0, 0.4, 0.9):
        x = votes.centre + share * reach
        kinks = [side * votes.radius + k * votes.sigma for side in (-1, 1) for k in (-8, 0, 8)]
        edges = np.unique(votes.centre + np.clip([-reach, *kinks, 0.0, share * reach], -reach, share * reach))
        pieces = [
            integrate.quad(votes.density, *ends, epsabs=1e-13, epsrel=1e-12, limit=200)[0]
            for ends in itertools.pairwise(edges)
        ]
        assert float(votes.distribution(x)) == pytest.approx(sum(pieces), abs=1e-9)


def test_the_limits_are_the_normal_and_the_uniform_distribution():
    x = np.linspace(-3, 3, 41)
    for votes in (VoteDistribution(1.0, 0.0, 0.0), VoteDistribution(1.0, -1e-9, 1e-9)):
        assert votes.density(x) == pytest.approx(stats.norm.pdf(x), rel=1e-12)
        assert votes.distribution(x) == pytest.approx(stats.norm.cdf(x), abs=1e-12)
        assert votes.peak_density == pytest.approx(stats.norm.pdf(0))
    x = np.array([-2.5, -1.9, 0.0, 0.7, 1.9, 2.5])
    for votes in (VoteDistribution(0.0, -2.0, 2.0), VoteDistribution(1e-9, -2.0, 2.0)):
        assert votes.density(x) == pytest.approx(stats.uniform.pdf(x, -2, 4), abs=1e-9)
        assert votes.distribution(x) == pytest.approx(stats.uniform.cdf(x, -2, 4), abs=1e-9)
        assert votes.quantile([0.25, 0.9]) == pytest.approx([-1.0, 1.6], abs=1e-8)
        assert votes.peak_density == pytest.approx(0.25)


def test_without_noise_and_extent_all_votes_are_at_one_place():
    votes = VoteDistribution(0.0, 0.5, 0.5, rho=2.0)
    assert votes.distribution([2.4, 2.5, 2.6]).tolist() == [0.0, 0.0, 1.0]
    assert votes.quantile([0.0, 0.3, 1.0]).tolist() == [2.5, 2.5, 2.5]
    assert math.isinf(votes.peak_density)
    assert votes.share([0.0, 0.4, 0.6], 1.0).tolist() == [1.0, 1.0, 0.0]
    assert votes.mean_share(0.1) == 1.0


@steady
@given(spreads, st.floats(1e-12, 1 - 1e-9))
def test_a_quantile_is_where_the_distribution_function_has_the_share(votes, share):
    place = float(votes.quantile(share))
    assert float(votes.distribution(place)) == pytest.approx(share, abs=1e-9)


@steady
@given(spreads)
def test_the_distribution_function_rises_from_0_to_1_and_is_symmetric(votes):
    reach = votes.radius + 10 * votes.sigma
    x = np.linspace(-reach, reach, 201)
    found = votes.distribution(votes.centre + x)
    # The sum with the centre rounds x; what it rounds by, times the density, is lost.
    lost = 1e-12 + np.spacing(abs(votes.centre) + reach) * votes.peak_density * 4
    assert (np.diff(found) >= -lost).all()
    assert found[0] == pytest.approx(0, abs=1e-12)
    assert found[-1] == pytest.approx(1, abs=1e-12)
    assert found + found[::-1] == pytest.approx(np.ones(201), abs=lost)


@steady
@given(spreads, st.floats(0.01, 50))
def test_cells_side_by_side_share_all_votes(votes, width):
    width *= votes.sigma + votes.radius
    count = math.ceil((votes.radius + 9 * votes.sigma) / width) + 1
    offsets = (np.arange(-count, count + 1) + 0.3) * width
    assert votes.share(offsets, width).sum() == pytest.approx(1, abs=1e-9)


@steady
@given(spreads)
def test_the_greatest_density_is_that_of_the_centre(votes):
    assert votes.peak_density == pytest.approx(float(votes.density(votes.centre)), rel=1e-9)
    around = votes.centre + np.linspace(-2, 2, 41) * (votes.radius + votes.sigma)
    assert (votes.density(around) <= votes.peak_density * (1 + 1e-9)).all()


def test_the_far_tail_keeps_its_digits():
    # The smallest shares have an asymptotic form: the normal tail, integrated twice over the ends.
    votes = VoteDistribution(1.0, -0.5, 0.5)
    for place in (-20.0, -30.0):
        expected = integrate.quad(
            lambda s, x=place: stats.norm.cdf(x + s), -0.5, 0.5, epsrel=1e-12, epsabs=0
        )[0]
        assert float(votes.distribution(place)) == pytest.approx(expected, rel=1e-9)
        assert float(votes.quantile(expected)) == pytest.approx(place, rel=1e-10)


# Offsets


@pytest.mark.parametrize("delta", [0.0, 1e-9, 0.02, -0.3, 1.2, math.pi / 2])
def test_votes_of_the_ends_of_a_line_are_the_bounds(delta):
    theta, rho, along = 0.7, -31.0, (-12.0, 55.0)
    votes = VoteDistribution.of_line(0.0, along, delta, rho)
    ends = []
    for k in along:
        x = rho * math.cos(theta) - k * math.sin(theta)
        y = rho * math.sin(theta) + k * math.cos(theta)
        ends.append(x * math.cos(theta + delta) + y * math.sin(theta + delta))
    assert [rho + votes.lower, rho + votes.upper] == pytest.approx(sorted(ends), abs=1e-12)
    assert votes.centre == pytest.approx(sum(ends) / 2)
    assert votes.bias == pytest.approx(sum(ends) / 2 - rho)


@pytest.mark.parametrize(("sigma", "delta"), [(0.1, 0.01), (0.1, 0.9), (1e-6, 0.02), (0.5, 1e-6)])
def test_votes_of_plots_anywhere_along_a_line_are_distributed_so(sigma, delta):
    count, theta, rho, along = 200_000, 2.1, 17.0, (-4.0, 9.0)
    random = np.random.default_rng(5)
    k = random.uniform(*along, count)
    noise = random.normal(0.0, sigma, (2, count))
    x = rho * np.cos(theta) - k * np.sin(theta) + noise[0]
    y = rho * np.sin(theta) + k * np.cos(theta) + noise[1]
    votes = VoteDistribution.of_line(sigma, along, delta, rho)
    found = x * np.cos(theta + delta) + y * np.sin(theta + delta)
    assert stats.kstest(found, votes.distribution).statistic < 0.01


# Mean shares


@pytest.mark.parametrize(("ratio", "published"), [(0, 0.80), (1, 0.77), (2, 0.69), (4, 0.48)])
def test_mean_shares_of_a_cell_of_four_sigma(ratio, published):
    # R is that of the row in question; the mean is over the place of the votes in their cell.
    assert round(VoteDistribution(1.0, -ratio, ratio).mean_share(4.0), 2) == published


@steady
@given(spreads, st.floats(0.05, 30))
def test_the_mean_share_is_the_mean_over_the_places_in_a_cell(votes, width):
    width *= votes.sigma
    offsets = (np.arange(4000) + 0.5) / 4000 * width - 0.5 * width
    assert votes.mean_share(width) == pytest.approx(votes.share(offsets, width).mean(), abs=1e-5)
