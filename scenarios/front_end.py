"""From points to plots: what stands between a sensor of high resolution and an initiator.

The points of each dwell (one beam of one scan) are clustered in range and Doppler; each cluster gives a plot
of range, azimuth and Doppler, converted to cartesian coordinates with its covariance.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.circle import cut_open
from algorithms.clustering.clusters import NONE, Clusters
from algorithms.clustering.modes import cluster
from algorithms.clustering.parameters import Clustering
from algorithms.clustering.points import Points
from algorithms.compiled import kernel
from algorithms.plots import PlotChunk
from scenarios.conversion import convert
from scenarios.detections import PointDraw, ResolvedWorld
from scenarios.simulate import Draw

Array = NDArray[np.float64]


@kernel
def _converted_each(measured, sigma):  # type: ignore[no-untyped-def]
    axes = measured.shape[1]
    ways = np.empty((2 * axes - 1, axes))
    mean, covariance = np.empty_like(measured), np.empty((len(measured), axes, axes))
    for row in range(len(measured)):
        convert(measured[row], sigma[row], ways, mean[row], covariance[row])
    return mean, covariance


def dwell_offsets(drawn: PointDraw) -> NDArray[np.int64]:
    """Return where the points of each dwell begin, and the end of the last; only dwells with points."""
    trial = np.repeat(np.arange(len(drawn.offsets) - 1), np.diff(drawn.offsets))
    key = np.stack([trial, drawn.scan, drawn.beam])
    first = np.flatnonzero(np.any(np.diff(key, axis=1) != 0, axis=0)) + 1
    ends = [len(drawn.scan)] if len(drawn.scan) else []
    return np.concatenate([[0], first, ends]).astype(np.int64)


def measured_points(resolved: ResolvedWorld, drawn: PointDraw) -> dict[str, list[float]]:
    """Return what was measured of points: the azimuth of the dwell in degrees, and the range of the cell."""
    cells, sensor = resolved.cells, drawn.sensor
    azimuth = cells.first_azimuth[sensor] + (drawn.beam + 0.5) * cells.beam_width[sensor]
    along = (drawn.range + 0.5) * cells.range_cell[sensor]
    return {"dwell": np.degrees(azimuth).tolist(), "range": along.tolist()}


def every_point(resolved: ResolvedWorld, drawn: PointDraw) -> Draw:
    """Return the plots of a draw where every point is one.

    Notes
    -----
    The standard deviation of a plot's range is that of the noise with that of a cell, 1/√12 of its size; its
    azimuth has those of the noise and of the beam.
    """
    variance = resolved.cells.range_cell[drawn.sensor] ** 2 / 12.0
    rows = np.arange(len(drawn.scan))
    return _plots(resolved, drawn, rows, drawn.range, drawn.doppler, drawn.amplitude, variance, drawn.origin)


def clustered(resolved: ResolvedWorld, drawn: PointDraw, parameters: Clustering) -> Draw:
    """Return the plots of a draw whose points are clustered, dwell by dwell.

    Parameters
    ----------
    resolved : the scenario's arrays
    drawn : its points
    parameters : of a mode; extents and cells in cells

    Notes
    -----
    Doppler is a circle: it is cut in the widest gap of each dwell, so that no target is cut at the fold. A
    plot's range has the variance of its kept points and of a cell, by their number (weighted as the mean
    is; of the strongest point, that of one), and that of the noise, which they share. A plot comes from the
    target that has the most members in its cluster, from none where clutter has more.
    """
    offsets = dwell_offsets(drawn)
    first = offsets[:-1]
    opened = cut_open(drawn.doppler, offsets, resolved.cells.doppler_cells[drawn.sensor[first]])
    clusters = cluster(Points.of(drawn.range, opened, drawn.amplitude, offsets), parameters)
    targets = len(resolved.extents.counts)
    members = clusters.label != NONE
    votes = np.bincount(
        clusters.label[members] * (targets + 1) + drawn.origin[members] + 1,
        minlength=len(clusters) * (targets + 1),
    ).reshape(len(clusters), targets + 1)
    best = votes[:, 1:].argmax(axis=1) if targets else np.zeros(len(clusters), np.int64)
    own = votes[np.arange(len(clusters)), best + 1] if targets else np.zeros(len(clusters))
    origin = np.where(own >= np.maximum(votes[:, 0], 1), best, -1).astype(np.int32)
    rows = first[clusters.scan]
    cell = resolved.cells.range_cell[drawn.sensor[rows]]
    variance = cell**2 * _range_variance(drawn, clusters, is_mean=parameters.result == "mean")
    return _plots(
        resolved, drawn, rows, clusters.range, clusters.doppler, clusters.amplitude, variance, origin
    )


def _range_variance(drawn: PointDraw, clusters: Clusters, *, is_mean: bool) -> Array:
    """Return the variance of the range of each cluster's plot, in cells: of its points, by their number."""
    label, along = clusters.label[clusters.kept], drawn.range[clusters.kept]
    weight = drawn.amplitude[clusters.kept]

    def sums(values: Array) -> Array:
        return np.bincount(label, values, minlength=len(clusters)).astype(np.float64)

    number = sums(np.ones_like(along))
    away = along - (sums(along) / np.maximum(number, 1.0))[label]
    spread = sums(away**2) / np.maximum(number, 1.0) + 1.0 / 12.0
    if not is_mean:
        return spread
    # Points of unequal weight count for fewer.
    return spread * np.where(sums(weight) > 0.0, sums(weight**2) / np.maximum(sums(weight), 1e-300) ** 2, 1.0)


def _plots(
    resolved: ResolvedWorld,
    drawn: PointDraw,
    rows: NDArray[np.int64],
    along: Array,
    doppler: Array,
    amplitude: Array,
    variance: Array,
    origin: NDArray[np.int32],
) -> Draw:
    """Return plots as initiators take them.

    Parameters
    ----------
    rows : int64 (plots,), a point of the dwell of each, rising
    along, doppler : float64 (plots,), in cells
    variance : of the range of each, without the noise
    """
    sensor, cells = drawn.sensor[rows], resolved.cells.doppler_cells[drawn.sensor[rows]]
    width = resolved.cells.beam_width[sensor]
    measured = np.stack(
        [
            (along + 0.5) * resolved.cells.range_cell[sensor],
            resolved.cells.first_azimuth[sensor] + (drawn.beam[rows] + 0.5) * width,
        ],
        axis=1,
    )
    noise = resolved.cells.noise[sensor]
    sigma = np.sqrt(np.stack([variance + noise[:, 0] ** 2, width**2 / 12.0 + noise[:, 1] ** 2], axis=1))
    position, covariance = _converted_each(measured, sigma)
    # A plot of a cluster that was opened may lie beyond the last cell.
    speed = ((doppler + 0.5) % cells - 0.5 * cells) * resolved.cells.doppler_cell[sensor]
    offsets = np.searchsorted(rows, drawn.offsets).astype(np.int64)
    chunk = PlotChunk(
        drawn.scan[rows],
        drawn.time[rows],
        position + resolved.world.measurement.station[sensor],
        offsets,
        covariance,
        amplitude,
        speed,
    )
    return Draw(chunk, origin, drawn.states)
