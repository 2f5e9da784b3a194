"""Draws of points: what sensors of high resolution see, many points a target, each in its cells.

The plots of the scenario without noise say where a target is in each scan; its points lie about that
place and its radial speed. Every point has the azimuth of its dwell, the beam that holds the measured
azimuth of its target. Trial k is the same draw whatever the chunk, and without the targets the clutter has
the same points.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.streams import normal_pair, uniform_pair
from scenarios.conversion import polar
from scenarios.model import Scenario
from scenarios.sensors import PolarSensor
from scenarios.simulate import NOISE, SENSOR, draw
from scenarios.targets import Extension
from scenarios.world import World

Array = NDArray[np.float64]

POINTS = 16
"""First block of a target's stream in a scan from which its points are drawn, two blocks a point."""

CLUTTER = SENSOR - 2
"""Stream of a sensor, beyond those of its targets, that gives Doppler and amplitude of clutter."""


@dataclass(frozen=True, slots=True)
class ResolvedWorld:
    """A scenario of sensors of high resolution, as the kernels take it.

    Attributes
    ----------
    world : without noise
    range_cell, beam_width, first_azimuth, doppler_cell : float64 (sensors,)
    beams, doppler_cells : int64 (sensors,), number of beams of the sector, and of Doppler cells
    noise : float64 (sensors, 2), on range and azimuth
    counts : int64 (targets,), points of each target
    extent : float64 (targets, 4), spread in range and in radial speed, correlation, amplitude
    """

    world: World
    range_cell: Array
    beam_width: Array
    first_azimuth: Array
    doppler_cell: Array
    beams: NDArray[np.int64]
    doppler_cells: NDArray[np.int64]
    noise: Array
    counts: NDArray[np.int64]
    extent: Array

    @classmethod
    def of(cls, scenario: Scenario) -> ResolvedWorld:
        """Return the arrays of a scenario whose sensors have a resolution."""
        world = World.of(scenario)
        sensors = [sensor for sensor in scenario.sensors if isinstance(sensor, PolarSensor)]
        cells = [sensor.resolution for sensor in sensors if sensor.resolution is not None]
        widths = np.radians([cell.beam_width_deg for cell in cells])
        spans = world.limits[:, 1, 1] - world.limits[:, 1, 0]
        extents = [target.extended or ONE_POINT for target in scenario.targets]
        given = [(one.range_spread, one.doppler_spread, one.correlation, one.amplitude) for one in extents]
        return cls(
            replace(world, sigma=np.zeros_like(world.sigma)),
            np.array([cell.range_cell for cell in cells]),
            widths,
            world.limits[:, 1, 0].copy(),
            np.array([cell.doppler_cell for cell in cells]),
            np.ceil(spans / widths - 1e-9).astype(np.int64),
            np.array([cell.doppler_cells for cell in cells], np.int64),
            np.array([sensor.noise[:2] for sensor in sensors]),
            np.array([found.points for found in extents], np.int64),
            np.array(given, float).reshape(-1, 4),
        )

    def ideal(self) -> ResolvedWorld:
        """Return the same where each target is one point, at its place."""
        extent = self.extent * (0.0, 0.0, 0.0, 1.0)
        return replace(self, counts=np.ones_like(self.counts), extent=extent)


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
    shift : float64 (trials, targets, d), how far from its `position` each target began
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
    shift: Array

    def without_targets(self) -> PointDraw:
        """Return the same draw with the points of the targets taken out: the control."""
        kept = self.origin < 0
        before = np.concatenate([[0], np.cumsum(kept)]).astype(np.int64)
        columns = {name: getattr(self, name)[kept] for name in COLUMNS}
        return PointDraw(**columns, offsets=before[self.offsets], shift=self.shift)


COLUMNS = ("scan", "time", "sensor", "beam", "range", "doppler", "amplitude", "origin")
"""The columns that have a value of each point."""


@kernel
def _amplitude(chance, scale):  # type: ignore[no-untyped-def]
    return scale * math.sqrt(-2.0 * math.log(1.0 - chance))


@kernel
def _beam(azimuth, first, width, beams, span):  # type: ignore[no-untyped-def]
    """Return the beam that holds an azimuth; beside the sector the nearest."""
    turned = (azimuth - first) % (2.0 * math.pi)
    if turned > span:
        return beams - 1 if turned - span <= 2.0 * math.pi - turned else np.int64(0)
    return min(np.int64(turned / width), beams - 1)


@kernel
def _folded(speed, cell, cells):  # type: ignore[no-untyped-def]
    """Return the Doppler cell of a radial speed."""
    return np.int64(math.floor(speed / cell + 0.5 * cells)) % cells


