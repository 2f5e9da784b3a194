"""Polar measurements to cartesian positions with their covariance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel

Array = NDArray[np.float64]


@kernel
def _direction(azimuth, elevation, way):  # type: ignore[no-untyped-def]
    """Write the unit vector of a direction, as many axes of it as there is room for."""
    ground = math.cos(elevation)
    way[0] = ground * math.sin(azimuth)
    way[1] = ground * math.cos(azimuth)
    if len(way) > 2:
        way[2] = math.sin(elevation)


@kernel
def convert(measured, sigma, ways, mean, covariance):  # type: ignore[no-untyped-def]
    """Write mean and covariance of where a polar measurement may come from.

    A place is r·u, its range times its direction, and range and direction are independent: the
    unscented transform is needed for the angles alone. With ū and U the mean and the covariance of
    the directions, the mean of r·u is r·ū, and its covariance σ²·ūūᵀ + (r² + 3σ²)·U.

    The plain transform, which moves one coordinate at a time, has r²·U. There the measured range
    stands for the true one, and of a target at one place the normalised squared error is too great,
    by 3·(σ/r)² on each axis across: half a percent where σ is a twentieth of the range. The term
    3σ², which the covariance of Lerro and Bar-Shalom has as well, makes up for it.

    Parameters
    ----------
    measured : float64 (d,), range, azimuth clockwise from north and, in space, elevation; radians
    sigma : float64 (d,), standard deviations of the three
    ways : float64 (≥ 2d − 1, d), working space
    mean : float64 (d,), measured from the sensor; changed in place
    covariance : float64 (d, d), changed in place

    References
    ----------
    S. Julier and J. Uhlmann, "A consistent, debiased method for converting between polar and
    Cartesian coordinate systems", SPIE 3086, 1997: points at the square root of d + κ standard
    deviations, d + κ = 3. D. Lerro and Y. Bar-Shalom, "Tracking with debiased consistent converted
    measurements versus EKF", IEEE Transactions on Aerospace and Electronic Systems 29(3), 1993.
    """
    axes = len(measured)
    reach = math.sqrt(3.0)
    side = 1.0 / 6.0
    count = 2 * axes - 1
    centre = 1.0 - (count - 1) * side
    for point in range(count):
        azimuth = measured[1]
        elevation = measured[2] if axes > 2 else 0.0
        if point > 0:
            axis = (point + 1) // 2
            moved = reach * sigma[axis] * (1.0 if point % 2 == 1 else -1.0)
            if axis == 1:
                azimuth += moved
            else:
                elevation += moved
        _direction(azimuth, elevation, ways[point])
    for row in range(axes):
        mean[row] = centre * ways[0, row]
        for point in range(1, count):
            mean[row] += side * ways[point, row]
    along = sigma[0] ** 2
    across = measured[0] ** 2 + 3.0 * along
    for row in range(axes):
        for column in range(row + 1):
            total = centre * (ways[0, row] - mean[row]) * (ways[0, column] - mean[column])
            for point in range(1, count):
                total += side * (ways[point, row] - mean[row]) * (ways[point, column] - mean[column])
            covariance[row, column] = along * mean[row] * mean[column] + across * total
            covariance[column, row] = covariance[row, column]
    for row in range(axes):
        mean[row] *= measured[0]


@kernel
def to_polar(place, station, sensor, measured):  # type: ignore[no-untyped-def]
    """Write range, azimuth and, in space, elevation of a place as a sensor sees it.

    Parameters
    ----------
    place : float64 (d,)
    station, sensor : float64 (sensors, d) and a row of it, no view, which would cost more than the rest
    measured : float64 (d,), changed in place
    """
    x, y = place[0] - station[sensor, 0], place[1] - station[sensor, 1]
    ground = math.sqrt(x * x + y * y)
    measured[0] = ground
    measured[1] = math.atan2(x, y)
    if len(place) > 2:
        z = place[2] - station[sensor, 2]
        measured[0] = math.sqrt(ground * ground + z * z)
        measured[2] = math.atan2(z, ground)


@kernel
def _converted(measured, sigma, mean, covariance):  # type: ignore[no-untyped-def]
    ways = np.empty((2 * measured.shape[1] - 1, measured.shape[1]))
    for row in range(len(measured)):
        convert(measured[row], sigma, ways, mean[row], covariance[row])


def converted(measured: Array, sigma: Array) -> tuple[Array, Array]:
    """Return positions from the sensor, and their covariances, of polar measurements.

    Parameters
    ----------
    measured : float64 (n, 2) or (n, 3), range, azimuth clockwise from north and, in space,
        elevation up from the horizon; radians
    sigma : float64 (2,) or (3,), standard deviations of the noise on each

    Returns
    -------
    position : float64 (n, d), by the unscented transform; see `convert`
    covariance : float64 (n, d, d)
    """
    measured = np.ascontiguousarray(measured, dtype=float)
    mean = np.empty_like(measured)
    covariance = np.empty((*measured.shape, measured.shape[1]))
    _converted(measured, np.ascontiguousarray(sigma, dtype=float), mean, covariance)
    return mean, covariance


def polar(position: Array) -> Array:
    """Return range, azimuth in (−π, π] and, in space, elevation of positions from the sensor.

    Parameters
    ----------
    position : float64 (…, 2) or (…, 3)
    """
    azimuth = np.arctan2(position[..., 0], position[..., 1])
    ground = np.hypot(position[..., 0], position[..., 1])
    if position.shape[-1] == 2:
        return np.stack([ground, azimuth], axis=-1)
    distance = np.hypot(ground, position[..., 2])
    return np.stack([distance, azimuth, np.arctan2(position[..., 2], ground)], axis=-1)
