"""Motions of targets: closed forms, process noise, prefixes, and the lines that stand for curved paths."""

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy import stats

from algorithms.errors import RequestError
from algorithms.parameters import validated
from scenarios.detections import ResolvedWorld, draw_points
from scenarios.experiments import MOST_TRIALS
from scenarios.model import Scenario
from scenarios.simulate import draw, truth
from scenarios.world import World

SIGMA_0 = {"sigma": 0.0}
PLANE = {"x": [0, 100], "y": [0, 100]}
SPACE = {**PLANE, "z": [0, 10]}
TURN = {"kind": "turn", "rate_deg": 2.0}
MOTIONS = {
    "constant-velocity": {"kind": "constant-velocity"},
    "acceleration": {"kind": "acceleration", "acceleration": [0.002, -0.004]},
    "turn": TURN,
    "waypoints": {"kind": "waypoints", "points": [[46, 20], [46, 24], [40, 24]]},
}


def scenario(*motions, scans=15, region=PLANE, sensor=SIGMA_0, **changes):
    ends = slice(0, len(region))
    targets = [
        {"position": [40, 20, 3][ends], "velocity": [0.3, 0.18, 0.01][ends], "motion": motion}
        for motion in motions
    ]
    parts = {"name": "moving", "scans": scans, "interval": 4, "region": region, "sensor": sensor}
    return validated(Scenario, {**parts, "targets": targets, **changes}, "scenario")


def drawn(of, seed=1, first=0, trials=1):
    return draw(World.of(of), seed, first, trials)


def plots(of):
    """Return the plots of the first target of a scenario, without noise."""
    found = drawn(of)
    return found.chunk.position[found.origin == 0]


@pytest.mark.parametrize("rate", [1.0, 2.0, 3.0, -3.0, 1e-9])
@pytest.mark.parametrize("region", [PLANE, SPACE])
def test_a_turn_is_flown_on_its_circle(rate, region):
    # x + iy about the centre of the circle; a turn to the right goes with the clock.
    omega, speed, elapsed = -math.radians(rate), 0.3 + 0.18j, 4.0 * np.arange(15)
    moved = speed * np.expm1(1j * omega * elapsed) / (1j * omega)
    expected = np.stack([40 + moved.real, 20 + moved.imag, 3 + 0.01 * elapsed], axis=1)[:, : len(region)]
    turning = scenario({"kind": "turn", "rate_deg": rate}, region=region)
    np.testing.assert_allclose(plots(turning), expected, rtol=0, atol=1e-9)
    states = drawn(turning).states
    heading = np.degrees(np.arctan2(states.velocity[0, :, 0, 0], states.velocity[0, :, 0, 1]))
    turned = (heading - heading[0] + 180.0) % 360.0 - 180.0
    np.testing.assert_allclose(turned, (rate * elapsed + 180.0) % 360.0 - 180.0, atol=1e-9)
    assert np.hypot(*states.velocity[0, :, 0, :2].T) == pytest.approx(abs(speed))


def test_a_turn_of_rate_zero_is_a_straight_path():
    straight, turning = scenario({}), scenario({"kind": "turn", "rate_deg": 0})
    np.testing.assert_allclose(plots(turning), plots(straight), rtol=0, atol=1e-12)


def test_an_accelerating_target_gains_speed():
    elapsed = 4.0 * np.arange(15)[:, None]
    acceleration = np.array([0.002, -0.004, 0.0005])
    motion = {"kind": "acceleration", "acceleration": acceleration.tolist()}
    accelerating = scenario(motion, region=SPACE)
    start, velocity = np.array([40, 20, 3]), np.array([0.3, 0.18, 0.01])
    expected = start + velocity * elapsed + acceleration * elapsed**2 / 2
    np.testing.assert_allclose(plots(accelerating), expected, rtol=0, atol=1e-9)
    speeds = drawn(accelerating).states.velocity[0, :, 0]
    np.testing.assert_allclose(speeds, velocity + acceleration * elapsed, rtol=0, atol=1e-12)


