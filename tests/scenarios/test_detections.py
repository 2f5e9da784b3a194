"""Points of sensors of high resolution, and the plots that are made of them."""

import copy

import numpy as np
import pytest

from algorithms.clustering.parameters import Recommended
from algorithms.errors import RequestError
from scenarios.detections import ResolvedWorld, draw_points
from scenarios.files.marked_yaml import write
from scenarios.files.set_files import load_set, parse_set
from scenarios.front_end import clustered, dwell_offsets, every_point
from scenarios.model import Scenario

SENSOR = {
    "kind": "polar",
    "sigma_range": 0.01,
    "sigma_azimuth_deg": 0.05,
    "range": [1, 60],
    "azimuth_deg": [-60, 60],
    "resolution": {"range_cell": 0.02, "beam_width_deg": 0.7, "doppler_cell": 0.001, "doppler_cells": 300},
}
EXTENT = {"points": 30, "range_spread": 0.06, "doppler_spread": 0.003, "correlation": -0.5, "amplitude": 2.0}
SCENARIO = {
    "name": "resolved",
    "unit": "km",
    "scans": 6,
    "interval": 4,
    "sensor": SENSOR,
    "clutter": [{"rate": 25, "over": "sector"}],
    "targets": [
        {"position": [-12, 30], "velocity": [0.1, -0.05], "extended": EXTENT},
        {"position": [15, 35], "velocity": [0.02, 0.3], "spread": 1.0, "extended": EXTENT},
        {"position": [0, 20], "velocity": [0.1, 0.0]},
    ],
}
CLUSTERING = Recommended(range_extent=20.0, doppler_extent=20.0)


def scenario(**changes) -> Scenario:
    return Scenario.model_validate({**copy.deepcopy(SCENARIO), **changes})


def columns(drawn):
    return {
        name: getattr(drawn, name)
        for name in ("scan", "time", "beam", "range", "doppler", "amplitude", "origin")
    }


def equal(first, second):
    for name, values in columns(first).items():
        np.testing.assert_array_equal(values, columns(second)[name], err_msg=name)


def part(drawn, trial):
    rows = slice(*drawn.offsets[trial : trial + 2])
    return {name: values[rows] for name, values in columns(drawn).items()}


def drawn_of(given, seed=3, first=0, trials=1):
    return draw_points(ResolvedWorld.of(given), seed, first, trials)


def test_a_trial_is_the_same_draw_in_any_chunk():
    whole = drawn_of(scenario(), trials=5)
    for trial in range(5):
        alone = drawn_of(scenario(), first=trial)
        for name, values in part(whole, trial).items():
            np.testing.assert_array_equal(values, columns(alone)[name], err_msg=name)


def test_fewer_scans_are_the_first_part_of_more():
    long, short = drawn_of(scenario()), drawn_of(scenario(scans=4))
    rows = long.scan < 4
    for name, values in columns(short).items():
        np.testing.assert_array_equal(values, columns(long)[name][rows], err_msg=name)


def test_without_targets_the_clutter_is_the_same():
    control = drawn_of(scenario(), trials=4).without_targets()
    equal(control, drawn_of(scenario(targets=[]), trials=4))
    assert np.diff(control.offsets).sum() == len(control.scan)


def test_points_are_sorted_and_within_their_cells():
    drawn = drawn_of(scenario(), trials=3)
    trial = np.repeat(np.arange(3), np.diff(drawn.offsets))
    keys = (drawn.doppler, drawn.range, drawn.beam, drawn.scan, trial)
    assert (np.lexsort(keys) == np.arange(len(trial))).all()
    for cells in (drawn.range, drawn.doppler):
        assert (cells == np.floor(cells)).all()
    assert (drawn.doppler >= 0).all()
    assert (drawn.doppler < 300).all()
    assert (drawn.beam >= 0).all()
    assert (drawn.beam < np.ceil(120 / 0.7)).all()


