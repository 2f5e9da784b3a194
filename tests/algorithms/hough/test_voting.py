from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from skimage.transform import hough_line

from algorithms.hough.grid import Grid
from algorithms.hough.voting import accumulate

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

places = arrays(np.float64, st.tuples(st.integers(0, 30), st.just(2)), elements=st.floats(-60, 60))
grids = st.builds(
    Grid,
    theta_bins=st.integers(1, 30),
    rho_bins=st.integers(1, 60),
    rho_min=st.floats(-80, 40),
    rho_step=st.floats(0.1, 5),
    origin=st.tuples(st.floats(-30, 30), st.floats(-30, 30)),
    theta_offset=st.floats(0, 0.999),
)


def distances(position, grid):
    """Return ρ of every plot (columns) in every row of a grid, measured from its origin."""
    shifted = position - np.array(grid.origin)
    return np.cos(grid.theta)[:, None] * shifted[:, 0] + np.sin(grid.theta)[:, None] * shifted[:, 1]


def clear_of_edges(position, grid, margin=1e-6):
    """Return the plots none of whose votes lies so near an edge that rounding could decide its column."""
    columns = (distances(position, grid) - grid.rho_min) / grid.rho_step
    return position[(np.abs(columns - np.rint(columns)) > margin).all(axis=0)]


@steady
@given(places, grids)
def test_votes_are_the_histogram_of_rho_in_every_row(position, grid):
    position = clear_of_edges(position, grid)
    found = accumulate(position, grid)
    edges = grid.rho_min + grid.rho_step * np.arange(grid.rho_bins + 1)
    expected = [np.histogram(row, edges)[0] for row in distances(position, grid)]
    np.testing.assert_array_equal(found.votes, expected)


@steady
@given(places, grids)
def test_every_vote_is_inside_or_counted_outside(position, grid):
    found = accumulate(position, grid)
    assert found.total + found.votes_outside == len(position) * grid.theta_bins
    rho = distances(clear_of_edges(position, grid), grid)
    outside = (rho < grid.rho_min) | (rho >= grid.rho_min + grid.rho_step * grid.rho_bins)
    assert found.votes_outside >= outside.sum()
    assert accumulate(clear_of_edges(position, grid), grid).votes_outside == outside.sum()


@steady
@given(places, places, grids)
def test_votes_of_two_batches_add_up(position, other, grid):
    both = accumulate(np.concatenate([other, position]), grid)
    apart = accumulate(position, grid), accumulate(other, grid)
    np.testing.assert_array_equal(both.votes, apart[0].votes + apart[1].votes)
    assert both.votes_outside == apart[0].votes_outside + apart[1].votes_outside


@steady
@given(
    places,
    st.integers(2, 30),
    st.integers(-60, 60),
    st.floats(0, 0.999),
    st.integers(5, 40),
    st.floats(0.2, 5),
)
def test_turning_the_plots_by_rows_shifts_the_rows(position, bins, steps, offset, half_columns, step):
    # Symmetric columns, so that a row that leaves at π comes back at 0 in mirror image.
    grid = Grid(bins, 2 * half_columns, -half_columns * step, step, (3.0, -4.0), offset)
    position = clear_of_edges(position, grid)
    turn = steps * grid.theta_step
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    turned = (position - grid.origin) @ rotation.T + grid.origin
    votes, after = accumulate(position, grid).votes, accumulate(turned, grid).votes
    for row in range(bins):
        crossings, target = divmod(row + steps, bins)
        expected = votes[row][::-1] if crossings % 2 else votes[row]
        np.testing.assert_array_equal(after[target], expected)


@steady
@given(places, grids, st.integers(0, 29), st.integers(-70, 70))
def test_moving_the_plots_along_the_normal_of_a_row_shifts_its_columns(position, grid, row, steps):
    row %= grid.theta_bins
    position = clear_of_edges(position, grid)
    normal = np.array([math.cos(grid.theta[row]), math.sin(grid.theta[row])])
    before = accumulate(position, grid).votes[row]
    after = accumulate(position + steps * grid.rho_step * normal, grid).votes[row]
    columns = np.arange(grid.rho_bins)
    kept = (columns + steps >= 0) & (columns + steps < grid.rho_bins)
    np.testing.assert_array_equal(after[columns[kept] + steps], before[kept])


def test_columns_are_closed_below_and_open_above():
    # θ = 0, so that ρ is x exactly.
    grid = Grid(1, 4, -1.0, 0.5, theta_offset=0.0)
    # As many plots as tell the edges apart.
    edges = np.repeat([-1.0, -0.5, 0.0, 0.5, 1.0], [1, 2, 3, 4, 5])
    on_edges = accumulate(np.column_stack([edges, np.zeros(15)]), grid)
    assert on_edges.votes.tolist() == [[1, 2, 3, 4]]
    assert on_edges.votes_outside == 5
    below = accumulate(np.column_stack([edges - 1e-9, np.zeros(15)]), grid)
    assert below.votes.tolist() == [[2, 3, 4, 5]]
    assert below.votes_outside == 1


