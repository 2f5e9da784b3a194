from __future__ import annotations

import numpy as np
import pytest

from scenarios.files.set_files import load_set
from scenarios.range_doppler import draw_scene
from scenarios.scenes import ExtendedTarget, Scene

AMONG_INTERFERENCE = load_set("range-doppler").scene("interference")


def test_a_trial_is_the_same_draw_in_any_chunk():
    scene = AMONG_INTERFERENCE
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
    scene = AMONG_INTERFERENCE
    whole, bare = (
        draw_scene(scene, 5, 0, 9),
        draw_scene(scene.model_copy(update={"interference": 0}), 5, 0, 9),
    )
    own = whole.origin >= 0
    assert (whole.points.range[own] == bare.points.range).all()
    assert (whole.points.amplitude[own] == bare.points.amplitude).all()
    assert (whole.centres == bare.centres).all()


def test_points_have_the_declared_moments():
    trials, points = 400, 50
    target = ExtendedTarget(
        range=30.0, doppler=-20.0, scatter=(3.0, 0.5), points=points, spread=(5.0, 3.0), correlation=-0.6
    )
    region = {"range": (10.0, 60.0), "doppler": (-30.0, -10.0)}
    scene = Scene(name="one", targets=[target], interference=20, region=region)
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


def test_noise_is_poisson_and_has_its_own_amplitude():
    trials, mean = 400, 12.5
    region = {"range": (0.0, 50.0), "doppler": (0.0, 40.0)}
    targets = [ExtendedTarget(range=25.0, doppler=20.0, amplitude=4.0)]
    scene = Scene(name="noisy", region=region, noise=mean, interference=3, amplitude=0.5, targets=targets)
    drawn = draw_scene(scene, 3, 0, trials)
    stray = drawn.origin < 0
    starts = drawn.points.offsets[:-1]
    counts = np.add.reduceat(stray.astype(int), starts) - 3
    assert counts.mean() == pytest.approx(mean, abs=4.0 * np.sqrt(mean / trials))
    assert counts.var() == pytest.approx(mean, rel=5.0 * np.sqrt(2.0 / trials))
    for own, scale in ((stray, 0.5), (~stray, 4.0)):
        square = np.mean(drawn.points.amplitude[own] ** 2)
        assert square == pytest.approx(2.0 * scale**2, rel=4.0 / np.sqrt(own.sum()))
    # The interference is the same without the noise, and so are the targets.
    quiet = draw_scene(scene.model_copy(update={"noise": 0.0}), 3, 0, trials)
    kept = np.concatenate([np.arange(start, start + 24 + 3) for start in starts])
    assert (drawn.points.range[kept] == quiet.points.range).all()
    assert (drawn.points.amplitude[kept] == quiet.points.amplitude).all()
    alone = draw_scene(scene, 3, 7)
    rows = slice(*drawn.points.offsets[7:9])
    assert (alone.points.range == drawn.points.range[rows]).all()


def test_draws_are_those_of_all_versions():
    drawn = draw_scene(AMONG_INTERFERENCE, 1, 0, 2)
    told = drawn.points.range.sum(), drawn.points.doppler.sum(), drawn.points.amplitude.sum()
    assert told == pytest.approx((6116.0, 4455.0, 141.47758432631713), rel=1e-12)
