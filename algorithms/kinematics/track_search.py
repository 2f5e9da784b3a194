"""Search for tracks of constant velocity along pairs of plots, and the choice among those that fit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.kinematics.gates import SpeedGate, can_fly, fit_limits
from algorithms.kinematics.least_squares import Fit, Fitting, Sums, add_plot, fit
from algorithms.kinematics.pairs import by_first

Array = NDArray[np.float64]
Rows = NDArray[np.int64]

MOST_FOUND = 20_000
"""The most tracks of a batch that are compared with one another."""

MOST_ROOM = 2**27
"""The most plots of all these tracks together, a GiB of them: of long tracks fewer are compared."""


class TrackRule(NamedTuple):
    """What makes plots a track of constant velocity.

    Attributes
    ----------
    gate : `SpeedGate`, of each pair of plots and of the fitted velocity
    least : least number of plots
    limits : float64 (2, most + 1), the greatest χ² by the number of plots; see `gates.fit_limits`
    planes : int64 (k, 2), axes of planes in which the velocity has the least speed, too, as it is
    """

    gate: SpeedGate
    least: int
    limits: Array
    planes: Rows

    @classmethod
    def of(cls, gate: SpeedGate, least: int, confidence: float, most: int, dimensions: int) -> TrackRule:
        """Return the rule for tracks of at most so many plots, with a χ² test of a confidence."""
        return cls(gate, least, fit_limits(confidence, most, dimensions), np.zeros((0, 2), np.int64))

    @property
    def most(self) -> int:
        """The most plots of a track."""
        return int(self.limits.shape[1]) - 1


class Candidates(NamedTuple):
    """Tracks that fit, and the working space of their search.

    Attributes
    ----------
    plots : int64 (most tracks, most plots), rows of the plots of each track, −1 beyond the last; there
        are `MOST_FOUND` rows, or as many as `MOST_ROOM` leaves
    squares : float64 (most tracks,), χ² of each
    path, following : int64 (most plots,), the track on the way, and the next pair of each of its plots
    fitting : `Fitting`, with a row of sums for each number of plots
    """

    plots: Rows
    squares: Array
    path: Rows
    following: Rows
    fitting: Fitting

    @classmethod
    def of(cls, most: int, dimensions: int) -> Candidates:
        """Return space for tracks of at most so many plots."""
        room = min(MOST_FOUND, max(MOST_ROOM // most, 1))
        return cls(
            np.empty((room, most), np.int64),
            np.empty(room),
            np.empty(most, np.int64),
            np.empty(most, np.int64),
            Fitting(Sums.of(most + 1, dimensions), Fit.of(dimensions)),
        )


@kernel
def _has_least_speeds(state, rule):  # type: ignore[no-untyped-def]
    """Return whether a velocity has the least speed in each plane that the rule names."""
    for plane in range(len(rule.planes)):
        across, up = state[1, rule.planes[plane, 0]], state[1, rule.planes[plane, 1]]
        if not np.sqrt(across * across + up * up) >= rule.gate.slowest:
            return False
    return True


@kernel
def search_motions(measured, pairs, begins, usable, rule, made, axes):  # type: ignore[no-untyped-def]
    """Write the tracks of constant velocity along pairs of usable plots, and return how many there are.

    From every plot a track is continued by each plot that a pair leads to, as long as the fit to
    what it has passes its χ² and its speed limits; it is kept where it has enough plots.

    Parameters
    ----------
    measured : `Measured`, one batch
    pairs : int64 (k, 2), sorted by their first plot
    begins : int64 (n + 1,), where each plot's pairs begin
    usable : bool (n,), which plots may be used
    rule : `TrackRule`
    made : `Candidates`, written
    axes : `PLANE` or `SPACE`
    """
    path, following, sums, fitted = made.path, made.following, made.fitting.sums, made.fitting.fit
    time, limits, deepest, count = measured.time, rule.limits, made.plots.shape[1], 0
    for start in range(len(time)):
        if not usable[start]:
            continue
        path[0], following[0] = start, begins[start]
        add_plot(sums, 0, 1, measured, start, start, axes)
        depth = 1
        while depth > 0:
            last = path[depth - 1]
            if depth == deepest or following[depth - 1] == begins[last + 1]:
                depth -= 1
                continue
            plot = pairs[following[depth - 1], 1]
            following[depth - 1] += 1
            if not usable[plot]:
                continue
            add_plot(sums, depth, depth + 1, measured, plot, start, axes)
            # Plots of one time leave the velocity open: they are not tested before a later one comes.
            if depth + 1 > 2 and time[plot] > time[start]:
                square, speed, deviation = fit(sums, depth + 1, fitted, axes)
                if square > limits[1, depth + 1] or not can_fly(rule.gate, speed, 1.0, deviation):
                    continue
                is_enough = depth + 1 >= rule.least and square <= limits[0, depth + 1]
                if is_enough and count < len(made.plots) and _has_least_speeds(fitted.state, rule):
                    path[depth] = plot
                    made.plots[count, :] = -1
                    made.plots[count, : depth + 1] = path[: depth + 1]
                    made.squares[count] = square
                    count += 1
            path[depth], following[depth] = plot, begins[plot]
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
def disjoint_tracks(measured, pairs, kept, usable, rule, made, axes):  # type: ignore[no-untyped-def]
    """Return the best tracks of constant velocity along kept pairs of usable plots, no plot in two of them.

    Parameters
    ----------
    measured : `Measured`, one batch
    pairs : int64 (k, 2)
    kept : bool (k,)
    usable : bool (n,)
    rule : `TrackRule`
    made : `Candidates`, written
    axes : `PLANE` or `SPACE`

    Returns
    -------
    chosen : int64 (tracks,), rows of the candidates, the best first
    is_full : whether more tracks fit than can be compared; then none is chosen
    """
    sorted_pairs, begins = by_first(pairs, kept, len(usable))
    number = search_motions(measured, sorted_pairs, begins, usable, rule, made, axes)
    chosen = np.empty(number, np.int64)
    if number == len(made.plots):
        return chosen[:0], True
    taken = np.zeros(len(usable), np.bool_)
    return chosen[: choose_disjoint(made.plots, made.squares, number, taken, chosen)], False