@kernel
def _points(  # type: ignore[no-untyped-def]
    seed, first_trial, trial_of, scan, ranges, azimuths, place, origin, velocity, limits, scan_sensor,
    scan_number, range_cell, beam_width, first_azimuth, doppler_cell, beams, doppler_cells, noise, counts,
    extent,
):  # fmt: skip
    """Return cells, beams, amplitudes, origins of the points, and the plot that each comes from."""
    number = 0
    for plot in range(len(scan)):
        number += counts[origin[plot]] if origin[plot] >= 0 else 1
    cells, beam_of = np.empty((number, 3)), np.empty(number, np.int64)
    parent = np.empty(number, np.int64)
    row, begin = 0, 0
    while begin < len(scan):
        end = begin
        while end < len(scan) and scan[end] == scan[begin] and trial_of[end] == trial_of[begin]:
            end += 1
        trial, sensor = first_trial + trial_of[begin], scan_sensor[scan[begin]]
        count, span = scan_number[scan[begin]], limits[sensor, 1, 1] - limits[sensor, 1, 0]
        stray = 0
        # In the order of range, which targets among them do not change.
        for index in np.argsort(ranges[begin:end]):
            plot = begin + index
            target, along, azimuth = origin[plot], ranges[plot], azimuths[plot]
            if target < 0:
                u, v = uniform_pair(seed, stray, count, CLUTTER + SENSOR * sensor, trial)
                stray += 1
                cells[row, 0] = math.floor(along / range_cell[sensor])
                cells[row, 1] = np.int64(u * doppler_cells[sensor])
                cells[row, 2] = _amplitude(v, 1.0)
                beam_of[row] = _beam(azimuth, first_azimuth[sensor], beam_width[sensor], beams[sensor], span)
                parent[row] = plot
                row += 1
                continue
            stream = 2 * target + 1 + SENSOR * sensor
            speed = 0.0
            if along > 0.0:
                speed = (velocity[target, 0] * place[plot, 0] + velocity[target, 1] * place[plot, 1]) / along
            x, y = normal_pair(seed, NOISE, count, stream, trial)
            along += noise[sensor, 0] * x
            azimuth += noise[sensor, 1] * y
            beam = _beam(azimuth, first_azimuth[sensor], beam_width[sensor], beams[sensor], span)
            r_spread, d_spread, correlation, scale = extent[target]
            for point in range(counts[target]):
                x, y = normal_pair(seed, POINTS + 2 * point, count, stream, trial)
                chance, _ = uniform_pair(seed, POINTS + 2 * point + 1, count, stream, trial)
                y = correlation * x + math.sqrt(1.0 - correlation * correlation) * y
                cells[row, 0] = math.floor((along + r_spread * x) / range_cell[sensor])
                cells[row, 1] = _folded(speed + d_spread * y, doppler_cell[sensor], doppler_cells[sensor])
                cells[row, 2] = _amplitude(chance, scale)
                beam_of[row] = beam
                parent[row] = plot
                row += 1
        begin = end
    return cells, beam_of, parent


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
    world = resolved.world
    drawn = draw(world, seed, first_trial, trials)
    chunk = drawn.chunk
    trial_of = np.repeat(np.arange(trials), np.diff(chunk.offsets))
    seen_from = np.ascontiguousarray(chunk.position - world.station[world.scan_sensor[chunk.scan]])
    measured = polar(seen_from)
    cells, beam, parent = _points(
        np.uint64(seed), first_trial, trial_of, chunk.scan, measured[:, 0].copy(), measured[:, 1].copy(),
        seen_from, drawn.origin, world.velocity, world.limits, world.scan_sensor, world.scan_number,
        resolved.range_cell, resolved.beam_width, resolved.first_azimuth, resolved.doppler_cell,
        resolved.beams, resolved.doppler_cells, resolved.noise, resolved.counts, resolved.extent,
    )  # fmt: skip
    order = np.lexsort((cells[:, 1], cells[:, 0], beam, chunk.scan[parent], trial_of[parent]))
    parent, cells = parent[order], cells[order]
    scan = chunk.scan[parent]
    offsets = np.searchsorted(trial_of[parent], np.arange(trials + 1)).astype(np.int64)
    along, doppler, amplitude = (np.ascontiguousarray(cells[:, column]) for column in range(3))
    return PointDraw(
        scan, chunk.time[parent], world.scan_sensor[scan], beam[order], along, doppler, amplitude,
        drawn.origin[parent], offsets, drawn.shift,
    )  # fmt: skip
