"""`hough-tui batch` and `hough-tui results`: rates, files, and the runs that are kept."""

import csv
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from hough_tui.experiments.metrics.kinds import INITIATION
from hough_tui.experiments.metrics.registry import metrics_of
from hough_tui.experiments.stores.folder import FolderStore

PROJECT = Path(__file__).parents[3]

DOCUMENT = {"sets", "seed", "version", "rows"}
ROW = {
    "set", "scenario", "initiator", "swept", "trials", "success_rate", "success_rate_ci95",
    "success_by_target", "false_track_ratio", "false_tracks_per_trial", "duplicates_per_trial",
    "tracks_per_trial", "success_control", "trials_without_track", "false_track_ratio_ci95", "criterion",
    "theta_rmse_deg", "rho_rmse", "seconds_per_trial",
}  # fmt: skip
FURTHER = {"complete", "format"}
SETTINGS = {"experiment", "seed", "unit", "parameters", "target_names", "ignores_z", "gospa_cutoff"}
FIGURES = {key for metric in metrics_of(INITIATION) for key in (metric.key, metric.interval_key) if key}

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
initiators:
  - {name: standard, fraction: 0.95, grid: {theta_bins: 90, rho_min: -150, rho_step: 0.6, rho_bins: 1000}}
experiments:
  - name: swept
    sweep: {scans: [4, 5], "clutter[0].rate": [1e0, 2.5], initiator.grid.theta_bins: [90]}
    trials: 6
    seed: 3
    criterion: {rho: 3.0, theta_deg: 6}
  - {name: plain, trials: 5, seed: 4, criterion: {plots: 3}, control: false}
