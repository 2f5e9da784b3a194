"""The extractions that look at the plots of a cell, beside loops in plain numpy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.hough.grid import Grid
from algorithms.hough.peaks.registry import EXTRACTIONS
from algorithms.hough.search import search
from algorithms.hough.voting import accumulate
from algorithms.hough.weighting import Weighting, accumulate_weighted

steady = settings(
    deadline=None, derandomize=True, max_examples=150, suppress_health_check=[HealthCheck.too_slow]
)

GRIDS = [Grid(12, 20, -10.0, 1.0, (0.3, -0.2)), Grid(7, 9, -6.3, 1.7), Grid(18, 40, -12.0, 0.6, (1.0, 2.0))]
WEIGHTINGS = [None, Weighting(True, 2.0, 1), Weighting(False, 2.0, 2)]

# Clusters, so that peaks lie beside one another, and few different places, so that cells are equal.
quarter = st.integers(-24, 24).map(lambda quarters: quarters / 4)
batches = st.lists(st.tuples(st.integers(0, 3), quarter, quarter), max_size=22).map(sorted)
thresholds = st.integers(1, 5)
windows = st.tuples(st.integers(0, 4), st.integers(0, 4))
tops = st.none() | st.integers(1, 4)


class Oracle:
    """An accumulator in plain numpy, worked out anew from the plots that are left."""

    def __init__(self, position, grid, weighting):
        self.grid, self.weighting = grid, weighting
        self.position = position
        self.theta = grid.theta
        self.columns = self.columns_of(position)

    def columns_of(self, position):
        """Return the column of each plot (across) in each row, by the order of operations of the kernels."""
        grid = self.grid
        x, y = (position[:, axis] - grid.origin[axis] for axis in (0, 1))
        along_x, along_y = np.cos(self.theta) / grid.rho_step, np.sin(self.theta) / grid.rho_step
        place = x * along_x[:, None] + y * along_y[:, None] + (1 - grid.rho_min / grid.rho_step)
        return np.floor(place).astype(int) - 1

    def values(self, kept=None):
        """Return votes, or weighted votes, of some plots."""
        position = self.position if kept is None else self.position[kept]
        if self.weighting is None:
            return accumulate(position, self.grid).votes.astype(float)
        return accumulate_weighted(position, self.grid, self.weighting).weighted

    def scatter(self, row, column, kept=None):
        """Return the sample variance of a cell."""
        voted = self.columns[row] == column
        if kept is not None:
            voted &= kept
        x, y = (self.position[voted, axis] - self.grid.origin[axis] for axis in (0, 1))
        rho = x * np.cos(self.theta[row]) + y * np.sin(self.theta[row])
        return rho.var(ddof=1) if len(rho) > 1 else np.inf

    def window(self, row, column, rows, columns, wrap, kept=None):
        """Return the set of cells within ±columns of the vote of the centroid of a cell's plots."""
        voted = self.columns[row] == column
        if kept is not None:
            voted &= kept
        centroid = self.position[voted].mean(axis=0)
        bins, cells = self.grid.theta_bins, set()
        centres = self.columns_of(centroid[None])[:, 0]
        for offset in range(-rows, rows + 1):
            if not wrap and not 0 <= row + offset < bins:
                continue
            other = (row + offset) % bins
            for found in range(centres[other] - columns, centres[other] + columns + 1):
                if 0 <= found < self.grid.rho_bins:
                    cells.add((other, found))
        return cells


def tied(values, oracle, cells, last, kept=None):
    """Return the cells from the greatest down, equals by their scatter, then by `last`."""

    def rank(cell):
        order = cell[0] * oracle.grid.rho_bins + cell[1]
        return -values[cell], oracle.scatter(*cell, kept), -order if last else order

    return sorted(cells, key=rank)


def best_first(oracle, threshold, rows, columns, last, wrap, maxima):
    values = oracle.values()
    cells = [tuple(map(int, cell)) for cell in np.argwhere(values >= threshold)]
    cleared, found = set(), []
    for cell in tied(values, oracle, cells, last):
        if cell in cleared or (maxima is not None and len(found) == maxima):
            continue
        found.append((*cell, values[cell]))
        cleared |= oracle.window(*cell, rows, columns, wrap)
    return found


