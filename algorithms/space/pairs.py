"""Pairs of plots of different scans that one target can have caused, by its speed."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel


@kernel
def by_x(position, scan):  # type: ignore[no-untyped-def]
    """Return the plots of one batch sorted by scan, then x, and where each scan begins among them.

    Returns
    -------
    order : int64 (n,)
    begins : int64 (scans with plots + 1,)
    """
    count = len(scan)
    order = np.empty(count, np.int64)
    begins = np.empty(count + 1, np.int64)
    scans, first = 0, 0
    while first < count:
        end = first
        while end < count and scan[end] == scan[first]:
            end += 1
        order[first:end] = first + np.argsort(position[first:end, 0])
        begins[scans] = first
        scans += 1
        first = end
    begins[scans] = count
    return order, begins[: scans + 1]


@kernel
def _variance_along(covariance, first, second, x, y, z):  # type: ignore[no-untyped-def]
    """Return the variance of the distance of two plots along their displacement, times its square."""
    total = 0.0
    for plot in (first, second):
        total += x * (covariance[plot, 0, 0] * x + 2.0 * covariance[plot, 0, 1] * y)
        total += y * (covariance[plot, 1, 1] * y + 2.0 * covariance[plot, 1, 2] * z)
        total += z * (covariance[plot, 2, 2] * z + 2.0 * covariance[plot, 0, 2] * x)
    return total


@kernel
def is_within_reach(  # type: ignore[no-untyped-def]
    position, time, covariance, first, second, slowest, fastest, allowance
):
    """Return whether two plots are as far apart as a target can go between them, the noise allowed for.

    Two plots of one time, of different sensors, are within reach where noise alone may part them.
    """
    x = position[second, 0] - position[first, 0]
    y = position[second, 1] - position[first, 1]
    z = position[second, 2] - position[first, 2]
    elapsed = time[second] - time[first]
    if elapsed < 0.0:
        return False
    square = x * x + y * y + z * z
    noise = 0.0
    if allowance > 0.0 and square > 0.0:
        noise = allowance * np.sqrt(_variance_along(covariance, first, second, x, y, z) / square)
    elif allowance > 0.0:
        noise = np.inf
    distance = np.sqrt(square)
    return slowest * elapsed - noise <= distance <= fastest * elapsed + noise


@kernel
def pairs_within_reach(  # type: ignore[no-untyped-def]
    position, time, scan, covariance, slowest, fastest, allowance, steps
):
    """Return the pairs of plots up to `steps` scans apart that are within reach, and how many were tried.

    Parameters
    ----------
    position : float64 (n, 3)
    time, scan, covariance : of the same plots, sorted by scan
    slowest, fastest : speeds
    allowance : standard deviations of the noise along the displacement by which a pair may miss
    steps : most scans between the plots of a pair

    Returns
    -------
    pairs : int64 (pairs, 2), the earlier plot first
    every : number of pairs before the gate
    """
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
                widest = max(widest, covariance[plot, 0, 0] + covariance[plot, 1, 1] + covariance[plot, 2, 2])
                latest = max(latest, time[plot])
            for first in order[begins[earlier] : begins[earlier + 1]]:
                own = covariance[first, 0, 0] + covariance[first, 1, 1] + covariance[first, 2, 2]
                reach = fastest * (latest - time[first]) + allowance * np.sqrt(own + widest)
                begin = np.searchsorted(places, position[first, 0] - reach)
                for k in range(begin, len(sought)):
                    if places[k] > position[first, 0] + reach:
                        break
                    second = sought[k]
                    if is_within_reach(
                        position, time, covariance, first, second, slowest, fastest, allowance
                    ):
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