def test_waypoints_are_reached_at_the_speed_of_the_target():
    # At 0.5 km/s the legs of 6, 4 and 6 km take 12, 8 and 12 s; then it flies on.
    motion = MOTIONS["waypoints"]
    target = {"position": [40, 20], "velocity": [0.3, 0.4], "motion": motion}
    flying = scenario(targets=[target], scans=10)
    expected = [
        (40, 20),
        (42, 20),
        (44, 20),
        (46, 20),
        (46, 22),
        (46, 24),
        (44, 24),
        (42, 24),
        (40, 24),
        (38, 24),
    ]
    np.testing.assert_allclose(plots(flying), expected, rtol=0, atol=1e-9)
    velocity = drawn(flying).states.velocity[0, :, 0]
    legs = [(0.5, 0)] * 3 + [(0, 0.5)] * 2 + [(-0.5, 0)] * 5
    np.testing.assert_allclose(velocity, legs, rtol=0, atol=1e-12)


def test_a_straight_path_is_what_it_was_to_the_byte():
    target = {"position": [40.1, 20.3], "velocity": [0.3, 0.18], "spread": [2, 3], "birth": 2, "death": 12}
    moving = scenario(targets=[target], interval=0.7)
    found = drawn(moving, trials=20)
    start = np.array([40.1, 20.3]) + found.states.shift[:, None, 0]
    expected = start + np.array([0.3, 0.18]) * (found.states.time[2:13, None] - 2 * 0.7)
    assert found.chunk.position.tobytes() == expected.reshape(-1, 2).tobytes()


@pytest.mark.parametrize("kind", MOTIONS)
def test_birth_and_death_bound_every_motion(kind):
    target = {"position": [40, 20], "velocity": [0.3, 0.4], "motion": MOTIONS[kind]}
    late = scenario(targets=[{**target, "birth": 3, "death": 8}])
    states, origin = drawn(late).states, drawn(late).chunk.scan
    assert origin.tolist() == states.present[:, 0].nonzero()[0].tolist() == list(range(3, 9))
    assert np.isnan(states.position[0, [0, 1, 2, 9, 14]]).all()
    np.testing.assert_allclose(plots(late), plots(scenario(targets=[target]))[:6], rtol=0, atol=1e-12)


NOISY = [{**motion, "process_noise": 0.003} for motion in MOTIONS.values()]
BUSY = {"sensor": {"sigma": 0.1, "detection_probability": 0.8}, "clutter": [{"rate": 3}]}


@settings(deadline=None, derandomize=True, max_examples=30, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, 2**64 - 1), st.integers(0, MOST_TRIALS - 3))
def test_fewer_scans_of_any_motion_are_the_first_part_of_more(seed, trial):
    short, long = (drawn(scenario(*NOISY, scans=scans, **BUSY), seed, trial, 2) for scans in (5, 15))
    states = long.states
    np.testing.assert_array_equal(short.states.position, states.position[:, :5])
    np.testing.assert_array_equal(short.states.velocity, states.velocity[:, :5])
    for index in range(2):
        one, other = short.chunk.trial(index), long.chunk.trial(index)
        np.testing.assert_array_equal(one.position, other.position[other.scan < 5])
    alone = drawn(scenario(*NOISY, **BUSY), seed, trial + 1)
    np.testing.assert_array_equal(alone.states.position[0], states.position[1])


