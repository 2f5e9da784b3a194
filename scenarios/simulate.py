"""Simulation: (scenario, seed, trial) to plots and truth.

Trial k of a scenario with a seed is the same draw whatever the chunk, the order or the number
of workers. Each source of plots (a target, a source of clutter) has a stream of its own for
each trial and scan: a draw without targets has the same clutter, and a draw of fewer scans is
the first part of one of more.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.lines import line_through
from algorithms.plots import PlotChunk
from algorithms.scoring import Truth
from algorithms.streams import normal_pair, uniform_pair
from scenarios.model import Scenario

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class World:
    """A scenario as the drawing kernel takes it.

    Attributes
    ----------
    position, velocity : float64 (targets, 2), in the scan in which each appears
    birth, death : int64 (targets,), first and last scan
    sigma : float64 (2,)
    detection_probability : probability of a plot
    counts : float64, the distribution functions of the sources' numbers of plots, end to end
    count_offsets : int64 (sources + 1,), where each source's distribution begins
    lower, size : float64 (sources, 2), the regions of the sources of clutter
    scans, interval : of the scenario
    """

    position: Array
    velocity: Array
    birth: NDArray[np.int64]
    death: NDArray[np.int64]
    sigma: Array
    detection_probability: float
    counts: Array
    count_offsets: NDArray[np.int64]
    lower: Array
    size: Array
    scans: int
    interval: float

    @classmethod
    def of(cls, scenario: Scenario) -> World:
        """Return the arrays of a scenario."""
        tables = [poisson_distribution(source.rate) for source in scenario.clutter]
        boxes = [(source.region or scenario.region).box for source in scenario.clutter]
        lower = np.array([box.lower for box in boxes], dtype=float).reshape(-1, 2)
        upper = np.array([box.upper for box in boxes], dtype=float).reshape(-1, 2)
        last = scenario.scans - 1
        targets = scenario.targets
        return cls(
            np.array([target.position for target in targets], dtype=float).reshape(-1, 2),
            np.array([target.velocity for target in targets], dtype=float).reshape(-1, 2),
            np.array([target.birth for target in targets], dtype=np.int64),
            np.array([last if target.death is None else target.death for target in targets], dtype=np.int64),
            np.array(scenario.sensor.axes, dtype=float),
            scenario.sensor.detection_probability,
            np.concatenate(tables) if tables else np.zeros(0),
            np.cumsum([0, *map(len, tables)], dtype=np.int64),
            lower,
            upper - lower,
            scenario.scans,
            scenario.interval,
        )


@lru_cache(maxsize=64)
def poisson_distribution(rate: float) -> Array:
    """Return the distribution function of a Poisson number at 0, 1, 2, …, as far as it is below 1.

    Parameters
    ----------
    rate : the mean, ≥ 0
    """
    if rate == 0.0:
        return np.ones(1)
    numbers = np.arange(int(rate + 12.0 * np.sqrt(rate)) + 40)
    log_factorial = np.concatenate([[0.0], np.cumsum(np.log(numbers[1:]))])
    distribution: Array = np.cumsum(np.exp(numbers * np.log(rate) - rate - log_factorial))
    distribution /= distribution[-1]
    return distribution


@kernel
def _detections(seed, trial, scan, birth, death, probability):  # type: ignore[no-untyped-def]
    count = 0
    for target in range(len(birth)):
        if birth[target] <= scan <= death[target]:
            chance, _ = uniform_pair(seed, 0, scan, 2 * target + 1, trial)
            count += chance < probability
    return count


@kernel
def _clutter_count(seed, trial, scan, source, counts, count_offsets):  # type: ignore[no-untyped-def]
    chance, _ = uniform_pair(seed, 0, scan, 2 * source, trial)
    distribution = counts[count_offsets[source] : count_offsets[source + 1]]
    return min(np.searchsorted(distribution, chance, side="right"), len(distribution) - 1)


@kernel
def _draw(  # type: ignore[no-untyped-def]
    seed, first_trial, trials, scans, interval, position, velocity, birth, death, sigma, probability,
    counts, count_offsets, lower, size,
):  # fmt: skip
    sources, targets = len(count_offsets) - 1, len(birth)
    offsets = np.zeros(trials + 1, np.int64)
    for k in range(trials):
        total = 0
        for scan in range(scans):
            for source in range(sources):
                total += _clutter_count(seed, first_trial + k, scan, source, counts, count_offsets)
            total += _detections(seed, first_trial + k, scan, birth, death, probability)
        offsets[k + 1] = offsets[k] + total
    scan_column = np.empty(offsets[trials], np.int32)
    origin = np.empty(offsets[trials], np.int32)
    place = np.empty((offsets[trials], 2), np.float64)
    row = 0
    for k in range(trials):
        trial = first_trial + k
        for scan in range(scans):
            begin = row
            for source in range(sources):
                for plot in range(_clutter_count(seed, trial, scan, source, counts, count_offsets)):
                    u, v = uniform_pair(seed, plot + 1, scan, 2 * source, trial)
                    place[row, 0] = lower[source, 0] + u * size[source, 0]
                    place[row, 1] = lower[source, 1] + v * size[source, 1]
                    origin[row] = -1
                    row += 1
            for target in range(targets):
                if not birth[target] <= scan <= death[target]:
                    continue
                chance, rank = uniform_pair(seed, 0, scan, 2 * target + 1, trial)
                if chance >= probability:
                    continue
                noise_x, noise_y = normal_pair(seed, 1, scan, 2 * target + 1, trial)
                elapsed = (scan - birth[target]) * interval
                # At a random place of its scan, so that no order tells targets from clutter.
                at = begin + np.int64(rank * (row - begin + 1))
                place[row, 0], place[row, 1], origin[row] = place[at, 0], place[at, 1], origin[at]
                place[at, 0] = position[target, 0] + velocity[target, 0] * elapsed + sigma[0] * noise_x
                place[at, 1] = position[target, 1] + velocity[target, 1] * elapsed + sigma[1] * noise_y
                origin[at] = target
                row += 1
            scan_column[begin:row] = scan
    return scan_column, place, origin, offsets


@dataclass(frozen=True, slots=True)
class Draw:
    """The plots of consecutive trials, and what caused them.

    Attributes
    ----------
    chunk : the plots
    origin : int32 (n,), the target that caused each plot, −1 for clutter
    """

    chunk: PlotChunk
    origin: NDArray[np.int32]

    def without_targets(self) -> Draw:
        """Return the same draw with the plots of the targets taken out: the control."""
        kept = self.origin < 0
        before = np.concatenate([[0], np.cumsum(kept)]).astype(np.int64)
        chunk = PlotChunk(
            self.chunk.scan[kept],
            self.chunk.time[kept],
            self.chunk.position[kept],
            before[self.chunk.offsets],
        )
        return Draw(chunk, self.origin[kept])


def draw(world: World, seed: int, first_trial: int, trials: int = 1) -> Draw:
    """Return the plots of consecutive trials.

    Parameters
    ----------
    world : the scenario's arrays
    seed : in [0, 2⁶⁴)
    first_trial, trials : which trials; they are numbered from 0
    """
    scan, position, origin, offsets = _draw(
        np.uint64(seed), first_trial, trials, world.scans, world.interval, world.position, world.velocity,
        world.birth, world.death, world.sigma, world.detection_probability,
        world.counts, world.count_offsets, world.lower, world.size,
    )  # fmt: skip
    return Draw(PlotChunk(scan, scan * world.interval, position, offsets), origin)


def true_lines(scenario: Scenario) -> tuple[Array, Array]:
    """Return θ and ρ of the targets' lines, NaN for one that stands still."""
    position = np.array([target.position for target in scenario.targets], dtype=float).reshape(-1, 2)
    velocity = np.array([target.velocity for target in scenario.targets], dtype=float).reshape(-1, 2)
    return line_through(position, velocity)


def truth(scenario: Scenario, drawn: Draw) -> Truth:
    """Return the truth of a draw as the scorer takes it."""
    theta, rho = true_lines(scenario)
    return Truth(theta, rho, drawn.origin)
