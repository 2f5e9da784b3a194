"""Clusters: from sets of points to one plot a target, interference removed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.ellipse import Ellipse, moments, squared_distance
from algorithms.clustering.points import Points
from algorithms.compiled import kernel

SLACK = 1.0 + 1e-9
"""Forgives rounding where a point lies on the ellipse itself."""

NONE = -1
"""The cluster of a point that is in none."""


class Sets(NamedTuple):
    """Sets of points, each wholly in one scan, in the order of the scans.

    Attributes
    ----------
    order : int64 (n,), points such that those of every set stand together
    first, end : int64 (k,), where they stand
    scan : int64 (k,), whose points they are
    """

    order: NDArray[np.int64]
    first: NDArray[np.int64]
    end: NDArray[np.int64]
    scan: NDArray[np.int64]


class Conclusion(NamedTuple):
    """What is made of a set: which of its points are kept, and which plot they give.

    Attributes
    ----------
    radius : how far from the centre a point is kept, in standard deviations
    least_points : the least number of points of a target
    is_mean : whether the plot is the mean weighted by amplitude, rather than the strongest point
    range_added, doppler_added : what is added to the variances of the ellipse
    """

    radius: float = np.inf
    least_points: int = 1
    is_mean: bool = True
    range_added: float = 0.0
    doppler_added: float = 0.0


@dataclass(frozen=True, slots=True)
class Clusters:
    """The clusters of the points of several scans, each with its plot.

    Attributes
    ----------
    points : what was clustered
    scan : int64 (k,), the scan of each cluster; clusters are in the order of scans
    range, doppler, amplitude : float64 (k,), the plot of each; of a mean, `amplitude` is the mean one
    strongest : int64 (k,), the strongest kept point of each, the first of equals
    moments : float64 (k, 5), mean range, mean Doppler, a, b and c of the members' ellipse
    label : int64 (n,), the cluster of which a point is a member; `NONE` of interference
    kept : bool (n,), whether the plot of a point's cluster is made of it, too
    """

    points: Points
    scan: NDArray[np.int64]
    range: NDArray[np.float64]
    doppler: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    strongest: NDArray[np.int64]
    moments: NDArray[np.float64]
    label: NDArray[np.int64]
    kept: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.range)

    @property
    def counts(self) -> NDArray[np.int64]:
        """Number of clusters of each scan."""
        return np.bincount(self.scan, minlength=self.points.scans)

    def members(self) -> list[NDArray[np.int64]]:
        """Return the points of each cluster, rising."""
        rows = np.flatnonzero(self.label != NONE)
        rows = rows[np.argsort(self.label[rows], kind="stable")]
        ends = np.cumsum(np.bincount(self.label[rows], minlength=len(self)))
        return np.split(rows, ends[:-1]) if len(self) else []

    def ellipse(self, index: int) -> Ellipse:
        """Return the ellipse of the members of a cluster."""
        centre_r, centre_d, a, b, c = self.moments[index].tolist()
        return Ellipse((centre_r, centre_d), a, b, c)


@kernel
def _keep(along, doppler, members, found, squared_radius, kept):  # type: ignore[no-untyped-def]
    """Mark the members within a radius, all where there is none; return how many are marked."""
    count = 0
    for point in members:
        r, d = along[point] - found[0], doppler[point] - found[1]
        kept[point] = squared_distance(r, d, found[2], found[3], found[4]) <= squared_radius
        count += kept[point]
    if count == 0:
        for point in members:
            kept[point] = True
        count = len(members)
    return count


@kernel
def _plot(along, doppler, amplitude, members, kept, count):  # type: ignore[no-untyped-def]
    """Return the strongest kept point, and mean range, Doppler and amplitude weighted by amplitude."""
    strongest = -1
    for point in members:
        if not kept[point]:
            continue
        if strongest < 0 or amplitude[point] > amplitude[strongest]:
            strongest = point
        elif amplitude[point] == amplitude[strongest] and point < strongest:
            strongest = point
    top = amplitude[strongest]
    weights, sum_r, sum_d = 0.0, 0.0, 0.0
    for point in members:
        if not kept[point]:
            continue
        # By the greatest, so that no sum overflows; all of them 0 count alike.
        weight = amplitude[point] / top if top > 0.0 else 1.0
        weights += weight
        sum_r += weight * (along[point] - along[strongest])
        sum_d += weight * (doppler[point] - doppler[strongest])
    mean = top * (weights / count) if top > 0.0 else 0.0
    return strongest, along[strongest] + sum_r / weights, doppler[strongest] + sum_d / weights, mean


@kernel
def _conclude(along, doppler, amplitude, sets, conclusion):  # type: ignore[no-untyped-def]
    """Return of each cluster its set, plot, strongest point and shape; of each point cluster and use."""
    room, squared_radius = len(sets.first), conclusion.radius**2 * SLACK
    which, strongest = np.empty(room, np.int64), np.empty(room, np.int64)
    plots, shapes = np.empty((room, 3)), np.empty((room, 5))
    label, kept = np.full(len(along), -1, np.int64), np.zeros(len(along), np.bool_)
    cluster = 0
    for index in range(room):
        members = sets.order[sets.first[index] : sets.end[index]]
        if len(members) < conclusion.least_points:
            continue
        mean_r, mean_d, a, b, c = moments(along, doppler, members)
        shape = (mean_r, mean_d, a + conclusion.range_added, b + conclusion.doppler_added, c)
        count = _keep(along, doppler, members, shape, squared_radius, kept)
        point, r, d, level = _plot(along, doppler, amplitude, members, kept, count)
        if not conclusion.is_mean:
            r, d, level = along[point], doppler[point], amplitude[point]
        for member in members:
            label[member] = cluster
        which[cluster], strongest[cluster] = index, point
        plots[cluster, 0], plots[cluster, 1], plots[cluster, 2] = r, d, level
        for column in range(5):
            shapes[cluster, column] = shape[column]
        cluster += 1
    return which[:cluster], plots[:cluster], strongest[:cluster], shapes[:cluster], label, kept


def conclude(points: Points, sets: Sets, conclusion: Conclusion) -> Clusters:
    """Return the clusters that sets of points are.

    Notes
    -----
    Points beyond the radius are left out of the plot once: the ellipse is not worked out again. The
    source drops the points on the ellipse, too, (14); here they are kept, for of four points in the
    corners of a rectangle none would be left. Where a small radius drops all points of a set, all
    are kept. Where all amplitudes are 0, the mean is that of equal weights; of equally strong points
    the first is the strongest.
    """
    which, plots, strongest, shapes, label, kept = _conclude(
        points.range, points.doppler, points.amplitude, sets, conclusion
    )
    along, doppler, amplitude = (np.ascontiguousarray(plots[:, column]) for column in range(3))
    return Clusters(points, sets.scan[which], along, doppler, amplitude, strongest, shapes, label, kept)
