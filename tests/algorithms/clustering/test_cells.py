"""The cells of recorded values, against values that were put into cells of a known size."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from algorithms.clustering.cells import cell_of


@given(
    size=st.sampled_from([0.001, 0.015, 1.0 / 3.0, 0.5, 2.5, 15.3]),
    offset=st.floats(-1e3, 1e3),
    seed=st.integers(0, 2**16),
)
def test_the_cells_of_values_are_found(size, offset, seed):
    cells = np.random.default_rng(seed).choice(400, 60, replace=False)
    values = offset + size * (np.append(cells, [500, 501]) + 0.5)
    if np.all(values == np.rint(values)):
        return
    assert cell_of(values, 16.0 * size) == pytest.approx(size, rel=1e-6)


def test_differences_need_not_hold_a_single_cell():
    cells = np.array([0, 2, 5, 7, 10, 12, 15, 17, 20, 1000])
    assert cell_of(0.1 * cells + 0.05, 2.0) == pytest.approx(0.1)


def test_cells_are_found_in_values_that_a_file_rounds():
    cells = np.random.default_rng(3).choice(3000, 200, replace=False)
    cells = np.append(cells, [4000, 4001])
    assert cell_of(np.round((cells + 0.5) / 3.0, 3), 6.0) == pytest.approx(1.0 / 3.0, rel=1e-4)


@pytest.mark.parametrize(
    ("values", "most", "cell"),
    [
        (np.arange(0.0, 300.0, 15.0), 16.0, 1.0),  # whole numbers are numbers of cells
        (np.arange(20.0), 0.5, 0.0),  # of which no target can be a part
        (np.random.default_rng(1).normal(size=500), 1.0, 0.0),
        (np.array([0.5, 100.5, 300.5]), 1000.0, 0.0),  # too few to tell
        (np.full(50, 0.25), 1.0, 0.0),
        (np.zeros(0), 1.0, 1.0),
    ],
)
def test_values_in_cells_of_no_own_size(values, most, cell):
    assert cell_of(values, most) == cell
