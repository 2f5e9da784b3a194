from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.context import Context, Unit
from algorithms.errors import RequestError
from algorithms.initiators import modified
from algorithms.initiators.modified import ModifiedParameters
from algorithms.initiators.registry import initiator
from algorithms.parameters import validated
from algorithms.plots import PlotChunk, Plots
from algorithms.scoring.matching import Criterion
from scenarios.targets import Target

steady = settings(deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])

SCENE = Context(3, 4.0)
MODIFIED = initiator("modified")
OWN_PLOTS = Criterion(plots=3)
TRIALS = 4000


def changed(scenario, *, sigma=None, probability=None, rate=None, **fields):
    """Return a scenario with other values of its sensor and its clutter."""
    given_values = {"sigma": sigma, "detection_probability": probability}
    update = {name: value for name, value in given_values.items() if value is not None}
    fields["sensor"] = scenario.sensor.model_copy(update=update)
    if rate is not None:
        fields["clutter"] = [source.model_copy(update={"rate": rate}) for source in scenario.clutter]
    return scenario.model_copy(update=fields)


# Reference figures, σ = .05 km; success in whole per cents.
@pytest.mark.parametrize(("probability", "success"), [(1.0, 0.77), (0.9, 0.56), (0.8, 0.40)])
def test_success_is_that_of_the_reference(course, measure, rate_margin, probability, success):
    scenario = changed(course.scenario("three-scans"), sigma=0.05, probability=probability, rate=20.0)
    found = measure(scenario, course.entry("modified"), OWN_PLOTS, TRIALS).success
    assert found.mean() == pytest.approx(success, abs=rate_margin(success, TRIALS, 0.01))


@pytest.mark.parametrize(("probability", "success"), [(1.0, 0.45), (0.9, 0.31), (0.8, 0.23)])
def test_success_falls_with_the_noise_as_in_the_reference(course, measure, rate_margin, probability, success):
    scenario = changed(course.scenario("three-scans"), sigma=0.1, probability=probability, rate=20.0)
    found = measure(scenario, course.entry("modified"), OWN_PLOTS, TRIALS).success
    assert found.mean() == pytest.approx(success, abs=rate_margin(success, TRIALS, 0.01))


@pytest.mark.parametrize(
    ("rate", "false", "last_digit"),
    [(5, 0.003, 0.001), (20, 0.008, 0.001), (50, 0.043, 0.001), (100, 0.24, 0.01)],
)
def test_false_tracks_are_those_of_the_reference(course, measure, margin, rate, false, last_digit):
    scenario = changed(course.scenario("three-scans"), sigma=0.05, rate=rate)
    found = measure(scenario, course.entry("modified"), OWN_PLOTS, 20_000).false
    assert found.mean() == pytest.approx(false, abs=margin(found.std(), 20_000) + 0.5 * last_digit)


def test_triples_of_clutter_are_as_many_as_chance_says(course, measure):
    # λ³ triples, each with the chance that two steps, uniform in (speed, angle)-rings, end in the region.
    rate, side, trials = 100.0, 100.0, 20_000
    scenario = changed(course.scenario("three-scans"), rate=rate, targets=[])
    found = measure(scenario, course.entry("modified"), OWN_PLOTS, trials).false
    shortest, longest, gate = 0.05 * 4, 0.7 * 4, math.radians(6)
    middle = (np.arange(30) + 0.5) / 30
    length = shortest + (longest - shortest) * middle
    first, second, heading, turn = np.meshgrid(
        length, length, 2 * math.pi * middle, gate * (2 * middle - 1), indexing="ij", sparse=True
    )
    x = first * np.cos(heading) + second * np.cos(heading + turn)
    y = first * np.sin(heading) + second * np.sin(heading + turn)
    inside = (1 - np.abs(x) / side) * (1 - np.abs(y) / side)
    # Each step's density in the region is 1/side²; a ring's element is r·dr·dφ.
    volume = ((longest - shortest) * 2 * math.pi) * ((longest - shortest) * 2 * gate)
    expected = rate**3 * (first * second * inside).mean() * volume / side**4
    assert found.mean() == pytest.approx(expected, abs=4 * found.std() / math.sqrt(trials))


def heading_towards(degrees):
    # Exact along the axes, where cos 90° is not quite zero.
    exact = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}
    x, y = exact.get(degrees, (math.cos(math.radians(degrees)), math.sin(math.radians(degrees))))
    return Target(position=(50.0, 50.0), velocity=(0.35 * x, 0.35 * y))


