"""Draws of points: what sensors of high resolution see, many points a target, each in its cells.

The plots of the scenario without noise say where a target is in each scan; its points lie about that
place and its radial speed. Every point has the azimuth of its dwell, the beam that holds the measured
azimuth of its target. Trial k is the same draw whatever the chunk, and without the targets the clutter has
the same points.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.rounding import floored
from algorithms.streams import normal_pair, uniform_pair
from algorithms.target_states import TargetStates
from scenarios.conversion import polar
from scenarios.model import Scenario
from scenarios.sensors import PolarSensor
from scenarios.simulate import draw
from scenarios.streams import CLUTTER_POINTS, NOISE, POINTS, SENSOR, Streams, target_stream
from scenarios.targets import Extension
from scenarios.world import World

Array = NDArray[np.float64]


class Cells(NamedTuple):
    """What sensors of high resolution tell apart.

    Attributes
    ----------
    range_cell, beam_width, first_azimuth, azimuth_span, doppler_cell : float64 (sensors,)
    beams, doppler_cells : int64 (sensors,), number of beams of the sector, and of Doppler cells
    noise : float64 (sensors, 2), on range and azimuth
    """

    range_cell: Array
    beam_width: Array
    first_azimuth: Array
    azimuth_span: Array
    doppler_cell: Array
    beams: NDArray[np.int64]
    doppler_cells: NDArray[np.int64]
    noise: Array


class Extents(NamedTuple):
    """What targets look like to such sensors.

    Attributes
    ----------
    counts : int64 (targets,), points of each target
    shape : float64 (targets, 4), spread in range and in radial speed, correlation, amplitude
    """

    counts: NDArray[np.int64]
    shape: Array


@dataclass(frozen=True, slots=True)
class ResolvedWorld:
    """A scenario of sensors of high resolution, as the kernels take it.

    Attributes
    ----------
    world : without noise
    cells, extents : of its sensors and of its targets
    """

    world: World
    cells: Cells
    extents: Extents

    @classmethod
    def of(cls, scenario: Scenario) -> ResolvedWorld:
        """Return the arrays of a scenario whose sensors have a resolution."""
        world = World.of(scenario)
        sensors = [sensor for sensor in scenario.sensors if isinstance(sensor, PolarSensor)]
        resolutions = [sensor.resolution for sensor in sensors if sensor.resolution is not None]
        widths = np.radians([resolution.beam_width_deg for resolution in resolutions])
        azimuths = world.measurement.limits[:, 1]
        spans = azimuths[:, 1] - azimuths[:, 0]
        cells = Cells(
            np.array([resolution.range_cell for resolution in resolutions]),
            widths,
            azimuths[:, 0].copy(),
            spans,
            np.array([resolution.doppler_cell for resolution in resolutions]),
            # A beam may be wider than the sector by any factor; it is one beam then.
            np.maximum(np.ceil(spans / widths - 1e-9), 1.0).astype(np.int64),
            np.array([resolution.doppler_cells for resolution in resolutions], np.int64),
            np.array([sensor.noise[:2] for sensor in sensors]),
        )
        extents = [target.extended or ONE_POINT for target in scenario.targets]
        shapes = [(one.range_spread, one.doppler_spread, one.correlation, one.amplitude) for one in extents]
        noiseless = world.measurement._replace(sigma=np.zeros_like(world.measurement.sigma))
        return cls(
            replace(world, measurement=noiseless),
            cells,
            Extents(
                np.array([one.points for one in extents], np.int64), np.array(shapes, float).reshape(-1, 4)
            ),
        )

    def ideal(self) -> ResolvedWorld:
        """Return the same where each target is one point, at its place."""
        shape = self.extents.shape * (0.0, 0.0, 0.0, 1.0)
        return replace(self, extents=Extents(np.ones_like(self.extents.counts), shape))


ONE_POINT = Extension(points=1)


@dataclass(frozen=True, slots=True)
class PointDraw:
    """The points of consecutive trials, sorted by trial, scan, beam, range and Doppler.

    Attributes
    ----------
    scan : int32 (n,)
    time : float64 (n,)
    sensor, beam : int64 (n,), whose point it is, and in which beam of its sector
    range, doppler : float64 (n,), the cells, counted from 0 at range 0 and at the lowest radial speed
    amplitude : float64 (n,), linear
    origin : int32 (n,), the target of each point, −1 for clutter
    offsets : int64 (trials + 1,), where each trial's points begin
    states : where each target was at every scan of each trial
    """

    scan: NDArray[np.int32]
    time: Array
    sensor: NDArray[np.int64]
    beam: NDArray[np.int64]
    range: Array
    doppler: Array
    amplitude: Array
    origin: NDArray[np.int32]
    offsets: NDArray[np.int64]
    states: TargetStates

    def without_targets(self) -> PointDraw:
        """Return the same draw with the points of the targets taken out: the control."""
        kept = self.origin < 0
        before = np.concatenate([[0], np.cumsum(kept)]).astype(np.int64)
        columns = {name: getattr(self, name)[kept] for name in COLUMNS}
        return PointDraw(**columns, offsets=before[self.offsets], states=self.states)


COLUMNS = ("scan", "time", "sensor", "beam", "range", "doppler", "amplitude", "origin")
"""The columns that have a value of each point."""


class SeenPlots(NamedTuple):
    """The plots of a chunk of trials as sensors see them, one row a plot.

    Attributes
    ----------
    trial : int64 (n,), counted from the first of the chunk
    scan, origin : int32 (n,)
    place : float64 (n, 2), from the sensor
    range, azimuth : float64 (n,)
    """

    trial: NDArray[np.int64]
    scan: NDArray[np.int32]
    origin: NDArray[np.int32]
    place: Array
    range: Array
    azimuth: Array


@kernel
def _amplitude(chance, scale):  # type: ignore[no-untyped-def]
    return scale * math.sqrt(-2.0 * math.log(1.0 - chance))


@kernel
def _beam(azimuth, cells, sensor):  # type: ignore[no-untyped-def]
    """Return the beam that holds an azimuth; beside the sector the nearest."""
    turned = (azimuth - cells.first_azimuth[sensor]) % (2.0 * math.pi)
    beams, span = cells.beams[sensor], cells.azimuth_span[sensor]
    if turned > span:
        return beams - 1 if turned - span <= 2.0 * math.pi - turned else np.int64(0)
    return min(floored(turned / cells.beam_width[sensor]), beams - 1)


@kernel
def _folded(speed, cells, sensor):  # type: ignore[no-untyped-def]
    """Return the Doppler cell of a radial speed, as a float: nothing bounds it before it is folded."""
    count = cells.doppler_cells[sensor]
    return np.floor(speed / cells.doppler_cell[sensor] + 0.5 * count) % count


@kernel
def _points(plots, velocity, measurement, cells, extents, streams):  # type: ignore[no-untyped-def]
    """Return cells, beams and amplitudes of the points, and the plot that each comes from.

    Parameters
    ----------
    plots : of the scenario without noise, a record `SeenPlots`
    velocity : float64 (trials, scans, targets, d)
    measurement, cells, extents, streams : records
    """
    number = 0
    for target in plots.origin:
        number += extents.counts[target] if target >= 0 else 1
    point_of, beam_of = np.empty((number, 3)), np.empty(number, np.int64)
    parent = np.empty(number, np.int64)
    row, begin = 0, 0
    while begin < len(plots.scan):
        k, scan = plots.trial[begin], plots.scan[begin]
        end = begin
        while end < len(plots.scan) and plots.scan[end] == scan and plots.trial[end] == k:
            end += 1
        trial, sensor, count = streams.first_trial + k, measurement.sensor[scan], measurement.number[scan]
        stray = 0
        # In the order of range, which targets among them do not change.
        for index in np.argsort(plots.range[begin:end]):
            plot = begin + index
            target, along, azimuth = plots.origin[plot], plots.range[plot], plots.azimuth[plot]
            if target < 0:
                u, v = uniform_pair(streams.seed, stray, count, CLUTTER_POINTS + SENSOR * sensor, trial)
                stray += 1
                point_of[row, 0] = np.floor(along / cells.range_cell[sensor])
                point_of[row, 1] = np.floor(u * cells.doppler_cells[sensor])
                point_of[row, 2] = _amplitude(v, 1.0)
                beam_of[row] = _beam(azimuth, cells, sensor)
                parent[row] = plot
                row += 1
                continue
            stream, speed = target_stream(target, sensor), 0.0
            if along > 0.0:
                east, north = velocity[k, scan, target, 0], velocity[k, scan, target, 1]
                speed = (east * plots.place[plot, 0] + north * plots.place[plot, 1]) / along
            x, y = normal_pair(streams.seed, NOISE, count, stream, trial)
            along += cells.noise[sensor, 0] * x
            azimuth += cells.noise[sensor, 1] * y
            beam = _beam(azimuth, cells, sensor)
            r_spread, d_spread, correlation, scale = extents.shape[target]
            for point in range(extents.counts[target]):
                x, y = normal_pair(streams.seed, POINTS + 2 * point, count, stream, trial)
                chance, _ = uniform_pair(streams.seed, POINTS + 2 * point + 1, count, stream, trial)
                y = correlation * x + math.sqrt(1.0 - correlation * correlation) * y
                point_of[row, 0] = np.floor((along + r_spread * x) / cells.range_cell[sensor])
                point_of[row, 1] = _folded(speed + d_spread * y, cells, sensor)
                point_of[row, 2] = _amplitude(chance, scale)
                beam_of[row] = beam
                parent[row] = plot
                row += 1
        begin = end
    return point_of, beam_of, parent


def draw_points(resolved: ResolvedWorld, seed: int, first_trial: int, trials: int = 1) -> PointDraw:
    """Return the points of consecutive trials.

    Parameters
    ----------
    resolved : the scenario's arrays
    seed : in [0, 2⁶⁴)
    first_trial, trials : which trials; they are numbered from 0

    Notes
    -----
    The range cell of a point is that of its target's measured range plus its own deviation; radial speed is
    positive where the target recedes, and folds into the unambiguous span about 0. All points of a target are
    in one dwell, whose azimuth is the centre of the beam: a target on the border of two beams is not seen
    in both. A source of clutter gives one point where it gives one plot, of a Doppler cell by chance.
    """
    measurement = resolved.world.measurement
    drawn = draw(resolved.world, seed, first_trial, trials)
    chunk, states = drawn.chunk, drawn.states
    trial_of = np.repeat(np.arange(trials), np.diff(chunk.offsets))
    place = np.ascontiguousarray(chunk.position - measurement.station[measurement.sensor[chunk.scan]])
    measured = polar(place)
    plots = SeenPlots(trial_of, chunk.scan, drawn.origin, place, measured[:, 0].copy(), measured[:, 1].copy())
    streams = Streams(np.uint64(seed), first_trial, trials)
    cells, beam, parent = _points(
        plots, states.velocity, measurement, resolved.cells, resolved.extents, streams
    )
    order = np.lexsort((cells[:, 1], cells[:, 0], beam, chunk.scan[parent], trial_of[parent]))
    parent, cells = parent[order], cells[order]
    scan = chunk.scan[parent]
    offsets = np.searchsorted(trial_of[parent], np.arange(trials + 1)).astype(np.int64)
    along, doppler, amplitude = (np.ascontiguousarray(cells[:, column]) for column in range(3))
    return PointDraw(
        scan, chunk.time[parent], measurement.sensor[scan], beam[order], along, doppler, amplitude,
        drawn.origin[parent], offsets, states,
    )  # fmt: skip
