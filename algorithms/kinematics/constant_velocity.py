"""Constant velocity: where a motion is at a time, how its estimate is predicted and how it starts.

A motion model is a record of its noise and a kernel `predict`, which moves a state and its
covariance on; the state begins with the position, which is all that `kalman` needs to know of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.kinematics.measured import own_row

Array = NDArray[np.float64]


class Motion(NamedTuple):
    """A motion of constant velocity, without noise.

    Attributes
    ----------
    position, velocity : float64 (d,)
    time : the time at which it is at `position`
    """

    position: Array
    velocity: Array
    time: float


class ConstantVelocity(NamedTuple):
    """A constant velocity but for a white acceleration.

    Attributes
    ----------
    variance : of the acceleration on each axis, which is constant from one prediction to the next
    """

    variance: float = 0.0


@kernel
def squared_miss(motion, measured, plot, axes):  # type: ignore[no-untyped-def]
    """Return the square of the distance of a plot from where a motion is at its time.

    Parameters
    ----------
    motion : `Motion`
    measured : `Measured`
    axes : `PLANE` or `SPACE`
    """
    elapsed, total = measured.time[plot] - motion.time, 0.0
    for axis in range(len(axes)):
        miss = measured.position[plot, axis] - motion.position[axis] - motion.velocity[axis] * elapsed
        total += miss * miss
    return total


@kernel
def predict(model, state, covariance, elapsed, axes):  # type: ignore[no-untyped-def]
    """Move an estimate on by so many seconds, in place: F·P·Fᵀ + Q with F = [1 T; 0 1] an axis.

    Parameters
    ----------
    model : `ConstantVelocity`; Q is its variance times [T⁴/4 T³/2; T³/2 T²] an axis
    state : float64 (2d,), position and velocity
    covariance : float64 (2d, 2d)
    axes : `PLANE` or `SPACE`
    """
    d, square = len(axes), elapsed * elapsed
    for row in range(d):
        state[row] += elapsed * state[d + row]
        for column in range(d):
            covariance[row, column] += elapsed * (covariance[row, d + column] + covariance[d + row, column])
            covariance[row, column] += square * covariance[d + row, d + column]
    for row in range(d):
        for column in range(d):
            covariance[row, d + column] += elapsed * covariance[d + row, d + column]
            covariance[d + column, row] = covariance[row, d + column]
    for axis in range(d):
        covariance[axis, axis] += 0.25 * model.variance * square * square
        covariance[axis, d + axis] += 0.5 * model.variance * square * elapsed
        covariance[d + axis, axis] = covariance[axis, d + axis]
        covariance[d + axis, d + axis] += model.variance * square


@kernel
def start_from_pair(measured, first, second, state, covariance, axes):  # type: ignore[no-untyped-def]
    """Write the estimate that two plots make at the time of the second, which is the later one.

    With R1 and R2 their covariances and T the time between them: place of the second plot with R2,
    their difference over T with (R1 + R2)/T², and R2/T between the two.

    Parameters
    ----------
    measured : `Measured`
    state : float64 (2d,), written
    covariance : float64 (2d, 2d), written
    axes : `PLANE` or `SPACE`
    """
    d, elapsed = len(axes), measured.time[second] - measured.time[first]
    early = measured.covariance[own_row(measured, first)]
    late = measured.covariance[own_row(measured, second)]
    for row in range(d):
        state[row] = measured.position[second, row]
        state[d + row] = (measured.position[second, row] - measured.position[first, row]) / elapsed
        for column in range(d):
            covariance[row, column] = late[row, column]
            covariance[row, d + column] = covariance[d + column, row] = late[row, column] / elapsed
            total = early[row, column] + late[row, column]
            covariance[d + row, d + column] = total / (elapsed * elapsed)
