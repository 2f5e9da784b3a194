"""Kalman filter: innovation, gate and update of any state that begins with a position."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from algorithms.compiled import kernel
from algorithms.kinematics.constant_velocity import ConstantVelocity, predict
from algorithms.kinematics.gates import chi_square_gate
from algorithms.kinematics.matrices import axes_of, inverse

Array = NDArray[np.float64]


class Innovation(NamedTuple):
    """What a plot says beyond a prediction; working space of `innovate` and `update`.

    Attributes
    ----------
    miss : float64 (d,), plot less predicted place
    covariance, inverse : float64 (d, d), of the miss, S
    crossed : float64 (k, d), covariance of the state with its place, P·Hᵀ
    gain : float64 (k, d), P·Hᵀ·S⁻¹
    """

    miss: Array
    covariance: Array
    inverse: Array
    crossed: Array
    gain: Array

    @classmethod
    def of(cls, dimensions: int, states: int) -> Innovation:
        """Return space for plots of d dimensions and states of so many components."""
        return cls(
            np.empty(dimensions),
            np.empty((dimensions, dimensions)),
            np.empty((dimensions, dimensions)),
            np.empty((states, dimensions)),
            np.empty((states, dimensions)),
        )


@kernel
def innovate(state, covariance, place, noise, made, axes):  # type: ignore[no-untyped-def]
    """Write the innovation of a plot; return its normalised square missᵀ·S⁻¹·miss and det S.

    The square is what a gate is put on (see `gates.chi_square_gate`); both make the plot's likelihood
    exp(−square/2)/√((2π)^d·det S).

    Parameters
    ----------
    state : float64 (k,), predicted; its first d components are the position
    covariance : float64 (k, k)
    place : float64 (≥ d,), position of the plot
    noise : float64 (d, d), its covariance
    made : `Innovation`, written but for the gain
    axes : `PLANE` or `SPACE`
    """
    for row in range(len(axes)):
        made.miss[row] = place[row] - state[row]
        for column in range(len(axes)):
            made.covariance[row, column] = covariance[row, column] + noise[row, column]
    determinant = inverse(made.covariance, made.inverse, axes)
    square = 0.0
    for row in range(len(axes)):
        for column in range(len(axes)):
            square += made.miss[row] * made.inverse[row, column] * made.miss[column]
    return square, determinant


@kernel
def update(state, covariance, made, axes):  # type: ignore[no-untyped-def]
    """Correct an estimate by the innovation written last, in place: state + K·miss, P − K·S·Kᵀ.

    Parameters
    ----------
    state : float64 (k,)
    covariance : float64 (k, k)
    made : `Innovation`; the gain is written
    axes : `PLANE` or `SPACE`
    """
    crossed, gain = made.crossed, made.gain
    for row in range(len(state)):
        for column in range(len(axes)):
            crossed[row, column] = covariance[row, column]
    for row in range(len(state)):
        for column in range(len(axes)):
            gain[row, column] = 0.0
            for k in range(len(axes)):
                gain[row, column] += crossed[row, k] * made.inverse[k, column]
            state[row] += gain[row, column] * made.miss[column]
    for row in range(len(state)):
        for column in range(row, len(state)):
            for k in range(len(axes)):
                covariance[row, column] -= gain[row, k] * crossed[column, k]
            covariance[column, row] = covariance[row, column]


class Estimate(NamedTuple):
    """What a filter holds of a target at a time.

    Attributes
    ----------
    state : float64 (2d,), position and velocity
    covariance : float64 (2d, 2d)
    time : seconds
    """

    state: Array
    covariance: Array
    time: float

    @classmethod
    def of(cls, position: ArrayLike, velocity: ArrayLike, covariance: ArrayLike, time: float) -> Estimate:
        """Return an estimate of a checked shape, such as a track's state.

        Raises
        ------
        ValueError
            Where shapes do not fit together, or a value is not finite.
        """
        state = np.concatenate([np.asarray(position, dtype=float), np.asarray(velocity, dtype=float)])
        square = np.array(covariance, dtype=float)
        axes_of(len(state) // 2)
        if square.shape != (len(state), len(state)):
            raise ValueError(
                f"a covariance of shape {square.shape} is given with a state of {len(state)} components"
            )
        if not (np.isfinite(state).all() and np.isfinite(square).all() and np.isfinite(time)):
            raise ValueError("an estimate has a value that is not finite; an open state starts no filter")
        return cls(state, square, float(time))


def predicted(estimate: Estimate, time: float, model: ConstantVelocity) -> Estimate:
    """Return an estimate moved to another time by a motion model."""
    state, covariance = estimate.state.copy(), estimate.covariance.copy()
    predict(model, state, covariance, time - estimate.time, axes_of(len(state) // 2))
    return Estimate(state, covariance, time)


def updated(
    estimate: Estimate, place: ArrayLike, noise: ArrayLike, gate: float | None = None
) -> tuple[Estimate, float] | None:
    """Return an estimate corrected by a plot of its time, and the plot's normalised squared innovation.

    Parameters
    ----------
    estimate : predicted to the time of the plot
    place : position of the plot, d numbers
    noise : its covariance, d × d
    gate : probability with which a target's own plot lies inside the gate; None takes any plot

    Returns
    -------
    None where the plot lies outside the gate.

    Raises
    ------
    ValueError
        Where shapes do not fit the estimate.
    """
    state, covariance = estimate.state.copy(), estimate.covariance.copy()
    dimensions = len(state) // 2
    at, spread = np.asarray(place, dtype=float), np.asarray(noise, dtype=float)
    if at.shape != (dimensions,) or spread.shape != (dimensions, dimensions):
        raise ValueError(
            f"a plot of shape {at.shape} with a covariance of shape {spread.shape} is given to an estimate "
            f"in {dimensions} dimensions"
        )
    axes, made = axes_of(dimensions), Innovation.of(dimensions, len(state))
    square, _ = innovate(state, covariance, at, spread, made, axes)
    if gate is not None and square > chi_square_gate(gate, dimensions):
        return None
    update(state, covariance, made, axes)
    return Estimate(state, covariance, estimate.time), float(square)
