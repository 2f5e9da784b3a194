"""Votes of the home cell, against sums over all outcomes and against the voting kernel on drawn plots."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from algorithms.context import Box
from algorithms.errors import RequestError
from algorithms.hough.grid import Grid
from algorithms.hough.voting import accumulate
from algorithms.plots import PlotChunk
from algorithms.quantisation.home_cell import COARSE, home_votes, reaching
from algorithms.quantisation.measurement import count_cells
from algorithms.quantisation.prediction import placed_votes, predict
from algorithms.quantisation.question import Clutter, ClutterSource, Question, TargetLine

steady = settings(deadline=None, derandomize=True, max_examples=60)

SQUARE = Box((0.0, 0.0), (100.0, 100.0))


def enumerated(theta_step, rho_step, sigma, scans, extent, probability):
    """Return the distribution of the home cell's votes by its definition, over every outcome."""
    along = np.linspace(-extent / 2, extent / 2, scans)
    places = (np.arange(60) + 0.5) / 60 - 0.5
    total = np.zeros(scans + 1)
    for delta, u in itertools.product(theta_step * places, rho_step * places):
        offset = u + along * math.sin(delta)
        upper, lower = (stats.norm.cdf((offset + side * rho_step / 2) / sigma) for side in (1, -1))
        hit = probability * (upper - lower)
        for outcome in itertools.product((0, 1), repeat=scans):
            total[sum(outcome)] += np.prod(np.where(outcome, hit, 1 - hit))
    return total / total.sum()


@pytest.mark.parametrize(
    ("theta_step", "rho_step", "sigma", "extent", "probability"),
    [(0.04, 0.4, 0.1, 10.0, 0.9), (0.2, 0.3, 0.1, 10.0, 1.0), (0.01, 1.0, 0.2, 3.0, 0.5)],
)
def test_the_votes_of_the_home_cell(theta_step, rho_step, sigma, extent, probability):
    expected = enumerated(theta_step, rho_step, sigma, 4, extent, probability)
    steps = np.array([theta_step]), np.array([rho_step])
    fine = home_votes(*steps, sigma, 4, extent, probability)[0, 0]
    assert fine == pytest.approx(expected, abs=2e-3)
    assert home_votes(*steps, sigma, 4, extent, probability, COARSE)[0, 0] == pytest.approx(fine, abs=2e-3)


@steady
@given(
    st.floats(0.001, 0.5), st.floats(0.01, 10), st.floats(0, 1), st.integers(1, 40), st.floats(0, 100),
    st.floats(0, 1),
)  # fmt: skip
def test_the_votes_of_the_home_cell_are_a_distribution(
    theta_step, rho_step, sigma, scans, extent, probability
):
    votes = home_votes(
        np.array([theta_step, theta_step / 2]), np.array([rho_step]), sigma, scans, extent, probability
    )
    assert votes.shape == (2, 1, scans + 1)
    assert (votes >= 0).all()
    assert votes.sum(axis=-1) == pytest.approx(np.ones((2, 1)))
    # Finer rows spread a line less.
    means = votes[:, 0] @ np.arange(scans + 1)
    assert means[1] >= means[0] - 1e-6 * scans
    assert means[0] <= scans * probability + 1e-9


def test_own_votes_and_clutter_reach_a_threshold_together():
    own = home_votes(np.array([0.05]), np.array([0.3, 0.6]), 0.1, 7, 12.0, 0.8)
    clutter = np.array([1.1, 2.2])
    found = reaching(own, clutter, 14)
    for width, most in itertools.product(range(2), range(1, 15)):
        numbers = np.arange(8)
        expected = (own[0, width] * stats.poisson.sf(most - numbers - 1, clutter[width])).sum()
        assert found[0, width, most - 1] == pytest.approx(expected)
    fixed = reaching(own, clutter, 14, 50.0)
    expected = (own[0, 1] * stats.binom.sf(6 - np.arange(8) - 1, 50, 2.2 / 50)).sum()
    assert fixed[0, 1, 5] == pytest.approx(expected)


# Targets


def test_the_line_of_a_motion():
    line = TargetLine.of_motion((40.0, 20.0), (0.3, 0.18), 15, 4.0, (0.1, 0.2))
    assert math.degrees(line.theta) == pytest.approx(120.96, abs=0.01)
    assert line.extent == pytest.approx(14 * 4 * math.hypot(0.3, 0.18))
    assert line.middle == pytest.approx((48.4, 25.04))
    assert line.about((0.0, 0.0))[0] == pytest.approx(-3.43, abs=0.005)
    rho, along = line.about((50.0, 50.0))
    cosine, sine = math.cos(line.theta), math.sin(line.theta)
    assert (50 + rho * cosine - along * sine, 50 + rho * sine + along * cosine) == pytest.approx(line.middle)
    assert line.sigma == pytest.approx(math.hypot(0.1 * cosine, 0.2 * sine))


