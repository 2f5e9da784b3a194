"""Simulation: (scenario, seed, trial) to plots and truth.

Trial k of a scenario with a seed is the same draw whatever the chunk, the order or the number
of workers. Each source of plots (a target, a source of clutter) has a stream of its own for
each trial, sensor and scan: a draw without targets has the same clutter, and a draw of fewer scans
is the first part of one of more (but for clutter whose number is fixed for the batch).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.lines import line_through
from algorithms.plots import PlotChunk
from algorithms.scoring import Truth
from algorithms.streams import normal_pair, uniform_pair
from scenarios.conversion import convert
from scenarios.model import Scenario
from scenarios.world import BOX, VOLUME, World

Array = NDArray[np.float64]

# Blocks of a target's stream in a scan; that of its start is in scan 0, whatever the sensor.
SEEN, NOISE, START, START_IN_SPACE, NOISE_IN_SPACE = 0, 1, 2, 3, 4

SENSOR = 1 << 20
"""Distance of the streams of one sensor from those of the next."""

IN_SPACE = 1 << 31
"""What is added to the block of a plot's place for the third number of it."""


@kernel
def _stream(source, is_target, sensor):  # type: ignore[no-untyped-def]
    return 2 * source + is_target + SENSOR * sensor


# The kernels take whole arrays and a row of each, no views: to make one costs more than a plot.


@kernel
def _to_polar(place, station, sensor, measured):  # type: ignore[no-untyped-def]
    """Write range, azimuth and, in space, elevation of a place as a sensor sees it."""
    x, y = place[0] - station[sensor, 0], place[1] - station[sensor, 1]
    ground = math.sqrt(x * x + y * y)
    measured[0] = ground
    measured[1] = math.atan2(x, y)
    if len(place) > 2:
        z = place[2] - station[sensor, 2]
        measured[0] = math.sqrt(ground * ground + z * z)
        measured[2] = math.atan2(z, ground)


@kernel
def _is_in_sector(measured, limits, sensor):  # type: ignore[no-untyped-def]
    if not limits[sensor, 0, 0] <= measured[0] <= limits[sensor, 0, 1]:
        return False
    if len(measured) > 2 and not limits[sensor, 2, 0] <= measured[2] <= limits[sensor, 2, 1]:
        return False
    turns = math.ceil((limits[sensor, 1, 0] - measured[1]) / (2.0 * math.pi))
    return measured[1] + 2.0 * math.pi * turns <= limits[sensor, 1, 1]


@kernel
def _put_converted(measured, sigma, station, sensor, ways, plots, covariance, row):  # type: ignore[no-untyped-def]
    """Write what a polar measurement is converted to as a plot."""
    convert(measured, sigma[sensor], ways, plots[row], covariance[row])
    for axis in range(len(measured)):
        plots[row, axis] += station[sensor, axis]


@kernel
def _put_plain(place, sigma, sensor, plots, covariance, row):  # type: ignore[no-untyped-def]
    """Write a cartesian measurement as a plot, with its covariance where others have one."""
    for axis in range(len(place)):
        plots[row, axis] = place[axis]
    if len(covariance) > 0:
        for axis in range(len(place)):
            for other in range(len(place)):
                covariance[row, axis, other] = 0.0
            covariance[row, axis, axis] = sigma[sensor, axis] ** 2


@kernel
def _move(plots, covariance, origin, row, at):  # type: ignore[no-untyped-def]
    """Move the plot of one row to another."""
    origin[at] = origin[row]
    for axis in range(plots.shape[1]):
        plots[at, axis] = plots[row, axis]
    if len(covariance) > 0:
        for axis in range(plots.shape[1]):
            for other in range(plots.shape[1]):
                covariance[at, axis, other] = covariance[row, axis, other]


@kernel
def _sector_point(u, v, w, limits, sensor, is_volume, measured):  # type: ignore[no-untyped-def]
    """Write the polar coordinates of a random point of a sector."""
    near, far = limits[sensor, 0, 0], limits[sensor, 0, 1]
    axes = len(measured)
    if is_volume:
        power = float(axes)
        measured[0] = (near**power + u * (far**power - near**power)) ** (1.0 / power)
    else:
        measured[0] = near + u * (far - near)
    measured[1] = limits[sensor, 1, 0] + v * (limits[sensor, 1, 1] - limits[sensor, 1, 0])
    if axes > 2:
        low, high = limits[sensor, 2, 0], limits[sensor, 2, 1]
        if is_volume:
            measured[2] = math.asin(math.sin(low) + w * (math.sin(high) - math.sin(low)))
        else:
            measured[2] = low + w * (high - low)


@kernel
def _scan_count(seed, trial, number, sensor, source, counts, count_offsets, fixed):  # type: ignore[no-untyped-def]
    """Return the number of plots that a source has in a scan, those of the batch left out."""
    if count_offsets[source] == count_offsets[source + 1]:
        return fixed[source, 0]
    chance, _ = uniform_pair(seed, 0, number, _stream(source, 0, sensor), trial)
    distribution = counts[count_offsets[source] : count_offsets[source + 1]]
    return min(np.searchsorted(distribution, chance, side="right"), len(distribution) - 1)


