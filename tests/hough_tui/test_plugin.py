"""A package that adds an initiator: listed, declared, validated, and run in worker processes."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]

MODULE = '''
"""Straight ways from a plot of the first scan to one of the last, in plain Python."""

import numpy as np

from hough_tui import plugin


class EndsParameters(plugin.Parameters):
    """The parameters of `ends`."""

    fastest: plugin.Positive = plugin.parameter(
        0.7, dimension=plugin.Dimension.SPEED, help="the greatest speed of a way"
    )
    least: plugin.Count = plugin.parameter(
        3, dimension=plugin.Dimension.COUNT, help="the least plots on a way"
    )
    near: plugin.Positive = plugin.parameter(
        0.5, dimension=plugin.Dimension.LENGTH, help="how far from a way its plots may be"
    )


class Ends(plugin.Initiator):
    """Every way with enough plots on it is a track."""

    name = "ends"
    summary = "straight ways from the first scan to the last"
    parameters = EndsParameters

    def initiate(self, plots, context, parameters):
        found, states = [], []
        scans = np.unique(plots.scan)
        if len(scans) > 1:
            for i in np.flatnonzero(plots.scan == scans[0]):
                for j in np.flatnonzero(plots.scan == scans[-1]):
                    velocity = (plots.position[j] - plots.position[i]) / (plots.time[j] - plots.time[i])
                    if not 0 < np.hypot(*velocity) <= parameters.fastest:
                        continue
                    way = plots.position[i] + np.outer(plots.time - plots.time[i], velocity)
                    off = np.hypot(*(plots.position - way).T)
                    nearest = [np.flatnonzero(plots.scan == scan) for scan in scans]
                    nearest = np.array([rows[np.argmin(off[rows])] for rows in nearest])
                    rows = nearest[off[nearest] <= parameters.near]
                    if len(rows) >= parameters.least:
                        found.append(rows)
                        states.append((*plots.position[i], *velocity))
        state = np.array(states, dtype=float).reshape(-1, 4)
        place, velocity = state[:, :2], state[:, 2:]
        theta, rho = plugin.line_through(place, velocity)
        score = np.array([float(len(rows)) for rows in found])
        states = plugin.fitted_states(plots, found, context)
        confirmed = np.full(len(found), context.scans - 1)
        return plugin.Tracks(theta, rho, score, tuple(found), states, confirmed)
'''

SET = """\
schema: 1
name: plain
scenarios:
  - name: one
    scans: 5
    interval: 4
    region: {x: [0, 100], y: [0, 100]}
    sensor: {sigma: 0.1, detection_probability: 0.8}
    clutter: [{rate: 3}]
    targets: [{position: [40, 20], velocity: [0.3, 0.18]}]
initiators:
  - {name: ends, near: 0.6}
  - {name: standard, votes: 4, grid: {theta_bins: 90, rho_min: -150, rho_step: 0.6, rho_bins: 1000}}
experiments:
  - name: basic
    initiators: [ends]
    sweep: {least: [3, 4]}
    trials: 700
    seed: 5
    criterion: {plots: 3}
  - {name: beside, trials: 20, seed: 5, criterion: {plots: 3}}