"""


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.yaml"
    path.write_text(SET)
    return path


def without_times(text: str) -> str:
    text, replaced = re.subn(r'"seconds_per_trial": [^,}\n]+', '"seconds_per_trial": 0', text)
    assert replaced
    return text


# The document


def test_the_document_has_the_fields_that_scripts_rely_on(cli):
    status, out, _ = cli("batch", "course-report", "--trials", 30, "--json")
    assert status == 0
    document = json.loads(out)
    assert document.keys() == DOCUMENT | FURTHER
    assert document["sets"] == ["course-report"]
    assert document["seed"] == 7
    assert document["version"]
    assert document["format"] == 2
    rows = document["rows"]
    assert len(rows) == 6 + 6 + 3
    for row in rows:
        assert row.keys() == ROW | SETTINGS | FIGURES
        assert (row["set"], row["trials"]) == ("course-report", 30)
        low, high = row["success_rate_ci95"]
        assert 0 <= low <= row["success_rate"] <= high <= 1
        assert len(row["success_by_target"]) == 2
        assert np.mean(row["success_by_target"]) == pytest.approx(row["success_rate"])
        low, high = row["false_track_ratio_ci95"]
        assert 0 <= low <= row["false_track_ratio"] <= high <= 1
        assert 0 <= row["success_control"] <= 1
        assert row["false_tracks_per_trial"] + row["duplicates_per_trial"] <= row["tracks_per_trial"]
        assert 0 <= row["trials_without_track"] <= 30
        assert row["seconds_per_trial"] > 0
    assert rows[0]["criterion"] == {"rho": 3.0, "theta_deg": None}
    assert rows[6]["criterion"] == {"rho": 3.0, "theta_deg": 6.0}
    assert rows[-1]["criterion"] == {"plots": 3}
    assert [row["swept"] for row in rows[:3]] == [{"scans": 5}, {"scans": 10}, {"scans": 15}]
    assert [row["initiator"] for row in rows[:6]] == ["standard"] * 3 + ["sequential"] * 3
    # 15 scans: clutter alone hardly reaches the threshold, and the targets do.
    assert rows[2]["success_rate"] > 0.9
    assert rows[2]["false_track_ratio"] < rows[0]["false_track_ratio"]


def test_the_number_of_workers_changes_no_byte(cli):
    given = ("batch", "course-report", "--trials", 300, "--json", "--no-keep")
    one, three = (cli(*given, "--workers", workers) for workers in (1, 3))
    assert one[0] == three[0] == 0
    assert without_times(one[1]) == without_times(three[1])


def test_trials_and_seed_are_those_given(cli, small):
    status, out, _ = cli("batch", small, "--json")
    assert status == 0
    told = json.loads(out)
    assert told["seed"] is None  # the experiments have several
    assert [(row["trials"], row["seed"]) for row in told["rows"]] == [(6, 3)] * 4 + [(5, 4)]
    changed = json.loads(cli("batch", small, "--json", "--trials", 9, "--seed", 2**64 - 1)[1])
    assert changed["seed"] == 2**64 - 1
    assert {(row["trials"], row["seed"]) for row in changed["rows"]} == {(9, 2**64 - 1)}
    again = json.loads(cli("batch", small, "--json", "--trials", 9, "--seed", 11)[1])
    assert [row["tracks_per_trial"] for row in again["rows"]] != [
        row["tracks_per_trial"] for row in changed["rows"]
    ]


def test_a_row_keeps_the_swept_key_as_it_was_written(cli, small):
    rows = json.loads(cli("batch", small, "--json")[1])["rows"]
    assert [row["swept"] for row in rows] == [
        {"scans": scans, "clutter[0].rate": rate, "initiator.grid.theta_bins": 90}
        for scans in (4, 5)
        for rate in (1.0, 2.5)
    ] + [{}]
    assert list(rows[0]["swept"]) == ["scans", "clutter[0].rate", "initiator.grid.theta_bins"]


def test_without_a_control_there_is_none(cli, small):
    row = json.loads(cli("batch", small, "--experiment", "plain", "--json")[1])["rows"][-1]
    assert row["experiment"] == "plain"
    assert row["success_control"] is None
    assert row["success_control_ci95"] is None


def test_chosen_experiments_run_alone(cli):
    out = cli("batch", "course-report", "--experiment", "modified", "--trials", 5, "--json")[1]
    assert {row["experiment"] for row in json.loads(out)["rows"]} == {"modified"}


def test_several_sets_are_one_document(cli, small):
    out = cli("batch", small, "course-text", "--trials", 4, "--json")[1]
    document = json.loads(out)
    assert document["sets"] == ["small", "course-text"]
    assert [row["set"] for row in document["rows"]] == ["small"] * 5 + ["course-text"] * 6


# Other forms


def test_the_csv_file_has_the_rows_of_the_document(cli, small, tmp_path):
    path = tmp_path / "rates.csv"
    status, out, _ = cli("batch", small, "--json", "--csv", path)
    assert status == 0
    rows = json.loads(out)["rows"]
    read = list(csv.DictReader(io.StringIO(path.read_text())))
    assert len(read) == len(rows)
    for line, row in zip(read, rows, strict=True):
        assert (line["set"], line["experiment"], line["initiator"]) == (
            "small",
            row["experiment"],
            "standard",
        )
        assert line["swept.clutter[0].rate"] == (str(row["swept"].get("clutter[0].rate", "")))
        for key in ("success_rate", "false_track_ratio", "tracks_per_trial", "seconds_per_trial"):
            assert float(line[key]) == row[key]
        assert [float(line["success_rate_ci95_low"]), float(line["success_rate_ci95_high"])] == row[
            "success_rate_ci95"
        ]
        assert float(line["success_by_target.0"]) == row["success_by_target"][0]
    assert path.read_bytes().count(b"\r") == 0


def test_csv_on_standard_output_is_all_there_is(cli, small, tmp_path):
    path = tmp_path / "rates.csv"
    status, out, _ = cli("batch", small, "--csv", "-")
    assert status == 0
    cli("batch", small, "--csv", path)
    printed, written = (list(csv.DictReader(io.StringIO(text))) for text in (out, path.read_text()))
    for row in (*printed, *written):
        del row["seconds_per_trial"]
    assert printed == written


def test_a_csv_file_that_cannot_be_written_costs_no_rates(cli, small, tmp_path):
    status, out, err = cli("batch", small, "--csv", tmp_path / "nowhere" / "rates.csv")
    assert status == 1
    assert "small · swept" in out
    assert "kept as" in err
    assert re.search(r"nowhere/\S*rates\.csv\S*: No such file or directory\n", err)
    assert "Traceback" not in err


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("form", [[], ["--json"], ["--plot"], ["--plot", "--metric", "false_track_ratio"]])
def test_standard_output_holds_neither_colour_nor_progress(cli, small, form, monkeypatch):
    status, out, err = cli("batch", small, *form)
    assert status == 0
    assert "\x1b" not in out + err
    assert "\r" not in out
    assert "trials/s" not in out
    assert "a second" not in out
    assert "a second" in err


def test_progress_goes_to_a_terminal_on_standard_error_alone(cli, small, monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    status, out, _ = cli("batch", small, "--json", "--trials", 4000)
    assert status == 0
    assert json.loads(out)["rows"]
    assert "trials" in terminal.getvalue()
    assert "\x1b" in terminal.getvalue()


def test_the_tables_tell_the_rates_of_the_document(cli, small, monkeypatch):
    monkeypatch.setenv("COLUMNS", "250")
    table = cli("batch", small)[1]
    rows = json.loads(cli("batch", small, "--json")[1])["rows"]
    lines = [line.split() for line in table.splitlines() if line.startswith("standard ")]
    assert len(lines) == len(rows)
    for line, row in zip(lines, rows, strict=True):
        assert f"{100 * row['success_rate']:.1f}" in line
    assert "Scenario one" in table


# Runs that are kept


def test_a_run_is_kept_and_found_again(cli, small, data_home):
    status, out, err = cli("batch", small, "--json")
    assert status == 0
    name = re.search(r"kept as (\S+)", err).group(1)
    (folder,) = (data_home / "hough-tui" / "runs").iterdir()
    assert folder.name == name
    status, listed, _ = cli("results", "list", "--json")
    assert status == 0
    assert json.loads(listed)["runs"] == [name]
    assert name in cli("results", "list")[1]
    status, shown, _ = cli("results", "show", name, "--json")
    assert status == 0
    assert shown == out
    assert cli("results", "show", name[-4:], "--json")[1] == out
    assert "small · swept" in cli("results", "show", name)[1]
    assert "\x1b" not in cli("results", "show", name, "--plot")[1]
    columns = FolderStore().load(name).columns
    for row, held in zip(json.loads(out)["rows"], columns, strict=True):
        assert held["found"].shape == (row["trials"], 1)
        assert held["tracks"].mean() == row["tracks_per_trial"]


def test_the_newest_run_is_listed_first(cli, small, monkeypatch):
    first = re.search(r"kept as (\S+)", cli("batch", small)[2]).group(1)
    began = time.time()
    while int(time.time()) == int(began):  # names tell whole seconds
        time.sleep(0.02)
    second = re.search(r"kept as (\S+)", cli("batch", small)[2]).group(1)
    assert json.loads(cli("results", "list", "--json")[1])["runs"] == [second, first]


def test_no_keep_keeps_nothing(cli, small, data_home):
    status, _, err = cli("batch", small, "--no-keep")
    assert status == 0
    assert "kept" not in err
    assert not data_home.exists()
    status, out, err = cli("results", "list")
    assert (status, out) == (0, "")
    assert err.startswith("hough-tui: no run has been kept yet")
    assert json.loads(cli("results", "list", "--json")[1])["runs"] == []


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_a_data_folder_that_is_a_file_costs_no_rates(cli, small, data_home, form):
    data_home.write_text("not a folder")
    status, out, err = cli("batch", small, *form)
    assert status == 1
    assert json.loads(out)["complete"] if form else "small · swept" in out
    assert "hough-tui: the run could not be kept: " in err
    assert str(data_home) in err
    assert "Not a directory" in err
    assert "Traceback" not in err
    assert data_home.read_text() == "not a folder"


def test_a_full_disk_costs_no_rates(cli, small, data_home, monkeypatch):
    def full(*args, **kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez_compressed", full)
    status, out, err = cli("batch", small, "--json")
    assert status == 1
    assert len(json.loads(out)["rows"]) == 5
    assert "could not be kept" in err
    assert "No space left on device" in err
    assert list((data_home / "hough-tui" / "runs").iterdir()) == []


# Processes

# The command, with a thread that writes a file as soon as trials are done.
WATCHED = """
import pathlib, signal, threading, time
from hough_tui.cli import main
from hough_tui.experiments.engines import threads as engine

