"""Least squares of a constant velocity over plots, each weighted by the inverse of its covariance.

With t the time of a plot from the first one, p its place from there and W its weight, the sums
S0, S1, S2 of W, t·W, t²·W and b0, b1 of W·p, t·W·p give the velocity
v = (S2 − S1·S0⁻¹·S1)⁻¹·(b1 − S1·S0⁻¹·b0) and the place S0⁻¹·(b0 − S1·v) at the time of the first plot.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.kinematics.matrices import inverse
from algorithms.kinematics.measured import own_row, part_of

Array = NDArray[np.float64]


class Sums(NamedTuple):
    """Sums over plots: with a row for each number of plots the last plot can be taken back.

    Attributes
    ----------
    weight : float64 (k, 3, d, d), S0, S1 and S2
    pushed : float64 (k, 2, d), b0 and b1
    squares : float64 (k,), the sum of pᵀ·W·p
    """

    weight: Array
    pushed: Array
    squares: Array

    @classmethod
    def of(cls, rows: int, dimensions: int) -> Sums:
        """Return so many rows, all of no plots."""
        shape = (dimensions, dimensions)
        return cls(np.zeros((rows, 3, *shape)), np.zeros((rows, 2, dimensions)), np.zeros(rows))


class Fit(NamedTuple):
    """A fitted constant velocity, and the matrices on the way to it.

    Attributes
    ----------
    state : float64 (2, d), place from the first plot, at its time, and velocity
    still : float64 (d, d), S0⁻¹, the covariance of the place if the velocity were 0 for sure
    joint : float64 (d, d), S2 − S1·S0⁻¹·S1
    spread : float64 (d, d), the covariance of the velocity, the inverse of `joint`
    left : float64 (d,), working space
    """

    state: Array
    still: Array
    joint: Array
    spread: Array
    left: Array

    @classmethod
    def of(cls, dimensions: int) -> Fit:
        """Return space for a fit."""
        still, joint, spread = np.empty((3, dimensions, dimensions))
        return cls(np.empty((2, dimensions)), still, joint, spread, np.empty(dimensions))


@kernel
def add_plot(sums, before, after, measured, plot, start, axes):  # type: ignore[no-untyped-def]
    """Write in the row `after` the sums of the row `before` and one more plot.

    Parameters
    ----------
    sums : `Sums`
    before, after : rows, which may be the same
    measured : `Measured`
    plot, start : the plot, and the first one of its track
    axes : `PLANE` or `SPACE`
    """
    elapsed = measured.time[plot] - measured.time[start]
    own = own_row(measured, plot)
    weight, pushed = sums.weight, sums.pushed
    total = 0.0
    for row in range(len(axes)):
        push = 0.0
        for column in range(len(axes)):
            value = measured.weight[own, row, column]
            push += value * (measured.position[plot, column] - measured.position[start, column])
            weight[after, 0, row, column] = weight[before, 0, row, column] + value
            weight[after, 1, row, column] = weight[before, 1, row, column] + elapsed * value
            weight[after, 2, row, column] = weight[before, 2, row, column] + elapsed * elapsed * value
        pushed[after, 0, row] = pushed[before, 0, row] + push
        pushed[after, 1, row] = pushed[before, 1, row] + elapsed * push
        total += push * (measured.position[plot, row] - measured.position[start, row])
    sums.squares[after] = sums.squares[before] + total


@kernel
def fit(sums, held, made, axes):  # type: ignore[no-untyped-def]
    """Write the best constant velocity; return χ², speed and the standard deviation of the speed.

    Parameters
    ----------
    sums : `Sums`
    held : row of the sums, of at least two plots at different times
    made : `Fit`, written
    axes : `PLANE` or `SPACE`
    """
    weight, pushed = sums.weight[held], sums.pushed[held]
    state, still, joint, spread, left = made.state, made.still, made.joint, made.spread, made.left
    dimensions = len(axes)
    inverse(weight[0], still, axes)
    for row in range(dimensions):
        for column in range(dimensions):
            total = weight[2, row, column]
            for k in range(dimensions):
                for m in range(dimensions):
                    total -= weight[1, row, k] * still[k, m] * weight[1, m, column]
            joint[row, column] = total
        left[row] = pushed[1, row]
        for k in range(dimensions):
            for m in range(dimensions):
                left[row] -= weight[1, row, k] * still[k, m] * pushed[0, m]
    inverse(joint, spread, axes)
    for row in range(dimensions):
        state[1, row] = 0.0
        for k in range(dimensions):
            state[1, row] += spread[row, k] * left[k]
    for row in range(dimensions):
        left[row] = pushed[0, row]
        for k in range(dimensions):
            left[row] -= weight[1, row, k] * state[1, k]
    square, speed = sums.squares[held], 0.0
    for row in range(dimensions):
        state[0, row] = 0.0
        for k in range(dimensions):
            state[0, row] += still[row, k] * left[k]
        square -= state[0, row] * pushed[0, row] + state[1, row] * pushed[1, row]
        speed += state[1, row] ** 2
    speed = np.sqrt(speed)
    variance = 0.0
    for row in range(dimensions):
        if speed > 0.0:
            for column in range(dimensions):
                variance += state[1, row] * spread[row, column] * state[1, column]
        else:
            variance += spread[row, row]
    if speed > 0.0:
        variance /= speed * speed
    return max(square, 0.0), speed, np.sqrt(max(variance, 0.0))


@kernel
def _write_covariance(sums, held, made, covariance, axes):  # type: ignore[no-untyped-def]
    """Write the covariance of place and velocity: S0⁻¹ + G·V·Gᵀ, −G·V and V, with G = S0⁻¹·S1.

    Parameters
    ----------
    sums, held, made : as of `fit`, which has been called
    covariance : float64 (2d, 2d), written
    """
    weight, still, spread = sums.weight[held], made.still, made.spread
    dimensions = len(axes)
    lever = made.joint
    for row in range(dimensions):
        for column in range(dimensions):
            lever[row, column] = 0.0
            for k in range(dimensions):
                lever[row, column] += still[row, k] * weight[1, k, column]
    for row in range(dimensions):
        for column in range(dimensions):
            total = 0.0
            for k in range(dimensions):
                total -= lever[row, k] * spread[k, column]
            covariance[row, dimensions + column] = total
            covariance[dimensions + column, row] = total
            covariance[dimensions + row, dimensions + column] = spread[row, column]
    for row in range(dimensions):
        for column in range(dimensions):
            total = still[row, column]
            for k in range(dimensions):
                total -= covariance[row, dimensions + k] * lever[column, k]
            covariance[row, column] = total


class Fitting(NamedTuple):
    """Working space of `fit_track`.

    Attributes
    ----------
    sums : at least two rows, the first of no plots
    fit : the last fit
    """

    sums: Sums
    fit: Fit

    @classmethod
    def of(cls, dimensions: int) -> Fitting:
        """Return space for the fit of a track."""
        return cls(Sums.of(2, dimensions), Fit.of(dimensions))


@kernel
def fit_track(measured, rows, space, states, track, axes):  # type: ignore[no-untyped-def]
    """Write the state of one track, at the scan and the time of its first plot; return how many plots it has.

    Where the plots leave the velocity open, since they are of one time, the place is their weighted
    mean.

    Parameters
    ----------
    measured : `Measured`
    rows : int64, the plots, −1 beyond the last
    space : `Fitting`
    states : `TrackStates`, written at `track`
    axes : `PLANE` or `SPACE`
    """
    dimensions, count, sums, made = len(axes), 0, space.sums, space.fit
    while count < len(rows) and rows[count] >= 0:
        add_plot(sums, min(count, 1), 1, measured, rows[count], rows[0], axes)
        count += 1
    if count == 0:
        return count
    start = rows[0]
    states.scan[track], states.time[track] = measured.scan[start], measured.time[start]
    fit(sums, 1, made, axes)
    is_open = False
    for axis in range(dimensions):
        is_open = is_open or not np.isfinite(made.state[0, axis] + made.state[1, axis])
    for axis in range(dimensions):
        place = made.state[0, axis]
        if is_open:
            place = 0.0
            for k in range(dimensions):
                place += made.still[axis, k] * sums.pushed[1, 0, k]
        states.position[track, axis] = measured.position[start, axis] + place
        states.velocity[track, axis] = np.nan if is_open else made.state[1, axis]
    if is_open:
        states.covariance[track] = np.nan
        states.covariance[track, :dimensions, :dimensions] = made.still
    else:
        _write_covariance(sums, 1, made, states.covariance[track], axes)
    return count


@kernel
def fit_tracks(measured, offsets, track_offsets, plots, space, states, axes):  # type: ignore[no-untyped-def]
    """Write the states of the tracks of a chunk of trials; see `fit_track`.

    Parameters
    ----------
    offsets, track_offsets : int64 (trials + 1,), where each trial's plots and tracks begin
    plots : int64 (m, k), the rows of each track's plots counted from the beginning of its trial
    """
    for trial in range(len(offsets) - 1):
        own = part_of(measured, offsets[trial], offsets[trial + 1])
        for track in range(track_offsets[trial], track_offsets[trial + 1]):
            fit_track(own, plots[track], space, states, track, axes)