@kernel
def _scan_of(seed, trial, scans, source, plot):  # type: ignore[no-untyped-def]
    """Return the scan into which a plot of the batch falls, and the block that its place is drawn from."""
    block = 2 * plot
    chance, _ = uniform_pair(seed, block, 0, _stream(source, 0, 0), trial)
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
def _place_clutter(  # type: ignore[no-untyped-def]
    seed, trial, block, number, stream, source, sensor, uniform, lower, size, is_polar, station, sigma,
    limits, place, measured, ways, plots, covariance, row,
):  # fmt: skip
    """Write a plot of clutter and, for a polar sensor, its covariance."""
    axes = len(place)
    u, v = uniform_pair(seed, block, number, stream, trial)
    w = 0.0
    if axes > 2:
        w, _ = uniform_pair(seed, block + IN_SPACE, number, stream, trial)
    if uniform[source] == BOX:
        place[0] = lower[source, 0] + u * size[source, 0]
        place[1] = lower[source, 1] + v * size[source, 1]
        if axes > 2:
            place[2] = lower[source, 2] + w * size[source, 2]
        if not is_polar[sensor]:
            _put_plain(place, sigma, sensor, plots, covariance, row)
            return
        _to_polar(place, station, sensor, measured)
    else:
        _sector_point(u, v, w, limits, sensor, uniform[source] == VOLUME, measured)
    _put_converted(measured, sigma, station, sensor, ways, plots, covariance, row)


@kernel
def _draw(  # type: ignore[no-untyped-def]
    seed, first_trial, trials, position, velocity, spread, begin, end, scan_time, scan_sensor, scan_number,
    is_polar, station, sigma, limits, probability, counts, count_offsets, fixed, uniform, lower, size,
):  # fmt: skip
    scans, sources, targets, axes = len(scan_time), len(count_offsets) - 1, len(begin), sigma.shape[1]
    shift = np.zeros((trials, targets, axes), np.float64)
    offsets = np.zeros(trials + 1, np.int64)
    place, measured, noise = np.empty(axes), np.empty(axes), np.empty(axes)
    ways = np.empty((2 * axes - 1, axes))
    for k in range(trials):
        trial = first_trial + k
        for target in range(targets):
            u, v = uniform_pair(seed, START, 0, _stream(target, 1, 0), trial)
            shift[k, target, 0] = (2.0 * u - 1.0) * spread[target, 0]
            shift[k, target, 1] = (2.0 * v - 1.0) * spread[target, 1]
            if axes > 2:
                w, _ = uniform_pair(seed, START_IN_SPACE, 0, _stream(target, 1, 0), trial)
                shift[k, target, 2] = (2.0 * w - 1.0) * spread[target, 2]
        total = fixed[:, 1].sum()
        for scan in range(scans):
            sensor, number = scan_sensor[scan], scan_number[scan]
            for source in range(sources):
                total += _scan_count(seed, trial, number, sensor, source, counts, count_offsets, fixed)
            time = scan_time[scan]
            for target in range(targets):
                if not begin[target] <= time <= end[target]:
                    continue
                chance, _ = uniform_pair(seed, SEEN, number, _stream(target, 1, sensor), trial)
                if chance >= probability[sensor]:
                    continue
                if is_polar[sensor]:
                    for axis in range(axes):
                        start = position[target, axis] + shift[k, target, axis]
                        place[axis] = start + velocity[target, axis] * (time - begin[target])
                    _to_polar(place, station, sensor, measured)
                    if not _is_in_sector(measured, limits, sensor):
                        continue
                total += 1
        offsets[k + 1] = offsets[k] + total
    scan_column = np.empty(offsets[trials], np.int32)
    time_column = np.empty(offsets[trials], np.float64)
    origin = np.empty(offsets[trials], np.int32)
    plots = np.empty((offsets[trials], axes), np.float64)
    covariance = np.empty((offsets[trials] if is_polar.any() else 0, axes, axes), np.float64)
    is_flat = axes == 2 and not is_polar.any()
    begins = np.zeros((sources, scans + 1), np.int64)
    order = np.empty((sources, fixed[:, 1].max() if sources > 0 else 0), np.int64)
    row = 0
    for k in range(trials):
        trial = first_trial + k
        for source in range(sources):
            if fixed[source, 1] > 0:
                _by_scan(seed, trial, scans, source, fixed[source, 1], begins[source], order[source])
        for scan in range(scans):
            first, time, number, sensor = row, scan_time[scan], scan_number[scan], scan_sensor[scan]
            for source in range(sources):
                of_batch = begins[source, scan + 1] - begins[source, scan]
                own = _scan_count(seed, trial, number, sensor, source, counts, count_offsets, fixed)
                for plot in range(of_batch + own):
                    if plot < of_batch:
                        one = order[source, begins[source, scan] + plot]
                        _, block = _scan_of(seed, trial, scans, source, one)
                        drawn_in, stream = np.int64(0), _stream(source, 0, 0)
                    else:
                        block, drawn_in = plot - of_batch + 1, number
                        stream = _stream(source, 0, sensor)
                    origin[row] = -1
                    if is_flat:
                        # As `_place_clutter` does it; the call alone takes longer than the rest.
                        u, v = uniform_pair(seed, block, drawn_in, stream, trial)
                        plots[row, 0] = lower[source, 0] + u * size[source, 0]
                        plots[row, 1] = lower[source, 1] + v * size[source, 1]
                        row += 1
                        continue
                    _place_clutter(
                        seed, trial, block, drawn_in, stream, source, sensor, uniform, lower, size, is_polar,
                        station, sigma, limits, place, measured, ways, plots, covariance, row,
                    )  # fmt: skip
                    row += 1
            for target in range(targets):
                if not begin[target] <= time <= end[target]:
                    continue
                chance, rank = uniform_pair(seed, SEEN, number, _stream(target, 1, sensor), trial)
                if chance >= probability[sensor]:
                    continue
                for axis in range(axes):
                    start = position[target, axis] + shift[k, target, axis]
                    place[axis] = start + velocity[target, axis] * (time - begin[target])
                if is_polar[sensor]:
                    _to_polar(place, station, sensor, measured)
                    if not _is_in_sector(measured, limits, sensor):
                        continue
                stream = _stream(target, 1, sensor)
                noise[0], noise[1] = normal_pair(seed, NOISE, number, stream, trial)
                if axes > 2:
                    noise[2], _ = normal_pair(seed, NOISE_IN_SPACE, number, stream, trial)
                # At a random place of its scan, so that no order tells targets from clutter.
                at = first + np.int64(rank * (row - first + 1))
                _move(plots, covariance, origin, at, row)
                origin[at] = target
                if is_polar[sensor]:
                    for axis in range(axes):
                        measured[axis] += sigma[sensor, axis] * noise[axis]
                    _put_converted(measured, sigma, station, sensor, ways, plots, covariance, at)
                else:
                    for axis in range(axes):
                        place[axis] += sigma[sensor, axis] * noise[axis]
                    _put_plain(place, sigma, sensor, plots, covariance, at)
                row += 1
            scan_column[first:row] = scan
            time_column[first:row] = time
    return scan_column, time_column, plots, covariance, origin, offsets, shift


