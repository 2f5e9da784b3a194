"""The question that a scenario asks of a quantisation, and the trials that answer it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from algorithms.context import Box, Unit
from algorithms.quantisation.advisor import centred_grid
from algorithms.quantisation.prediction import predict
from hough_tui.quantisation.confirmation import run_trials
from hough_tui.quantisation.designs import (
    Demands,
    Sensing,
    moving_targets,
    question_of,
    sensing_design,
    taken_for,
)
from scenarios.model import Scenario

BASE = {
    "name": "one",
    "scans": 12,
    "interval": 4,
    "region": {"x": [0, 100], "y": [0, 60]},
    "sensor": {"sigma": [0.1, 0.2], "detection_probability": 0.9},
    "targets": [
        {"position": [10, 10], "velocity": [0, 0]},
        {"position": [20, 30], "velocity": [0.3, 0.1], "birth": 2, "death": 9},
        {"position": [20, 30], "velocity": [0.3, 0.1], "birth": 12},
        {"position": [80, 40], "velocity": [-0.4, 0]},
    ],
}


def scenario(**changed):
    return Scenario.model_validate({**BASE, **changed})


def test_each_moving_target_has_a_line_of_its_own():
    lines = moving_targets(scenario())
    assert list(lines) == [1, 3]
    assert (lines[1].scans, lines[3].scans) == (8, 12)
    assert lines[1].extent == pytest.approx(7 * 4 * math.hypot(0.3, 0.1))
    assert lines[3].middle == pytest.approx((80 - 0.4 * 4 * 11 / 2, 40))
    # Along x only the noise on y lies across the line.
    assert lines[3].sigma == pytest.approx(0.2)


def test_the_line_of_a_turn_is_that_fitted_to_it():
    turn = {"position": [20, 30], "velocity": [0.3, 0.0], "motion": {"kind": "turn", "rate_deg": -30 / 44}}
    turning = scenario(targets=[turn])
    line = moving_targets(turning)[0]
    # An arc of 30° to the left, whose fitted line is parallel to its chord.
    assert math.degrees(line.theta) == pytest.approx(90 + 15)
    half, radius = math.radians(15), 0.3 / math.radians(30 / 44)
    assert line.extent == pytest.approx(2 * radius * math.sin(half), rel=0.01)
    words = taken_for(turning)["motion"]
    assert words.startswith("straight, along the line fitted to each path; paths depart from it by up to")
    sagitta = radius * (1 - math.cos(half))
    assert 0.5 * sagitta < float(words.split()[-2]) < sagitta
    disturbed = scenario(targets=[{**turn, "motion": {"process_noise": 0.1}}])
    assert taken_for(disturbed)["motion"].endswith("by their process noise")


def test_all_clutter_is_in_the_question():
    region = {"x": [50, 100], "y": [0, 60]}
    question = question_of(
        scenario(clutter=[{"rate": 5}, {"kind": "exact", "count": 3, "region": region}]), Demands(kappa=2.0)
    )
    assert [source.plots for source in question.clutter.sources] == [60, 36]
    assert question.clutter.sources[1].region == Box((50.0, 0.0), (100.0, 60.0))
    assert not question.clutter.is_exact
    assert question.kappa == 2.0
    assert question.region == Box((0.0, 0.0), (100.0, 60.0))
    fixed = question_of(scenario(clutter=[{"kind": "exact", "count": 99, "per": "batch"}]))
    assert fixed.clutter.fixed_number == 99


def test_trials_of_targets_that_begin_anywhere_in_a_spread_give_what_is_predicted():
    targets = [{"position": [40, 30], "velocity": [0.3, 0.18], "spread": [9, 4]}]
    given = scenario(targets=targets, clutter=[{"kind": "exact", "count": 200, "per": "batch"}])
    question = question_of(given)
    grid, votes, trials = centred_grid(question, 90, 0.6), 8, 1500
    told = predict(question, grid, votes)
    found = run_trials([given], grid, trials, 3, 60)
    error = math.sqrt(told.p_detection * (1 - told.p_detection) / trials)
    assert 0.5 < told.p_detection < 0.98
    assert found.rate(votes) == pytest.approx(told.p_detection, abs=4 * error + 0.01)
    cells = found.false_cells(votes)
    assert cells.mean() == pytest.approx(told.false_cells, abs=4 * cells.std() / math.sqrt(trials))
    # Every cell is counted in every trial, one more column than the grid has.
    assert (found.cells.sum(axis=1) == 90 * (grid.rho_bins + 1)).all()


def test_a_target_of_known_speed_may_be_anywhere():
    sensing = Sensing(0.1, 9, 4.0, 0.9, 20.0, Box((0.0, 0.0), (60.0, 90.0)), 0.3, Unit.KILOMETRE)
    design = sensing_design(sensing, Demands(), 1, {})
    places = np.array([next(iter(moving_targets(given).values())).middle for given in design.scenarios])
    assert (places >= 0).all()
    assert (places <= (60, 90)).all()
    assert places.std(axis=0) == pytest.approx([60 / math.sqrt(12), 90 / math.sqrt(12)], rel=0.3)
    for given in design.scenarios:
        assert math.hypot(*given.targets[0].velocity) == pytest.approx(0.3)
    assert design.question.lines[0].extent == pytest.approx(0.3 * 4 * 8)
    assert [line.middle for line in design.question.lines] == [None]
