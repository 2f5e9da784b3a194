"""The advisor, against what its own survey and the predictions say."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from algorithms.context import Box
from algorithms.errors import RequestError
from algorithms.quantisation.advisor import (
    INDIFFERENT,
    SearchGrid,
    advise,
    centred_grid,
    default_search,
    survey,
)
from algorithms.quantisation.prediction import predict
from algorithms.quantisation.question import Clutter, ClutterSource, Question, TargetLine
from algorithms.quantisation.spread import VoteDistribution

SQUARE = Box((0.0, 0.0), (100.0, 100.0))
QUESTION = Question((TargetLine(0.1, 15, 19.6),), 0.9, Clutter((ClutterSource(750.0, SQUARE),)), SQUARE)


@pytest.fixture(scope="module")
def advice():
    return advise(QUESTION)


def test_the_pick_keeps_every_demand(advice):
    radius = 0.5 * 19.6 * math.sin(0.5 * advice.grid.theta_step)
    assert radius <= 0.1 * (1 + 1e-9)
    assert advice.prediction.false_cells <= 1.0
    assert advice.grid.origin == (50.0, 50.0)
    assert advice.grid.rho_min == -SQUARE.farthest((50.0, 50.0))
    assert advice.grid.rho_bins * advice.grid.rho_step >= 2 * SQUARE.farthest((50.0, 50.0))


def test_no_other_quantisation_finds_more(advice):
    found = advice.survey
    for row, bins in enumerate(found.search.theta_bins):
        for width, step in enumerate(found.search.rho_step):
            best = int(advice.by_step().votes[row, width])
            assert (found.false_cells[row, width, best - 1 :] <= 1.0).all()
            assert best == 1 or found.false_cells[row, width, best - 2] > 1.0
            if found.is_allowed[row, width]:
                reached = predict(QUESTION, centred_grid(QUESTION, int(bins), float(step)), best)
                assert (1 - 2 * INDIFFERENT) * reached.p_detection <= advice.prediction.p_detection + 1e-3


def test_the_survey_is_what_is_predicted_one_by_one(advice):
    found = advice.survey
    for row, width, votes in ((0, 0, 5), (3, 8, 12), (8, 15, 20)):
        grid = centred_grid(QUESTION, int(found.search.theta_bins[row]), float(found.search.rho_step[width]))
        single = predict(QUESTION, grid, votes)
        assert found.p_detection[row, width, votes - 1] == pytest.approx(single.p_detection, abs=1e-3)
        assert found.false_cells[row, width, votes - 1] == pytest.approx(single.false_cells, rel=0.01)


def test_the_trade_off_rises_with_the_bound(advice):
    bounds, rates = zip(*advice.trade_off(), strict=True)
    assert bounds[4] == 1.0
    assert (np.diff(rates) >= 0).all()
    assert rates[4] == pytest.approx(advice.prediction.p_detection, abs=2 * INDIFFERENT)
    assert rates[0] < rates[-1]


def test_where_detection_is_certain_the_fewest_false_cells_are_chosen():
    easy = replace(QUESTION, lines=(TargetLine(0.1, 60, 24.0),), false_cells=10.0)
    found = advise(easy)
    assert found.prediction.p_detection > 1 - 2 * INDIFFERENT
    assert found.prediction.false_cells < 1e-6


def test_without_clutter_the_highest_threshold_that_costs_nothing_is_chosen():
    found = advise(replace(QUESTION, clutter=Clutter()))
    assert found.prediction.false_cells == 0.0
    assert found.prediction.p_detection > 0.998
    assert found.votes > 1


def test_several_targets_count_alike_and_the_longest_bounds_the_rows():
    lines = (TargetLine(0.1, 15, 19.6), TargetLine(0.1, 15, 60.0))
    found = advise(replace(QUESTION, lines=lines))
    assert 0.5 * 60.0 * math.sin(0.5 * found.grid.theta_step) <= 0.1 * (1 + 1e-9)
    single = [line.p_detection for line in found.prediction.lines]
    assert found.prediction.p_detection == pytest.approx(np.mean(single))


def test_kappa_decides_how_coarse_rows_may_be():
    coarse = advise(replace(QUESTION, kappa=4.0))
    radius = 0.5 * 19.6 * math.sin(0.5 * coarse.grid.theta_step)
    assert radius <= 0.4 * (1 + 1e-9)
    fine = advise(replace(QUESTION, kappa=0.2))
    assert 0.5 * 19.6 * math.sin(0.5 * fine.grid.theta_step) <= 0.02 * (1 + 1e-9)


def test_lines_that_are_to_be_held_apart_bound_the_columns():
    question = replace(QUESTION, separation=0.7, confidence=0.9)
    found = advise(question)
    half = 0.5 * 19.6
    votes = VoteDistribution.of_line(0.1, (-half, half), 0.5 * found.grid.theta_step)
    assert found.grid.rho_step <= 0.7 - 2 * votes.half_width(0.9) + 1e-9
    assert found.prediction.p_detection <= advise(QUESTION).prediction.p_detection + 1e-9
    with pytest.raises(RequestError, match=r"lines 0\.4 apart cannot be held apart") as refused:
        advise(replace(question, separation=0.4))
    # The message says what would do.
    least = float(str(refused.value).split("a separation of ")[1].split()[0])
    assert advise(replace(question, separation=1.01 * least)).grid.rho_step > 0


def test_what_cannot_be_advised_is_refused():
    with pytest.raises(RequestError, match="noise is 0"):
        advise(replace(QUESTION, lines=(TargetLine(0.0, 15, 19.6),)))
    with pytest.raises(RequestError, match="no threshold up to"):
        advise(replace(QUESTION, clutter=Clutter((ClutterSource(1e7, SQUARE),)), false_cells=1e-9))
    with pytest.raises(RequestError, match="allow a greater κ"):
        advise(replace(QUESTION, lines=(TargetLine(1e-4, 15, 1e4),)))


def test_a_search_of_ones_own():
    search = SearchGrid(np.array([160]), np.array([0.3]))
    found = advise(QUESTION, search)
    assert (found.grid.theta_bins, found.grid.rho_step) == (160, 0.3)
    assert survey(QUESTION, search).p_detection.shape[:2] == (1, 1)
    wanted = default_search(QUESTION)
    assert (np.diff(wanted.theta_bins) > 0).all()
    assert (np.diff(wanted.rho_step) > 0).all()


def test_no_column_is_as_wide_as_the_region():
    # At 9 of noise the widest columns that are tried elsewhere would be 180 wide.
    wide = replace(QUESTION, lines=(TargetLine(9.0, 15, 19.6),))
    assert default_search(wide).rho_step.max() == 90.0


def test_a_line_without_noise_across_it_does_not_hinder():
    lines = (TargetLine(0.1, 15, 19.6), TargetLine(0.0, 15, 19.6))
    assert advise(replace(QUESTION, lines=lines)).prediction.p_detection > 0.4
