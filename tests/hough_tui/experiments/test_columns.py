"""Columns by their schema: parts come together in any order, old files are read, damaged ones are refused."""

import numpy as np
import pytest

from algorithms.errors import RequestError
from hough_tui.experiments.columns.initiation import TrialColumns

RANDOM = np.random.default_rng(5)


def part(first, trials, targets=2, **effort):
    found = RANDOM.random((trials, targets)) < 0.7
    return TrialColumns.of(
        first,
        trials,
        found=found,
        tracks=RANDOM.integers(0, 9, trials),
        false=RANDOM.integers(0, 9, trials),
        duplicates=RANDOM.integers(0, 9, trials),
        theta_error=np.where(found, RANDOM.normal(size=found.shape), np.nan),
        rho_error=np.where(found, RANDOM.normal(size=found.shape), np.nan),
        votes_outside=RANDOM.integers(0, 9, trials),
        mixed=np.zeros(trials),
        effort={name: np.full(trials, value) for name, value in effort.items()},
    )


def same(ours, theirs):
    for name, values in theirs.arrays().items():
        np.testing.assert_array_equal(ours.arrays()[name], values, err_msg=name)
        assert ours.arrays()[name].dtype == values.dtype
    assert ours.arrays().keys() == theirs.arrays().keys()


def test_parts_come_together_in_any_order():
    parts = [part(first, 3, pairs=first) for first in (0, 3, 6)]
    whole = TrialColumns.empty(9, targets=2)
    for index in (2, 0, 1):
        whole.put(parts[index])
    for one in parts:
        rows = slice(int(one.trial[0]), int(one.trial[0]) + 3)
        same(whole.select(rows), one)


def test_empty_columns_hold_the_declared_fill_and_size():
    columns = TrialColumns.empty(4, targets=3, control=3)
    assert columns.trial.tolist() == [0, 1, 2, 3]
    assert np.isnan(columns.theta_error).all()
    assert (columns.mixed == -1).all()
    assert sum(values.nbytes for values in columns.arrays().values()) + 4 * 8 == 4 * (
        TrialColumns.bytes_a_trial(targets=3, control=3)
    )


def test_files_of_earlier_versions_are_read():
    ours = part(0, 5, pairs=7)
    arrays = ours.arrays()
    for name in ("mixed", "trial", "nees", "gospa_missed", "scans_to_initiate"):
        del arrays[name]
    arrays["control_found"] = np.zeros((0, 2), np.bool_)
    columns = TrialColumns.read(arrays, 5)
    assert (columns.mixed == -1).all()
    assert (columns.scans_to_initiate == -1).all()
    assert columns.nees.shape == (5, 2)
    assert np.isnan(columns.nees).all()
    assert columns.trial.tolist() == [0, 1, 2, 3, 4]
    assert columns.control_found.shape == (5, 0)
    np.testing.assert_array_equal(columns.effort["pairs"], ours.effort["pairs"])
    same(TrialColumns.read(ours.arrays(), 5), ours)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda arrays: arrays.pop("found"), "without the columns found"),
        (lambda arrays: arrays.update(tracks=np.zeros(4, np.int32)), "column tracks is of shape"),
    ],
)
def test_files_that_lack_or_shorten_columns_are_refused(change, words):
    arrays = part(0, 5).arrays()
    change(arrays)
    with pytest.raises(RequestError, match=words):
        TrialColumns.read(arrays, 5)
