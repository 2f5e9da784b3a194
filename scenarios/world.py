"""A scenario as the drawing kernels take it: records of arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.target_states import TargetStates
from scenarios.clutter import Clutter, ExactClutter, PoissonClutter
from scenarios.model import Scenario
from scenarios.sensors import CartesianSensor, PolarSensor

Array = NDArray[np.float64]

BOX, VOLUME, SECTOR = 0, 1, 2
"""Where clutter is uniform: in a box, in a sensor's volume, in its coordinates."""


class Ground(NamedTuple):
    """The targets: where each is at every scan before chance has a part in it, and what part it has.

    Attributes
    ----------
    start : float64 (targets, d), where each appears
    spread : float64 (targets, d), how far from there it may
    elapsed : float64 (scans, targets), seconds since it appeared; NaN where it is not there
    displacement : float64 (scans, targets, d), from its start to its place; NaN where it is not there
    velocity : float64 (scans, targets, d); NaN where it is not there
    present : bool (scans, targets)
    noise : float64 (targets, d), standard deviation of a random acceleration that is drawn in each interval
    interval : seconds
    """

    start: Array
    spread: Array
    elapsed: Array
    displacement: Array
    velocity: Array
    present: NDArray[np.bool_]
    noise: Array
    interval: float


class Measurement(NamedTuple):
    """The scans and the sensors; all sensors are polar or none is.

    Attributes
    ----------
    time : float64 (scans,), of all sensors, in order
    sensor, number : int64 (scans,), which sensor each scan is of, and its number there
    is_polar : whether the sensors measure range, azimuth and elevation
    station : float64 (sensors, d), where each stands
    sigma : float64 (sensors, d), on x, y, z or on range, azimuth, elevation; radians
    limits : float64 (sensors, d, 2), the sector of each; infinite for one that sees everything
    detection_probability : float64 (sensors,)
    """

    time: Array
    sensor: NDArray[np.int64]
    number: NDArray[np.int64]
    is_polar: NDArray[np.bool_]
    station: Array
    sigma: Array
    limits: Array
    detection_probability: Array


class ClutterSources(NamedTuple):
    """The sources of clutter.

    Attributes
    ----------
    counts : float64, the distribution functions of the sources' numbers of plots a scan, end to end;
        that of a source with a fixed number is empty
    offsets : int64 (sources + 1,), where each source's distribution begins
    fixed : int64 (sources, 2), the fixed number of plots of each scan, and that of the batch
    uniform : int64 (sources,), `BOX`, `VOLUME` or `SECTOR`
    lower, size : float64 (sources, d), the boxes
    """

    counts: Array
    offsets: NDArray[np.int64]
    fixed: NDArray[np.int64]
    uniform: NDArray[np.int64]
    lower: Array
    size: Array


@dataclass(frozen=True, slots=True)
class World:
    """A scenario as the drawing kernels take it; d is its number of dimensions, 2 or 3."""

    ground: Ground
    measurement: Measurement
    clutter: ClutterSources

    @classmethod
    def of(cls, scenario: Scenario) -> World:
        """Return the arrays of a scenario."""
        return cls(_ground(scenario), _measurement(scenario), _clutter_sources(scenario))

    @property
    def planned_states(self) -> TargetStates:
        """The states of targets before chance has a part in them, as those of one trial."""
        ground = self.ground
        position = ground.start + ground.displacement
        return TargetStates(
            self.measurement.time,
            ground.present,
            position[None],
            ground.velocity[None],
            np.zeros((1, *ground.start.shape)),
        )


def _ground(scenario: Scenario) -> Ground:
    axes, targets = scenario.dimensions, scenario.targets
    time = np.array([time for time, _, _ in scenario.timetable], dtype=float)
    elapsed = np.full((len(time), len(targets)), np.nan)
    displacement = np.full((len(time), len(targets), axes), np.nan)
    velocity, present = np.full_like(displacement, np.nan), np.zeros_like(elapsed, dtype=np.bool_)
    for index, target in enumerate(targets):
        there = target.is_present(time, scenario.interval)
        elapsed[there, index] = time[there] - target.lifetime(scenario.interval)[0]
        displacement[there, index], velocity[there, index] = target.course(elapsed[there, index])
        present[:, index] = there
    return Ground(
        _columns([target.position for target in targets], axes),
        _columns([target.spread_axes for target in targets], axes),
        elapsed,
        displacement,
        velocity,
        present,
        _columns([target.motion.noise_axes(axes) for target in targets], axes),
        scenario.interval,
    )


def _measurement(scenario: Scenario) -> Measurement:
    axes, sensors = scenario.dimensions, scenario.sensors
    time, sensor, number = zip(*scenario.timetable, strict=True)
    return Measurement(
        np.array(time, dtype=float),
        np.array(sensor, dtype=np.int64),
        np.array(number, dtype=np.int64),
        np.array([isinstance(sensor, PolarSensor) for sensor in sensors]),
        _columns([_station(sensor, axes) for sensor in sensors], axes),
        _columns([_sigma(sensor, axes) for sensor in sensors], axes),
        np.array([_limits(sensor, axes) for sensor in sensors], dtype=float),
        np.array([sensor.detection_probability for sensor in sensors], dtype=float),
    )


def _clutter_sources(scenario: Scenario) -> ClutterSources:
    axes, clutter = scenario.dimensions, scenario.clutter
    tables = [
        poisson_distribution(source.rate) if isinstance(source, PoissonClutter) else np.zeros(0)
        for source in clutter
    ]
    boxes = [scenario.area(source) for source in clutter]
    lower = _columns([box.lower for box in boxes], axes)
    return ClutterSources(
        np.concatenate(tables) if tables else np.zeros(0),
        np.cumsum([0, *map(len, tables)], dtype=np.int64),
        np.array([_fixed_numbers(source) for source in clutter], dtype=np.int64).reshape(-1, 2),
        np.array([_uniform(source) for source in clutter], dtype=np.int64),
        lower,
        _columns([box.upper for box in boxes], axes) - lower,
    )


def _columns(vectors: list[tuple[float, ...]], axes: int) -> Array:
    return np.array(vectors, dtype=float).reshape(-1, axes)


def _station(sensor: CartesianSensor | PolarSensor, axes: int) -> tuple[float, ...]:
    return sensor.station if isinstance(sensor, PolarSensor) else (0.0,) * axes


def _sigma(sensor: CartesianSensor | PolarSensor, axes: int) -> tuple[float, ...]:
    return sensor.sigmas if isinstance(sensor, PolarSensor) else sensor.axes(axes)


def _limits(sensor: CartesianSensor | PolarSensor, axes: int) -> tuple[tuple[float, float], ...]:
    everything = ((-np.inf, np.inf),) * axes
    return sensor.limits[:axes] if isinstance(sensor, PolarSensor) else everything


def _uniform(source: Clutter) -> int:
    return {"volume": VOLUME, "sector": SECTOR}.get(source.over, BOX)


def _fixed_numbers(source: Clutter) -> tuple[int, int]:
    if not isinstance(source, ExactClutter):
        return 0, 0
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
