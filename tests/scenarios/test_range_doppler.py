from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from scenarios.range_doppler import SCENES, ExtendedTarget, RangeDopplerScene, draw_scene


def test_a_trial_is_the_same_draw_in_any_chunk():
    scene = SCENES["interference"]
    whole = draw_scene(scene, 5, 0, 6)
    for trial in range(6):
        alone = draw_scene(scene, 5, trial)
        rows = slice(*whole.points.offsets[trial : trial + 2])
        assert (alone.points.range == whole.points.range[rows]).all()
        assert (alone.points.doppler == whole.points.doppler[rows]).all()
        assert (alone.points.amplitude == whole.points.amplitude[rows]).all()
        assert (alone.origin == whole.origin[rows]).all()
        assert (alone.centres[0] == whole.centres[trial]).all()
    assert not (draw_scene(scene, 6, 0).points.range == draw_scene(scene, 5, 0).points.range).all()


def test_targets_are_the_same_without_interference():
    scene = SCENES["interference"]
    whole, bare = draw_scene(scene, 5, 0, 9), draw_scene(replace(scene, interference=0), 5, 0, 9)
    own = whole.origin >= 0
    assert (whole.points.range[own] == bare.points.range).all()
    assert (whole.points.amplitude[own] == bare.points.amplitude).all()
    assert (whole.centres == bare.centres).all()


def test_points_have_the_declared_moments():
    trials, points = 400, 50
    target = ExtendedTarget(30.0, -20.0, (3.0, 0.5), points, (5.0, 3.0), -0.6)
    scene = RangeDopplerScene((target,), 20, ((10.0, 60.0), (-30.0, -10.0)))
    drawn = draw_scene(scene, 1, 0, trials)
    own = drawn.origin == 0
    place = np.stack([drawn.points.range, drawn.points.doppler])
    assert (place == np.rint(place)).all()
    away = place[:, own].reshape(2, trials, points) - drawn.centres[:, 0].T[:, :, None]
    number = trials * points
    # Rounding to cells adds a twelfth to each variance.
    expected = np.array([[25.0, -9.0], [-9.0, 9.0]]) + np.eye(2) / 12.0
    assert np.cov(away.reshape(2, -1)) == pytest.approx(expected, rel=0.05)
    assert away.reshape(2, -1).mean(axis=1) == pytest.approx(0.0, abs=4.0 * 5.0 / np.sqrt(number))
    shift = drawn.centres[:, 0] - (30.0, -20.0)
    assert (np.abs(shift).max(axis=0) <= (3.0, 0.5)).all()
    assert shift.var(axis=0) == pytest.approx([9.0 / 3.0, 0.25 / 3.0], rel=0.25)
    assert shift.mean(axis=0) == pytest.approx([0.0, 0.0], abs=4.0 * np.sqrt(3.0 / trials))
    stray = place[:, ~own]
    assert stray.min(axis=1) == pytest.approx([10.0, -30.0])
    assert stray.max(axis=1) == pytest.approx([60.0, -10.0])
    assert stray.mean(axis=1) == pytest.approx([35.0, -20.0], abs=4.0 * 50.0 / np.sqrt(12.0 * stray.shape[1]))
    # Rayleigh's law: mean square 2.
    assert np.mean(drawn.points.amplitude**2) == pytest.approx(2.0, abs=4.0 * 2.0 / np.sqrt(len(own)))
