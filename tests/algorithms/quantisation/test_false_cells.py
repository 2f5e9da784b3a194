"""Cells that clutter alone lifts to a threshold, against sums, a closed formula, and draws."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, special, stats

from algorithms.context import Box
from algorithms.hough.grid import Grid
from algorithms.hough.voting import accumulate
from algorithms.quantisation.counts import integrated_tails, tails
from algorithms.quantisation.false_cells import false_cells, false_cells_by_row
from algorithms.quantisation.question import Clutter, ClutterSource, TargetLine

steady = settings(deadline=None, derandomize=True, max_examples=80)

SQUARE = Box((0.0, 0.0), (100.0, 100.0))


@pytest.mark.parametrize("mean", [0.0, 1e-6, 0.3, 2.6, 40.0])
def test_tails_of_a_poisson_number(mean):
    expected = stats.poisson.sf(np.arange(61) - 1, mean)
    assert tails(mean, 60) == pytest.approx(expected, rel=1e-10, abs=1e-300)


@pytest.mark.parametrize(("mean", "fixed"), [(0.0, 9), (0.3, 3), (2.6, 5), (2.6, 750), (40.0, 41), (5.0, 5)])
def test_tails_of_a_binomial_number(mean, fixed):
    expected = stats.binom.sf(np.arange(61) - 1, fixed, mean / fixed)
    assert tails(mean, 60, float(fixed)) == pytest.approx(expected, rel=1e-9, abs=1e-14)


@pytest.mark.parametrize("fixed", [None, 5.0, 750.0])
def test_integrated_tails(fixed):
    for most in (1, 3, 6):

        def tail(mean, most=most):
            return float(tails(mean, most, fixed)[most])

        expected = integrate.quad(tail, 0.0, 2.6, epsabs=1e-13)[0]
        assert float(integrated_tails(2.6, most, fixed)[most - 1]) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("width", "height"), [(100.0, 100.0), (300.0, 40.0)])
@pytest.mark.parametrize("votes", [2, 8, 15])
def test_a_fixed_number_of_plots_gives_the_closed_formula(width, height, votes):
    plots, rho_step, bins = 750, 0.6, 91
    theta = (np.arange(bins) + 0.5) * np.pi / bins
    across, up = width * np.abs(np.cos(theta)), height * np.abs(np.sin(theta))
    f, s = 0.5 * np.abs(across - up), 0.5 * (across + up)
    chord = width * height / np.maximum(across, up)
    q = rho_step * chord / (width * height)
    below = special.betainc(votes, plots - votes + 1, q)
    above = special.betainc(votes + 1, plots - votes + 1, q)
    expected = (2 * f * below + 2 * (s - f) * (below - votes * above / ((plots + 1) * q))) / rho_step
    clutter = Clutter((ClutterSource(plots, Box((0.0, 0.0), (width, height))),), is_exact=True)
    found = false_cells_by_row(clutter, theta, np.array([rho_step]), votes)[:, 0, votes - 1]
    assert found == pytest.approx(expected, rel=1e-7)


def rectangles(draw_float):
    return st.builds(
        lambda x, y, width, height: Box((x, y), (x + width, y + height)),
        draw_float(-50, 50), draw_float(-50, 50), draw_float(1, 100), draw_float(1, 100),
    )  # fmt: skip


sources = st.builds(ClutterSource, st.floats(1, 2000), rectangles(st.floats))


@steady
@given(
    st.lists(sources, min_size=1, max_size=3).map(tuple),
    st.integers(1, 12),
    st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
    st.floats(-80, 0),
    st.sampled_from([0.0, 0.5]),
)
def test_several_regions_and_any_grid_are_the_sum_over_the_cells(found, votes, origin, rho_min, offset):
    clutter = Clutter(found)
    # Fine columns, so that the density is straight within almost every cell.
    grid = Grid(6, 20_000, rho_min, 0.01, origin, offset)
    density = clutter.density(grid.theta[:, None], grid.rho, grid.origin)
    tail = stats.poisson.sf(votes - 1, grid.rho_step * density)
    # Along the axes the density jumps at both ends of each region: the sum takes the cell there whole or
    # not at all, the integral in part.
    jumps = np.isclose(np.sin(2.0 * grid.theta), 0.0)
    margin = 2 * len(found) * tail[jumps].max(axis=1).sum()
    assert false_cells(clutter, grid, votes) == pytest.approx(tail.sum(), rel=2e-3, abs=margin + 1e-9)


def test_the_density_holds_all_plots_and_is_that_of_draws():
    source = ClutterSource(1000.0, Box((10.0, -20.0), (70.0, 10.0)))
    place = np.random.default_rng(3).uniform((10, -20), (70, 10), (200_000, 2))
    for theta in (0.0, 0.4, np.pi / 2, 2.2):
        rho = np.linspace(-120, 120, 240_001)
        density = source.density(theta, rho, (5.0, 7.0))
        assert np.trapezoid(density, rho) == pytest.approx(1000, rel=1e-3)
        voted = (place[:, 0] - 5) * np.cos(theta) + (place[:, 1] - 7) * np.sin(theta)
        for low, high in ((-20, 0), (0, 20), (20, 40)):
            share = np.mean((voted >= low) & (voted < high))
            within = (rho >= low) & (rho < high)
            assert density[within].mean() * 20 / 1000 == pytest.approx(share, abs=0.006)


def test_no_clutter_lifts_no_cell():
    assert false_cells(Clutter(), Grid(9, 9, -9.0, 2.0), 1) == 0.0
    assert false_cells(Clutter((ClutterSource(0.0, SQUARE),)), Grid(9, 9, -9.0, 2.0), 1) == 0.0


def test_false_cells_of_drawn_clutter():
    # A grid that is not centred and does not reach over the whole region.
    grid = Grid(45, 90, -60.0, 1.5, (10.0, 20.0))
    clutter = Clutter((ClutterSource(400.0, SQUARE),))
    random = np.random.default_rng(11)
    for votes in (9, 12):
        counts = []
        for _ in range(400):
            plots = random.uniform(0.0, 100.0, (random.poisson(400.0), 2))
            counts.append(int((accumulate(plots, grid).votes >= votes).sum()))
        error = np.std(counts) / np.sqrt(len(counts))
        assert np.mean(counts) == pytest.approx(false_cells(clutter, grid, votes), abs=4 * error)


def test_the_clutter_on_a_line_of_unknown_place_is_the_mean_over_lines_through_the_region():
    clutter = Clutter((ClutterSource(500.0, Box((0.0, 0.0), (80.0, 30.0))),))
    random = np.random.default_rng(2)
    place = random.uniform((0, 0), (80, 30), (100_000, 2))
    theta = random.uniform(0, np.pi, 100_000)
    rho = place[:, 0] * np.cos(theta) + place[:, 1] * np.sin(theta)
    expected = clutter.density(theta, rho, (0.0, 0.0)).mean()
    assert clutter.density_on(TargetLine(0.1, 9, 5.0)) == pytest.approx(expected, rel=0.005)