AXES = (0, 90, 180, 270)
HEADINGS = [axis + off for axis in AXES for off in (-0.1, 0, 0.1)]


@pytest.mark.parametrize("heading", HEADINGS)
def test_a_heading_near_an_axis_is_found_as_often_as_any_other(course, measure, heading):
    found = []
    for seed, towards in ((1, heading), (2, 31.0)):
        scenario = changed(course.scenario("three-scans"), rate=0.0, targets=[heading_towards(towards)])
        found.append(measure(scenario, course.entry("modified"), OWN_PLOTS, 2000, seed=seed).success)
    error = math.sqrt((found[0].var() + found[1].var()) / 2000)
    assert found[0].mean() == pytest.approx(found[1].mean(), abs=4 * error)
    assert found[1].mean() > 0.7


@pytest.mark.parametrize("heading", [*HEADINGS, 31.0, 45.0, 123.0])
def test_without_noise_every_heading_is_found(course, measure, heading):
    scenario = changed(
        course.scenario("three-scans"), sigma=0.0, rate=0.0, targets=[heading_towards(heading)]
    )
    found = measure(scenario, course.entry("modified"), OWN_PLOTS, 50)
    assert found.success.tolist() == [1.0] * 50
    assert found.false.tolist() == [0] * 50


def test_the_literal_reading_fails_along_the_axes(course, measure, margin):
    # The reference: 33 % of the headings near an axis against 77 %.
    for axis in AXES:
        scene = course.scenario("three-scans")
        exact = changed(scene, sigma=0.0, rate=0.0, targets=[heading_towards(axis)])
        assert measure(exact, course.entry("modified"), OWN_PLOTS, 20, mode="document").success.max() == 0.0
        noisy = changed(scene, sigma=0.05, rate=0.0, targets=[heading_towards(axis)])
        found = measure(noisy, course.entry("modified"), OWN_PLOTS, 2000, mode="document").success
        assert found.mean() == pytest.approx(0.33, abs=margin(found.std(), 2000) + 0.005)


def test_the_literal_reading_agrees_away_from_the_axes(course, measure):
    scenario = changed(course.scenario("three-scans"), rate=0.0, targets=[heading_towards(31.0)])
    found = [
        measure(scenario, course.entry("modified"), OWN_PLOTS, 1000, mode=mode).success
        for mode in ("sound", "document")
    ]
    np.testing.assert_array_equal(*found)


def is_kept(first, second, tolerance, document):
    """Return whether two displacements, each (x, y), have one direction in a mode's sense."""
    (x1, y1), (x2, y2) = (np.float64(first), np.float64(second))
    if document:
        with np.errstate(all="ignore"):
            angles = np.arctan(x1 / -y1), np.arctan(x2 / -y2)
            return bool(abs(angles[0] - angles[1]) <= tolerance and (y2 / x2) / (y1 / x1) > 0)
    if (x1 == 0 == y1) or (x2 == 0 == y2):
        return False
    return abs(math.atan2(x1 * y2 - y1 * x2, x1 * x2 + y1 * y2)) <= tolerance


def brute_force(rows, interval, slowest, fastest, tolerance, document):
    steps = {}
    for a, (scan_a, *place_a) in enumerate(rows):
        for b, (scan_b, *place_b) in enumerate(rows):
            if scan_b == scan_a + 1:
                step = np.subtract(place_b, place_a)
                if slowest * interval <= math.sqrt(step @ step) <= fastest * interval:
                    steps[a, b] = step
    return [
        [a, b, d]
        for (a, b), first in steps.items()
        for (c, d), second in steps.items()
        if b == c and is_kept(first, second, tolerance, document)
    ]


def crowded(seed, scans):
    """Return plots on few places, so that they meet the gates exactly, lie along the axes and coincide."""
    generator = np.random.default_rng(seed)
    rows = []
    for scan in scans:
        places = generator.integers(-3, 4, (generator.integers(8), 2)).astype(float)
        rows.extend((scan, *place) for place in places)
    return rows


runs_of_scans = st.sampled_from(
    [(), (0, 1), (0, 1, 2), (5, 6, 7, 8), (0, 1, 3, 4, 5), (1, 2, 3, 5, 6, 7), (0, 2, 4)]
)
batches = st.builds(crowded, st.integers(0, 2**32), runs_of_scans)