@dataclass(frozen=True, slots=True)
class Draw:
    """The plots of consecutive trials, and what caused them.

    Attributes
    ----------
    chunk : the plots
    origin : int32 (n,), the target that caused each plot, −1 for clutter
    shift : float64 (trials, targets, d), how far from its `position` each target began
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
    scan, time, position, covariance, origin, offsets, shift = _draw(
        np.uint64(seed), first_trial, trials, world.position, world.velocity, world.spread, world.begin,
        world.end, world.scan_time, world.scan_sensor, world.scan_number, world.is_polar, world.station,
        world.sigma, world.limits, world.detection_probability, world.counts, world.count_offsets,
        world.fixed, world.uniform, world.lower, world.size,
    )  # fmt: skip
    known = covariance if world.is_polar.any() else None
    return Draw(PlotChunk(scan, time, position, offsets, known), origin, shift)


def true_paths(scenario: Scenario, shift: Array) -> tuple[Array, ...]:
    """Return the true positions of each target at the times of the scenario's interval.

    Parameters
    ----------
    shift : float64 (targets, d), how far from its `position` each target began

    Returns
    -------
    paths : for each target, float64 (times in which it is there, d)
    """
    paths = []
    last = scenario.last_time
    for target, moved in zip(scenario.targets, shift, strict=True):
        begin, end = target.lifetime(scenario.interval)
        steps = math.floor((min(end, last) - begin) / scenario.interval + 1e-9)
        elapsed = np.arange(max(0, steps + 1)) * scenario.interval
        paths.append(np.array(target.position) + moved + elapsed[:, None] * np.array(target.velocity))
    return tuple(paths)


def true_lines(scenario: Scenario, shift: Array) -> tuple[Array, Array]:
    """Return θ and ρ of the targets' lines in the plane (x, y), NaN for one that stands still there.

    Parameters
    ----------
    shift : float64 (…, targets, d), how far from its `position` each target began

    Returns
    -------
    theta, rho : float64 (…, targets)
    """
    position = np.array([target.position[:2] for target in scenario.targets], dtype=float).reshape(-1, 2)
    velocity = np.array([target.velocity[:2] for target in scenario.targets], dtype=float).reshape(-1, 2)
    start = position + shift[..., :2]
    return line_through(start, np.broadcast_to(velocity, start.shape))


def truth(scenario: Scenario, drawn: Draw) -> Truth:
    """Return the truth of a draw as the scorer takes it."""
    theta, rho = true_lines(scenario, drawn.shift)
    ends = [
        [end[:2] for end in target.ends(scenario.interval, scenario.last_time)] for target in scenario.targets
    ]
    middle = np.array(ends, dtype=float).reshape(-1, 2, 2).mean(axis=1) + drawn.shift[..., :2]
    return Truth(theta, rho, middle, drawn.origin)
