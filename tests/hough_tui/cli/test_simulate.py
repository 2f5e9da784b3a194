"""`hough-tui simulate`: the trials of the batch, one by one, as CSV."""

import csv
import io
import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from scenarios.files.set_files import load_set
from scenarios.recordings.csv_plots import parse_plots
from scenarios.simulate import draw
from scenarios.world import World

PROJECT = Path(__file__).parents[3]
CROSSING = ("simulate", "course-report", "--scenario", "two-crossing")


def same_bits(one, other) -> bool:
    return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()


def assert_is_drawn(text, scenario, seed, trial):
    """Check that a CSV text holds the plots of a trial bit for bit, with the target of each."""
    found = parse_plots(text, "plots.csv")
    drawn = draw(World.of(scenario), seed, trial)
    plots = drawn.chunk.trial(0)
    assert same_bits(found.plots.scan, plots.scan)
    assert same_bits(found.plots.time, plots.time)
    assert same_bits(found.plots.position, plots.position)
    assert found.extra["target"] == tuple("" if cause < 0 else str(cause) for cause in drawn.origin)


@pytest.mark.parametrize("trial", [0, 1, 255, 256, 2**32 - 1])
def test_a_trial_is_that_of_the_scenario_and_the_seed_of_its_experiments(cli, trial):
    status, out, err = cli(*CROSSING, "--trial", trial)
    assert (status, err) == (0, "")
    assert_is_drawn(out, load_set("course-report").scenario("two-crossing"), 7, trial)


def test_trial_0_is_the_default(cli):
    assert cli(*CROSSING)[1] == cli(*CROSSING, "--trial", 0)[1] != cli(*CROSSING, "--trial", 1)[1]


@pytest.mark.parametrize("seed", [0, 8, 2**64 - 1])
def test_another_seed(cli, seed):
    status, out, _ = cli(*CROSSING, "--trial", 2, "--seed", seed)
    assert status == 0
    assert_is_drawn(out, load_set("course-report").scenario("two-crossing"), seed, 2)


def test_a_trial_is_the_one_that_the_batch_scored(cli):
    plan = plan_run([load_set("course-report")], experiments=["tables"], trials=40)
    job = Job(plan, 2)
    assert job.wait()
    index = next(k for k, cell in enumerate(plan.cells) if cell.swept == {"scans": 15})
    cell, columns = plan.cells[index], job.columns[index]
    assert cell.entry.name == "standard"
    assert len(set(columns.tracks.tolist())) > 1
    for trial in (0, 17, 39):
        recording = parse_plots(cli(*CROSSING, "--trial", trial)[1], "plots.csv")
        tracks = cell.entry.algorithm.initiate(recording.plots, cell.scenario.context, cell.parameters)
        assert len(tracks) == columns.tracks[trial]


def test_fewer_scans_are_the_first_part_of_more(cli):
    every = cli(*CROSSING, "--trial", 4)[1].splitlines()
    first = cli(*CROSSING, "--trial", 4, "--set", "scans=5")[1].splitlines()
    assert len(first) < len(every)
    assert first == every[: len(first)]
    assert [line.split(",")[0] for line in every].count("5") > 0
    assert {line.split(",")[0] for line in first[1:]} == set("01234")


def test_changed_fields_are_those_of_the_draw(cli):
    given = ("--set", "clutter.0.rate=2", "--set", "sensor.sigma=0", "--set", "scenario.interval=1")
    out = cli(*CROSSING, *given)[1]
    rows = list(csv.DictReader(io.StringIO(out)))
    assert sum(row["target"] == "" for row in rows) < 90
    own = [row for row in rows if row["target"] == "1"]
    assert [float(row["time"]) for row in own] == list(range(15))
    for row in own:
        # Without noise the plot is the truth.
        assert (row["x"], row["y"]) == (row["true_x"], row["true_y"])
        np.testing.assert_allclose(float(row["x"]), 20 + 0.3 * float(row["time"]), rtol=1e-12)


def test_a_set_with_one_scenario_needs_no_name(cli):
    status, out, _ = cli("simulate", "course-text")
    assert status == 0
    assert_is_drawn(out, load_set("course-text").scenarios[0], 7, 0)


def test_the_output_file_has_what_standard_output_has(cli, tmp_path):
    path = tmp_path / "plots.csv"
    printed = cli(*CROSSING, "--trial", 6)[1]
    status, out, err = cli(*CROSSING, "--trial", 6, "--output", path)
    assert (status, out, err) == (0, "", "")
    assert path.read_bytes() == printed.encode()
    assert list(tmp_path.iterdir()) == [path]


def test_an_output_file_is_replaced_as_a_whole(cli, tmp_path):
    path, link = tmp_path / "plots.csv", tmp_path / "link.csv"
    path.write_text("old\n")
    path.chmod(0o640)
    link.symlink_to(path)
    with path.open() as reader:
        assert cli(*CROSSING, "-o", link)[0] == 0
        # Who had opened the old file still reads it, all of it.
        assert reader.read() == "old\n"
    assert link.is_symlink()
    assert path.read_text() == cli(*CROSSING)[1]
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_write_that_fails_leaves_the_old_file(cli, tmp_path, monkeypatch):
    path = tmp_path / "plots.csv"
    path.write_text("old\n")

    def full(*args, **kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("scenarios.files.atomic.os.fsync", full)
    status, out, err = cli(*CROSSING, "--output", path)
    assert (status, out) == (1, "")
    assert "No space left on device" in err
    assert path.read_text() == "old\n"
    assert list(tmp_path.iterdir()) == [path]


def test_an_output_in_no_folder_is_one_line_and_no_traceback(cli, tmp_path):
    status, out, err = cli(*CROSSING, "--output", tmp_path / "nowhere" / "plots.csv")
    assert (status, out) == (1, "")
    assert err.startswith("hough-tui: ")
    assert err.count("\n") == 1
    assert "nowhere" in err


@pytest.mark.parametrize(
    ("rate", "status"), [(50, {0, 1}), (3000, {1})], ids=["a little", "more than a pipe holds"]
)
def test_a_reader_that_stops_early_sees_no_traceback(rate, status):
    command = [sys.executable, "-c", "from hough_tui.cli import main; main()", *CROSSING]
    # Without buffers a write that the reader cuts short is no error to Python.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    with subprocess.Popen(
        [*command, "--set", f"rate={rate}"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=PROJECT,
        env=environment,
    ) as process:
        assert process.stdout.readline() == b"scan,time,x,y,target,true_x,true_y\n"
        process.stdout.close()
        err = process.stderr.read().decode()
    assert [line for line in err.splitlines() if "compiling" not in line] == []
    assert process.returncode in status
