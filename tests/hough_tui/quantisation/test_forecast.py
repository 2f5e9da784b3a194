"""Forecasts: the same figures as the prediction gives, for what the set holds."""

import math

import numpy as np
import pytest

from algorithms.errors import RequestError
from algorithms.hough.grid import BYTES_PER_CELL
from algorithms.hough.weighting import BYTES_PER_CELL as WEIGHTED_BYTES
from algorithms.parameters import replaced
from algorithms.quantisation.prediction import predict
from hough_tui.quantisation.designs import question_of
from hough_tui.quantisation.forecast import forecast, recommendation, recommended
from hough_tui.quantisation.vote_cost import VoteCost, known_cost, vote_cost
from scenarios.files.set_files import load_set
from scenarios.simulate import draw
from scenarios.sweeps import place
from scenarios.world import World


@pytest.fixture(scope="module")
def course():
    return load_set("course-report")


def test_the_outlook_is_what_is_predicted_for_the_resolved_entry(course):
    scenario, entry = course.scenarios[0], course.initiators[0]
    told = forecast(entry, scenario)
    resolved = entry.parameters.resolved(scenario.context)
    grid = resolved.grid.grid(scenario.context)
    direct = predict(question_of(scenario), grid, resolved.votes)
    assert (told.outlook.grid, told.outlook.votes) == (grid, resolved.votes)
    assert told.outlook.p_detection == direct.p_detection
    assert told.outlook.false_cells == direct.false_cells
    assert told.outlook.share == direct.share
    assert told.outlook.size == grid.theta_bins * grid.rho_bins * BYTES_PER_CELL
    assert not told.is_weighted


def test_votes_are_counted_as_they_are_cast(course):
    scenario, entry = course.scenarios[0], course.initiators[0]
    told = forecast(entry, scenario).outlook
    plots = [len(draw(World.of(scenario), 1, trial).chunk.scan) for trial in range(60)]
    # The number of plots has a standard deviation of its own.
    tolerance = 5.0 * np.std(plots) / math.sqrt(len(plots)) + 1e-9
    assert abs(np.mean(plots) - told.votes_cast / told.grid.theta_bins) < tolerance


def test_what_is_recommended_keeps_the_bound(course):
    scenario = course.scenarios[0]
    few, many = (recommended(recommendation(scenario, bound), False) for bound in (0.1, 10.0))
    assert few.false_cells <= 0.1 < many.false_cells <= 10.0
    assert few.p_detection < many.p_detection


def test_of_weighted_votes_the_plain_ones_are_predicted():
    given = load_set("thesis-five-targets")
    scenario, entry = given.scenarios[0], given.entry("weighted-20")
    told = forecast(entry, scenario)
    resolved = entry.parameters.resolved(scenario.context)
    assert told.is_weighted
    assert told.outlook.votes == resolved.least_votes + 1
    assert told.outlook.size == math.prod(told.outlook.grid.shape) * WEIGHTED_BYTES
    assert "more plain votes than T1" in told.notes[0]


def test_what_is_taken_for_something_simpler_is_said(course):
    given = load_set("par-table-2")
    entry = course.initiators[0]
    assert forecast(entry, course.scenarios[0]).notes == ()
    assert any(
        "Assumed clutter: uniform over the region" in note
        for note in forecast(entry, given.scenarios[0]).notes
    )


def test_a_picture_tells_the_spread_of_its_row(course):
    scenario, entry = course.scenarios[0], course.initiators[0]
    told = forecast(entry, scenario)
    line = question_of(scenario).lines[0]
    shown = told.pictures[0]
    row = math.radians(shown.theta)
    assert shown.spread == pytest.approx(0.5 * line.extent * math.sin(abs(row - line.theta)))
    assert shown.away == pytest.approx(math.degrees(abs(row - line.theta)))
    assert shown.most_spread == pytest.approx(
        0.5 * line.extent * math.sin(0.5 * told.outlook.grid.theta_step)
    )
    assert shown.least < shown.mean < shown.most
    # The density integrates to the shares, bin by bin.
    for column, share in shown.shares.items():
        begin = shown.first + column * shown.step
        if begin >= shown.low and begin + shown.step <= shown.high:
            rho = np.linspace(begin, begin + shown.step, 4001)
            whole = np.trapezoid(shown.curve[:, 1], shown.curve[:, 0])
            part = np.trapezoid(np.interp(rho, *shown.curve.T), rho)
            assert part / whole == pytest.approx(share, abs=2e-4)


def test_what_cannot_be_predicted_is_said(course):
    scenario, entry = course.scenarios[0], course.initiators[0]
    with pytest.raises(RequestError, match="no target that moves"):
        forecast(entry, scenario.model_copy(update={"targets": []}))
    with pytest.raises(RequestError, match="a threshold of 1,000,000 votes"):
        forecast(replaced(entry, {("votes",): 1_000_000}), scenario)
    still = replaced(scenario, {place("sigma", scenario, [])[1]: 0.0})
    assert "Without noise" in forecast(entry, still).notes[0]
    with pytest.raises(RequestError, match="the noise is 0"):
        recommendation(still, 1.0)


def test_a_line_outside_the_columns_has_no_home_cell(course):
    scenario, entry = course.scenarios[0], course.initiators[0]
    shown = forecast(replaced(entry, {("grid", "rho_bins"): 3}), scenario).pictures[0]
    assert shown.home == -1
    assert shown.shares == {}


def test_what_votes_cost_is_measured_once():
    plain, weighted = vote_cost(False), vote_cost(True)
    assert known_cost(False) is plain
    assert vote_cost(False) is plain
    assert weighted is not plain
    for cost in (plain, weighted):
        assert cost.vote >= 0.0
        assert cost.cell >= 0.0
        assert cost.seconds(1e6, 10**6) > 0.0
    assert VoteCost(2.0, 3.0).seconds(10.0, 4) == 32.0
