"""States of tracks, judged in experiments: where they are, what the columns hold, what GOSPA is made of."""

import numpy as np
import pytest

from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from scenarios.files.set_files import parse_set

SET = """
schema: 1
name: judged
scenarios:
  - name: one
    scans: 8
    interval: 4
    region: {{x: [0, 60], y: [0, 60]}}
    sensor: {{sigma: 0.1}}
    clutter: [{{rate: 2}}]
    targets:
      - {{position: [10, 10], velocity: [0.3, 0.2]}}
      - {{position: [50, 10], velocity: [-0.3, 0.2], birth: 2}}
initiators:
  - {{name: standard, votes: 5}}
  - {{name: modified, speed_min: 0.2, speed_max: 0.5, angle_tolerance_deg: 20}}
experiments:
  - {{name: runs, trials: 250, seed: 4, criterion: {criterion}, control: false{further}}}
"""
BY_PLOTS, BY_LINE = "{plots: 5}", "{rho: 1.0, theta_deg: 5}"


def rows_of(criterion, further=""):
    job = Job(plan_run([parse_set(SET.format(criterion=criterion, further=further), "judged.yaml")]), 2)
    assert job.wait()
    return {row["initiator"]: row for row in job.rows()}, job


@pytest.fixture(scope="module")
def judged():
    return rows_of("{plots: 3}")


def test_states_of_pure_tracks_are_consistent():
    three = SET.replace("scans: 8", "scans: 3").replace(", birth: 2", "").replace("rate: 2", "rate: 0")
    text = three.format(criterion="{plots: 3}", further="")
    job = Job(plan_run([parse_set(text, "three.yaml")], trials=1000), 2)
    assert job.wait()
    row = job.rows()[1]
    low, high = row["nees_ci95"]
    assert low <= 4 <= high
    # σ on each axis, of a fit over three plots of 4 s apart: √(5/6) σ at the first of them, √(1/32) σ/s.
    assert row["position_rmse"] == pytest.approx(0.1 * np.sqrt(2 * 5 / 6), rel=0.08)
    assert row["velocity_rmse"] == pytest.approx(0.1 * np.sqrt(2 / 32), rel=0.08)
    assert row["position_rmse_ci95"][0] < row["position_rmse"] < row["position_rmse_ci95"][1]


def test_gospa_is_the_root_of_the_squares_of_its_parts(judged):
    for row in judged[0].values():
        parts = [row[f"gospa_{part}"] for part in ("localisation", "missed", "false")]
        assert row["gospa"] == pytest.approx(np.sqrt(np.sum(np.square(parts))), rel=1e-6)
        # Ten times the noise; each missed target and each false track counts half of its square.
        assert row["gospa_cutoff"] == pytest.approx(1.0)


def test_the_cutoff_belongs_to_the_experiment(judged):
    wider, _ = rows_of("{plots: 3}", ", gospa_cutoff: 40")
    for name, row in wider.items():
        assert row["gospa_cutoff"] == 40.0
        assert row["gospa_false"] > judged[0][name]["gospa_false"]
        assert row["nees"] == judged[0][name]["nees"]


def test_latency_is_that_of_whole_batches_and_of_windows(judged):
    row = judged[0]["standard"]
    # Both targets are confirmed with the last of 8 scans; the second comes with the third.
    assert row["scans_to_initiate_p90"] == 8.0
    assert 6.0 < row["scans_to_initiate"] < 8.0
    assert judged[0]["modified"]["scans_to_initiate"] <= row["scans_to_initiate"]


def test_lines_alone_give_states_where_they_are_asked_for():
    keys = ("position_rmse", "velocity_rmse", "cross_track_rmse", "nees", "gospa", "gospa_cutoff")
    (alone, _), (asked, _) = rows_of(BY_LINE), rows_of(BY_LINE, ", kinematics: always")
    never, _ = rows_of("{plots: 3}", ", kinematics: never")
    for name in alone:
        assert {alone[name][key] for key in keys} == {never[name][key] for key in keys} == {None}
        assert all(asked[name][key] is not None for key in keys)
        assert asked[name]["success_rate"] == alone[name]["success_rate"]
        assert asked[name]["scans_to_initiate"] == alone[name]["scans_to_initiate"]