def test_the_points_of_a_target_lie_about_its_place_and_speed():
    trials, given = 300, scenario(clutter=[])
    drawn = drawn_of(given, trials=trials)
    number = trials * 6 * 30
    own = drawn.origin == 0
    assert own.sum() == number
    assert (drawn.origin == 2).sum() == trials * 6
    time = drawn.time[own]
    x, y = -12 + 0.1 * time, 30 - 0.05 * time
    distance = np.hypot(x, y)
    speed = (0.1 * x - 0.05 * y) / distance
    along = (drawn.range[own] + 0.5) * 0.02 - distance
    doppler = (drawn.doppler[own] + 0.5 - 150) * 0.001 - speed
    # The noise of a scan is common to its points; rounding to cells adds a twelfth.
    variance = 0.06**2 + 0.01**2 + 0.02**2 / 12
    assert along.var() == pytest.approx(variance, rel=0.03)
    assert along.mean() == pytest.approx(0.0, abs=4 * np.sqrt(0.01**2 / (trials * 6) + 0.06**2 / number))
    assert doppler.var() == pytest.approx(0.003**2 + 0.001**2 / 12, rel=0.03)
    assert doppler.mean() == pytest.approx(0.0, abs=4 * 0.003 / np.sqrt(number))
    assert np.mean(along * doppler) == pytest.approx(-0.5 * 0.06 * 0.003, rel=0.06)
    assert np.mean(drawn.amplitude[own] ** 2) == pytest.approx(2 * 2.0**2, rel=0.03)
    # The beam holds the measured azimuth; one dwell a scan.
    azimuth = np.degrees(np.arctan2(x, y))
    centre = -60 + (drawn.beam[own] + 0.5) * 0.7
    assert np.abs(centre - azimuth).max() < 0.35 + 5 * 0.05
    assert (centre - azimuth).std() == pytest.approx(np.hypot(0.7 / np.sqrt(12), 0.05), rel=0.25)
    trial = np.repeat(np.arange(trials), np.diff(drawn.offsets))
    assert np.unique(np.stack([trial, drawn.scan, drawn.beam])[:, own], axis=1).shape[1] == trials * 6


def test_doppler_folds():
    fast = {"position": [0, 30], "velocity": [0.0, 0.4], "extended": {**EXTENT, "doppler_spread": 0.0}}
    drawn = drawn_of(scenario(targets=[fast], clutter=[]))
    # 400 m/s in a span of 300 m/s looks like 100 m/s.
    assert set(drawn.doppler) == {(400 + 150) % 300}
    plots = clustered(ResolvedWorld.of(scenario(targets=[fast])), drawn, CLUSTERING).chunk
    assert plots.doppler == pytest.approx(0.1, abs=0.001)


