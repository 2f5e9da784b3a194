import numpy as np
import pytest

from algorithms.intervals import wilson
from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.rows import row_of
from scenarios.files.set_files import load_set


@pytest.fixture
def cell():
    return plan_run([load_set("course-report")], trials=4).cells[0]


def test_rates_by_hand(cell):
    columns = TrialColumns.empty(4, targets=2, control=2)
    columns.found[:] = [[1, 1], [1, 0], [0, 0], [1, 1]]
    columns.tracks[:] = [4, 2, 0, 5]
    columns.false[:] = [1, 1, 0, 0]
    columns.duplicates[:] = [1, 0, 0, 3]
    columns.theta_error[:] = np.radians([[1, -1], [2, np.nan], [np.nan, np.nan], [0, 0]])
    columns.rho_error[:] = [[0.3, -0.3], [0.6, np.nan], [np.nan, np.nan], [0, 0]]
    columns.votes_outside[:] = [0, 8, 0, 0]
    columns.control_found[0, 0] = True
    row = row_of(cell, columns, seconds=0.008)
    assert row["success_rate"] == pytest.approx(5 / 8)
    assert row["success_by_target"] == pytest.approx([0.75, 0.5])
    assert row["target_names"] == ["rising", "falling"]
    assert row["success_control"] == pytest.approx(1 / 8)
    assert row["false_track_ratio"] == pytest.approx((0.25 + 0.5 + 0 + 0) / 4)
    assert row["false_tracks_per_trial"] == pytest.approx(0.5)
    assert row["duplicates_per_trial"] == pytest.approx(1.0)
    assert row["tracks_per_trial"] == pytest.approx(11 / 4)
    assert row["trials_without_track"] == 1
    assert row["theta_rmse_deg"] == pytest.approx(np.sqrt((1 + 1 + 4) / 5))
    assert row["rho_rmse"] == pytest.approx(np.sqrt((0.09 + 0.09 + 0.36) / 5))
    assert row["votes_outside_per_trial"] == 2.0
    assert row["seconds_per_trial"] == pytest.approx(0.002)
    low, high = row["success_rate_ci95"]
    assert 0 <= low < 5 / 8 < high <= 1


def test_one_target_gives_the_interval_of_wilson(cell):
    columns = TrialColumns.empty(50, targets=1)
    columns.found[:31] = True
    row = row_of(cell, columns, seconds=1.0)
    assert row["success_rate_ci95"] == pytest.approx(wilson(31 / 50, 50))
    assert row["success_control"] is None


def test_targets_that_are_found_together_widen_the_interval(cell):
    apart, together = (TrialColumns.empty(400, targets=2) for _ in range(2))
    apart.found[:200, 0] = True
    apart.found[100:300, 1] = True
    together.found[:200] = True
    widths = [np.ptp(row_of(cell, columns, 1.0)["success_rate_ci95"]) for columns in (apart, together)]
    assert widths[1] == pytest.approx(widths[0] * np.sqrt(2), rel=0.02)


def test_without_targets_there_is_no_success_rate(cell):
    row = row_of(cell, TrialColumns.empty(3), 1.0)
    assert row["success_rate"] is None
    assert row["success_rate_ci95"] is None
    assert row["success_by_target"] == []
    assert row["theta_rmse_deg"] is None
