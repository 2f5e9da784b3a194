"""Experiments of clustering: rows by hand, the same figures for any number of workers, runs that are kept."""

import copy
import csv
import io
import json

import numpy as np
import pytest

from algorithms.clustering.modes import cluster
from algorithms.errors import RequestError
from algorithms.intervals import wilson
from hough_tui.experiments.columns.clustering import ClusterColumns
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.metrics.registry import leading_metric
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from hough_tui.experiments.rows import row_of
from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.reports.charts import rate_chart
from hough_tui.reports.documents import csv_text, markdown_text
from hough_tui.reports.rates import rate_sheets
from hough_tui.reports.series import rate_series
from scenarios.files.set_files import load_set, parse_set
from scenarios.range_doppler import draw_scene

SWEPT = """
schema: 1
name: swept
scenes:
  - name: pair
    region: {range: [0, 120], doppler: [0, 90]}
    noise: 3
    targets: [{range: 30, doppler: 45}, {range: 75, doppler: 45}]
clusterings:
  - {name: recommended, range_extent: 16, doppler_extent: 12}
  - {name: k-means, range_extent: 16, doppler_extent: 12, number: auto}
experiments:
  - {name: stray, kind: clustering, trials: 450, seed: 5, sweep: {scene.interference: [0, 40]}}
"""


@pytest.fixture(scope="module")
def plan():
    return plan_run([parse_set(SWEPT, "swept.yaml")])


@pytest.fixture(scope="module")
def job(plan):
    job = Job(plan, 2)
    assert job.wait()
    return job


def cell_of(targets=2):
    text = SWEPT if targets else SWEPT.replace("[{range: 30, doppler: 45}, {range: 75, doppler: 45}]", "[]")
    return plan_run([parse_set(text.replace("number: auto", "number: 2"), "swept.yaml")]).cells[0]


def test_cells_are_scene_by_scene_and_share_their_draws(plan):
    told = [(cell.scene.interference, cell.entry.name, cell.swept) for cell in plan.cells]
    assert told == [
        (0, "recommended", {"scene.interference": 0}),
        (40, "recommended", {"scene.interference": 40}),
        (0, "k-means", {"scene.interference": 0}),
        (40, "k-means", {"scene.interference": 40}),
    ]
    assert [[tuple(run.cells) for run in shared.runs] for shared in plan.draws] == [
        [(0,), (2,)],
        [(1,), (3,)],
    ]


def test_rows_by_hand():
    cell, columns = cell_of(), ClusterColumns.empty(5, targets=2)
    columns.excess[:] = [0, 0, 1, -1, -2]
    columns.squared_error[:] = [[1, 3], [0, 0], [4, 4], [9, 7], [np.nan, np.nan]]
    row = row_of(cell, columns, seconds=0.01)
    assert (row["set"], row["experiment"], row["scene"], row["clustering"]) == (
        *("swept", "stray"),
        *("pair", "recommended"),
    )
    assert row["count_exact_rate"] == pytest.approx(0.4)
    assert row["count_exact_rate_ci95"] == pytest.approx(list(wilson(0.4, 5)))
    assert (row["too_few_rate"], row["too_many_rate"]) == (0.4, 0.2)
    assert row["excess_per_trial"] == pytest.approx(-0.4)
    assert row["clusters_per_trial"] == pytest.approx(1.6)
    # Mean squares of the trials: 2, 0, 4, 8.
    assert row["centroid_rmse"] == pytest.approx(np.sqrt(3.5))
    half = 1.959963984540054 * np.std([2, 0, 4, 8], ddof=1) / 2.0
    assert row["centroid_rmse_ci95"] == pytest.approx([np.sqrt(3.5 - half), np.sqrt(3.5 + half)])
    assert (row["trials"], row["trials_without_plot"]) == (5, 1)
    assert row["seconds_per_trial"] == pytest.approx(0.002)


def test_without_targets_there_is_no_error():
    columns = ClusterColumns.empty(3)
    columns.excess[:] = [0, 2, 0]
    row = row_of(cell_of(0), columns, seconds=1.0)
    assert (row["centroid_rmse"], row["centroid_rmse_ci95"]) == (None, None)
    assert row["trials_without_plot"] == 2
    assert row["count_exact_rate"] == pytest.approx(2 / 3)


def test_the_number_of_workers_changes_no_byte(plan, job):
    one = Job(plan, 1)
    assert one.wait()
    for ours, theirs in zip(one.columns, job.columns, strict=True):
        for name, values in ours.arrays().items():
            np.testing.assert_array_equal(values, theirs.arrays()[name], err_msg=name)
    rows = [copy.deepcopy(found.rows()) for found in (one, job)]
    for row in (*rows[0], *rows[1]):
        del row["seconds_per_trial"]
    assert json.dumps(rows[0]) == json.dumps(rows[1])


def test_a_trial_can_be_found_again_alone(plan, job):
    for trial in (0, 201, 449):
        for index, cell in enumerate(plan.cells):
            drawn = draw_scene(cell.scene, cell.experiment.seed, trial)
            found = cluster(drawn.points, cell.parameters)
            assert len(found) - 2 == job.columns[index].excess[trial]


def test_a_run_is_kept_and_comes_back(job, tmp_path):
    store, run = FolderStore(tmp_path), result(job)
    loaded = store.load(store.add(run))
    assert loaded.document["rows"] == json.loads(json.dumps(run.document["rows"]))
    assert loaded.sets == run.sets
    for ours, theirs in zip(run.columns, loaded.columns, strict=True):
        for name, values in ours.items():
            np.testing.assert_array_equal(values, theirs[name])


def test_rows_become_tables_charts_and_files(job):
    rows = job.rows()
    (sheet,) = rate_sheets(rows)
    assert [column.name for column in sheet.columns[:3]] == ["clustering", "interference", "exact %"]
    assert "Scene pair." in sheet.notes[0]
    assert sheet.notes[1] == "450 trials a row, seed 5."
    assert "| recommended |" in markdown_text(rows).replace("  ", "")
    table = list(csv.DictReader(io.StringIO(csv_text(rows))))
    assert [row["swept.scene.interference"] for row in table] == ["0", "40", "0", "40"]
    assert float(table[1]["count_exact_rate_ci95_low"]) == rows[1]["count_exact_rate_ci95"][0]
    metric = leading_metric(rows).key
    series = rate_series(rows, metric)
    assert (series.swept, [one.label for one in series.series]) == (
        "interference",
        ["recommended", "k-means"],
    )
    assert series.series[0].x == (0.0, 40.0)
    assert "exact counts" in rate_chart(rows, metric, 80, 20, False)


def test_rows_of_both_kinds_stand_in_one_table(job):
    tracks = Job(plan_run([load_set("course-report")], experiments=["modified"], trials=3), 1)
    assert tracks.wait()
    rows = [{**row, "set": "", "experiment": ""} for row in (*tracks.rows(), *job.rows())]
    (sheet,) = rate_sheets(rows)
    told = [(column.name, column.called) for column in sheet.columns]
    assert len(set(told)) == len(told)
    assert {"initiator", "clustering", "success %", "exact %"} <= {name for name, _ in told}
    assert {len(column.cells) for column in sheet.columns} == {len(rows)}


def test_k_means_that_cannot_find_so_many_says_in_which_trial():
    text = SWEPT.replace("number: auto", "number: 60").replace("[0, 40]", "[0]")
    job = Job(plan_run([parse_set(text, "swept.yaml")], trials=20), 1)
    with pytest.raises(RequestError, match=r"k-means on pair, trial \d+: k-means is to find 60 targets"):
        job.wait()
