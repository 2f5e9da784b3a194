"""Metrics as objects: one that is declared here alone is shown, written and offered everywhere."""

import csv
import io
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.metrics.estimators import MeanCount
from hough_tui.experiments.metrics.kinds import INITIATION, KINDS
from hough_tui.experiments.metrics.metric import Metric, Sample
from hough_tui.experiments.metrics.registry import METRICS
from hough_tui.experiments.plan import plan_run
from hough_tui.reports.documents import sheet_markdown
from hough_tui.reports.metric_columns import column_keys, measured, metric_columns
from hough_tui.reports.metric_listing import metric_sheet
from scenarios.files.set_files import load_set

MISSED = Metric(
    key="missed_per_trial",
    kind=INITIATION,
    words="missed targets a trial",
    definition="Number of targets that no track matches.",
    values=lambda sample: (~sample.columns.found).sum(axis=1),
    estimator=MeanCount(),
    heading="missed\n/trial",
    rank=5,
    interval_rank=5,
)


@pytest.fixture
def declared(monkeypatch):
    monkeypatch.setitem(METRICS, MISSED.key, MISSED)
    return MISSED


RUN = ("batch", "course-report", "--experiment", "tables", "--trials", "20")


def test_a_metric_of_one_object_is_everywhere(cli, declared, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    status, out, err = cli(*RUN, "--json", "--csv", tmp_path / "rows.csv")
    assert status == 0
    rows = json.loads(out)["rows"]
    for row in rows:
        assert row["missed_per_trial"] == pytest.approx(2 * (1 - row["success_rate"]))
        low, high = row["missed_per_trial_ci95"]
        assert low <= row["missed_per_trial"] <= high
    table = list(csv.DictReader(io.StringIO((tmp_path / "rows.csv").read_text())))
    assert [float(row["missed_per_trial"]) for row in table] == [row["missed_per_trial"] for row in rows]
    assert "missed_per_trial_ci95_low" in table[0]
    name = re.search(r"kept as (\S+)", err).group(1)
    assert cli("results", "export", name, tmp_path / "rows.md")[0] == 0
    assert "| missed /trial |" in (tmp_path / "rows.md").read_text()
    shown = cli("results", "show", name, "--plot", "--metric", declared.key)[1]
    assert "missed" in shown
    assert "missed targets a trial, bars: 95 % interval" in shown
    chosen = cli("results", "show", name, "--columns", "missed_per_trial_ci95,missed_per_trial")[1]
    assert "success" not in chosen.splitlines()[1]
    assert declared.key in cli("metrics")[1]
    assert declared in measured(rows)
    other = re.search(r"kept as (\S+)", cli(*RUN, "--seed", "8")[2]).group(1)
    compared = json.loads(cli("results", "compare", name, other, "--metric", declared.key, "--json")[1])
    assert compared["rows"][0]["differences"][1] is not None


def test_a_metric_is_what_a_published_table_compares(declared):
    from hough_tui.published.comparison import TABLES, compare, plan_table

    table = TABLES["course-2-1"]
    entry = replace(table.entries[0], metric=declared.key, published=0.0)
    table = replace(table, entries=(entry,))
    job = Job(plan_table(table, 20), 1)
    assert job.wait()
    (row,) = compare(table, job)["rows"]
    assert (row["metric"], row["measured"], row["consistent"]) == (declared.key, 0.0, True)


def test_tables_are_asked_for_any_metric_in_any_order():
    job = Job(plan_run([load_set("course-report")], experiments=["modified"], trials=5), 1)
    assert job.wait()
    rows = job.rows()
    keys = [key for key in column_keys() if key.removesuffix("_ci95") in rows[0]]
    wanted = keys[::-1]
    columns = metric_columns(rows, wanted)
    assert [key for key in dict.fromkeys(column.key for column in columns)] == wanted
    default = {column.key for column in metric_columns(rows)}
    assert default < set(keys)
    for cell, columns, seconds in job.finished():
        sample = Sample(cell, columns, seconds)
        for metric in METRICS.values():
            if metric.kind is INITIATION:
                assert len(metric.per_trial(sample)) in (0, 5)


def test_metrics_have_definitions_and_keys_of_their_own():
    for key, metric in METRICS.items():
        assert metric.key == key
        assert metric.definition.endswith(".")
        assert metric.words
    for kind in KINDS:
        assert METRICS[kind.leading].kind is kind
        assert METRICS[kind.leading].rank == 0


def test_the_page_of_metrics_lists_them_as_they_are():
    page = Path(__file__).parents[4] / "docs" / "metrics.md"
    table = sheet_markdown(replace(metric_sheet(), title="", notes=()))
    assert table in page.read_text(encoding="utf-8")