def test_process_noise_is_an_acceleration_of_each_interval():
    noise, trials = np.array([0.003, 0.001]), 400
    disturbed = scenario({"process_noise": noise.tolist()}, scans=11)
    states = drawn(disturbed, trials=trials).states
    place, speed = states.position[:, :, 0], states.velocity[:, :, 0]
    acceleration = np.diff(speed, axis=1) / 4.0
    moved = 4.0 * speed[:, :-1] + 0.5 * 16.0 * acceleration
    np.testing.assert_allclose(np.diff(place, axis=1), moved, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(place[:, 0], np.broadcast_to([40.0, 20.0], (trials, 2)))
    count = trials * 10
    for values, sigma in zip(acceleration.reshape(count, 2).T, noise, strict=True):
        # P[√n·D > 2.2] is 1.3e-4 (Kolmogorov).
        assert stats.kstest(values / sigma, "norm").statistic * math.sqrt(count) < 2.2
    assert abs(np.corrcoef(acceleration[:, 0, 0], acceleration[:, 1, 0])[0, 1]) < 4.0 / math.sqrt(trials)
    assert abs(np.corrcoef(acceleration.reshape(count, 2).T)[0, 1]) < 4.0 / math.sqrt(count)


def test_process_noise_does_not_depend_on_who_looks():
    disturbed = {"process_noise": 0.002, **TURN}
    alone, two = (
        drawn(scenario(disturbed, region=SPACE, further_sensors=further), 5, 3).states
        for further in ([], [{**SIGMA_0, "period": 1.0, "first_scan": 0.5}])
    )
    own = np.isin(two.time, alone.time) & (two.time % 4.0 == 0.0)
    np.testing.assert_array_equal(two.position[0, own], alone.position[0, : own.sum()])
    # Between the scans of the first sensor, too, the random part is half the acceleration times time squared.
    calm = drawn(
        scenario(TURN, region=SPACE, further_sensors=[{**SIGMA_0, "period": 1.0, "first_scan": 0.5}])
    )
    part = two.velocity[0, :, 0] - calm.states.velocity[0, :, 0]
    within = [index for index, time in enumerate(two.time) if 4.0 <= time < 8.0]
    rates = np.diff(part[within], axis=0) / np.diff(two.time[within])[:, None]
    np.testing.assert_allclose(rates, np.broadcast_to(rates[0], rates.shape), atol=1e-12)


def test_a_disturbed_target_leaves_the_other_draws_alone():
    calm, disturbed = (
        drawn(scenario(motion, scans=6, **BUSY), 7, 2, 3)
        for motion in (TURN, {**TURN, "process_noise": 0.01})
    )
    np.testing.assert_array_equal(calm.origin, disturbed.origin)
    own = calm.origin == 0
    np.testing.assert_array_equal(calm.chunk.position[~own], disturbed.chunk.position[~own])
    moved = disturbed.states.position - calm.states.position
    trial = np.repeat(np.arange(3), np.diff(calm.chunk.offsets))
    apart = disturbed.chunk.position[own] - calm.chunk.position[own]
    np.testing.assert_allclose(apart, moved[trial, calm.chunk.scan, 0][own], atol=1e-12)


@pytest.mark.parametrize("motion", [TURN, MOTIONS["acceleration"], {"process_noise": 0.003}])
def test_the_line_of_a_curved_path_is_its_least_squares_fit(motion):
    curved = scenario(motion, scans=6)
    found = drawn(curved, trials=3)
    known = truth(curved, found)
    for trial in range(3):
        path = found.states.paths(trial)[0]
        velocity, place = np.polyfit(found.states.time, path, 1)
        x, y = known.middle[trial, 0]
        assert (x, y) == pytest.approx(tuple(path.mean(axis=0)))
        theta, rho = known.theta[trial, 0], known.rho[trial, 0]
        assert abs(velocity @ [math.cos(theta), math.sin(theta)]) < 1e-12
        assert place @ [math.cos(theta), math.sin(theta)] == pytest.approx(rho)
        assert x * math.cos(theta) + y * math.sin(theta) == pytest.approx(rho)


def test_a_curved_path_of_one_scan_or_none_has_the_line_of_its_velocity():
    once = {"position": [40, 20], "velocity": [0.3, 0.18], "motion": TURN, "birth": 2, "death": 2}
    known = truth(found := scenario(targets=[once, {**once, "birth": 90, "death": 95}]), drawn(found))
    assert np.degrees(known.theta[0, 0]) == pytest.approx(120.96, abs=0.005)
    assert np.isnan(known.theta[0, 1])


def test_a_target_is_still_only_where_nothing_moves_it():
    def still(**changes):
        target = {"position": [40, 20, 3], "velocity": [0, 0, 1], **changes}
        return scenario(targets=[target], region=SPACE).targets[0].stands_still

    assert still()
    assert still(motion=TURN)
    assert still(motion={"kind": "acceleration", "acceleration": [0, 0, 1]})
    assert not still(motion={"kind": "acceleration", "acceleration": [0.1, 0, 0]})
    assert still(motion={"kind": "waypoints", "points": [[40, 20, 5]]})
    assert not still(motion={"kind": "waypoints", "points": [[40, 21, 5]]})


def test_clutter_about_the_targets_covers_a_turn():
    clutter = [{"kind": "exact", "count": 800, "per": "batch", "over": "targets"}]
    # Half a circle to the right, eastward again in scan 15: its width is twice the radius of 5.73 km.
    turning = scenario({"kind": "turn", "rate_deg": 3.0}, scans=16, clutter=clutter)
    found = drawn(turning)
    path = found.states.paths(0)[0]
    clouds = found.without_targets().chunk.position
    assert (clouds >= path.min(axis=0) - 1e-9).all()
    assert (clouds <= path.max(axis=0) + 1e-9).all()
    assert np.ptp(clouds, axis=0) == pytest.approx(np.ptp(path, axis=0), rel=0.02)


def test_radial_speed_is_that_of_the_turning_target():
    sensor = {
        "kind": "polar",
        "sigma_range": 0.0,
        "sigma_azimuth_deg": 0.0,
        "range": [1, 90],
        "azimuth_deg": [-90, 90],
        "resolution": {
            "range_cell": 0.01,
            "beam_width_deg": 1,
            "doppler_cell": 1e-4,
            "doppler_cells": 20_000,
        },
    }
    turning = scenario({"kind": "turn", "rate_deg": 3.0}, sensor=sensor, region=PLANE)
    found = draw_points(ResolvedWorld.of(turning).ideal(), 1, 0)
    place, velocity = (table[0, :, 0] for table in (found.states.position, found.states.velocity))
    radial = (place * velocity).sum(axis=1) / np.hypot(*place.T)
    np.testing.assert_allclose((found.doppler - 10_000 + 0.5) * 1e-4, radial, atol=1e-4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"motion": {"kind": "acceleration", "acceleration": [1, 2, 3]}},
            "motion.acceleration has 3 numbers",
        ),
        ({"motion": {"kind": "acceleration"}}, "acceleration: is missing"),
        ({"motion": {"process_noise": [1, 2, 3]}}, "motion.process_noise has 3 numbers"),
        ({"motion": {"process_noise": -1}}, "must be at least 0"),
        ({"motion": {"kind": "turn"}}, "rate_deg: is missing"),
        ({"motion": {"kind": "turn", "rate_deg": 400}}, "must be at most 360"),
        ({"motion": {"kind": "spiral"}}, "spiral"),
        ({"motion": {"kind": "waypoints", "points": []}}, "points"),
        ({"motion": {"kind": "waypoints", "points": [[1, 2, 3]]}}, r"motion.points\[0\] has 3 numbers"),
        (
            {"motion": {"kind": "waypoints", "points": [[9, 9], [9, 9]]}},
            r"points\[1\] is where motion.points\[0\]",
        ),
        ({"motion": {"kind": "waypoints", "points": [[40, 20]]}}, r"points\[0\] is where position is"),
        ({"motion": {"kind": "waypoints", "points": [[1, 2]]}, "velocity": [0, 0]}, "velocity is zero"),
    ],
)
def test_motions_that_cannot_be_are_refused(changes, message):
    target = {"position": [40, 20], "velocity": [0.3, 0.18], **changes}
    with pytest.raises(RequestError, match=message):
        scenario(targets=[target])


def test_noise_over_endless_intervals_is_refused():
    late = {**SIGMA_0, "first_scan": 1e9}
    with pytest.raises(RequestError, match=r"250,000,0\d\d intervals .* the limit is 1,000,000"):
        scenario({"process_noise": 1.0}, sensor=late)
    assert len(plots(scenario({}, sensor=late))) == 15
