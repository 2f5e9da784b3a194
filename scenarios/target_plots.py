"""The states of targets in each trial, and the plots that sensors have of them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.streams import normal_pair, uniform_pair
from scenarios.conversion import to_polar
from scenarios.plot_rows import put_polar, put_variance
from scenarios.streams import (
    ACCELERATION,
    ACCELERATION_IN_SPACE,
    NOISE,
    NOISE_IN_SPACE,
    SEEN,
    START,
    START_IN_SPACE,
    target_stream,
)

Array = NDArray[np.float64]


class TargetPlots(NamedTuple):
    """The plots of targets in a chunk of trials, sorted by trial, scan and target.

    Attributes
    ----------
    begins : int64 (trials × scans + 1,), where those of each scan of each trial begin
    target : int32 (n,)
    rank : float64 (n,), in [0, 1), where in its scan a plot lies among those put there before it
    position, covariance : float64 (n, d) and (n, d, d); no covariances where no sensor is polar
    """

    begins: NDArray[np.int64]
    target: NDArray[np.int32]
    rank: Array
    position: Array
    covariance: Array


@kernel
def _put_acceleration(ground, streams, trial, target, step, acceleration):  # type: ignore[no-untyped-def]
    """Write the random acceleration of a target in an interval, counted from its birth."""
    stream = target_stream(target, 0)
    x, y = normal_pair(streams.seed, ACCELERATION, step, stream, trial)
    acceleration[0], acceleration[1] = ground.noise[target, 0] * x, ground.noise[target, 1] * y
    if len(acceleration) > 2:
        z, _ = normal_pair(streams.seed, ACCELERATION_IN_SPACE, step, stream, trial)
        acceleration[2] = ground.noise[target, 2] * z


@kernel
def _disturb(ground, streams, trial, target, position, velocity):  # type: ignore[no-untyped-def]
    """Add to the states of a target in a trial what its random accelerations make of them.

    Each acceleration holds for one interval of the scenario, counted from birth, whatever sensors look when.
    """
    scans, _, axes = position.shape
    moved, speed, acceleration = np.zeros(axes), np.zeros(axes), np.empty(axes)
    step, interval = 0, ground.interval
    _put_acceleration(ground, streams, trial, target, step, acceleration)
    for scan in range(scans):
        if not ground.present[scan, target]:
            continue
        while ground.elapsed[scan, target] >= (step + 1) * interval:
            for axis in range(axes):
                moved[axis] += interval * (speed[axis] + 0.5 * interval * acceleration[axis])
                speed[axis] += interval * acceleration[axis]
            step += 1
            _put_acceleration(ground, streams, trial, target, step, acceleration)
        left = ground.elapsed[scan, target] - step * interval
        for axis in range(axes):
            position[scan, target, axis] += moved[axis] + left * (
                speed[axis] + 0.5 * left * acceleration[axis]
            )
            velocity[scan, target, axis] += speed[axis] + left * acceleration[axis]


@kernel
def target_states(ground, streams):  # type: ignore[no-untyped-def]
    """Return the states of targets at every scan of each trial.

    Returns
    -------
    position, velocity : float64 (trials, scans, targets, d)
    shift : float64 (trials, targets, d), how far from its declared position each target begins
    """
    scans, targets, axes = ground.displacement.shape
    shift = np.empty((streams.trials, targets, axes))
    position = np.empty((streams.trials, scans, targets, axes))
    velocity = np.empty_like(position)
    for k in range(streams.trials):
        trial = streams.first_trial + k
        for target in range(targets):
            stream = target_stream(target, 0)
            u, v = uniform_pair(streams.seed, START, 0, stream, trial)
            shift[k, target, 0] = (2.0 * u - 1.0) * ground.spread[target, 0]
            shift[k, target, 1] = (2.0 * v - 1.0) * ground.spread[target, 1]
            if axes > 2:
                w, _ = uniform_pair(streams.seed, START_IN_SPACE, 0, stream, trial)
                shift[k, target, 2] = (2.0 * w - 1.0) * ground.spread[target, 2]
            for scan in range(scans):
                for axis in range(axes):
                    start = ground.start[target, axis] + shift[k, target, axis]
                    position[k, scan, target, axis] = start + ground.displacement[scan, target, axis]
                    velocity[k, scan, target, axis] = ground.velocity[scan, target, axis]
            if ground.noise[target].any():
                _disturb(ground, streams, trial, target, position[k], velocity[k])
    return position, velocity, shift


@kernel
def _is_in_sector(measured, limits, sensor):  # type: ignore[no-untyped-def]
    if not limits[sensor, 0, 0] <= measured[0] <= limits[sensor, 0, 1]:
        return False
    if len(measured) > 2 and not limits[sensor, 2, 0] <= measured[2] <= limits[sensor, 2, 1]:
        return False
    turns = np.ceil((limits[sensor, 1, 0] - measured[1]) / (2.0 * math.pi))
    return measured[1] + 2.0 * math.pi * turns <= limits[sensor, 1, 1]


@kernel
def target_plots(position, present, measurement, streams):  # type: ignore[no-untyped-def]
    """Return the plots of targets.

    Parameters
    ----------
    position : float64 (trials, scans, targets, d), as `target_states` gives them
    present : bool (scans, targets)
    measurement, streams : records
    """
    trials, scans, targets, axes = position.shape
    most = trials * present.sum()
    begins = np.zeros(trials * scans + 1, np.int64)
    origin, rank = np.empty(most, np.int32), np.empty(most)
    plots = np.empty((most, axes))
    covariance = np.empty((most if measurement.is_polar.any() else 0, axes, axes))
    place, noise, ways = np.empty(axes), np.empty(axes), np.empty((2 * axes - 1, axes))
    row = 0
    for k in range(trials):
        trial = streams.first_trial + k
        for scan in range(scans):
            sensor, number = measurement.sensor[scan], measurement.number[scan]
            for target in range(targets):
                if not present[scan, target]:
                    continue
                stream = target_stream(target, sensor)
                chance, place_in_scan = uniform_pair(streams.seed, SEEN, number, stream, trial)
                if chance >= measurement.detection_probability[sensor]:
                    continue
                if measurement.is_polar[sensor]:
                    to_polar(position[k, scan, target], measurement.station, sensor, place)
                    if not _is_in_sector(place, measurement.limits, sensor):
                        continue
                else:
                    for axis in range(axes):
                        place[axis] = position[k, scan, target, axis]
                noise[0], noise[1] = normal_pair(streams.seed, NOISE, number, stream, trial)
                if axes > 2:
                    noise[2], _ = normal_pair(streams.seed, NOISE_IN_SPACE, number, stream, trial)
                for axis in range(axes):
                    place[axis] += measurement.sigma[sensor, axis] * noise[axis]
                if measurement.is_polar[sensor]:
                    put_polar(
                        place, measurement.sigma, measurement.station, sensor, ways, plots, covariance, row
                    )
                else:
                    plots[row] = place
                    put_variance(measurement.sigma, sensor, covariance, row)
                origin[row], rank[row] = target, place_in_scan
                row += 1
            begins[k * scans + scan + 1] = row
    return TargetPlots(begins, origin[:row], rank[:row], plots[:row], covariance[:row])
