"""`hough-tui results compare` and `results export`: runs side by side, and runs as files."""

import csv
import io
import json
import re

import pytest

SET = """\
schema: 1
name: small
scenarios:
  - name: one
    scans: 4
    interval: 4
    region: {x: [0, 100], y: [0, 100]}
    sensor: {sigma: 0.1}
    clutter: [{rate: 5}]
    targets: [{position: [40, 20], velocity: [0.3, 0.18]}]
initiators: [{name: standard}]
experiments:
  - {name: swept, sweep: {sensor.detection_probability: [1, 0.2]}, trials: 60, seed: 3, criterion: {plots: 3}}
"""


@pytest.fixture
def kept(cli, tmp_path):
    """Return the names of two runs, the second with cells too small for the noise, and a row more."""
    path, names = tmp_path / "small.yaml", []
    for text in (
        SET,
        SET.replace("[1, 0.2]", "[1, 0.2, 0.5]").replace(
            "name: standard", "name: standard, fraction: 1.0, grid: {rho_step: 0.01}"
        ),
    ):
        path.write_text(text)
        names.append(re.search(r"kept as (\S+)", cli("batch", path)[2]).group(1))
    return names


def test_runs_are_compared_row_by_row(cli, kept, monkeypatch):
    status, out, _ = cli("results", "compare", *kept, "--json")
    assert status == 0
    document = json.loads(out)
    assert document.keys() == {
        "format", "version", "runs", "seeds", "metric", "rows", "rows_in_one_run_only", "same_criteria"
    }  # fmt: skip
    assert (document["runs"], document["seeds"]) == (kept, [3, 3])
    assert (document["metric"], document["rows_in_one_run_only"]) == ("success_rate", 1)
    assert document["same_criteria"] is True
    assert [row["swept"] for row in document["rows"]] == [
        {"sensor.detection_probability": value} for value in (1.0, 0.2)
    ]
    for row in document["rows"]:
        assert (row["set"], row["experiment"], row["scenario"], row["initiator"]) == (
            "small", "swept", "one", "standard",
        )  # fmt: skip
        first, second = row["values"]
        base, found = row["differences"]
        low, high = found["ci95"]
        assert base is None
        assert found["value"] == pytest.approx(second - first)
        assert low <= found["value"] <= high
        assert found["beyond_chance"] is (low > 0 or high < 0)
    # Even a target that is always detected has no cell for all of its votes there.
    assert document["rows"][0]["differences"][1]["beyond_chance"]
    monkeypatch.setenv("COLUMNS", "200")
    status, table, _ = cli("results", "compare", *kept)
    assert status == 0
    assert "B − A" in table
    assert "differs" in table
    assert f"A: {kept[0]}, seed 3" in table
    other = json.loads(cli("results", "compare", *kept, "--metric", "false_track_ratio", "--json")[1])
    assert other["metric"] == "false_track_ratio"
    assert other["rows"][0]["values"] != document["rows"][0]["values"]
    counts = json.loads(cli("results", "compare", *kept, "--metric", "false_tracks_per_trial", "--json")[1])
    first, second = counts["rows"][0]["values"]
    low, high = counts["rows"][0]["differences"][1]["ci95"]
    assert low <= second - first <= high


def test_runs_of_clusterings_are_compared_by_their_exact_counts(cli):
    names = []
    for seed in (1, 2):
        run = ("batch", "range-doppler", "--experiment", "scenes", "--trials", 20, "--seed", seed)
        names.append(re.search(r"kept as (\S+)", cli(*run)[2]).group(1))
    document = json.loads(cli("results", "compare", *names, "--json")[1])
    assert document["metric"] == "count_exact_rate"
    assert {row["clustering"] for row in document["rows"]} >= {"recommended", "corrected-patent"}
    assert all(row["differences"][1] is not None for row in document["rows"])


def test_a_run_is_exported_by_the_ending_of_the_file(cli, kept, tmp_path):
    name = kept[0]
    document = cli("results", "show", name, "--json")[1]
    written = {ending: tmp_path / f"run{ending}" for ending in (".csv", ".json", ".md")}
    for path in written.values():
        path.write_text("before")
        status, out, err = cli("results", "export", name, path)
        assert (status, out) == (0, "")
        assert f"2 rows written to {path}" in err
    assert written[".json"].read_text() == document
    rows = list(csv.DictReader(io.StringIO(written[".csv"].read_text())))
    assert [float(row["success_rate"]) for row in rows] == [
        row["success_rate"] for row in json.loads(document)["rows"]
    ]
    assert written[".md"].read_text().startswith("### small · swept")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("compare", "A"), "there is one run only"),
        (("compare", "A", "A"), "is given twice"),
        (("compare", "A", "B", "--metric", "sucess_rate"), "did you mean 'success_rate'"),
        (("compare", "A", "B", "--metric", "seconds_per_trial"), "seconds_per_trial has no interval"),
        (("show", "A", "--columns", "success_rate,nothing"), "--columns: there is no metric 'nothing'"),
        (("show", "A", "--columns", ","), "no metric is named"),
        (("show", "A", "--metric", "success_by_target"), "there is no metric 'success_by_target'"),
        (("compare", "A", "nowhere"), "there is no run 'nowhere'"),
        (("compare", "small", "A"), "fits 2 runs"),
        (("export", "A", "run.txt"), "run.txt: the name must end in one of .csv, .json, .md"),
        (("export", "A", "no/folder/run.csv"), "there is no folder no/folder"),
        (("export", "nowhere", "run.csv"), "there is no run 'nowhere'"),
    ],
)
def test_what_cannot_be_done_is_said(cli, kept, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    names = {"A": kept[0], "B": kept[1]}
    status, out, err = cli("results", *(names.get(argument, argument) for argument in arguments))
    assert (status, out) == (2, "")
    assert said in err
    assert "Traceback" not in err
