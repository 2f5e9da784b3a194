from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.context import Box, Context
from algorithms.errors import RequestError
from algorithms.hough.grid import Grid, GridParameters
from algorithms.hough.lines import line_distance
from algorithms.hough.voting import accumulate
from algorithms.parameters import validated

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

grids = st.builds(
    Grid,
    theta_bins=st.integers(1, 40),
    rho_bins=st.integers(1, 40),
    rho_min=st.floats(-100, 100),
    rho_step=st.floats(0.01, 10),
    origin=st.tuples(st.floats(-100, 100), st.floats(-100, 100)),
    theta_offset=st.floats(0, 0.999),
)

SCENE = Context(15, 4.0, 1.0, (0.1, 0.1), Box((0.0, 0.0), (100.0, 100.0)))
COURSE = Grid(90, 1000, -150.0, 0.6)


def test_the_centres_of_the_course_report_grid():
    assert COURSE.shape == (90, 1000)
    assert np.degrees(COURSE.theta) == pytest.approx(np.arange(1, 180, 2))
    assert COURSE.rho == pytest.approx(-149.7 + 0.6 * np.arange(1000))


@steady
@given(grids)
def test_the_line_at_a_centre_lies_in_its_cell(grid):
    rows, columns = (part.ravel() for part in np.indices(grid.shape))
    theta, rho = grid.lines(rows, columns)
    assert ((theta >= 0) & (theta < math.pi)).all()
    assert [grid.cell(*line) for line in zip(theta, rho, strict=True)] == list(
        zip(rows, columns, strict=True)
    )


@steady
@given(grids, st.floats(0, math.pi, exclude_max=True), st.floats(0.001, 0.999))
def test_the_centre_of_a_cell_is_within_half_a_cell_of_its_lines(grid, theta, share):
    # ρ about the grid's origin, anywhere in the columns.
    shifted = grid.rho_min + share * grid.rho_step * grid.rho_bins
    towards = grid.origin[0] * math.cos(theta) + grid.origin[1] * math.sin(theta)
    found = grid.cell(theta, shifted + towards)
    if found is None:
        # Only the nearest row being across the seam, where ρ is −ρ, may put the line outside.
        assert min(theta, math.pi - theta) <= grid.theta_step / 2 + 1e-9
        end = grid.rho_min + grid.rho_step * grid.rho_bins
        assert not grid.rho_min + 1e-9 <= -shifted < end - 1e-9
        return
    row, column = found
    angle, distance = line_distance(theta, shifted, grid.theta[row], grid.rho[column])
    assert angle <= grid.theta_step / 2 + 1e-9
    if angle < math.pi / 2 - 1e-6:
        assert distance <= grid.rho_step / 2 + 1e-6


def test_a_line_nearer_to_the_first_row_across_the_seam_lies_in_it():
    grid = Grid(6, 10, -5.0, 1.0, theta_offset=0.0)
    assert grid.cell(math.pi - 0.01, 3.5) == (0, 1)
    assert grid.cell(0.01, 3.5) == (0, 8)
    late = Grid(6, 10, -5.0, 1.0, theta_offset=0.9)
    assert late.cell(0.0, 3.5) == (5, 1)


@pytest.mark.parametrize("rho", [-5.01, 5.0, 1e9, -1e9])
def test_a_line_beyond_the_columns_has_no_cell(rho):
    assert Grid(6, 10, -5.0, 1.0).cell(0.3, rho) is None


def test_columns_are_closed_below_and_open_above():
    grid = Grid(6, 10, -5.0, 1.0)
    assert grid.cell(0.3, -5.0) == (0, 0)
    assert grid.cell(0.3, -1e-9) == (0, 4)
    assert grid.cell(0.3, 0.0) == (0, 5)


def test_automatic_columns_are_symmetric_about_the_centre_of_the_region():
    grid = GridParameters().grid(SCENE)
    assert grid.origin == (50.0, 50.0)
    assert grid.rho_min == pytest.approx(-math.hypot(50, 50))
    assert grid.rho_step == pytest.approx(6 * 0.1)
    assert grid.rho_bins == math.ceil(2 * math.hypot(50, 50) / 0.6)


@steady
@given(
    st.integers(1, 60),
    st.one_of(st.just("auto"), st.floats(0.05, 50)),
    st.one_of(st.just("auto"), st.tuples(st.floats(-200, 200), st.floats(-200, 200))),
    st.sampled_from([(0.1, 0.1), (2.0, 0.0), (0.0, 0.0), None]),
    st.integers(0, 2**32),
)
def test_no_plot_of_the_region_votes_outside_an_automatic_grid(bins, step, origin, sigma, seed):
    region = Box((-30.0, 10.0), (50.0, 60.0))
    parameters = GridParameters(theta_bins=bins, rho_step=step, origin=origin)
    grid = parameters.grid(Context(5, 1.0, 1.0, sigma, region))
    places = np.random.default_rng(seed).uniform(region.lower, region.upper, (40, 2))
    assert accumulate(places, grid).votes_outside == 0


