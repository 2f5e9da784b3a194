from __future__ import annotations

import math

import numpy as np
import pytest

from algorithms.context import Box, Context, Unit
from algorithms.errors import RequestError
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.best_first import ASSUMED_SPEED, BestFirst, peak_width
from algorithms.hough.peaks.registry import EXTRACTIONS
from algorithms.initiators.accumulating import AccumulatingParameters
from algorithms.initiators.registry import initiator
from algorithms.initiators.sequential import SequentialParameters
from algorithms.initiators.standard import StandardParameters
from algorithms.initiators.weighted import WeightedParameters
from algorithms.parameters import validated
from algorithms.plots import Plots

SCENE = Context(20, 4.0, 0.9, (0.1, 0.1), Box((0.0, 0.0), (100.0, 100.0)))
WEIGHTED = initiator("weighted")


def plots_of(rows, interval=4.0):
    rows = np.array(sorted(rows), dtype=float).reshape(-1, 3)
    return Plots(rows[:, 0].astype(np.int32), rows[:, 0] * interval, np.ascontiguousarray(rows[:, 1:]))


def initiate(plots, context=SCENE, **given_values):
    parameters = validated(WeightedParameters, given_values, "weighted").resolved(context)
    return WEIGHTED.initiate(plots, context, parameters)


def one_target(seed=0, clutter=0):
    generator = np.random.default_rng(seed)
    rows = [
        (scan, *(np.array([30.0 + scan, 40.0 + 0.6 * scan]) + generator.normal(0, 0.1, 2)))
        for scan in range(20)
    ]
    rows += [(generator.integers(20), *generator.uniform(0, 100, 2)) for _ in range(clutter)]
    return plots_of(rows)


def test_what_is_worked_out_for_the_scene():
    found = WeightedParameters().resolved(SCENE)
    # 0.4·20·0.9 = 7.2 and 0.6·20·0.9 = 10.8 votes.
    assert (found.least_votes, found.votes, found.maxima) == (7, 11, None)
    assert found.resolved(SCENE) == found
    assert WeightedParameters(mode="single").resolved(SCENE).maxima == 1
    assert WeightedParameters(mode="single", maxima=3).resolved(SCENE).maxima == 3
    assert WeightedParameters(least_votes=2).resolved(SCENE).least_votes == 2


@pytest.mark.parametrize(
    ("scans", "probability", "expected"), [(20, 0.9, 7), (40, 0.9, 14), (100, 1.0, 40), (5, 0.2, 0)]
)
def test_the_floor_is_four_tenths_of_the_expected_votes(scans, probability, expected):
    context = Context(scans, 1.0, probability, (0.1, 0.1), SCENE.region)
    assert WeightedParameters().resolved(context).least_votes == expected


def test_one_target_is_one_track_with_its_state():
    tracks = initiate(one_target(clutter=100))
    best = int(np.argmax(tracks.score))
    assert tracks.states.velocity[best] == pytest.approx([0.25, 0.15], abs=0.01)
    assert len(tracks.plots[best]) >= 18


def test_the_tracks_are_centres_of_cells_at_the_threshold_of_the_weighted_votes():
    plots = one_target(clutter=200)
    parameters = WeightedParameters(peaks="threshold").resolved(SCENE)
    accumulator = WEIGHTED.accumulator(plots, SCENE, parameters)
    tracks = WEIGHTED.initiate(plots, SCENE, parameters)
    rows, columns = np.nonzero(accumulator.weighted >= parameters.votes)
    theta, rho = accumulator.grid.lines(rows, columns)
    assert len(tracks) > 0
    np.testing.assert_array_equal(tracks.theta, theta)
    np.testing.assert_array_equal(tracks.rho, rho)
    np.testing.assert_array_equal(tracks.score, accumulator.weighted[rows, columns])
    assert (np.isnan(accumulator.std) == (accumulator.votes <= parameters.least_votes)).all()


def test_single_takes_the_greatest_weighted_cell_and_a_great_exponent_the_least_deviation():
    plots = one_target(seed=4)
    for eta in (2.0, 1e6):
        parameters = WeightedParameters(mode="single", eta=eta, votes=1).resolved(SCENE)
        accumulator = WEIGHTED.accumulator(plots, SCENE, parameters)
        tracks = WEIGHTED.initiate(plots, SCENE, parameters)
        assert len(tracks) == 1
        values = accumulator.weighted if eta == 2.0 else -np.nan_to_num(accumulator.std, nan=np.inf)
        best = np.unravel_index(values.argmax(), values.shape)
        assert tracks.theta[0] == accumulator.grid.theta[best[0]]


