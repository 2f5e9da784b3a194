"""Draws of polar sensors, in space, and of several sensors."""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy import stats

from algorithms.errors import RequestError
from algorithms.parameters import validated
from scenarios.conversion import polar
from scenarios.experiments import MOST_TRIALS
from scenarios.model import Scenario
from scenarios.simulate import draw, truth
from scenarios.world import World

steady = settings(
    deadline=None, derandomize=True, max_examples=30, suppress_health_check=[HealthCheck.too_slow]
)

RADAR = {
    "kind": "polar",
    "sigma_range": 50,
    "sigma_azimuth_deg": 0.3,
    "sigma_elevation_deg": 0.2,
    "range": [1000, 40000],
    "azimuth_deg": [-20, 20],
    "elevation_deg": [0, 10],
}
LANDING = {"name": "landing", "position": [0, 30000, 2500], "velocity": [0, -250, -20]}


def scenario(**changes):
    given = {
        "name": "approach",
        "unit": "m",
        "scans": 4,
        "interval": 1,
        "sensor": RADAR,
        "targets": [LANDING],
    }
    return validated(Scenario, {**given, **changes}, "scenario")


def drawn(found, seed=1, first=0, trials=1):
    return draw(World.of(found), seed, first, trials)


def coordinates(position, station=(0.0, 0.0, 0.0)):
    distance, azimuth, elevation = polar(position - np.array(station)).T
    return distance, np.degrees(azimuth), np.degrees(elevation)


def test_plots_scatter_about_the_true_path_as_their_covariance_says():
    trials = 2000
    found = drawn(scenario(), trials=trials)
    place = found.chunk.position.reshape(trials, 4, 3)
    path = found.states.paths(0)[0]
    assert path[3] == pytest.approx([0.0, 29250.0, 2440.0])
    miss = (place - path).reshape(-1, 3)
    inverse = np.linalg.inv(found.chunk.covariance)
    squares = np.einsum("ni,nij,nj->n", miss, inverse, miss).sum()
    low, high = stats.chi2(3 * len(miss)).ppf([0.0005, 0.9995])
    assert low < squares < high
    distance, azimuth, elevation = coordinates(place.reshape(-1, 3))
    true = [values.repeat(trials).reshape(4, trials).T.ravel() for values in coordinates(path)]
    for measured, exact, sigma in zip((distance, azimuth, elevation), true, (50.0, 0.3, 0.2), strict=True):
        spread = np.std(measured - exact)
        assert spread == pytest.approx(sigma, rel=4.0 / math.sqrt(2 * len(measured)) + 0.002)


def test_the_covariance_of_a_plot_follows_from_where_it_lies():
    radar = {**RADAR, "position": [500, -800, 20]}
    found = scenario(sensor=radar)
    plots = drawn(found, trials=50).chunk
    told = found.sensor.covariance(plots.position)
    # A position is the mean of where a plot may come from, which lies nearer than what was measured.
    largest = np.abs(plots.covariance).max(axis=(1, 2), keepdims=True)
    np.testing.assert_allclose(told / largest, plots.covariance / largest, atol=1e-3)


@pytest.mark.parametrize("over", ["volume", "sector"])
def test_clutter_fills_the_sector_evenly(over):
    clutter = [{"kind": "exact", "count": 20000, "per": "batch", "over": over}]
    found = drawn(scenario(targets=[], clutter=clutter))
    distance, azimuth, elevation = coordinates(found.chunk.position)
    cubes = distance**3 if over == "volume" else distance
    heights = np.sin(np.radians(elevation)) if over == "volume" else elevation
    low, high = (1000.0**3, 40000.0**3) if over == "volume" else (1000.0, 40000.0)
    top = math.sin(math.radians(10.0)) if over == "volume" else 10.0
    for values, begin, end in ((cubes, low, high), (azimuth, -20.0, 20.0), (heights, 0.0, top)):
        assert stats.kstest(values, stats.uniform(begin, end - begin).cdf).pvalue > 1e-4
    assert (np.linalg.eigvalsh(found.chunk.covariance) > 0.0).all()