@settings(steady, max_examples=300)
@given(
    st.lists(batches, min_size=1, max_size=3),
    st.sampled_from([0.0, 0.25, 0.5]),
    st.sampled_from([0.75, 1.25]),
    st.sampled_from([6.0, 37.3, 89.0]),
    st.sampled_from(["sound", "document"]),
)
def test_the_triples_are_those_of_three_nested_loops(chunk_of, trials, slowest, fastest, degrees, mode):
    parameters = ModifiedParameters(
        speed_min=slowest, speed_max=fastest, angle_tolerance_deg=degrees, mode=mode
    )
    found = MODIFIED.initiate_chunk(chunk_of(*trials), SCENE, parameters.resolved(SCENE))
    for index, trial in enumerate(trials):
        mine = found.plots[found.offsets[index] : found.offsets[index + 1]].tolist()
        expected = brute_force(trial, 4.0, slowest, fastest, math.radians(degrees), mode == "document")
        assert sorted(mine) == sorted(expected)


def one(rows, times=None, **given_values):
    rows = np.array(rows, dtype=float).reshape(-1, 3)
    time = rows[:, 0] * 4.0 if times is None else np.array(times, dtype=float)
    plots = Plots(rows[:, 0].astype(np.int32), time, np.ascontiguousarray(rows[:, 1:]))
    parameters = validated(ModifiedParameters, given_values, "modified").resolved(SCENE)
    return MODIFIED.initiate(plots, SCENE, parameters)


STRAIGHT = [(0, 0.0, 0.0), (1, 1.0, 0.5), (2, 2.0, 1.0)]


def test_a_track_has_the_line_and_the_state_of_its_plots():
    tracks = one(STRAIGHT)
    assert [rows.tolist() for rows in tracks.plots] == [[0, 1, 2]]
    assert tracks.score.tolist() == [3.0]
    assert math.degrees(tracks.theta[0]) == pytest.approx(math.degrees(math.atan2(1.0, -0.5)))
    assert tracks.rho[0] == pytest.approx(0.0, abs=1e-12)
    assert tracks.states.velocity[0] == pytest.approx([0.25, 0.125])
    assert tracks.states.position[0] == pytest.approx([0.0, 0.0], abs=1e-12)
    theta, rho = tracks.states.lines
    assert (theta[0], rho[0]) == pytest.approx((tracks.theta[0], 0.0), abs=1e-12)


def test_reversal_is_refused_in_sound_mode_and_kept_in_document_mode():
    back = [(0, 0.0, 0.0), (1, 1.0, 0.5), (2, 0.0, 0.0)]
    assert len(one(back)) == 0
    tracks = one(back, mode="document")
    assert len(tracks) == 1
    assert np.isfinite(tracks.theta).all()