def vote_removal(oracle, threshold, rows, columns, last, wrap, maxima):
    kept, found = np.ones(len(oracle.position), bool), []
    while maxima is None or len(found) < maxima:
        values = oracle.values(kept)
        if not values.size or values.max() < threshold:
            break
        equal = [tuple(map(int, cell)) for cell in np.argwhere(values == values.max())]
        row, column = tied(values, oracle, equal, last, kept)[0]
        found.append((row, column, values[row, column]))
        taken = oracle.window(row, column, rows, columns, wrap, kept)
        taken -= {cell for cell in taken if cell[0] == row}
        taken |= {(row, other) for other in range(column - columns, column + columns + 1)}
        for other, at in taken:
            if 0 <= at < oracle.grid.rho_bins:
                kept &= oracle.columns[other] != at
    return found


def thesis(oracle, threshold, rows, columns, last, maxima):
    values = oracle.values()
    left = [tuple(map(int, cell)) for cell in np.argwhere(values >= threshold)]
    found = []
    while left:
        first = left[0]
        group = [
            cell for cell in left if abs(cell[0] - first[0]) <= rows and abs(cell[1] - first[1]) <= columns
        ]
        left = [cell for cell in left if cell not in group]
        scatters = [oracle.scatter(*cell) for cell in group]
        equal = [cell for cell, scatter in zip(group, scatters, strict=True) if scatter == min(scatters)]
        best = equal[-1 if last else 0]
        found.append((*best, values[best]))
    if maxima is not None:
        by_value = sorted(range(len(found)), key=lambda k: (-found[k][2], -k if last else k))
        found = [found[k] for k in sorted(by_value[:maxima])]
    return found


def compare(found, expected, grid):
    rows = np.array([cell[0] for cell in expected], np.int64)
    columns = np.array([cell[1] for cell in expected], np.int64)
    theta, rho = grid.lines(rows, columns)
    np.testing.assert_array_equal(found.theta, theta)
    np.testing.assert_array_equal(found.rho, rho)
    np.testing.assert_allclose(found.score, [cell[2] for cell in expected], rtol=1e-12)


CASES = {"best-first": best_first, "vote-removal": vote_removal}


def peaks_of(name, votes, maxima=None, rows=0, columns=0, last=True, wrap=True):
    choices = {"votes": votes, "maxima": maxima, "rows": rows, "columns": columns, "last": last, "wrap": wrap}
    return EXTRACTIONS[name].of(choices)


@steady
@given(
    batches, st.sampled_from(GRIDS), st.sampled_from(WEIGHTINGS), thresholds, windows, tops,
    st.booleans(), st.booleans(), st.sampled_from(list(CASES)), st.integers(0, 2**32 - 1),
)  # fmt: skip
def test_peaks_are_those_of_a_loop_over_all_cells(
    chunk_of, trial, grid, weighting, threshold, window, maxima, last, wrap, extraction, seed
):
    # A little noise, so that no two cells scatter equally but for those of the same plots at the same places.
    noise = np.random.default_rng(seed).normal(0, 1e-3, (len(trial), 2))
    chunk = chunk_of([(scan, x + dx, y + dy) for (scan, x, y), (dx, dy) in zip(trial, noise, strict=True)])
    peaks = peaks_of(extraction, threshold, maxima, *window, last, wrap)
    found = search(chunk, grid, peaks, weighting)
    oracle = Oracle(chunk.position, grid, weighting)
    compare(found, CASES[extraction](oracle, threshold, *window, last, wrap, maxima), grid)


@steady
@given(
    batches, st.sampled_from(GRIDS), st.sampled_from(WEIGHTINGS), thresholds, windows, tops,
    st.booleans(), st.integers(0, 2**32 - 1),
)  # fmt: skip
def test_groups_are_those_of_the_thesis(
    chunk_of, trial, grid, weighting, threshold, window, maxima, last, seed
):
    noise = np.random.default_rng(seed).normal(0, 1e-3, (len(trial), 2))
    chunk = chunk_of([(scan, x + dx, y + dy) for (scan, x, y), (dx, dy) in zip(trial, noise, strict=True)])
    peaks = peaks_of("thesis", threshold, maxima, *window, last)
    found = search(chunk, grid, peaks, weighting)
    compare(found, thesis(Oracle(chunk.position, grid, weighting), threshold, *window, last, maxima), grid)


