"""Simulation: (scenario, seed, trial) to plots and truth.

Trial k of a scenario with a seed is the same draw whatever the chunk, the order or the number
of workers. Each source of plots (a target, a source of clutter) has a stream of its own for
each trial and scan: a draw without targets has the same clutter, and a draw of fewer scans is
the first part of one of more (but for clutter whose number is fixed for the batch).
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
from scenarios.model import ExactClutter, PoissonClutter, Scenario

Array = NDArray[np.float64]

START = 2
"""Block of a target's stream from which its start is drawn; 0 tells whether it is seen, 1 is its noise."""


@dataclass(frozen=True, slots=True)
class World:
    """A scenario as the drawing kernel takes it.

    Attributes
    ----------
    position, velocity : float64 (targets, 2), in the scan in which each appears
    spread : float64 (targets, 2), how far from `position` each may begin
    birth, death : int64 (targets,), first and last scan
    sigma : float64 (2,)
    detection_probability : probability of a plot
    counts : float64, the distribution functions of the sources' numbers of plots a scan, end to end;
        that of a source with a fixed number is empty
    count_offsets : int64 (sources + 1,), where each source's distribution begins
    fixed : int64 (sources, 2), the fixed number of plots of each scan, and that of the batch
    lower, size : float64 (sources, 2), the regions of the sources of clutter
    scans, interval : of the scenario
    """

    position: Array
    velocity: Array
    spread: Array
    birth: NDArray[np.int64]
    death: NDArray[np.int64]
    sigma: Array
    detection_probability: float
    counts: Array
    count_offsets: NDArray[np.int64]
    fixed: NDArray[np.int64]
    lower: Array
    size: Array
    scans: int
    interval: float

    @classmethod
    def of(cls, scenario: Scenario) -> World:
        """Return the arrays of a scenario."""
        clutter = scenario.clutter
        tables = [
            poisson_distribution(source.rate) if isinstance(source, PoissonClutter) else np.zeros(0)
            for source in clutter
        ]
        fixed = [_fixed_numbers(source) if isinstance(source, ExactClutter) else (0, 0) for source in clutter]
        boxes = [scenario.area(source) for source in clutter]
        lower = np.array([box.lower for box in boxes], dtype=float).reshape(-1, 2)
        upper = np.array([box.upper for box in boxes], dtype=float).reshape(-1, 2)
        last = scenario.scans - 1
        targets = scenario.targets
        return cls(
            np.array([target.position for target in targets], dtype=float).reshape(-1, 2),
            np.array([target.velocity for target in targets], dtype=float).reshape(-1, 2),
            np.array([target.spread_axes for target in targets], dtype=float).reshape(-1, 2),
            np.array([target.birth for target in targets], dtype=np.int64),
            np.array([last if target.death is None else target.death for target in targets], dtype=np.int64),
            np.array(scenario.sensor.axes, dtype=float),
            scenario.sensor.detection_probability,
            np.concatenate(tables) if tables else np.zeros(0),
            np.cumsum([0, *map(len, tables)], dtype=np.int64),
            np.array(fixed, dtype=np.int64).reshape(-1, 2),
            lower,
            upper - lower,
            scenario.scans,
            scenario.interval,
        )


def _fixed_numbers(source: ExactClutter) -> tuple[int, int]:
    return (source.count, 0) if source.per == "scan" else (0, source.count)


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
def _scan_count(seed, trial, scan, source, counts, count_offsets, fixed):  # type: ignore[no-untyped-def]
    """Return the number of plots that a source has in a scan, those of the batch left out."""
    if count_offsets[source] == count_offsets[source + 1]:
        return fixed[source, 0]
    chance, _ = uniform_pair(seed, 0, scan, 2 * source, trial)
    distribution = counts[count_offsets[source] : count_offsets[source + 1]]
    return min(np.searchsorted(distribution, chance, side="right"), len(distribution) - 1)


@kernel
def _scan_of(seed, trial, scans, source, plot):  # type: ignore[no-untyped-def]
    """Return the scan into which a plot of the batch falls, and the block that its place is drawn from."""
    block = 2 * plot
    chance, _ = uniform_pair(seed, block, 0, 2 * source, trial)
    return min(np.int64(chance * scans), scans - 1), block + 1


@kernel
def _by_scan(seed, trial, scans, source, number, begins, order):  # type: ignore[no-untyped-def]
    """Sort the plots of a batch by their scans: those of scan s are order[begins[s]:begins[s + 1]]."""
    begins[:] = 0
    for plot in range(number):
        scan, _ = _scan_of(seed, trial, scans, source, plot)
        begins[scan + 1] += 1
    for scan in range(scans):
        begins[scan + 1] += begins[scan]
    # From behind, each scan's end is counted down to its begin, which is where it belongs.
    for plot in range(number - 1, -1, -1):
        scan, _ = _scan_of(seed, trial, scans, source, plot)
        begins[scan + 1] -= 1
        order[begins[scan + 1]] = plot
    begins[:-1] = begins[1:]
    begins[scans] = number


