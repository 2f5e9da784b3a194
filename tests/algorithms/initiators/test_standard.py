from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.context import Box, Context
from algorithms.errors import RequestError
from algorithms.hough.lines import line_distance, line_through
from algorithms.initiators.registry import initiator
from algorithms.initiators.standard import StandardParameters
from algorithms.parameters import validated
from algorithms.plots import Plots
from algorithms.scoring.matching import Criterion

steady = settings(
    deadline=None, derandomize=True, max_examples=200, suppress_health_check=[HealthCheck.too_slow]
)

TRIALS = 2000
BY_RHO = Criterion(rho=3.0)
BY_LINE = Criterion(rho=3.0, theta=math.radians(6))
SCENE = Context(6, 4.0, 1.0, (0.1, 0.1), Box((0.0, 0.0), (100.0, 100.0)))
STANDARD = initiator("standard")


def of_scans(course, scans):
    return course.scenario("two-crossing").model_copy(update={"scans": scans})


# Reference figures: success and false share with ρ alone, the same with θ, success without a target.
FIGURES = {
    5: (1.000, 0.882, 1.000, 0.964, 0.999),
    10: (0.998, 0.708, 0.995, 0.796, 0.634),
    15: (0.996, 0.345, 0.995, 0.402, 0.127),
}


@pytest.mark.parametrize("scans", FIGURES)
@pytest.mark.parametrize("criterion", [BY_RHO, BY_LINE], ids=["rho", "line"])
def test_the_published_table_is_reproduced(course, measure, margin, rate_margin, scans, criterion):
    at = 0 if criterion is BY_RHO else 2
    success, false_ratio = FIGURES[scans][at : at + 2]
    found = measure(of_scans(course, scans), course.entry("standard"), criterion, TRIALS)
    # Both targets of a trial may be found or missed together, so a trial counts once.
    assert found.success.mean() == pytest.approx(success, abs=rate_margin(success, TRIALS, 0.001))
    allowed = margin(found.false_ratio.std(), TRIALS) + 0.0005
    assert found.false_ratio.mean() == pytest.approx(false_ratio, abs=allowed)


@pytest.mark.parametrize("scans", FIGURES)
def test_chance_alone_succeeds_as_often_as_the_reference_says(course, measure, rate_margin, scans):
    expected = FIGURES[scans][4]
    found = measure(of_scans(course, scans), course.entry("standard"), BY_RHO, TRIALS, control=True)
    assert found.success.mean() == pytest.approx(expected, abs=rate_margin(expected, TRIALS, 0.001))
    assert (found.false_ratio > 0).any()


def test_cells_over_the_threshold_by_clutter_alone(course, measure):
    # About 270 at five scans, to two digits.
    found = measure(of_scans(course, 5), course.entry("standard"), BY_LINE, 500, control=True)
    error = 4 * found.false.std() / math.sqrt(500)
    assert found.false.mean() == pytest.approx(270, abs=5 + error)


def test_the_threshold_of_the_course_report():
    votes = [
        StandardParameters().resolved(Context(n, 4.0, 1.0, (0.1, 0.1), SCENE.region)).votes
        for n in (5, 10, 15)
    ]
    assert votes == [5, 10, 15]


@steady
@given(st.integers(1, 200), st.integers(0, 100), st.integers(0, 100))
def test_the_threshold_is_the_fraction_of_the_expected_votes_rounded_up(scans, probability, fraction):
    context = Context(scans, 4.0, probability / 100, (0.1, 0.1), SCENE.region)
    found = StandardParameters(fraction=fraction / 100).resolved(context)
    assert found.votes == max(1, math.ceil(Fraction(fraction, 100) * Fraction(probability, 100) * scans))


def test_given_votes_win_over_the_fraction():
    assert StandardParameters(votes=3, fraction=1.0).resolved(SCENE).votes == 3


def test_resolved_parameters_resolve_to_themselves():
    once = StandardParameters().resolved(SCENE)
    assert once.resolved(SCENE) == once


def plots_of(rows, interval=4.0):
    rows = np.array(rows, dtype=float).reshape(-1, 3)
    return Plots(rows[:, 0].astype(np.int32), rows[:, 0] * interval, np.ascontiguousarray(rows[:, 1:]))


def initiate(plots, context=SCENE, **given_values):
    parameters = validated(StandardParameters, given_values, "standard").resolved(context)
    return STANDARD.initiate(plots, context, parameters)


@steady
@given(st.floats(0, 2 * math.pi), st.floats(0.1, 0.6), st.integers(0, 2**32))
def test_a_target_without_noise_comes_out_with_its_state_whatever_its_heading(heading, speed, seed):
    generator = np.random.default_rng(seed)
    velocity = speed * np.array([math.cos(heading), math.sin(heading)])
    start = generator.uniform(30, 70, 2)
    rows = []
    for scan in range(6):
        rows.extend((scan, *place) for place in generator.uniform(0, 100, (10, 2)))
        rows.append((scan, *(start + 4.0 * scan * velocity)))
    # The row nearest to its line spreads six plots over two columns at most.
    tracks = initiate(plots_of(rows), votes=3)
    line = line_through(start, velocity)
    angle, distance = line_distance(*tracks.states.lines, *line)
    exact = np.flatnonzero((angle < 1e-6) & (distance < 1e-4))
    assert len(exact)
    # A cell that the target merely touches has fewer of its plots.
    best = max(exact, key=lambda track: len(tracks.plots[track]))
    assert tracks.plots[best].tolist() == [10 + 11 * scan for scan in range(6)]
    assert tracks.states.velocity[best] == pytest.approx(velocity, abs=1e-9)
    assert tracks.states.position[best] == pytest.approx(start, abs=1e-9)


