"""Splitting a scan's points until every part is one target, as compiled code."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.ellipse import chord, moments, width
from algorithms.clustering.parameters import CorrectedPatent, Recommended
from algorithms.clustering.points import Points
from algorithms.compiled import kernel

ROUNDING = 1e-9
"""Sizes that differ by this share of them are equal: a change of unit must not decide between them."""

SLACK = 1.0 + ROUNDING

WHOLE, RANGE, DOPPLER = -1, 0, 1
"""Along which axis a set is split; a whole one is not split."""


class Rule(NamedTuple):
    """When a set is split, as the kernels take it.

    Attributes
    ----------
    at_mean : whether by the chord of the ellipse, at the mean range, as the source does; else by
        the extents, at the widest gap
    range_extent, doppler_extent : the greatest ones of a target
    range_added, doppler_added : what is added to the variances
    """

    at_mean: bool
    range_extent: float
    doppler_extent: float
    range_added: float
    doppler_added: float

    @classmethod
    def of(cls, parameters: Recommended | CorrectedPatent) -> Rule:
        """Return the rule of a mode."""
        if isinstance(parameters, CorrectedPatent):
            return cls(True, parameters.range_extent, np.inf, 0.0, 0.0)
        # A value that is rounded to a cell is off by an even distribution over the cell.
        added = (parameters.range_cell**2 / 12.0, parameters.doppler_cell**2 / 12.0)
        return cls(False, parameters.range_extent, parameters.doppler_extent, *added)


class Splits(NamedTuple):
    """The trees of splits of all scans: every set that was looked at, each before its parts.

    Attributes
    ----------
    order : int64 (n,), the points such that those of every set stand together
    offsets : int64 (scans + 1,), where each scan's sets begin, and the end of the last
    parent : int64 (k,), the set that a set is a part of; −1 for the points of a scan
    first, end : int64 (k,), where a set's points stand in `order`
    axis : int64 (k,), `WHOLE`, or along which axis the set was split
    cut : float64 (k,), where: its points at this value or below are the first part
    gap : float64 (k,), how far the parts are apart along the axis
    """

    order: NDArray[np.int64]
    offsets: NDArray[np.int64]
    parent: NDArray[np.int64]
    first: NDArray[np.int64]
    end: NDArray[np.int64]
    axis: NDArray[np.int64]
    cut: NDArray[np.float64]
    gap: NDArray[np.float64]

    @property
    def leaves(self) -> NDArray[np.int64]:
        """The sets that were not split, scan after scan."""
        return np.flatnonzero(self.axis == WHOLE)


@kernel
def _widest_gap(values, order, centre):  # type: ignore[no-untyped-def]
    """Return the widest gap between neighbours in rising order, and the value below it.

    Of equal gaps, which values in whole cells have often, the one nearest the centre is taken: so
    dense points without a gap are halved, not peeled from one end.
    """
    widest = 0.0
    for place in range(1, len(order)):
        widest = max(widest, values[order[place]] - values[order[place - 1]])
    below, nearest = 0.0, np.inf
    for place in range(1, len(order)):
        low, high = values[order[place - 1]], values[order[place]]
        away = abs(0.5 * (low + high) - centre)
        if (high - low) * SLACK >= widest and away < nearest - ROUNDING * widest:
            below, nearest = low, away
    # Where sums overflow no neighbours are as far apart as the widest gap says: there is no place to cut.
    return widest if nearest < np.inf else 0.0, below


@kernel
def _cut(along, doppler, by_range, by_doppler, rule):  # type: ignore[no-untyped-def]
    """Return where a set is to be split: axis, the value up to which the first part goes, and the gap.

    Parameters
    ----------
    along, doppler : float64 (n,), of all points
    by_range, by_doppler : int64 (m,), the set in rising order of each; with `at_mean` in any order
    """
    mean_r, mean_d, a, b, c = moments(along, doppler, by_range)
    if rule.at_mean:
        if chord(a, b, c) <= rule.range_extent * SLACK:
            return WHOLE, 0.0, 0.0
        below, above = -np.inf, np.inf
        for point in by_range:
            if along[point] <= mean_r:
                below = max(below, along[point])
            else:
                above = min(above, along[point])
        # A mean that rounding has moved onto the greatest range leaves nothing above it.
        if below == -np.inf or above == np.inf:
            return WHOLE, 0.0, 0.0
        return RANGE, mean_r, above - below
    axis, cut, widest, relative = WHOLE, 0.0, 0.0, 0.0
    if width(a + rule.range_added) > rule.range_extent * SLACK:
        gap, below = _widest_gap(along, by_range, mean_r)
        if gap > 0.0:
            axis, cut, widest, relative = RANGE, below, gap, gap / rule.range_extent
    if width(b + rule.doppler_added) > rule.doppler_extent * SLACK:
        gap, below = _widest_gap(doppler, by_doppler, mean_d)
        if gap / rule.doppler_extent > relative * SLACK:
            axis, cut, widest = DOPPLER, below, gap
    return axis, cut, widest


@kernel
def _part(values, cut, order, buffer):  # type: ignore[no-untyped-def]
    """Put the points up to a value before the others, each part in its order; return how many they are."""
    kept, moved = 0, 0
    for place in range(len(order)):
        point = order[place]
        if values[point] <= cut:
            order[kept] = point
            kept += 1
        else:
            buffer[moved] = point
            moved += 1
    for place in range(moved):
        order[kept + place] = buffer[place]
    return kept


@kernel
def _split(along, doppler, offsets, rule, largest):  # type: ignore[no-untyped-def]
    count = len(along)
    scans = len(offsets) - 1
    # A set of n points has at most n parts that are whole, so n − 1 that are split.
    room = 2 * count
    sets = np.zeros(scans + 1, np.int64)
    parent, first, end, axis = (
        np.empty(room, np.int64),
        np.empty(room, np.int64),
        np.empty(room, np.int64),
        np.empty(room, np.int64),
    )
    cut, gap = np.empty(room), np.empty(room)
    by_range = np.arange(count)
    by_doppler = by_range if rule.at_mean else np.arange(count)
    buffer = np.empty(largest, np.int64)
    # What waits: the second parts of the sets above the present one.
    waiting = np.empty((largest + 1, 3), np.int64)
    found = 0
    for scan in range(scans):
        begin, stop = offsets[scan], offsets[scan + 1]
        sets[scan] = found
        if begin == stop:
            continue
        if not rule.at_mean:
            by_range[begin:stop] = begin + np.argsort(along[begin:stop], kind="mergesort")
            by_doppler[begin:stop] = begin + np.argsort(doppler[begin:stop], kind="mergesort")
        waiting[0, 0], waiting[0, 1], waiting[0, 2] = -1, begin, stop
        depth = 1
        while depth > 0:
            depth -= 1
            above, low, high = waiting[depth]
            here = found
            found += 1
            parent[here], first[here], end[here] = above, low, high
            axis[here], cut[here], gap[here] = _cut(
                along, doppler, by_range[low:high], by_doppler[low:high], rule
            )
            if axis[here] == WHOLE:
                continue
            values = along if axis[here] == RANGE else doppler
            middle = low + _part(values, cut[here], by_range[low:high], buffer)
            if not rule.at_mean:
                _part(values, cut[here], by_doppler[low:high], buffer)
            waiting[depth, 0], waiting[depth, 1], waiting[depth, 2] = here, middle, high
            waiting[depth + 1, 0], waiting[depth + 1, 1], waiting[depth + 1, 2] = here, low, middle
            depth += 2
    sets[scans] = found
    return by_range, sets, parent[:found], first[:found], end[:found], axis[:found], cut[:found], gap[:found]


def split(points: Points, rule: Rule) -> Splits:
    """Return the trees of splits of all scans.

    Parameters
    ----------
    points : of any number of scans
    rule : when a set is split

    Notes
    -----
    It ends: a set is split only where points lie on both sides of the cut, so that both parts hold
    at least one point and fewer than the set. A scan of n points is therefore split at most n − 1
    times, whatever its points are. At the mean range, points of equal range have a chord of 0 and
    are whole (as printed in the source, whose chord measures Doppler, they would be split for
    ever); at the widest gap, points that are equal along an axis have no gap there.

    The points are sorted once; each set then takes a time that grows with its number of points. So
    a scan takes O(n log n) where the parts are alike in size, O(n²) where every cut takes off but
    one point, as of gaps that grow steadily.
    """
    largest = int(np.diff(points.offsets).max(initial=0))
    return Splits(*_split(points.range, points.doppler, points.offsets, rule, largest))
