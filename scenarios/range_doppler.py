"""Draws of scenes: the points of extended targets in the range-Doppler plane.

Trial k of a scene with a seed is the same draw whatever the chunk. Each target, the interference and
the noise have streams of their own, so that a scene without interference has the same points of its
targets.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.points import Points
from algorithms.compiled import kernel
from algorithms.streams import normal_pair, uniform_pair
from scenarios.scenes import Scene
from scenarios.world import poisson_distribution

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SceneDraw:
    """The points of some trials of a scene.

    Attributes
    ----------
    points : of one scan a trial; range and Doppler are whole cells, amplitudes follow Rayleigh's law
    origin : int32 (n,), the target of each point; −1 of interference
    centres : float64 (trials, targets, 2), the centres of the targets
    """

    points: Points
    origin: NDArray[np.int32]
    centres: Array


# Streams of a scene: 0 of what no target causes, then one a target. In stream 0 the interference is
# drawn as of scan 0, noise as of scan 1, its number before its points.
STRAY = 0
INTERFERENCE, NOISE = 0, 1


@kernel
def _rayleigh(seed, block, number, stream, trial, scale):  # type: ignore[no-untyped-def]
    chance, _ = uniform_pair(seed, block, number, stream, trial)
    return scale * math.sqrt(-2.0 * math.log(1.0 - chance))


@kernel
def _noise_count(seed, trial, distribution):  # type: ignore[no-untyped-def]
    chance, _ = uniform_pair(seed, 0, NOISE, STRAY, trial)
    return min(np.searchsorted(distribution, chance, side="right"), len(distribution) - 1)


@kernel
def _draw(  # type: ignore[no-untyped-def]
    seed, first_trial, trials, targets, counts, interference, noise, amplitude, lower, size
):  # fmt: skip
    """Return points (range, Doppler, amplitude), origins, offsets and centres of trials.

    Parameters
    ----------
    targets : float64 (targets, 8), range, Doppler, scatter in both, spread in both, correlation,
        amplitude
    counts : int64 (targets,), points of each
    interference : number of points that no target causes
    noise : float64, distribution function of the number of further such points
    amplitude : of the points that no target causes
    lower, size : float64 (2,), the region
    """
    offsets = np.zeros(trials + 1, np.int64)
    for k in range(trials):
        number = _noise_count(seed, first_trial + k, noise)
        offsets[k + 1] = offsets[k] + counts.sum() + interference + number
    points = np.empty((offsets[trials], 3))
    origin = np.full(offsets[trials], -1, np.int32)
    centres = np.empty((trials, len(counts), 2))
    for k in range(trials):
        trial, row = first_trial + k, offsets[k]
        for target in range(len(counts)):
            r, d, scatter_r, scatter_d, spread_r, spread_d, correlation, scale = targets[target]
            u, v = uniform_pair(seed, 0, 0, target + 1, trial)
            centres[k, target, 0] = r + scatter_r * (2.0 * u - 1.0)
            centres[k, target, 1] = d + scatter_d * (2.0 * v - 1.0)
            for point in range(counts[target]):
                x, y = normal_pair(seed, 2 * point + 1, 0, target + 1, trial)
                y = correlation * x + math.sqrt(1.0 - correlation * correlation) * y
                points[row, 0] = np.rint(centres[k, target, 0] + spread_r * x)
                points[row, 1] = np.rint(centres[k, target, 1] + spread_d * y)
                points[row, 2] = _rayleigh(seed, 2 * point + 2, 0, target + 1, trial, scale)
                origin[row] = target
                row += 1
        further = offsets[k + 1] - row - interference
        for source, number in ((INTERFERENCE, interference), (NOISE, further)):
            for point in range(number):
                u, v = uniform_pair(seed, 2 * point + 1, source, STRAY, trial)
                points[row, 0] = np.rint(lower[0] + u * size[0])
                points[row, 1] = np.rint(lower[1] + v * size[1])
                points[row, 2] = _rayleigh(seed, 2 * point + 2, source, STRAY, trial, amplitude)
                row += 1
    return points, origin, offsets, centres


def draw_scene(scene: Scene, seed: int, trial: int, trials: int = 1) -> SceneDraw:
    """Return the points of trials of a scene.

    Parameters
    ----------
    seed : of the draws, 0 to 2⁶⁴ − 1
    trial, trials : the first one, and how many
    """
    given = [
        (target.range, target.doppler, *target.scatter, *target.spread, target.correlation, target.amplitude)
        for target in scene.targets
    ]
    counts = np.array([target.points for target in scene.targets], np.int64)
    bounds = np.array([scene.region.range, scene.region.doppler])
    points, origin, offsets, centres = _draw(
        np.uint64(seed), trial, trials, np.array(given, float).reshape(-1, 8), counts, scene.interference,
        poisson_distribution(scene.noise), scene.amplitude, bounds[:, 0].copy(), bounds[:, 1] - bounds[:, 0],
    )  # fmt: skip
    along, doppler, amplitude = (points[:, column] for column in range(3))
    return SceneDraw(Points.of(along, doppler, amplitude, offsets), origin, centres)