def test_votes_equal_those_of_opencv():
    # OpenCV rounds to the nearest of the centres min_rho + j·rho_step, and reports local maxima.
    grid = Grid(36, 240, -60.25, 0.5)
    generator = np.random.default_rng(5)
    along = np.linspace(0, 25, 30)
    lines = [
        start + along[:, None] * np.array(way) for start, way in (((-10, 5), (0.8, 0.6)), ((5, -20), (0, 1)))
    ]
    position = np.concatenate([generator.uniform(-30, 30, (150, 2)), *lines])
    # OpenCV counts in single precision.
    position = clear_of_edges(np.float32(position).astype(float), grid, margin=2e-3)
    assert len(position) > 120
    votes = accumulate(position, grid).votes.astype(int)
    threshold = 4
    peaks = cv2.HoughLinesPointSet(
        position.astype(np.float32)[:, None, :], 100_000, threshold,
        grid.rho[0], grid.rho[-1], grid.rho_step,
        grid.theta[0], grid.theta[0] + math.pi, grid.theta_step,
    ).reshape(-1, 3)  # fmt: skip
    columns = np.rint((peaks[:, 1] - grid.rho[0]) / grid.rho_step).astype(int)
    rows = np.rint((peaks[:, 2] - grid.theta[0]) / grid.theta_step).astype(int)
    np.testing.assert_array_equal(votes[rows, columns], peaks[:, 0])
    around = np.pad(votes, 1)
    local = (
        (votes > threshold)
        & (votes > around[1:-1, :-2])
        & (votes >= around[1:-1, 2:])
        & (votes > around[:-2, 1:-1])
        & (votes >= around[2:, 1:-1])
    )
    assert len(peaks) > 20
    assert sorted(zip(rows, columns, strict=True)) == sorted(zip(*np.nonzero(local), strict=True))


def test_votes_equal_those_of_scikit_image():
    theta = (np.arange(45) + 0.5) * math.pi / 45
    # It rounds to the nearest whole ρ.
    grid = Grid(45, 131, -65.5, 1.0)
    rows, columns = np.nonzero(np.random.default_rng(6).random((40, 50)) < 0.05)
    position = clear_of_edges(np.column_stack([columns, rows]).astype(float), grid)
    assert len(position) > 60
    image = np.zeros((40, 50), bool)
    image[tuple(position[:, ::-1].astype(int).T)] = True
    expected, _, centres = hough_line(image, theta)
    np.testing.assert_allclose(centres, grid.rho)
    np.testing.assert_array_equal(accumulate(position, grid).votes, expected.T)


def test_the_height_of_a_plot_does_not_vote():
    position = np.random.default_rng(7).uniform(-5, 5, (20, 3))
    grid = Grid(12, 30, -8.0, 0.5)
    np.testing.assert_array_equal(accumulate(position, grid).votes, accumulate(position[:, :2], grid).votes)


def test_no_plots_give_no_votes():
    found = accumulate(np.empty((0, 2)), Grid(4, 5, -1.0, 0.4))
    assert found.votes.shape == (4, 5)
    assert (found.total, found.votes_outside) == (0, 0)


def test_one_plot_votes_once_in_each_row():
    found = accumulate(np.array([[1.0, 2.0]]), Grid(9, 100, -5.0, 0.1))
    assert found.votes.sum(axis=1).tolist() == [1] * 9
    assert found.votes_outside == 0


def test_identical_plots_share_one_cell_in_each_row():
    found = accumulate(np.full((300, 2), 1.5), Grid(9, 100, -5.0, 0.1))
    assert found.votes.max(axis=1).tolist() == [300] * 9
    assert found.total == 2700


def test_the_greatest_cell_is_the_first_of_equals():
    position = np.array([[2.25, 0.0], [0.25, 0.0], [2.25, 1.0], [0.25, 1.0], [1.25, 0.0]])
    assert accumulate(position, Grid(1, 20, -5.0, 0.5, theta_offset=0.0)).greatest == (0, 10)


@pytest.mark.parametrize("far", [1e9, -1e9, 1e300])
def test_plots_far_outside_are_counted_outside(far):
    found = accumulate(np.array([[far, 0.3 * far], [0.1, 0.2]]), Grid(7, 20, -1.0, 0.1))
    assert found.votes_outside == 7
    assert found.total == 7


def test_coordinates_of_a_billion_vote_as_those_at_the_origin_do():
    generator = np.random.default_rng(8)
    # Multiples of 1/64 are exact at both places.
    position = generator.integers(-640, 640, (50, 2)) / 64.0
    grid, far = Grid(30, 60, -15.0, 0.5), Grid(30, 60, -15.0, 0.5, (1e9, -1e9))
    np.testing.assert_array_equal(
        accumulate(position + far.origin, far).votes, accumulate(position, grid).votes
    )


@pytest.mark.parametrize(
    ("x", "grid"),
    [
        (1e308, Grid(90, 10, -0.5, 0.1)),
        (1.0, Grid(2, 10, 1.0, 1e-310, theta_offset=0.0)),
        (1.0, Grid(90, 10, -1.79e308, 0.1)),
    ],
)
def test_every_row_counts_a_plot_of_any_place_once(x, grid):
    found = accumulate(np.array([[x, -x]]), grid)
    assert found.total + found.votes_outside == grid.theta_bins