@pytest.mark.parametrize(
    ("velocity", "noise"), [((0.3, 0.0), (0.1, 0.0)), ((-0.3, 0.0), (0.1, 0.0)), ((0.0, 0.3), (0.0, 0.1))]
)
def test_a_line_along_the_only_axis_with_noise_has_none_across(velocity, noise):
    assert TargetLine.of_motion((40.0, 20.0), velocity, 15, 4.0, noise).sigma == 0.0


def test_the_share_in_the_home_cell_is_that_of_the_votes_there_are():
    line = TargetLine.of_motion((40.0, 20.0), (0.3, 0.18), 15, 4.0, (0.1, 0.1))
    shares = [
        predict(Question((line,), probability, Clutter(), SQUARE), Grid(90, 400, -140.0, 0.7), 5).share
        for probability in (0.0, 0.3, 1.0)
    ]
    assert shares == pytest.approx([shares[-1]] * 3)
    assert shares[-1] > 0.5


def test_a_cell_as_wide_as_the_region_holds_no_more_than_all_clutter():
    line = TargetLine.of_motion((40.0, 20.0), (0.3, 0.18), 15, 4.0, (0.1, 0.1))
    question = Question((line,), 0.9, Clutter((ClutterSource(50.0, SQUARE),)), SQUARE)
    assert question.other_votes(line, 5000.0) == 50.0


@pytest.mark.parametrize("speed", [(0.3, 0.18), (0.2, 0.0), (-0.01, 0.3), (0.2, 0.001), (0.2, -0.001)])
@pytest.mark.parametrize("offset", [0.0, 0.5])
def test_placed_votes_are_where_the_plots_vote(speed, offset):
    # Rows and columns are those of the voting kernel, at the seam too.
    line = TargetLine.of_motion((40.0, 20.0), speed, 15, 4.0, (0.0, 0.0))
    grid = Grid(90, 400, -140.0, 0.7, (13.0, -8.0), offset)
    placed = placed_votes(line, grid)
    distance = abs(grid.theta[placed.row] - line.theta)
    assert min(distance, math.pi - distance) <= grid.theta_step / 2 + 1e-12
    votes = accumulate(np.array([line.middle]), grid).votes[placed.row]
    assert np.flatnonzero(votes).tolist() == [placed.column]
    shifted = np.array([40.0, 20.0]) + np.arange(15)[:, None] * 4.0 * np.array(speed) - grid.origin
    angle = grid.theta[placed.row]
    rho = shifted @ [math.cos(angle), math.sin(angle)]
    assert (rho.min(), rho.max()) == pytest.approx(
        (placed.votes.rho + placed.votes.lower, placed.votes.rho + placed.votes.upper)
    )


def test_a_line_outside_the_grid_has_no_home_cell():
    line = TargetLine.of_motion((40.0, 20.0), (0.3, 0.18), 15, 4.0, (0.1, 0.1))
    placed = placed_votes(line, Grid(90, 10, 200.0, 0.7))
    assert (placed.column, placed.share) == (-1, 0.0)


def test_plots_of_other_targets_count_where_their_tracks_cross_the_line():
    motions = [((40.0, 40.0), (0.3, 0.3)), ((40.0, 52.0), (0.3, -0.2)), ((10.0, 80.0), (0.3, 0.0))]
    lines = tuple(TargetLine.of_motion(*motion, 20, 4.0, (0.3, 0.3)) for motion in motions)
    question = Question(lines, 0.9, Clutter(), SQUARE)
    random = np.random.default_rng(4)
    own, (first, velocity) = lines[0], motions[1]
    # Plots anywhere along the other's track: their share within half a column of the line.
    elapsed = random.uniform(0, 19 * 4.0, 200_000)
    place = np.array(first) + elapsed[:, None] * np.array(velocity) + random.normal(0, 0.3, (200_000, 2))
    away = place @ [math.cos(own.theta), math.sin(own.theta)] - own.about((0.0, 0.0))[0]
    expected = 18 * np.mean(np.abs(away) < 1.0)
    assert expected > 1
    assert question.other_votes(own, 2.0) == pytest.approx(expected, rel=0.03)
    # Nobody crosses the third one's line.
    assert question.other_votes(lines[2], 2.0) == pytest.approx(0.0, abs=1e-6)