@pytest.mark.parametrize(("x", "y"), [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_the_bounds_of_the_speed_belong_to_the_gate(x, y):
    rows = np.array([(0, 0.0, 0.0), (1, 3.0 * x, 3.0 * y), (2, 6.0 * x, 6.0 * y)])
    assert len(one(rows, speed_min=0.05, speed_max=0.75)) == 1
    assert len(one(rows, speed_min=0.75, speed_max=0.8)) == 1
    assert len(one(rows, speed_min=0.05, speed_max=0.7499)) == 0
    assert len(one(rows, speed_min=0.7501, speed_max=0.8)) == 0


def test_every_window_of_three_scans_is_searched():
    rows = [(scan, float(scan), 0.5 * scan) for scan in range(6)]
    assert [found.tolist() for found in one(rows).plots] == [[k, k + 1, k + 2] for k in range(4)]


def test_scans_that_are_missing_join_nothing():
    rows = [(scan, float(scan), 0.5 * scan) for scan in (0, 1, 3, 4, 6, 7)]
    assert len(one(rows)) == 0


def test_speeds_are_taken_from_the_times_of_the_plots():
    # 1.118 km in 4 s is .28 km/s; in 1 s it is beyond the gate.
    assert len(one(STRAIGHT, times=[0.0, 4.0, 8.0])) == 1
    assert len(one(STRAIGHT, times=[0.0, 1.0, 5.0])) == 0
    assert len(one(STRAIGHT, times=[0.0, 0.0, 4.0])) == 0
    assert len(one(STRAIGHT, times=[0.0, 40.0, 44.0])) == 0


def test_times_may_differ_within_a_scan():
    rows = [(0, 0.0, 0.0), (0, -2.0, -1.0), (1, 1.0, 0.5), (1, 1.5, 0.75), (2, 2.0, 1.0)]
    times = [0.0, 3.9, 4.0, 7.9, 8.0]
    # Steps from row 1 are too fast whatever their end, as is the one from row 3 in .1 s.
    assert [rows.tolist() for rows in one(rows, times=times, speed_min=0.0).plots] == [[0, 2, 4]]


def test_default_speeds_follow_the_unit():
    for unit in Unit:
        found = ModifiedParameters().resolved(Context(3, 4.0, unit=unit))
        assert found.speed_min * unit.metres == pytest.approx(50.0)
        assert found.speed_max * unit.metres == pytest.approx(700.0)


@pytest.mark.parametrize(
    "rows",
    [
        [],
        [(0, 1.0, 1.0)],
        [(0, 1.0, 1.0), (0, 2.0, 1.5), (0, 3.0, 2.0)],
        [(0, 1.0, 1.0), (1, 2.0, 1.5)],
        [(scan, 1.0, 1.0) for scan in (0, 0, 1, 1, 2, 2)],
    ],
    ids=["none", "one", "one scan", "two scans", "identical"],
)
@pytest.mark.parametrize("mode", ["sound", "document"])
@pytest.mark.parametrize("speed_min", [0.0, 0.05])
def test_too_little_gives_no_tracks(rows, mode, speed_min):
    assert len(one(rows, mode=mode, speed_min=speed_min)) == 0


def test_coordinates_of_a_billion_give_the_same_triples():
    generator = np.random.default_rng(3)
    rows = np.column_stack([np.repeat([0, 1, 2], 40), generator.integers(-320, 320, (120, 2)) / 64])
    near, far = one(rows), one(rows + np.array([0, 1e9, 1e9]))
    assert len(near) > 0
    assert [found.tolist() for found in near.plots] == [found.tolist() for found in far.plots]
    assert far.theta == pytest.approx(near.theta)
    assert far.states.velocity == pytest.approx(near.states.velocity, abs=1e-6)


def test_trials_without_plots_between_others_have_no_tracks(chunk_of):
    parameters = ModifiedParameters().resolved(SCENE)
    found = MODIFIED.initiate_chunk(chunk_of([], STRAIGHT, [], [], STRAIGHT, []), SCENE, parameters)
    assert found.counts.tolist() == [0, 1, 0, 0, 1, 0]
    assert found.plots.tolist() == [[0, 1, 2]] * 2
    assert found.votes_outside.tolist() == [0] * 6


def test_tracks_of_a_chunk_have_the_lines_of_their_own_plots(chunk_of):
    moved = [(scan, x + 50.0, y - 20.0) for scan, x, y in STRAIGHT]
    found = MODIFIED.initiate_chunk(chunk_of(STRAIGHT, moved), SCENE, ModifiedParameters().resolved(SCENE))
    expected = [one(rows).rho[0] for rows in (STRAIGHT, moved)]
    assert found.rho.tolist() == pytest.approx(expected)


def test_a_great_number_of_triples_is_kept_whole():
    generator = np.random.default_rng(11)
    place = generator.uniform(0, 2, (180, 2))
    scan = np.repeat(np.arange(3, dtype=np.int32), 60)
    chunk = PlotChunk(scan, scan * 4.0, place, np.array([0, 180]))
    parameters = ModifiedParameters(angle_tolerance_deg=80.0, speed_min=0.0).resolved(SCENE)
    found = MODIFIED.initiate_chunk(chunk, SCENE, parameters)
    first, second = place[60:120] - place[:60, None], place[120:] - place[60:120, None]
    dot = np.einsum("abk,bck->abc", first, second)
    cross = first[..., None, 0] * second[None, ..., 1] - first[..., None, 1] * second[None, ..., 0]
    near = np.abs(np.arctan2(cross, dot)) <= math.radians(80)
    slow = (np.hypot(*first.T).T <= 2.8)[..., None] & (np.hypot(*second.T).T <= 2.8)[None]
    assert found.counts[0] == (near & slow).sum() > 40_000


def test_more_triples_than_one_call_may_give_are_refused(monkeypatch, chunk_of):
    monkeypatch.setattr(modified, "LARGEST_RESULT", 5)
    rows = [(scan, float(scan), 0.5 * scan) for scan in range(7)]
    parameters = ModifiedParameters().resolved(SCENE)
    assert MODIFIED.initiate_chunk(chunk_of(rows), SCENE, parameters).counts.tolist() == [5]
    with pytest.raises(RequestError, match="more than 5 triples pass the gates; narrow speed_min"):
        MODIFIED.initiate_chunk(chunk_of([*rows, (7, 7.0, 3.5)]), SCENE, parameters)