@pytest.mark.parametrize(
    ("position", "is_seen"),
    [
        ([0, 30000, 2500], True),
        ([0, 30000, 6000], False),
        ([0, 42000, 2500], False),
        ([0, 500, 20], False),
        ([15000, 30000, 2500], False),
        ([0, -30000, 2500], False),
    ],
)
def test_a_target_is_seen_in_the_sector_only(position, is_seen):
    found = drawn(scenario(targets=[{"position": position, "velocity": [0, 1, 0]}]), trials=20)
    assert len(found.origin) == (80 if is_seen else 0)


def test_a_sector_may_lie_across_north_and_south():
    for azimuths, at in (([-20, 20], [0, 9000]), ([340, 380], [0, 9000]), ([170, 190], [0, -9000])):
        radar = {"kind": "polar", "sigma_range": 0, "sigma_azimuth_deg": 0, "range": [0, 10000]}
        radar["azimuth_deg"] = azimuths
        for x in (-100.0, 100.0):
            target = {"position": [x, at[1]], "velocity": [0, 0]}
            found = drawn(scenario(sensor=radar, targets=[target]))
            np.testing.assert_allclose(found.chunk.position, [[x, at[1]]] * 4, atol=1e-6)


@steady
@given(st.integers(0, 2**64 - 1), st.integers(0, MOST_TRIALS - 5), st.integers(1, 4))
def test_a_trial_is_the_same_alone_as_in_a_chunk(seed, first, trials):
    clutter = [{"rate": 3, "over": "volume"}, {"kind": "exact", "count": 5, "per": "batch", "over": "sector"}]
    radar = {**RADAR, "detection_probability": 0.7}
    second = {**radar, "position": [2000, 0, 0], "first_scan": 0.4, "azimuth_deg": [-30, 10]}
    target = {**LANDING, "spread": [100, 200, 50]}
    both = scenario(sensor=radar, further_sensors=[second], clutter=clutter, targets=[target])
    chunk = drawn(both, seed, first, trials)
    for index in range(trials):
        alone = drawn(both, seed, first + index)
        rows = slice(chunk.chunk.offsets[index], chunk.chunk.offsets[index + 1])
        for name in ("scan", "time", "position", "covariance"):
            np.testing.assert_array_equal(getattr(chunk.chunk, name)[rows], getattr(alone.chunk, name))
        np.testing.assert_array_equal(chunk.origin[rows], alone.origin)


def test_plots_of_several_sensors_are_merged_in_the_order_of_time():
    second = {**RADAR, "position": [3000, 0, 0], "first_scan": 0.5, "sigma_range": 10, "period": 2}
    both = scenario(further_sensors=[second])
    found = drawn(both, trials=300)
    plots = found.chunk.trial(0)
    assert plots.time.tolist() == [0.0, 0.5, 1.0, 2.0, 2.5, 3.0, 4.5, 6.5]
    assert plots.scan.tolist() == list(range(8))
    # The first sensor sees what it sees alone.
    alone = drawn(scenario(), trials=300)
    first = np.isin(found.chunk.time, [0.0, 1.0, 2.0, 3.0])
    np.testing.assert_array_equal(found.chunk.position[first], alone.chunk.position)
    np.testing.assert_array_equal(found.chunk.covariance[first], alone.chunk.covariance)
    # Each measures from its own place, with its own noise.
    path = np.array([0.0, 30000.0, 2500.0]) + found.chunk.time[~first, None] * np.array([0.0, -250.0, -20.0])
    distance, _, _ = coordinates(found.chunk.position[~first], (3000.0, 0.0, 0.0))
    exact, _, _ = coordinates(path, (3000.0, 0.0, 0.0))
    assert np.std(distance - exact) == pytest.approx(10.0, rel=0.1)
    context = both.context
    assert (context.scans, context.interval) == (8, pytest.approx(6.5 / 7))
    assert both.last_time == 6.5


def test_the_control_keeps_the_covariances_of_clutter():
    found = drawn(scenario(clutter=[{"rate": 20, "over": "volume"}]), trials=10)
    control = found.without_targets()
    assert len(control.chunk.covariance) == len(control.chunk.position) == (found.origin < 0).sum()
    np.testing.assert_array_equal(control.chunk.covariance, found.chunk.covariance[found.origin < 0])