def test_a_question_that_cannot_be_asked_is_refused():
    line = TargetLine(0.1, 15, 20.0)
    for changed, words in (
        ({"lines": ()}, "none that moves"),
        ({"lines": (TargetLine(0.1, 1001, 20.0),)}, "1,001 scans"),
        ({"false_cells": 0.0}, "false_cells 0"),
        ({"kappa": -1.0}, "kappa -1"),
        ({"separation": math.inf}, "separation inf"),
        ({"confidence": 1.0}, "confidence 1"),
    ):
        given_fields = {
            "lines": (line,),
            "detection_probability": 0.9,
            "clutter": Clutter(),
            "region": SQUARE,
        }
        with pytest.raises(RequestError, match=words):
            Question(**{**given_fields, **changed})


# Trials


def drawn_chunk(random, trials, scans, first, velocity, interval, sigma, probability, clutter):
    """Return trials of one target in clutter, by numpy alone."""
    parts = []
    for _ in range(trials):
        seen = np.flatnonzero(random.random(scans) < probability)
        track = np.array(first) + seen[:, None] * interval * np.array(velocity)
        track = track + random.normal(0, sigma, track.shape)
        parts.append(np.concatenate([track, random.uniform(0, 100, (random.poisson(clutter), 2))]))
    offsets = np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.int64)
    place = np.concatenate(parts)
    return PlotChunk(np.zeros(len(place), np.int32), np.zeros(len(place)), place, offsets)


# Lines beside the seam, from one row before it to one row after it.
@pytest.mark.parametrize(("velocity", "row"), [((0.001, 0.4), 29), ((-0.001, 0.4), 29), ((-0.042, 0.398), 0)])
def test_counted_cells_are_those_of_the_voting_kernel(velocity, row):
    random = np.random.default_rng(8)
    first = (20.0, 30.0)
    chunk = drawn_chunk(random, 60, 9, first, velocity, 4.0, 0.1, 0.9, 80)
    line = TargetLine.of_motion(first, velocity, 9, 4.0, (0.1, 0.1))
    grid = Grid(30, 200, -75.0, 0.75, (50.0, 50.0))
    shifts = random.random((60, 2))
    found = count_cells(chunk, grid, np.array([line.theta]), np.full((60, 1, 2), line.middle), shifts, 40)
    rows = set()
    for trial in range(60):
        moved = Grid(
            30, 201, grid.rho_min - shifts[trial, 1] * grid.rho_step, grid.rho_step, grid.origin,
            grid.theta_offset + shifts[trial, 0],
        )  # fmt: skip
        votes = accumulate(chunk.trial(trial).position, moved).votes
        home = placed_votes(line, moved)
        assert found.home[trial, 0] == votes[home.row, home.column]
        block = []
        for away, beside in itertools.product((-1, 0, 1), repeat=2):
            near, column = home.row + away, home.column + beside
            if not 0 <= near < 30:
                column = math.floor((-moved.rho[column] - moved.rho_min) / moved.rho_step)
            block.append(votes[near % 30, column])
        assert found.block[trial, 0] == max(block)
        assert found.cells[trial].tolist() == np.bincount(votes.ravel(), minlength=41).tolist()
        rows.add(home.row)
    assert row in rows


def test_the_prediction_is_what_trials_give():
    # Rows so coarse that the extent spreads votes by more than the noise does.
    random = np.random.default_rng(21)
    trials, scans, first, velocity = 1500, 12, (30.0, 40.0), (0.3, 0.18)
    line = TargetLine.of_motion(first, velocity, scans, 4.0, (0.1, 0.1))
    question = Question((line,), 0.9, Clutter((ClutterSource(300.0, SQUARE),)), SQUARE)
    chunk = drawn_chunk(random, trials, scans, first, velocity, 4.0, 0.1, 0.9, 300)
    for theta_bins, rho_step in ((40, 0.5), (150, 0.3)):
        grid = Grid(theta_bins, math.ceil(142 / rho_step), -71.0, rho_step, (50.0, 50.0))
        counts = count_cells(
            chunk,
            grid,
            np.array([line.theta]),
            np.full((trials, 1, 2), line.middle),
            random.random((trials, 2)),
            60,
        )
        for votes in (6, 8, 10):
            expected = predict(question, grid, votes).p_detection
            error = math.sqrt(expected * (1 - expected) / trials)
            assert (counts.home >= votes).mean() == pytest.approx(expected, abs=4 * error + 0.005)