def test_the_tracks_are_the_cells_at_the_threshold():
    plots = plots_of([(scan, 40 + scan, 20 + 0.6 * scan) for scan in range(6)])
    parameters = StandardParameters().resolved(SCENE)
    accumulator = STANDARD.accumulator(plots, SCENE, parameters)
    tracks = STANDARD.initiate(plots, SCENE, parameters)
    rows, columns = np.nonzero(accumulator.votes >= 6)
    theta, rho = accumulator.grid.lines(rows, columns)
    assert len(tracks) > 0
    np.testing.assert_array_equal(tracks.theta, theta)
    np.testing.assert_array_equal(tracks.rho, rho)
    np.testing.assert_array_equal(tracks.score, accumulator.votes[rows, columns])


@pytest.mark.parametrize("rows", [[], [(0, 5.0, 5.0)]])
def test_no_plot_or_one_plot_reaches_no_threshold_of_six(rows):
    tracks = initiate(plots_of(rows))
    assert len(tracks) == 0
    assert tracks.states.velocity.shape == (0, 2)
    assert tracks.plots == ()


def test_one_plot_with_one_vote_is_a_track_in_every_row_without_velocity():
    tracks = initiate(plots_of([(2, 5.0, 6.0)]), votes=1, grid={"theta_bins": 12})
    assert len(tracks) == 12
    assert np.isnan(tracks.states.velocity).all()
    assert [rows.tolist() for rows in tracks.plots] == [[0]] * 12
    assert tracks.states.position.tolist() == [[5.0, 6.0]] * 12


@pytest.mark.parametrize("scans", [[0] * 8, [0, 1, 2, 3, 4, 5, 5, 5]])
def test_identical_plots_fill_one_cell_in_every_row(scans):
    tracks = initiate(plots_of([(scan, 33.0, 44.0) for scan in scans]), grid={"theta_bins": 12})
    assert tracks.score.tolist() == [8.0] * 12
    for rows in tracks.plots:
        assert len(rows) == len(set(scans))
    still = len(set(scans)) > 1
    assert (tracks.states.velocity == 0).all() if still else np.isnan(tracks.states.velocity).all()


def test_plots_of_one_scan_alone_are_tracks_without_velocity():
    tracks = initiate(plots_of([(4, 10.0 + k, 20.0) for k in range(7)]))
    assert len(tracks) > 0
    assert np.isnan(tracks.states.velocity).all()
    assert all(len(rows) == 1 for rows in tracks.plots)


def test_coordinates_of_a_billion_give_the_tracks_of_the_origin():
    rows = np.array([(scan, 40 + scan, 20 + 0.75 * scan) for scan in range(6)])
    near = initiate(plots_of(rows))
    far_scene = Context(6, 4.0, 1.0, (0.1, 0.1), Box((1e9, 1e9), (1e9 + 100, 1e9 + 100)))
    far = initiate(plots_of(rows + np.array([0, 1e9, 1e9])), far_scene)
    np.testing.assert_array_equal(far.theta, near.theta)
    np.testing.assert_array_equal(far.score, near.score)
    assert far.states.velocity == pytest.approx(near.states.velocity, abs=1e-6)
    assert [found.tolist() for found in far.plots] == [found.tolist() for found in near.plots]


def test_the_height_of_plots_changes_nothing():
    rows = [(scan, 40 + scan, 20 + 0.6 * scan) for scan in range(6)]
    flat = plots_of(rows)
    high = Plots(flat.scan, flat.time, np.column_stack([flat.position, [7.0, -3, 1e6, 0, 2, 9]]))
    above, below = initiate(high), initiate(flat)
    for column in ("theta", "rho", "score"):
        np.testing.assert_array_equal(getattr(above, column), getattr(below, column))
    np.testing.assert_array_equal(above.states.velocity, below.states.velocity)


def test_votes_outside_the_grid_are_counted():
    context, rows = SCENE, [(scan, 90.0, 90.0 + scan) for scan in range(6)]
    parameters = StandardParameters.model_validate(
        {"grid": {"theta_bins": 90, "rho_min": -50, "rho_step": 0.5, "rho_bins": 200}}
    ).resolved(context)
    plots = plots_of(rows)
    found = STANDARD.initiate_chunk(plots.chunk(), context, parameters)
    assert 0 < found.votes_outside[0] < 6 * 90
    assert found.votes_outside[0] == STANDARD.accumulator(plots, context, parameters).votes_outside


def test_an_accumulator_that_is_too_large_is_refused():
    with pytest.raises(
        RequestError, match=r"100,000 × 100,000 cells would need 37\.3 GiB; the limit is 1 GiB"
    ):
        initiate(plots_of([]), grid={"theta_bins": 100_000, "rho_bins": 100_000})
