"""Differences of rates, and runs side by side."""

import copy

import numpy as np
import pytest

from algorithms.intervals import mean_interval, wilson
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.metrics.registry import METRICS
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from hough_tui.experiments.stores.folder import Run
from hough_tui.reports.comparison import comparable, compare, comparison_sheet, difference
from hough_tui.reports.documents import sheet_markdown
from scenarios.files.set_files import load_set


@pytest.fixture(scope="module")
def run():
    job = Job(plan_run([load_set("course-report")], experiments=["modified"], trials=400), 2)
    assert job.wait()
    return result(job)


def compared(runs, key="success_rate"):
    return comparison_sheet(compare(runs, METRICS[key]))


def column(sheet, heading):
    (found,) = [column for column in sheet.columns if column.name == heading]
    return [cell.strip() for cell in found.cells]


@pytest.mark.parametrize(
    ("first", "second", "low", "high"),
    [
        # Newcombe 1998, table II, method 10.
        ((48, 80), (56, 70), 0.0524, 0.3339),
        ((3, 10), (9, 10), 0.1705, 0.8090),
        ((0, 10), (10, 10), 0.6075, 1.0),
    ],
)
def test_the_interval_of_a_difference_is_newcombes(first, second, low, high):
    rates = [count / of for count, of in (first, second)]
    ends = [wilson(rate, of) for rate, (_, of) in zip(rates, (first, second), strict=True)]
    found = difference(rates[0], ends[0], rates[1], ends[1])
    assert found.value == pytest.approx(rates[1] - rates[0])
    assert (found.low, found.high) == pytest.approx((low, high), abs=6e-5)
    assert found.is_beyond_chance


@pytest.mark.parametrize("shared", [0.0, 0.7])
def test_intervals_hold_the_true_difference_as_often_as_they_say(shared):
    random = np.random.default_rng(1)
    hits = 0
    for _ in range(600):
        common = random.random((200, 2)) < shared
        chance = random.random(200)
        values = np.where(common, chance[:, None], random.random((200, 2))) < np.array([0.6, 0.7])
        first, second = values[:, 0], values[:, 1]
        related = float(np.corrcoef(first, second)[0, 1]) if shared else 0.0
        found = difference(first.mean(), mean_interval(first), second.mean(), mean_interval(second), related)
        hits += found.low <= 0.1 <= found.high
    assert 0.92 <= hits / 600 <= 0.98


def test_a_run_does_not_differ_from_itself(run):
    metrics = comparable(run.document["rows"])
    assert {"success_rate", "false_tracks_per_trial", "theta_rmse_deg"} <= {one.key for one in metrics}
    for metric in metrics:
        sheet = compared([("one", run), ("two", run)], metric.key)
        (values,) = (one for one in sheet.columns if one.name.startswith("B − A") and one.cells)
        assert {float(cell) for cell in values.cells} == {0.0}
        assert column(sheet, "beyond chance") == [""] * 3
        assert any("0 of 3 differences" in note for note in sheet.notes)


def test_a_metric_that_the_rows_have_not_is_said_to_be_missing(run):
    sheet = compared([("one", run), ("two", run)], "count_exact_rate")
    assert column(sheet, "B − A points") == ["–"] * 3
    assert any("Nothing here has a figure of exact counts" in note for note in sheet.notes)


def test_pairs_of_the_same_draws_are_told_apart_better(run):
    worse = copy.deepcopy(run)
    rows, columns = worse.document["rows"], []
    for row, found in zip(rows, run.columns, strict=True):
        changed = found["found"].copy()
        changed[:30] = False
        per_trial = changed.mean(axis=1)
        row["success_rate"] = float(per_trial.mean())
        row["success_rate_ci95"] = list(mean_interval(per_trial))
        columns.append({**found, "found": changed})
    worse = Run(worse.sets, worse.document, tuple(columns))
    paired = compared([("one", run), ("two", worse)])
    assert column(paired, "beyond chance") == ["differs"] * 3
    others = copy.deepcopy(worse.document)
    for row in others["rows"]:
        row["seed"] = 8
    apart = compared([("one", run), ("two", Run(worse.sets, others, worse.columns))])
    assert width(column(apart, "95 % interval")[0]) > 1.5 * width(column(paired, "95 % interval")[0])


def width(text):
    low, high = (float(end) for end in text.split(" to "))
    return high - low


def test_rows_that_stand_in_one_run_only_are_left_out_and_counted(run):
    fewer = Run(run.sets, {**run.document, "rows": run.document["rows"][:1]}, run.columns[:1])
    sheet = compared([("one", run), ("two", fewer), ("three", run)])
    assert column(sheet, "B − A points") == ["0.0", "–", "–"]
    assert column(sheet, "C − A points") == ["0.0"] * 3
    sheet = compared([("one", fewer), ("two", run)])
    assert len(column(sheet, "initiator")) == 1
    assert any(note.startswith("2 rows stand in one run only") for note in sheet.notes)
    assert sheet_markdown(sheet)


def test_runs_with_nothing_in_common_say_so(run):
    rows = [{**row, "experiment": "another"} for row in run.document["rows"]]
    sheet = compared([("one", run), ("two", Run(run.sets, {**run.document, "rows": rows}, run.columns))])
    assert not sheet.columns
    assert any("No row stands in more than one" in note for note in sheet.notes)


def test_other_criteria_are_pointed_out(run):
    rows = [{**row, "criterion": {"plots": 2}} for row in run.document["rows"]]
    sheet = compared([("one", run), ("two", Run(run.sets, {**run.document, "rows": rows}, run.columns))])
    assert any("same criterion" in note for note in sheet.notes)
