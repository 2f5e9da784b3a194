from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from algorithms.hough.peaks.ballots import Ballot
from algorithms.hough.peaks.cells import maximum
from algorithms.hough.peaks.sequential import SequentialRule, clear_window, successive_maxima
from algorithms.hough.peaks.threshold import at_threshold
from algorithms.hough.voting import GridArrays

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

# Few different counts, so that equals are common; the sentinels hold more than any cell.
votes_tables = arrays(
    np.uint32,
    st.tuples(st.integers(1, 9), st.integers(1, 12)),
    elements=st.integers(0, 5),
)
rho_mins = st.integers(-160, 80).map(lambda sixteenths: sixteenths / 16)
rho_steps = st.sampled_from([0.25, 0.5, 1.0, 2.0])


def with_sentinels(votes):
    padded = np.full((votes.shape[0], votes.shape[1] + 2), 99, np.uint32)
    padded[:, 1:-1] = votes
    return padded


def window(shape, row, column, rows, columns, wrap, rho_min, rho_step):
    """Return the set of cells within ±rows, ±columns of a cell, each cell looked at from both its sides."""
    height, width = shape
    step, least = Fraction(rho_step), Fraction(rho_min)
    opposite = math.floor((-(least + (column + Fraction(1, 2)) * step) - least) / step)
    cells = set()
    for other in range(height):
        for across in range(width):
            if abs(other - row) <= rows and abs(across - column) <= columns:
                cells.add((other, across))
            beyond = min(abs(other + height - row), abs(other - height - row)) <= rows
            if wrap and beyond and abs(across - opposite) <= columns:
                cells.add((other, across))
    return cells


def brute_force_maxima(votes, least, maxima, rows, columns, last, wrap, rho_min, rho_step):
    left = {cell: int(votes[cell]) for cell in np.ndindex(votes.shape)}
    found = []
    while len(found) < maxima:
        best = max(left.values())
        if best < max(least, 1):
            break
        equals = sorted(cell for cell, count in left.items() if count == best)
        row, column = equals[-1] if last else equals[0]
        found.append((row, column, best))
        for cell in window(votes.shape, row, column, rows, columns, wrap, rho_min, rho_step):
            left[cell] = 0
    return found, left


def grid_of(votes, rho_min, rho_step):
    nothing = np.empty(0)
    return GridArrays(nothing, nothing, votes.shape[1], rho_min, rho_step, (0.0, 0.0))


def clear(padded, row, column, rows, columns, wrap, rho_min, rho_step):
    rule = SequentialRule(np.uint32(1), 1, rows, columns, wrap, True)
    clear_window(padded, row, column, rule, grid_of(padded, rho_min, rho_step))


def run_maxima(votes, least, maxima, rows, columns, last, wrap, rho_min, rho_step):
    padded, nothing = with_sentinels(votes), np.empty(0)
    grid = grid_of(votes, rho_min, rho_step)
    ballot = Ballot(nothing, nothing, grid, padded, padded, None, np.empty(0, np.int32))
    rule = SequentialRule(np.uint32(least), maxima, rows, columns, wrap, last)
    cells, count = successive_maxima(ballot, rule, np.empty((1, 3), np.int64), 0)
    return [tuple(cell) for cell in cells[:count].tolist()], padded


@steady
@given(votes_tables, st.integers(1, 6))
def test_cells_at_the_threshold_are_all_of_them_in_order(votes, least):
    before = np.array([[-1, -2, -3]], np.int64)
    cells, count = at_threshold(with_sentinels(votes), np.uint32(least), before, 1)
    expected = [(row, column, votes[row, column]) for row, column in np.argwhere(votes >= least).tolist()]
    assert cells[:count].tolist() == [[-1, -2, -3], *map(list, expected)]


@steady
@given(votes_tables, st.booleans())
def test_the_maximum_is_the_first_or_the_last_of_equals(votes, last):
    row, column, best = maximum(with_sentinels(votes), last)
    equals = np.argwhere(votes == votes.max())
    assert [row, column - 1] == equals[-1 if last else 0].tolist()
    assert best == votes.max()


