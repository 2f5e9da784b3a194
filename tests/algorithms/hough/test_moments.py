from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from algorithms.hough.grid import Grid
from algorithms.hough.moments import moments
from algorithms.hough.voting import accumulate

steady = settings(
    deadline=None, derandomize=True, max_examples=100, suppress_health_check=[HealthCheck.too_slow]
)

places = arrays(np.float64, st.tuples(st.integers(0, 40), st.just(2)), elements=st.floats(-60, 60))
grids = st.builds(
    Grid,
    theta_bins=st.integers(1, 12),
    rho_bins=st.integers(1, 40),
    rho_min=st.floats(-80, 40),
    rho_step=st.floats(0.1, 20),
    origin=st.tuples(st.floats(-30, 30), st.floats(-30, 30)),
    theta_offset=st.floats(0, 0.999),
)
# θ = 0, so that ρ is x exactly; one cell of width 8 about 0.
ONE_CELL = Grid(1, 1, -4.0, 8.0, theta_offset=0.0)


def cell_by_cell(position, grid):
    """Yield row, column and the ρ (from the grid's origin) that numpy finds in each cell with votes."""
    x, y = position[:, 0] - grid.origin[0], position[:, 1] - grid.origin[1]
    for row, theta in enumerate(grid.theta):
        cosine, sine = np.cos(theta), np.sin(theta)
        column = np.floor(
            x * (cosine / grid.rho_step) + y * (sine / grid.rho_step) + (1 - grid.rho_min / grid.rho_step)
        )
        for here in np.unique(column):
            if 1 <= here <= grid.rho_bins:
                yield row, int(here) - 1, (x * cosine + y * sine)[column == here]


@steady
@given(places, grids)
def test_moments_are_those_of_numpy_in_every_cell(position, grid):
    found = moments(position, grid)
    np.testing.assert_array_equal(found.votes, accumulate(position, grid).votes)
    occupied = np.zeros(grid.shape, bool)
    for row, column, rho in cell_by_cell(position, grid):
        occupied[row, column] = True
        assert found.mean[row, column] == pytest.approx(rho.mean(), abs=1e-9)
        assert found.squares[row, column] == pytest.approx(len(rho) * rho.var(), rel=1e-7, abs=1e-10)
        if len(rho) > 1:
            assert found.deviation[row, column] == pytest.approx(rho.std(ddof=1), rel=1e-6, abs=1e-7)
    assert np.isnan(found.mean[~occupied]).all()
    assert (found.squares[~occupied] == 0).all()
    assert (np.isnan(found.deviation) == (found.votes < 2)).all()


def one_cell(rho):
    rho = np.asarray(rho, dtype=float)
    return moments(np.column_stack([rho, np.zeros(len(rho))]), ONE_CELL)


@steady
@given(st.floats(-3.9, 3.9), st.integers(2, 500))
def test_equal_rho_have_no_deviation_at_all(rho, votes):
    found = one_cell(np.full(votes, rho))
    assert found.votes.tolist() == [[votes]]
    assert found.squares[0, 0] == 0
    assert found.deviation[0, 0] == 0


@steady
@given(st.floats(-3.9, 3.9), st.floats(-3.9, 3.9))
def test_two_votes_deviate_by_their_distance_over_the_root_of_two(first, second):
    found = one_cell([first, second])
    assert found.deviation[0, 0] == pytest.approx(abs(first - second) / np.sqrt(2), rel=1e-9, abs=1e-14)


def test_a_tiny_spread_far_from_the_centre_of_the_cell_is_not_lost():
    # Sums of squares about the centre would keep no digit of a variance of 1e-18.
    rho = 3.75 + 1e-9 * np.random.default_rng(3).standard_normal(400)
    assert one_cell(rho).deviation[0, 0] == pytest.approx(rho.std(ddof=1), rel=1e-5)


def test_one_vote_far_from_many_close_ones_does_not_hide_them():
    rho = np.concatenate([[-3.9], 3.9 + 1e-7 * np.random.default_rng(3).standard_normal(99)])
    assert one_cell(rho).squares[0, 0] == pytest.approx(100 * rho.var(), rel=1e-12)


def test_far_from_the_origin_the_deviation_is_as_exact_as_the_coordinates():
    # ρ of a million and σ of a thousandth: doubles there are 1e-10 apart.
    generator = np.random.default_rng(5)
    rho = 1e6 + 1e-3 * generator.standard_normal(1000)
    position = np.column_stack([rho, generator.uniform(-1e6, 1e6, 1000)])
    grid = Grid(1, 400, 1e6 - 1.0, 5e-3, theta_offset=0.0)
    found = moments(position, grid)
    for row, column, votes in cell_by_cell(position, grid):
        if len(votes) > 1:
            assert found.deviation[row, column] == pytest.approx(votes.std(ddof=1), rel=1e-5)
    assert found.votes.sum() == 1000


def test_votes_outside_touch_no_cell():
    found = one_cell([-4.1, 4.0, 1e300, -1e300, 0.5])
    assert found.votes.tolist() == [[1]]
    assert found.mean.tolist() == [[0.5]]
    assert found.squares.tolist() == [[0.0]]