@kernel
def _draw(  # type: ignore[no-untyped-def]
    seed, first_trial, trials, scans, interval, position, velocity, spread, birth, death, sigma, probability,
    counts, count_offsets, fixed, lower, size,
):  # fmt: skip
    sources, targets = len(count_offsets) - 1, len(birth)
    offsets = np.zeros(trials + 1, np.int64)
    for k in range(trials):
        total = fixed[:, 1].sum()
        for scan in range(scans):
            for source in range(sources):
                total += _scan_count(seed, first_trial + k, scan, source, counts, count_offsets, fixed)
            total += _detections(seed, first_trial + k, scan, birth, death, probability)
        offsets[k + 1] = offsets[k] + total
    scan_column = np.empty(offsets[trials], np.int32)
    origin = np.empty(offsets[trials], np.int32)
    place = np.empty((offsets[trials], 2), np.float64)
    shift = np.empty((trials, targets, 2), np.float64)
    begins = np.zeros((sources, scans + 1), np.int64)
    order = np.empty((sources, fixed[:, 1].max() if sources > 0 else 0), np.int64)
    row = 0
    for k in range(trials):
        trial = first_trial + k
        for target in range(targets):
            u, v = uniform_pair(seed, START, 0, 2 * target + 1, trial)
            shift[k, target, 0] = (2.0 * u - 1.0) * spread[target, 0]
            shift[k, target, 1] = (2.0 * v - 1.0) * spread[target, 1]
        for source in range(sources):
            if fixed[source, 1] > 0:
                _by_scan(seed, trial, scans, source, fixed[source, 1], begins[source], order[source])
        for scan in range(scans):
            begin = row
            for source in range(sources):
                for plot in order[source, begins[source, scan] : begins[source, scan + 1]]:
                    _, block = _scan_of(seed, trial, scans, source, plot)
                    u, v = uniform_pair(seed, block, 0, 2 * source, trial)
                    place[row, 0] = lower[source, 0] + u * size[source, 0]
                    place[row, 1] = lower[source, 1] + v * size[source, 1]
                    origin[row] = -1
                    row += 1
                for plot in range(_scan_count(seed, trial, scan, source, counts, count_offsets, fixed)):
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
                start_x = position[target, 0] + shift[k, target, 0]
                start_y = position[target, 1] + shift[k, target, 1]
                place[at, 0] = start_x + velocity[target, 0] * elapsed + sigma[0] * noise_x
                place[at, 1] = start_y + velocity[target, 1] * elapsed + sigma[1] * noise_y
                origin[at] = target
                row += 1
            scan_column[begin:row] = scan
    return scan_column, place, origin, offsets, shift


@dataclass(frozen=True, slots=True)
class Draw:
    """The plots of consecutive trials, and what caused them.

    Attributes
    ----------
    chunk : the plots
    origin : int32 (n,), the target that caused each plot, −1 for clutter
    shift : float64 (trials, targets, 2), how far from its `position` each target began
    """

    chunk: PlotChunk
    origin: NDArray[np.int32]
    shift: Array

    def without_targets(self) -> Draw:
        """Return the same draw with the plots of the targets taken out: the control."""
        kept = self.origin < 0
        return Draw(self.chunk.chosen(kept), self.origin[kept], self.shift)


def draw(world: World, seed: int, first_trial: int, trials: int = 1) -> Draw:
    """Return the plots of consecutive trials.

    Parameters
    ----------
    world : the scenario's arrays
    seed : in [0, 2⁶⁴)
    first_trial, trials : which trials; they are numbered from 0
    """
    scan, position, origin, offsets, shift = _draw(
        np.uint64(seed), first_trial, trials, world.scans, world.interval, world.position, world.velocity,
        world.spread, world.birth, world.death, world.sigma, world.detection_probability,
        world.counts, world.count_offsets, world.fixed, world.lower, world.size,
    )  # fmt: skip
    return Draw(PlotChunk(scan, scan * world.interval, position, offsets), origin, shift)


def true_paths(scenario: Scenario, shift: Array) -> tuple[Array, ...]:
    """Return the true positions of each target in the scans in which it is there, float64 (scans, 2).

    Parameters
    ----------
    shift : float64 (targets, 2), how far from its `position` each target began
    """
    paths = []
    for target, moved in zip(scenario.targets, shift, strict=True):
        elapsed = np.arange(len(target.present(scenario.scans))) * scenario.interval
        paths.append(np.array(target.position) + moved + elapsed[:, None] * np.array(target.velocity))
    return tuple(paths)


def true_lines(scenario: Scenario, shift: Array) -> tuple[Array, Array]:
    """Return θ and ρ of the targets' lines, NaN for one that stands still.

    Parameters
    ----------
    shift : float64 (…, targets, 2), how far from its `position` each target began

    Returns
    -------
    theta, rho : float64 (…, targets)
    """
    position = np.array([target.position for target in scenario.targets], dtype=float).reshape(-1, 2)
    velocity = np.array([target.velocity for target in scenario.targets], dtype=float).reshape(-1, 2)
    return line_through(position + shift, np.broadcast_to(velocity, shift.shape))


def truth(scenario: Scenario, drawn: Draw) -> Truth:
    """Return the truth of a draw as the scorer takes it."""
    theta, rho = true_lines(scenario, drawn.shift)
    ends = [target.ends(scenario.scans, scenario.interval) for target in scenario.targets]
    middle = np.array(ends, dtype=float).reshape(-1, 2, 2).mean(axis=1) + drawn.shift
    return Truth(theta, rho, middle, drawn.origin)
