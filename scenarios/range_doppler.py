"""Scenes of extended targets in the range-Doppler plane, and draws of their points.

Trial k of a scene with a seed is the same draw whatever the chunk. Each target and the interference
have streams of their own, so that a scene without interference has the same points of its targets.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.points import Points
from algorithms.compiled import kernel
from algorithms.streams import normal_pair, uniform_pair

Array = NDArray[np.float64]

RANGE_EXTENT, DOPPLER_EXTENT = 16.0, 12.0
"""The greatest extents of a target in the scenes below, in cells."""

SPREAD = (3.0, 2.0)
"""Standard deviations of a target's points in the scenes below, in cells."""


@dataclass(frozen=True, slots=True)
class ExtendedTarget:
    """A target that a high-resolution radar sees as many points, gaussian about its centre.

    Attributes
    ----------
    range, doppler : its centre, in cells
    scatter : how far the centre of a trial lies from there at most, evenly, in range and in Doppler
    points : how many it gives in a scan
    spread : standard deviations of its points in range and in Doppler
    correlation : of the two, −1 to 1
    """

    range: float
    doppler: float
    scatter: tuple[float, float] = (0.5, 0.5)
    points: int = 24
    spread: tuple[float, float] = SPREAD
    correlation: float = 0.0


@dataclass(frozen=True, slots=True)
class RangeDopplerScene:
    """Extended targets, and points that no target caused.

    Attributes
    ----------
    targets : each with a scatter of half a cell at least, as cells are nothing to them
    interference : number of further points in a scan, uniform over `region`
    region : lowest and highest cell in range, and in Doppler
    """

    targets: tuple[ExtendedTarget, ...]
    interference: int = 0
    region: tuple[tuple[float, float], tuple[float, float]] = ((0.0, 120.0), (0.0, 90.0))


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


APART = (ExtendedTarget(30, 35, (8.0, 12.0)), ExtendedTarget(75, 55, (8.0, 12.0)))
"""Two targets far from each other in range, and in some trials in Doppler."""

SCENES: dict[str, RangeDopplerScene] = {
    "same Doppler": RangeDopplerScene((ExtendedTarget(30, 45), ExtendedTarget(75, 45))),
    "separated": RangeDopplerScene(APART),
    "unequal": RangeDopplerScene(
        (ExtendedTarget(30, 40, (2.0, 4.0), points=60), ExtendedTarget(60, 45, (2.0, 4.0), points=12))
    ),
    "diagonal": RangeDopplerScene(
        tuple(ExtendedTarget(at, at, (2.0, 2.0), correlation=0.7) for at in (15.0, 45.0, 75.0))
    ),
    "same range": RangeDopplerScene((ExtendedTarget(60, 25), ExtendedTarget(60, 65))),
    "interference": RangeDopplerScene(APART, interference=10),
    "close": RangeDopplerScene((ExtendedTarget(50, 40, (1.0, 2.0)), ExtendedTarget(71, 47, (1.0, 2.0)))),
}
"""The seven kinds of scene by which methods of clustering are compared."""


@kernel
def _draw(seed, first_trial, trials, targets, counts, interference, lower, size):  # type: ignore[no-untyped-def]
    """Return points (range, Doppler, amplitude), origins and centres of trials.

    Parameters
    ----------
    targets : float64 (targets, 7), range, Doppler, scatter in both, spread in both, correlation
    counts : int64 (targets,), points of each
    interference : number of further points
    lower, size : float64 (2,), the region
    """
    each = counts.sum() + interference
    points = np.empty((trials * each, 3))
    origin = np.empty(trials * each, np.int32)
    centres = np.empty((trials, len(counts), 2))
    row = 0
    for k in range(trials):
        trial = first_trial + k
        for target in range(len(counts)):
            r, d, scatter_r, scatter_d, spread_r, spread_d, correlation = targets[target]
            u, v = uniform_pair(seed, 0, 0, target + 1, trial)
            centres[k, target, 0] = r + scatter_r * (2.0 * u - 1.0)
            centres[k, target, 1] = d + scatter_d * (2.0 * v - 1.0)
            for point in range(counts[target]):
                x, y = normal_pair(seed, 2 * point + 1, 0, target + 1, trial)
                chance, _ = uniform_pair(seed, 2 * point + 2, 0, target + 1, trial)
                y = correlation * x + math.sqrt(1.0 - correlation * correlation) * y
                points[row, 0] = np.rint(centres[k, target, 0] + spread_r * x)
                points[row, 1] = np.rint(centres[k, target, 1] + spread_d * y)
                points[row, 2] = math.sqrt(-2.0 * math.log(1.0 - chance))
                origin[row] = target
                row += 1
        for point in range(interference):
            u, v = uniform_pair(seed, 2 * point + 1, 0, 0, trial)
            chance, _ = uniform_pair(seed, 2 * point + 2, 0, 0, trial)
            points[row, 0] = np.rint(lower[0] + u * size[0])
            points[row, 1] = np.rint(lower[1] + v * size[1])
            points[row, 2] = math.sqrt(-2.0 * math.log(1.0 - chance))
            origin[row] = -1
            row += 1
    return points, origin, centres


def draw_scene(scene: RangeDopplerScene, seed: int, trial: int, trials: int = 1) -> SceneDraw:
    """Return the points of trials of a scene.

    Parameters
    ----------
    seed : of the draws, 0 to 2⁶⁴ − 1
    trial, trials : the first one, and how many
    """
    given = [
        (target.range, target.doppler, *target.scatter, *target.spread, target.correlation)
        for target in scene.targets
    ]
    counts = np.array([target.points for target in scene.targets], np.int64)
    bounds = np.array(scene.region, float)
    points, origin, centres = _draw(
        np.uint64(seed), trial, trials, np.array(given, float).reshape(-1, 7), counts,
        scene.interference, bounds[:, 0].copy(), bounds[:, 1] - bounds[:, 0],
    )  # fmt: skip
    offsets = np.arange(trials + 1, dtype=np.int64) * (int(counts.sum()) + scene.interference)
    along, doppler, amplitude = (points[:, column] for column in range(3))
    return SceneDraw(Points.of(along, doppler, amplitude, offsets), origin, centres)