@steady
@given(batches, st.sampled_from(WEIGHTINGS), thresholds, st.integers(1, 6), st.booleans())
def test_the_greatest_of_the_cells_at_a_threshold(chunk_of, trial, weighting, threshold, maxima, last):
    grid = GRIDS[0]
    chunk = chunk_of(trial)
    found = search(chunk, grid, peaks_of("threshold", threshold, maxima, last=last), weighting)
    values = Oracle(chunk.position, grid, weighting).values()
    cells = [tuple(map(int, cell)) for cell in np.argwhere(values >= threshold)]
    order = sorted(range(len(cells)), key=lambda k: (-values[cells[k]], -k if last else k))
    compare(found, [(*cells[k], values[cells[k]]) for k in sorted(order[:maxima])], grid)


EVERY = [peaks_of(extraction, 2, None, 2, 2) for extraction in EXTRACTIONS]


@steady
@given(st.lists(batches, min_size=1, max_size=4), st.sampled_from(EVERY), st.sampled_from(WEIGHTINGS))
def test_a_trial_gives_the_same_in_a_chunk_as_alone(chunk_of, trials, peaks, weighting):
    found = search(chunk_of(*trials), GRIDS[0], peaks, weighting)
    assert len(found.counts) == len(found.votes_outside) == len(trials)
    for index, trial in enumerate(trials):
        alone = search(chunk_of(trial), GRIDS[0], peaks, weighting)
        tracks = slice(found.offsets[index], found.offsets[index + 1])
        for column in ("theta", "rho", "score"):
            np.testing.assert_array_equal(getattr(found, column)[tracks], getattr(alone, column))
        assert found.votes_outside[index] == alone.votes_outside[0]


@pytest.mark.parametrize("weighting", WEIGHTINGS)
@pytest.mark.parametrize("extraction", list(EXTRACTIONS))
def test_a_threshold_that_no_cell_reaches_gives_no_track(chunk_of, extraction, weighting):
    trial = [(scan, 0.5 + 0.25 * scan, 2.0) for scan in range(4)]
    found = search(chunk_of(trial, []), GRIDS[0], peaks_of(extraction, 5, None, 3, 3), weighting)
    assert found.counts.tolist() == [0, 0]
    assert search(chunk_of(), GRIDS[0], peaks_of(extraction, 1), weighting).counts.tolist() == []


@pytest.mark.parametrize("extraction", list(EXTRACTIONS))
def test_no_cell_above_the_floor_gives_no_track(chunk_of, extraction):
    trial = [(scan, 0.5 + 0.25 * scan, 2.0) for scan in range(4)]
    peaks = peaks_of(extraction, 1, None, 3, 3)
    assert search(chunk_of(trial), GRIDS[0], peaks, Weighting(True, 2.0, 4)).counts.tolist() == [0]
    assert search(chunk_of(trial), GRIDS[0], peaks, Weighting(True, 2.0, 3)).counts[0] > 0


def test_the_literal_end_of_the_thesis_would_have_hidden_the_second_line(chunk_of):
    # Two lines whose first groups have more than one candidate each; both are found.
    trial = [(scan, -3.0, 4.0 - scan) for scan in range(8)] + [(scan, 6.0 - scan, 3.0) for scan in range(8)]
    found = search(chunk_of(sorted(trial)), GRIDS[2], peaks_of("thesis", 6, None, 4, 2))
    assert {round(float(np.degrees(theta)) / 30) % 6 for theta in found.theta} >= {0, 3}


def test_windows_larger_than_the_accumulator_leave_one_maximum(chunk_of):
    trial = [(0, 1.0, 1.0), (1, 1.0, 2.0), (2, -3.0, 4.0)]
    for extraction in ("best-first", "thesis", "vote-removal"):
        peaks = peaks_of(extraction, 1, None, 10**12, 10**12)
        assert search(chunk_of(trial), GRIDS[0], peaks).counts.tolist() == [1]