class Watched(engine.Job):
    def __init__(self, *given):
        super().__init__(*given)
        def watch():
            while not self.progress.done.any():
                time.sleep(0.01)
            pathlib.Path(SIGN).touch()
        threading.Thread(target=watch, daemon=True).start()

engine.Job = Watched
# A shell that runs the tests in the background has its children ignore interrupts.
signal.signal(signal.SIGINT, signal.default_int_handler)
main()
"""


def test_an_interrupt_ends_a_batch_and_keeps_the_finished_trials(data_home, tmp_path):
    sign = tmp_path / "begun"
    program = WATCHED.replace("SIGN", repr(str(sign)))
    command = [sys.executable, "-c", program, "batch", "course-report", "--trials", "2000000"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=PROJECT, env=os.environ
    ) as process:
        try:
            deadline = time.monotonic() + 120
            while not sign.exists():
                assert process.poll() is None, process.stderr.read()
                assert time.monotonic() < deadline
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == 130, err
    assert out == ""
    lines = [line for line in err.splitlines() if "compiling" not in line]
    assert lines[-1] == "hough-tui: interrupted"
    assert len(lines) == 2
    name = re.fullmatch(r"hough-tui: kept as (\S+) \(the finished trials only\)", lines[0]).group(1)
    run = FolderStore(data_home / "hough-tui" / "runs").load(name)
    assert run.document["complete"] is False
    done = [row["trials"] for row in run.document["rows"]]
    assert done
    assert all(0 < trials < 2_000_000 for trials in done)
    assert [len(columns["tracks"]) for columns in run.columns] == done