def test_clutter_is_uniform_in_doppler_and_amplitudes_are_rayleigh():
    drawn = drawn_of(scenario(targets=[], clutter=[{"rate": 400, "over": "sector"}]), trials=20)
    number = len(drawn.scan)
    assert number == pytest.approx(20 * 6 * 400, rel=4 / np.sqrt(20 * 6 * 400))
    counts = np.bincount((drawn.doppler // 30).astype(int), minlength=10)
    assert ((counts - number / 10) ** 2 / (number / 10)).sum() < 35  # χ² of 9 degrees, p of 6e-5
    assert np.mean(drawn.amplitude**2) == pytest.approx(2.0, rel=4 / np.sqrt(number))
    assert (drawn.origin == -1).all()


def test_every_point_may_be_a_plot():
    resolved, drawn = ResolvedWorld.of(scenario()), drawn_of(scenario(), trials=2)
    plots = every_point(resolved, drawn)
    chunk = plots.chunk
    assert len(chunk.scan) == len(drawn.scan)
    np.testing.assert_array_equal(plots.origin, drawn.origin)
    np.testing.assert_array_equal(chunk.offsets, drawn.offsets)
    azimuth = np.radians(-60 + (drawn.beam + 0.5) * 0.7)
    along = (drawn.range + 0.5) * 0.02
    sine = np.stack([np.sin(azimuth), np.cos(azimuth)], axis=1)
    # The unscented transform draws a plot in by half the variance of its azimuth.
    assert chunk.position == pytest.approx(along[:, None] * sine, rel=1e-4, abs=1e-2)
    across = np.stack([sine[:, 1], -sine[:, 0]], axis=1)
    radial = np.einsum("ni,nij,nj->n", sine, chunk.covariance, sine)
    lateral = np.einsum("ni,nij,nj->n", across, chunk.covariance, across)
    assert radial == pytest.approx(0.01**2 + 0.02**2 / 12, rel=0.05)
    assert lateral == pytest.approx(along**2 * np.radians(np.hypot(0.05, 0.7 / np.sqrt(12))) ** 2, rel=0.01)


def test_a_target_may_be_seen_as_one_point():
    resolved = ResolvedWorld.of(scenario())
    ideal = draw_points(resolved.ideal(), 3, 0, 40)
    assert [(ideal.origin == target).sum() for target in range(3)] == [40 * 6] * 3
    equal(ideal.without_targets(), draw_points(resolved, 3, 0, 40).without_targets())


def test_plots_of_clusters_against_the_truth():
    trials, given = 60, scenario(scans=3)
    resolved = ResolvedWorld.of(given)
    drawn = draw_points(resolved, 3, 0, trials)
    plots = clustered(resolved, drawn, CLUSTERING)
    chunk = plots.chunk
    # A target of one point is no cluster, and neither is clutter that is alone in its dwell.
    assert set(plots.origin) == {0, 1}
    assert [(plots.origin == target).sum() for target in (0, 1)] == pytest.approx([180, 180], abs=2)
    trial = np.repeat(np.arange(trials), np.diff(chunk.offsets))
    place = plots.states.position[trial, chunk.scan, plots.origin]
    error = chunk.position - place
    normal = np.einsum("ni,nij,nj->n", error, np.linalg.inv(chunk.covariance), error)
    # Two degrees of freedom; the error of a beam is even, which scatters less than χ².
    assert normal.mean() == pytest.approx(2.0, abs=0.35)
    radial = np.einsum("ni,ni->n", error, place / np.linalg.norm(place, axis=1)[:, None])
    assert radial.std() == pytest.approx(np.sqrt(0.01**2 + 4 / np.pi * 0.06**2 / 30), rel=0.15)
    assert (np.diff(chunk.scan)[np.diff(trial) == 0] >= 0).all()


def test_a_target_at_the_fold_is_one_cluster():
    at_fold = {"position": [0, 30], "velocity": [0.0, 0.15], "extended": EXTENT}
    given = scenario(targets=[at_fold], clutter=[])
    resolved, drawn = ResolvedWorld.of(given), drawn_of(given, trials=20)
    assert drawn.doppler.min() < 20
    assert drawn.doppler.max() > 280
    plots = clustered(resolved, drawn, CLUSTERING)
    assert len(plots.origin) == 20 * 6
    away = np.abs(np.abs(plots.chunk.doppler) - 0.15)
    assert away.max() < 0.003


def test_dwells_are_those_of_a_loop():
    drawn = drawn_of(scenario(), trials=3)
    trial = np.repeat(np.arange(3), np.diff(drawn.offsets))
    keys = list(zip(trial.tolist(), drawn.scan.tolist(), drawn.beam.tolist(), strict=True))
    expected = [index for index, key in enumerate(keys) if index == 0 or keys[index - 1] != key]
    assert dwell_offsets(drawn).tolist() == [*expected, len(keys)]
    assert dwell_offsets(drawn_of(scenario(targets=[], clutter=[]))).tolist() == [0]


def test_without_points_there_are_no_plots():
    given = scenario(targets=[], clutter=[])
    plots = clustered(ResolvedWorld.of(given), drawn_of(given, trials=2), CLUSTERING)
    assert plots.chunk.offsets.tolist() == [0, 0, 0]


SET = {
    "schema": 1,
    "name": "points",
    "scenarios": [SCENARIO],
    "clusterings": [
        {"name": "recommended", "range_extent": 20, "doppler_extent": 20},
        {"name": "k-means", "range_extent": 20, "doppler_extent": 20, "number": 2},
    ],
    "initiators": [{"name": "standard"}],
    "experiments": [{"name": "all", "clusterings": ["none", "recommended"], "criterion": {"plots": 3}}],
}


def test_the_set_is_sound_as_it_is():
    assert parse_set(write(copy.deepcopy(SET)), "points.yaml").scenarios[0].is_resolved


REFUSED = {
    "no clusterings": (
        lambda data: data["experiments"][0].pop("clusterings"),
        ["experiments[0].clusterings", "none (every point is a plot)", "ideal"],
    ),
    "an unknown clustering": (
        lambda data: data["experiments"][0].update(clusterings=["recomended"]),
        ["experiments[0].clusterings[0]", "did you mean 'recommended'", "none", "ideal"],
    ),
    "k-means": (
        lambda data: data["experiments"][0].update(clusterings=["none", "k-means"]),
        ["experiments[0].clusterings[1]", "no sensor knows"],
    ),
    "clusterings without points": (
        lambda data: (
            data["scenarios"][0]["sensor"].pop("resolution"),
            [target.pop("extended", None) for target in data["scenarios"][0]["targets"]],
        ),
        ["experiments[0].clusterings", "no sensor of high resolution"],
    ),
    "extended before a sensor that sees one plot": (
        lambda data: data["scenarios"][0]["sensor"].pop("resolution"),
        ["scenarios[0]", "targets[0] is extended", "resolution"],
    ),
    "clutter beyond the sector": (
        lambda data: data["scenarios"][0].update(clutter=[{"rate": 3}]),
        ["scenarios[0]", "clutter[0] is over: region", "over: sector"],
    ),
    "in space": (
        lambda data: data["scenarios"][0]["sensor"].update(sigma_elevation_deg=0.1),
        ["scenarios[0].sensor", "resolution is given with sigma_elevation_deg"],
    ),
    "one Doppler cell": (
        lambda data: data["scenarios"][0]["sensor"]["resolution"].update(doppler_cells=1),
        ["scenarios[0].sensor.resolution.doppler_cells", "1 is given", "at least 2"],
    ),
    "one sensor of two": (
        lambda data: data["scenarios"][0].update(
            further_sensors=[{key: value for key, value in SENSOR.items() if key != "resolution"}]
        ),
        ["scenarios[0]", "some sensors have a resolution"],
    ),
    "a reserved name": (
        lambda data: data["clusterings"][1].update(name="ideal", mode="k-means"),
        ["clusterings[1].name", "'ideal'", "another name"],
    ),
    "a sweep that not every clustering has": (
        lambda data: data["experiments"][0].update(sweep={"clustering.range_extent": [10]}),
        ["experiments[0].sweep.clustering.range_extent", "must belong to every clustering"],
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused(case):
    change, words = REFUSED[case]
    data = copy.deepcopy(SET)
    change(data)
    with pytest.raises(RequestError) as caught:
        parse_set(write(data), "points.yaml")
    for word in words:
        assert word in str(caught.value), str(caught.value)


def test_the_bundled_scenario_is_told_to_initiators_with_its_cells():
    (given,) = load_set("range-doppler").scenarios
    sensor = given.sensor
    assert sensor.sigmas[0] == pytest.approx(np.hypot(0.005, 0.015 / np.sqrt(12)))
    assert sensor.sigmas[1] == pytest.approx(np.radians(np.hypot(0.1, 0.5 / np.sqrt(12))))
    assert sensor.resolution.span == pytest.approx(0.4)