@steady
@given(st.data(), votes_tables, st.booleans(), rho_mins, rho_steps)
def test_clearing_touches_the_window_and_nothing_else(data, votes, wrap, rho_min, rho_step):
    votes += 1
    height, width = votes.shape
    row, column = data.draw(st.integers(0, height - 1)), data.draw(st.integers(0, width - 1))
    # Fewer rows than there are: beyond, every row is reached without crossing the seam.
    rows, columns = data.draw(st.integers(0, height - 1)), data.draw(st.integers(0, width + 2))
    padded = with_sentinels(votes)
    clear(padded, row, column + 1, rows, columns, wrap, rho_min, rho_step)
    expected = votes.copy()
    for cell in window(votes.shape, row, column, rows, columns, wrap, rho_min, rho_step):
        expected[cell] = 0
    np.testing.assert_array_equal(padded, with_sentinels(expected))


@steady
@given(
    st.data(), votes_tables, st.integers(0, 5), st.integers(1, 12), st.integers(0, 4),
    st.booleans(), st.booleans(), rho_mins, rho_steps,
)  # fmt: skip
def test_successive_maxima_are_those_of_a_loop_over_all_cells(
    data, votes, least, maxima, columns, last, wrap, rho_min, rho_step
):
    rows = data.draw(st.integers(0, len(votes) - 1))
    options = (least, maxima, rows, columns, last, wrap, rho_min, rho_step)
    found, padded = run_maxima(votes, *options)
    expected, left = brute_force_maxima(votes, *options)
    assert found == expected
    for (row, column), count in left.items():
        assert padded[row, column + 1] == count


def test_a_window_across_the_seam_clears_the_mirror_image():
    # Ten columns about 0: column 7 on one side of the seam is column 2 on the other.
    votes = np.ones((6, 10), np.uint32)
    padded = with_sentinels(votes)
    clear(padded, 0, 8, 1, 1, True, -5.0, 1.0)
    cleared = {(row, column) for row, column in np.argwhere(padded[:, 1:-1] == 0).tolist()}
    assert cleared == {(row, column) for row in (0, 1) for column in (6, 7, 8)} | {(5, 1), (5, 2), (5, 3)}


def test_a_window_that_stops_at_the_edges_leaves_the_other_side():
    votes = np.ones((6, 10), np.uint32)
    padded = with_sentinels(votes)
    clear(padded, 5, 1, 2, 3, False, -5.0, 1.0)
    cleared = {(row, column) for row, column in np.argwhere(padded[:, 1:-1] == 0).tolist()}
    assert cleared == {(row, column) for row in (3, 4, 5) for column in (0, 1, 2, 3)}


@pytest.mark.parametrize(("last", "expected"), [(True, [3, 2, 0]), (False, [0, 2, 3])])
def test_ties_decide_the_order_of_equal_cells(last, expected):
    votes = np.zeros((5, 6), np.uint32)
    votes[0, 2] = votes[3, 4] = votes[2, 0] = 7
    found, _ = run_maxima(votes, 1, 3, 0, 0, last, True, -3.0, 1.0)
    assert [row for row, _, _ in found] == expected


def test_maxima_end_where_no_votes_are_left():
    votes = np.zeros((3, 4), np.uint32)
    votes[1, 1] = 2
    assert run_maxima(votes, 0, 50, 0, 0, True, True, -2.0, 1.0)[0] == [(1, 1, 2)]
    assert run_maxima(np.zeros((3, 4), np.uint32), 0, 5, 0, 0, True, True, -2.0, 1.0)[0] == []
    assert run_maxima(votes, 3, 5, 0, 0, True, True, -2.0, 1.0)[0] == []


def test_more_maxima_than_there_is_room_for_are_all_kept():
    votes = np.arange(1, 41, dtype=np.uint32).reshape(4, 10)
    found, _ = run_maxima(votes, 1, 40, 0, 0, True, True, -5.0, 1.0)
    assert [count for _, _, count in found] == list(range(40, 0, -1))