def test_a_given_number_of_columns_covers_the_region():
    grid = GridParameters(rho_bins=100).grid(SCENE)
    assert grid.rho_step * 100 == pytest.approx(2 * math.hypot(50, 50))


def test_without_noise_the_region_has_five_hundred_columns():
    grid = GridParameters().grid(Context(5, 1.0, 1.0, None, SCENE.region))
    assert grid.rho_bins == 500
    assert grid.rho_step * 500 == pytest.approx(2 * math.hypot(50, 50))


def test_a_given_first_column_is_measured_from_the_origin_of_coordinates():
    grid = GridParameters(rho_min=-150.0, rho_step=0.6, rho_bins=1000).grid(SCENE)
    assert grid == COURSE
    reaching = GridParameters(rho_min=-150.0).grid(SCENE)
    assert reaching.origin == (0.0, 0.0)
    assert reaching.rho_min + reaching.rho_step * reaching.rho_bins >= math.hypot(100, 100)


def test_a_given_origin_and_first_column_are_both_kept():
    grid = GridParameters(rho_min=-10.0, rho_step=1.0, rho_bins=20, origin=(3.0, 4.0)).grid(SCENE)
    assert (grid.origin, grid.rho_min) == ((3.0, 4.0), -10.0)


def test_step_and_columns_alone_make_a_symmetric_grid_that_needs_no_region():
    grid = GridParameters(rho_step=2.0, rho_bins=7).grid(Context(5, 1.0))
    assert (grid.rho_min, grid.origin) == (-7.0, (0.0, 0.0))


def test_a_region_that_is_one_point_still_has_a_column():
    grid = GridParameters().grid(Context(5, 1.0, 1.0, None, Box((3.0, 4.0), (3.0, 4.0))))
    assert grid.cell(0.0, 3.0) is not None


@steady
@given(
    st.one_of(st.just("auto"), st.floats(0.05, 5)),
    st.one_of(st.just("auto"), st.integers(1, 500)),
    st.one_of(st.just("auto"), st.floats(-300, 50)),
    st.one_of(st.just("auto"), st.tuples(st.floats(-200, 200), st.floats(-200, 200))),
)
def test_resolving_changes_nothing_about_the_grid(step, bins, rho_min, origin):
    given_parameters = GridParameters(rho_step=step, rho_bins=bins, rho_min=rho_min, origin=origin)
    resolved = given_parameters.resolved(SCENE)
    assert "auto" not in resolved.model_dump().values()
    assert resolved.grid(SCENE) == given_parameters.grid(SCENE)
    assert resolved.resolved(SCENE) == resolved


def test_an_accumulator_that_is_too_large_is_refused_with_its_size_and_the_limit():
    parameters = GridParameters(theta_bins=50_000, rho_bins=10_000, rho_step=1.0)
    with pytest.raises(RequestError) as error:
        parameters.grid(SCENE)
    # 50,000 × 10,000 cells of 4 bytes.
    assert "50,000 × 10,000" in str(error.value)
    assert "1.9 GiB" in str(error.value)
    assert "the limit is 1 GiB" in str(error.value)
    assert "theta_bins" in str(error.value)


def test_the_largest_accumulator_is_not_refused():
    assert GridParameters(theta_bins=2**14, rho_bins=2**14, rho_step=1.0).grid(SCENE).shape == (2**14, 2**14)
    with pytest.raises(RequestError, match="the limit is 1 GiB"):
        GridParameters(theta_bins=2**14, rho_bins=2**14 + 1, rho_step=1.0).grid(SCENE)


def test_an_absurdly_fine_step_is_refused_in_words():
    with pytest.raises(RequestError, match="the limit is 1 GiB"):
        GridParameters(rho_step=1e-12).grid(SCENE)


@pytest.mark.parametrize("given_values", [{}, {"rho_step": 1.0}, {"rho_bins": 10}, {"rho_min": -5.0}])
def test_without_a_region_what_it_would_decide_must_be_given(given_values):
    with pytest.raises(RequestError, match="the region is not known"):
        GridParameters(**given_values).grid(Context(5, 1.0))


def test_a_first_column_past_the_region_is_refused():
    with pytest.raises(RequestError, match="past the farthest corner") as error:
        GridParameters(rho_min=142.0).grid(SCENE)
    assert "142" in str(error.value)
    assert "141.421" in str(error.value)


def test_a_number_of_columns_beyond_floating_point_is_refused_in_words():
    with pytest.raises(RequestError, match=r"rho_bins: .* must be at most|the limit is 1 GiB"):
        validated(GridParameters, {"rho_bins": 10**400, "rho_step": 1.0}, "grid").grid(SCENE)