def test_birth_and_death_are_on_the_grid_of_scans():
    # 3 × 0.1 is more than 0.3 in floating point, 7 × 0.1 more than 0.7.
    sensor = {"sigma": 0.0}
    found = scenario(
        interval=0.1,
        scans=9,
        sensor=sensor,
        further_sensors=[{**sensor, "period": 0.3}, {**sensor, "first_scan": 0.7}],
        region={"x": [0, 10], "y": [0, 10]},
        targets=[{"position": [1, 2], "velocity": [1, 0], "birth": 3, "death": 6},
                 {"position": [1, 2], "velocity": [1, 0], "birth": 7}],
    )  # fmt: skip
    plots, origin = drawn(found).chunk, drawn(found).origin
    times = {target: sorted(np.round(plots.time[origin == target], 6).tolist()) for target in (0, 1)}
    assert times[0] == [0.3, 0.3, 0.4, 0.5, 0.6, 0.6]
    every_interval, slow = [0.7, 0.8], [0.9, 1.2, 1.5, 1.8, 2.1, 2.4]
    late = [0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5]
    assert times[1] == sorted([*every_interval, *slow, *late])


def test_truth_in_space_has_the_lines_of_the_plane():
    climbing = {"position": [0, 20000, 1000], "velocity": [0, 0, 30]}
    found = drawn(scenario(targets=[LANDING, climbing]), trials=2)
    known = truth(scenario(targets=[LANDING, climbing]), found)
    assert known.theta[:, 0] == pytest.approx(0.0)
    assert known.rho[:, 0] == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(known.theta[:, 1]).all()
    assert known.middle[0, 0] == pytest.approx([0.0, 29625.0])


def test_the_region_of_a_polar_scenario_is_the_box_around_its_sector():
    box = scenario().box
    reach = 40000.0
    ground = reach * math.sin(math.radians(20.0))
    assert box.lower == pytest.approx(
        (-ground, 1000 * math.cos(math.radians(20)) * math.cos(math.radians(10)), 0)
    )
    assert box.upper == pytest.approx((ground, reach, reach * math.sin(math.radians(10.0))))
    clutter = [{"kind": "exact", "count": 5000, "per": "batch", "over": "volume"}]
    place = drawn(scenario(targets=[], clutter=clutter)).chunk.position
    assert (place >= np.array(box.lower) - 1e-6).all()
    assert (place <= np.array(box.upper) + 1e-6).all()


def test_cartesian_sensors_in_space():
    found = drawn(
        scenario(sensor={"sigma": [1, 2, 3]}, region={"x": [-9e3, 9e3], "y": [0, 4e4], "z": [0, 5e3]}),
        trials=3000,
    )
    path = found.states.paths(0)[0]
    miss = found.chunk.position.reshape(-1, 4, 3) - path
    assert miss.reshape(-1, 3).std(axis=0) == pytest.approx([1.0, 2.0, 3.0], rel=0.04)
    assert found.chunk.covariance is None


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"targets": [{"position": [1, 2], "velocity": [3, 4]}]},
            r"sensor is in space .* targets\[0\] is in the plane",
        ),
        ({"targets": [{"position": [1, 2, 3], "velocity": [3, 4]}]}, "velocity has 2 numbers and position 3"),
        ({"sensor": {"sigma": 1}}, "region is missing; a cartesian sensor sees everything"),
        (
            {"sensor": {"sigma": 1}, "region": {"x": [0, 1], "y": [0, 1], "z": [0, 1]},
             "clutter": [{"rate": 1, "over": "volume"}]},
            "a cartesian sensor has no sector",
        ),
        ({"sensor": {**RADAR, "azimuth_deg": [0, 721]}}, "must be at most 720"),
        ({"sensor": {**RADAR, "azimuth_deg": [-300, 300]}}, "azimuth_deg spans 600°"),
        ({"sensor": {**RADAR, "sigma_elevation_deg": None}}, "elevation_deg is given without"),
        ({"sensor": {**RADAR, "range": [5, 1]}}, "spans nothing"),
        ({"sensor": {"kind": "sonar"}}, "there is no kind 'sonar'"),
    ],
)  # fmt: skip
def test_what_does_not_fit_together_is_refused_in_words(changes, message):
    with pytest.raises(RequestError, match=message):
        scenario(**changes)
