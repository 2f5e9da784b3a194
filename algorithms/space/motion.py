"""Tracks of constant velocity in space: least squares with covariances, and the search for what fits."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel

MOST_FOUND = 20_000
"""The most tracks of a batch that are compared with one another."""


@cache
def chi_square_limits(confidence: float, most: int) -> NDArray[np.float64]:
    """Return the greatest χ² of a fit to 0, 1, …, `most` plots in space, for a track and on the way to one.

    A constant velocity has 6 parameters, so m plots leave 3m − 6 degrees of freedom; for 2 plots
    and fewer every fit passes. What is continued need not pass the same test: of a target with
    four plots the first three would fail it as often again.

    Returns
    -------
    limits : float64 (2, most + 1), at the confidence, and at a hundredth of what is left to 1
    """
    # Imported here: scipy takes a tenth of a second that only initiation in space needs.
    from scipy.special import chdtri

    plots = np.arange(most + 1)
    limits = np.full((2, most + 1), np.inf)
    for row, missed in enumerate((1.0 - confidence, 0.01 * (1.0 - confidence))):
        limits[row, 3:] = chdtri(3 * plots[3:] - 6, missed)
    return limits


@kernel
def inverse(a, made):  # type: ignore[no-untyped-def]
    """Write the inverse of a symmetric 3 × 3 matrix."""
    c00 = a[1, 1] * a[2, 2] - a[1, 2] * a[1, 2]
    c01 = a[0, 2] * a[1, 2] - a[0, 1] * a[2, 2]
    c02 = a[0, 1] * a[1, 2] - a[0, 2] * a[1, 1]
    scale = 1.0 / (a[0, 0] * c00 + a[0, 1] * c01 + a[0, 2] * c02)
    made[0, 0] = c00 * scale
    made[0, 1] = made[1, 0] = c01 * scale
    made[0, 2] = made[2, 0] = c02 * scale
    made[1, 1] = (a[0, 0] * a[2, 2] - a[0, 2] * a[0, 2]) * scale
    made[1, 2] = made[2, 1] = (a[0, 1] * a[0, 2] - a[0, 0] * a[1, 2]) * scale
    made[2, 2] = (a[0, 0] * a[1, 1] - a[0, 1] * a[0, 1]) * scale


@kernel
def add_plot(sums, vectors, squares, depth, weight, plot, x, y, z, elapsed):  # type: ignore[no-untyped-def]
    """Write at `depth` the sums of the plots at the depth before and one more.

    Parameters
    ----------
    sums : float64 (depths, 3, 3, 3), of W, t·W and t²·W
    vectors : float64 (depths, 2, 3), of W·p and t·W·p
    squares : float64 (depths,), of pᵀ·W·p
    weight : float64 (n, 3, 3), the inverse covariances W
    x, y, z, elapsed : place p and time t of the plot, from the first one of the track
    """
    total = 0.0
    for row in range(3):
        pushed = weight[plot, row, 0] * x + weight[plot, row, 1] * y + weight[plot, row, 2] * z
        vectors[depth, 0, row] = vectors[depth - 1, 0, row] + pushed
        vectors[depth, 1, row] = vectors[depth - 1, 1, row] + elapsed * pushed
        total += pushed * (x if row == 0 else y if row == 1 else z)
        for column in range(3):
            value = weight[plot, row, column]
            sums[depth, 0, row, column] = sums[depth - 1, 0, row, column] + value
            sums[depth, 1, row, column] = sums[depth - 1, 1, row, column] + elapsed * value
            sums[depth, 2, row, column] = sums[depth - 1, 2, row, column] + elapsed * elapsed * value
    squares[depth] = squares[depth - 1] + total


@kernel
def fit(sums, vectors, squares, depth, still, moving, state):  # type: ignore[no-untyped-def]
    """Return χ², speed and the standard deviation of the speed of the best constant velocity.

    With S0, S1, S2 the sums of W, t·W, t²·W and b0, b1 those of W·p, t·W·p:
    v = (S2 − S1·S0⁻¹·S1)⁻¹·(b1 − S1·S0⁻¹·b0) and p = S0⁻¹·(b0 − S1·v).

    Parameters
    ----------
    sums, vectors, squares, depth : see `add_plot`; at least two plots at different times
    still, moving : float64 (3, 3), working space
    state : float64 (2, 3), is given p and v
    """
    inverse(sums[depth, 0], still)
    joint, left = moving, np.zeros(3)
    for row in range(3):
        for column in range(3):
            total = sums[depth, 2, row, column]
            for k in range(3):
                for m in range(3):
                    total -= sums[depth, 1, row, k] * still[k, m] * sums[depth, 1, m, column]
            joint[row, column] = total
        left[row] = vectors[depth, 1, row]
        for k in range(3):
            for m in range(3):
                left[row] -= sums[depth, 1, row, k] * still[k, m] * vectors[depth, 0, m]
    spread = np.empty((3, 3))
    inverse(joint, spread)
    for row in range(3):
        state[1, row] = spread[row, 0] * left[0] + spread[row, 1] * left[1] + spread[row, 2] * left[2]
    for row in range(3):
        left[row] = vectors[depth, 0, row]
        for k in range(3):
            left[row] -= sums[depth, 1, row, k] * state[1, k]
    square = squares[depth]
    for row in range(3):
        state[0, row] = still[row, 0] * left[0] + still[row, 1] * left[1] + still[row, 2] * left[2]
        square -= state[0, row] * vectors[depth, 0, row] + state[1, row] * vectors[depth, 1, row]
    speed = np.sqrt(state[1, 0] ** 2 + state[1, 1] ** 2 + state[1, 2] ** 2)
    variance = 0.0
    if speed > 0.0:
        for row in range(3):
            for column in range(3):
                variance += state[1, row] * spread[row, column] * state[1, column]
        variance /= speed * speed
    else:
        variance = spread[0, 0] + spread[1, 1] + spread[2, 2]
    return max(square, 0.0), speed, np.sqrt(max(variance, 0.0))


@kernel
def _keep(found, squares, count, path, length, square):  # type: ignore[no-untyped-def]
    found[count, :] = -1
    found[count, :length] = path[:length]
    squares[count] = square
    return count + 1


@kernel
def search_motions(  # type: ignore[no-untyped-def]
    position, time, weight, pairs, usable, plots, least, limits, slowest, fastest, allowance, planes,
    found, squares,
):  # fmt: skip
    """Write the tracks of constant velocity along pairs of usable plots, and return how many there are.

    From every plot a track is continued by each plot that a pair leads to, as long as the fit to
    what it has passes its χ² and its speed limits; it is kept where it has enough plots.

    Parameters
    ----------
    position, time, weight : of the batch; see `add_plot`
    pairs : int64 (k, 2), sorted by their first plot
    usable : bool (n,), which plots may be used
    plots : int64 (n + 1,), where each plot's pairs begin
    least : least number of plots of a track
    limits : float64 (2, …), the greatest χ² by the number of plots; see `chi_square_limits`
    slowest, fastest, allowance : of the speed, and standard deviations by which it may miss
    planes : int64 (k, 2), axes of planes in which the velocity has the least speed, too, as it is
    found : int64 (≥ `MOST_FOUND`, most plots of a track), is given the plots of each track, −1 beyond
    squares : float64 of the same length, is given χ²
    """
    deepest = found.shape[1]
    sums, vectors = np.zeros((deepest + 1, 3, 3, 3)), np.zeros((deepest + 1, 2, 3))
    totals = np.zeros(deepest + 1)
    still, moving, state = np.empty((3, 3)), np.empty((3, 3)), np.empty((2, 3))
    path, following = np.empty(deepest, np.int64), np.empty(deepest, np.int64)
    count = 0
    for start in range(len(position)):
        if not usable[start]:
            continue
        path[0], following[0] = start, plots[start]
        add_plot(sums, vectors, totals, 1, weight, start, 0.0, 0.0, 0.0, 0.0)
        depth = 1
        while depth > 0:
            last = path[depth - 1]
            if depth == deepest or following[depth - 1] == plots[last + 1]:
                depth -= 1
                continue
            pair = following[depth - 1]
            following[depth - 1] += 1
            plot = pairs[pair, 1]
            if not usable[plot]:
                continue
            x = position[plot, 0] - position[start, 0]
            y = position[plot, 1] - position[start, 1]
            z = position[plot, 2] - position[start, 2]
            add_plot(sums, vectors, totals, depth + 1, weight, plot, x, y, z, time[plot] - time[start])
            # Plots of one time leave the velocity open: they are not tested before a later one comes.
            if depth + 1 > 2 and time[plot] > time[start]:
                square, speed, deviation = fit(sums, vectors, totals, depth + 1, still, moving, state)
                noise = allowance * deviation
                if square > limits[1, depth + 1] or not slowest - noise <= speed <= fastest + noise:
                    continue
                is_enough = depth + 1 >= least and square <= limits[0, depth + 1]
                for plane in range(len(planes)):
                    across, up = state[1, planes[plane, 0]], state[1, planes[plane, 1]]
                    is_enough = is_enough and np.sqrt(across * across + up * up) >= slowest
                if is_enough and count < len(found):
                    path[depth] = plot
                    count = _keep(found, squares, count, path, depth + 1, square)
            path[depth], following[depth] = plot, plots[plot]
            depth += 1
    return count


@kernel
def choose_disjoint(found, squares, count, taken, chosen):  # type: ignore[no-untyped-def]
    """Write which tracks are taken, best first: more plots, then less χ²; no plot is in two of them.

    Parameters
    ----------
    found, squares, count : tracks, as `search_motions` writes them
    taken : bool (n,), plots that are taken already; changed in place
    chosen : int64 (≥ count,), is given the tracks
    """
    lengths = np.empty(count)
    for track in range(count):
        length = 0
        while length < found.shape[1] and found[track, length] >= 0:
            length += 1
        # More plots always come before less χ².
        lengths[track] = -float(length) + squares[track] / (1.0 + squares[track])
    number = 0
    for track in np.argsort(lengths, kind="mergesort"):
        is_free = True
        for plot in found[track]:
            if plot >= 0 and taken[plot]:
                is_free = False
        if is_free:
            for plot in found[track]:
                if plot >= 0:
                    taken[plot] = True
            chosen[number] = track
            number += 1
    return number


@kernel
def write_track(position, time, weight, rows, plots, state, track):  # type: ignore[no-untyped-def]
    """Write the plots of a track and the state that fits them; return how many plots there are.

    Parameters
    ----------
    position, time, weight : of the batch
    rows : int64, the plots, −1 beyond the last
    plots : int64 (tracks, ≥ rows), is given the plots in row `track`
    state : float64 (tracks, 2, 3), is given the place at the time of the first plot, and the velocity
    """
    count = 0
    while count < len(rows) and rows[count] >= 0:
        plots[track, count] = rows[count]
        count += 1
    sums, vectors, totals = np.zeros((count + 1, 3, 3, 3)), np.zeros((count + 1, 2, 3)), np.zeros(count + 1)
    start = rows[0]
    for k in range(count):
        x = position[rows[k], 0] - position[start, 0]
        y = position[rows[k], 1] - position[start, 1]
        z = position[rows[k], 2] - position[start, 2]
        add_plot(sums, vectors, totals, k + 1, weight, rows[k], x, y, z, time[rows[k]] - time[start])
    fit(sums, vectors, totals, count, np.empty((3, 3)), np.empty((3, 3)), state[track])
    for axis in range(3):
        state[track, 0, axis] += position[start, axis]
    return count
