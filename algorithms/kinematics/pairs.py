"""Pairs of plots of different scans that one target can have caused, by its speed."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.kinematics.gates import can_fly
from algorithms.kinematics.measured import own_row
from algorithms.kinematics.strips import by_x, strip


@kernel
def is_within_reach(measured, gate, first, second, axes):  # type: ignore[no-untyped-def]
    """Return whether two plots are as far apart as a target can go between them, the noise allowed for.

    Two plots of one time, of different sensors, are within reach where noise alone may part them.

    Parameters
    ----------
    measured : `Measured`
    gate : `SpeedGate`
    axes : `PLANE` or `SPACE`
    """
    elapsed = measured.time[second] - measured.time[first]
    if elapsed < 0.0:
        return False
    square, variance = 0.0, 0.0
    early = measured.covariance[own_row(measured, first)]
    late = measured.covariance[own_row(measured, second)]
    for row in range(len(axes)):
        step = measured.position[second, row] - measured.position[first, row]
        square += step * step
        for column in range(len(axes)):
            other = measured.position[second, column] - measured.position[first, column]
            variance += step * (early[row, column] + late[row, column]) * other
    if gate.allowance == 0.0:
        return can_fly(gate, np.sqrt(square), elapsed, 0.0)
    # Two plots at one place have no direction along which they could have a distance: any will do.
    deviation = np.sqrt(variance / square) if square > 0.0 else np.inf
    return can_fly(gate, np.sqrt(square), elapsed, deviation)


@kernel
def _variance(measured, plot, axes):  # type: ignore[no-untyped-def]
    """Return the sum of the variances of a plot on all axes: none along a direction is greater."""
    own, total = own_row(measured, plot), 0.0
    for axis in range(len(axes)):
        total += measured.covariance[own, axis, axis]
    return total


@kernel
def pairs_within_reach(measured, gate, steps, axes):  # type: ignore[no-untyped-def]
    """Return the pairs of plots up to `steps` scans apart that are within reach, and how many were tried.

    Parameters
    ----------
    measured : `Measured`, one batch sorted by scan
    gate : `SpeedGate`
    steps : most scans between the plots of a pair
    axes : `PLANE` or `SPACE`

    Returns
    -------
    pairs : int64 (pairs, 2), the earlier plot first
    every : number of pairs before the gate
    """
    position, time, scan = measured.position, measured.time, measured.scan
    order, begins = by_x(position, scan)
    pairs = np.empty((4 * len(scan) + 16, 2), np.int64)
    count, every = 0, 0
    for earlier in range(len(begins) - 2):
        for later in range(earlier + 1, len(begins) - 1):
            if scan[order[begins[later]]] - scan[order[begins[earlier]]] > steps:
                break
            sought = order[begins[later] : begins[later + 1]]
            every += (begins[earlier + 1] - begins[earlier]) * len(sought)
            places = position[sought, 0]
            # No two plots with a greater distance in x than this can be within reach.
            widest, latest = 0.0, -np.inf
            for plot in sought:
                widest = max(widest, _variance(measured, plot, axes))
                latest = max(latest, time[plot])
            for first in order[begins[earlier] : begins[earlier + 1]]:
                noise = gate.allowance * np.sqrt(_variance(measured, first, axes) + widest)
                reach = gate.fastest * (latest - time[first]) + noise
                begin, end = strip(places, position[first, 0], reach)
                for second in sought[begin:end]:
                    if is_within_reach(measured, gate, first, second, axes):
                        if count == len(pairs):
                            larger = np.empty((2 * count, 2), np.int64)
                            larger[:count] = pairs
                            pairs = larger
                        pairs[count, 0], pairs[count, 1] = first, second
                        count += 1
    return pairs[:count], every


@kernel
def by_first(pairs, kept, count):  # type: ignore[no-untyped-def]
    """Return the kept pairs sorted by their first plot, and where those of each of `count` plots begin.

    Returns
    -------
    sorted_pairs : int64 (kept pairs, 2)
    begins : int64 (count + 1,)
    """
    begins = np.zeros(count + 1, np.int64)
    for pair in range(len(pairs)):
        if kept[pair]:
            begins[pairs[pair, 0] + 1] += 1
    for plot in range(count):
        begins[plot + 1] += begins[plot]
    sorted_pairs = np.empty((begins[count], 2), np.int64)
    places = begins.copy()
    for pair in range(len(pairs)):
        if kept[pair]:
            sorted_pairs[places[pairs[pair, 0]]] = pairs[pair]
            places[pairs[pair, 0]] += 1
    return sorted_pairs, begins


@kernel
def root(parents, node):  # type: ignore[no-untyped-def]
    """Return the representative of a node's component; the way there is shortened."""
    while parents[node] != node:
        parents[node] = parents[parents[node]]
        node = parents[node]
    return node


@kernel
def components(count, pairs, kept):  # type: ignore[no-untyped-def]
    """Return a representative for each of `count` plots, the same for those that kept pairs connect.

    Parameters
    ----------
    pairs : int64 (k, 2)
    kept : bool (k,)
    """
    parents = np.arange(count)
    for pair in range(len(pairs)):
        if kept[pair]:
            first, second = root(parents, pairs[pair, 0]), root(parents, pairs[pair, 1])
            parents[max(first, second)] = min(first, second)
    for node in range(count):
        parents[node] = root(parents, node)
    return parents