def test_a_floor_above_all_votes_gives_no_track():
    assert len(initiate(one_target(), least_votes=30)) == 0
    assert len(initiate(plots_of([]))) == 0
    assert len(initiate(plots_of([(3, 5.0, 5.0)]))) == 0


@pytest.mark.parametrize("peaks", list(EXTRACTIONS))
@pytest.mark.parametrize("mode", ["several", "single"])
def test_identical_plots_weigh_all_their_votes(peaks, mode):
    tracks = initiate(
        plots_of([(scan, 33.0, 44.0) for scan in range(20)]), peaks=peaks, mode=mode, maxima=3, least_votes=7
    )
    assert len(tracks) > 0
    assert (tracks.score == 20).all()


def test_an_accumulator_with_its_deviations_may_be_too_large_where_the_votes_alone_are_not():
    large = {"theta_bins": 10_000, "rho_bins": 10_000}
    assert validated(StandardParameters, {"grid": large}, "standard").resolved(SCENE).grid.rho_bins == 10_000
    with pytest.raises(RequestError, match=r"would need 1\.9 GiB; the limit is 1 GiB"):
        validated(WeightedParameters, {"grid": large}, "weighted").resolved(SCENE)


# The choices of every accumulating initiator


def test_defaults_of_the_three():
    chosen = [
        (model().peaks, model().maxima)
        for model in (StandardParameters, SequentialParameters, WeightedParameters)
    ]
    assert chosen == [("threshold", None), ("sequential", 2), ("best-first", None)]
    declared = AccumulatingParameters.model_fields
    assert SequentialParameters.model_fields["peaks"].description == declared["peaks"].description


@pytest.mark.parametrize(
    ("peaks", "window"),
    [("threshold", (0, 0)), ("thesis", (4, 2)), ("sequential", (5, 5)), ("vote-removal", (0, 1))],
)
def test_windows_that_depend_on_nothing(peaks, window):
    for context in (SCENE, Context(3, 1.0, 0.5, None, SCENE.region)):
        found = StandardParameters(peaks=peaks).resolved(context)
        assert (found.suppress_theta, found.suppress_rho) == window
    given = StandardParameters(peaks=peaks, suppress_theta=7, suppress_rho=8).resolved(SCENE)
    assert (given.suppress_theta, given.suppress_rho) == (7, 8)


def test_the_width_of_a_peak_is_where_its_votes_fall_below_the_threshold():
    # A track of 20 votes spread evenly over 12 km through the origin; rows of half a degree.
    grid = Grid(360, 400, -40.0, 0.2)
    along = np.linspace(-6, 6, 2001)
    tilt = np.arange(60) * grid.theta_step
    share = [np.mean(np.abs(along * math.sin(angle)) < 0.5 * grid.rho_step) for angle in tilt]
    for votes in (5, 10, 16):
        rows = np.count_nonzero(20 * np.array(share) >= votes) - 1
        assert peak_width(grid, 20.0, 12.0, votes) == pytest.approx(rows, abs=1)


def test_the_window_of_best_first_is_twice_the_width_of_a_peak_at_the_assumed_speed():
    grid = StandardParameters().resolved(SCENE).grid.grid(SCENE)
    length = ASSUMED_SPEED / 1000 * 4.0 * 19
    rows, columns = BestFirst.default_window(grid, SCENE, 18)
    assert rows == math.ceil(2 * peak_width(grid, 18.0, length, 18))
    assert columns == 2
    in_metres = Context(20, 4.0, 0.9, (100.0, 100.0), Box((0.0, 0.0), (1e5, 1e5)), Unit.METRE)
    metres = StandardParameters().resolved(in_metres).grid.grid(in_metres)
    assert BestFirst.default_window(metres, in_metres, 18) == (rows, columns)


def test_the_window_of_best_first_stays_below_an_eighth_of_a_turn():
    grid = Grid(90, 100, -50.0, 1.0)
    for context in (SCENE, Context(1, 4.0, 1.0, None, SCENE.region)):
        assert BestFirst.default_window(grid, context, 1)[0] == 22
    assert BestFirst.default_window(Grid(1, 100, -50.0, 1.0), SCENE, 1)[0] == 1