"""


@pytest.fixture
def hough_tui(data_home, tmp_path):
    """Run hough-tui in a process that finds the package; return it finished."""
    site = tmp_path / "site"
    (site / "ends-1.0.dist-info").mkdir(parents=True)
    (site / "ends.py").write_text(MODULE)
    (site / "ends-1.0.dist-info" / "METADATA").write_text("Metadata-Version: 2.1\nName: ends\nVersion: 1.0\n")
    (site / "ends-1.0.dist-info" / "entry_points.txt").write_text(
        "[hough_tui.initiators]\nends = ends:Ends\n"
    )
    (tmp_path / "plain.yaml").write_text(SET)

    def run(*arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run(
            [sys.executable, "-c", "from hough_tui.cli import main; main()", *arguments],
            capture_output=True,
            text=True,
            timeout=120,
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": os.pathsep.join([str(site), str(PROJECT)])},
        )

    return run


def test_a_plug_in_is_listed_with_its_parameters_and_refuses_what_they_do_not_allow(hough_tui, tmp_path):
    listed = hough_tui("initiators", "--json")
    assert listed.returncode == 0, listed.stderr
    told = {found["name"]: found for found in json.loads(listed.stdout)["initiators"]}
    assert {"standard", "sequential", "modified"} < told.keys()
    assert told["ends"]["summary"] == "straight ways from the first scan to the last"
    assert {found["name"]: (found["default"], found["help"]) for found in told["ends"]["parameters"]} == {
        "fastest": (0.7, "the greatest speed of a way"),
        "least": (3, "the least plots on a way"),
        "near": (0.5, "how far from a way its plots may be"),
    }
    text = SET.replace("{name: ends, near: 0.6}", "{name: ends, naer: 0.6, least: 0}")
    (tmp_path / "wrong.yaml").write_text(text)
    checked = hough_tui("validate", "plain.yaml", "wrong.yaml")
    assert checked.returncode == 2
    assert checked.stdout.startswith("plain.yaml: valid")
    lines = checked.stderr.removeprefix("hough-tui: ").splitlines()
    assert sorted(line.split(": ")[0] for line in lines) == ["wrong.yaml:12:18", "wrong.yaml:12:36"]
    assert "did you mean 'near'" in checked.stderr
    assert "0 is given; it must be at least 1" in checked.stderr


def test_a_plug_in_gives_the_same_rates_for_any_number_of_workers(hough_tui):
    documents = []
    for workers in ("1", "2"):
        done = hough_tui("batch", "plain.yaml", "--workers", workers, "--json", "--no-keep")
        assert done.returncode == 0, done.stderr
        document = json.loads(done.stdout)
        for row in document["rows"]:
            del row["seconds_per_trial"]
        documents.append(document)
    one, two = documents
    assert one == two
    strict, loose, beside, standard = one["rows"][1], one["rows"][0], one["rows"][2], one["rows"][3]
    assert [row["initiator"] for row in one["rows"]] == ["ends", "ends", "ends", "standard"]
    assert [row["swept"] for row in one["rows"]] == [{"least": 3}, {"least": 4}, {}, {}]
    assert beside["parameters"] == {"fastest": 0.7, "least": 3, "near": 0.6}
    # Ends and one more of three: 0.8² × (1 − 0.2³); ends and two more: 0.8² × (0.8³ + 3 × 0.8² × 0.2).
    assert loose["success_rate"] == pytest.approx(0.635, abs=0.06)
    assert strict["success_rate"] == pytest.approx(0.573, abs=0.06)
    assert strict["success_rate"] < loose["success_rate"]
    assert loose["success_control"] == 0
    assert standard["tracks_per_trial"] > 0


def test_a_plug_in_runs_on_recorded_plots(hough_tui, tmp_path):
    (tmp_path / "plots.csv").write_text(
        "scan,x,y\n"
        + "".join(f"{scan},{scan},{0.5 * scan}\n{scan},{90 - 7 * scan},50\n" for scan in range(5))
    )
    given = ("--initiator", "ends", "--interval", "4", "--set", "least=5", "--json")
    done = hough_tui("initiate", "plots.csv", *given)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert [track["plots"] for track in found["tracks"]] == [[0, 2, 4, 6, 8]]
    assert found["tracks"][0]["velocity"] == pytest.approx([0.25, 0.125])
    assert "accumulator" not in found


def test_a_plug_in_that_cannot_be_loaded_is_a_warning(hough_tui, tmp_path):
    module = tmp_path / "site" / "ends.py"
    module.write_text("import nothing_of_this_name\n")
    reason = (
        "plug-in 'ends' (ends:Ends, ends 1.0) cannot be loaded: ModuleNotFoundError: "
        f"No module named 'nothing_of_this_name' ({module}:1); mend or remove it"
    )
    done = hough_tui("initiators", "--json")
    assert done.returncode == 0
    listed = {each["name"]: each for each in json.loads(done.stdout)["initiators"]}
    assert listed["ends"] == {
        "name": "ends", "summary": "", "source": "", "parameters": [], "error": reason,
    }  # fmt: skip
    assert listed["standard"]["error"] is None
    assert done.stderr == f"hough-tui: {reason}; everything else works without it\n"
    checked = hough_tui("validate", "course-report", "plain.yaml")
    assert checked.returncode == 2
    assert checked.stdout.startswith("course-report: valid")
    assert (
        f"plain.yaml:12:5: initiators[0]: the initiator 'ends' could not be loaded: {reason}"
        in checked.stderr
    )
    assert "Traceback" not in done.stderr + checked.stderr


def failing(tmp_path, line):
    """Have the plug-in run a line in trials of 17 plots; return where the line stands."""
    module = tmp_path / "site" / "ends.py"
    begin = "        found, states = [], []\n"
    text = MODULE.replace(begin, f"        if len(plots) == 17:\n            {line}\n{begin}")
    module.write_text(text)
    return f"{module}:{text[: text.index(line)].count(chr(10)) + 1}"


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("plots.speed", "AttributeError: 'Plots' object has no attribute 'speed' ({place})"),
        ("import os; os._exit(3)", "initiator ends: its worker process died"),
    ],
)
def test_a_plug_in_that_fails_is_named_with_trial_and_line(hough_tui, tmp_path, line, words):
    place = failing(tmp_path, line)
    done = hough_tui("batch", "plain.yaml", "--experiment", "basic", "--trials", "60", "--no-keep")
    assert done.returncode == 1
    assert done.stdout == ""
    (message,) = [text for text in done.stderr.splitlines() if words.format(place=place) in text]
    assert re.match(r"hough-tui: set plain, scenario one( \(the control\))?, seed 5, trials? \d+", message)
    assert message.endswith("; mend the plug-in")
    assert "Traceback" not in done.stderr
