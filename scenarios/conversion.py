"""Polar measurements to cartesian positions with their covariance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel

Array = NDArray[np.float64]


@kernel
def _position(distance, azimuth, elevation, place):  # type: ignore[no-untyped-def]
    """Write the position of polar coordinates, as many axes of it as there is room for."""
    ground = distance * math.cos(elevation)
    place[0] = ground * math.sin(azimuth)
    place[1] = ground * math.cos(azimuth)
    if len(place) > 2:
        place[2] = distance * math.sin(elevation)


@kernel
def convert(measured, sigma, points, mean, covariance):  # type: ignore[no-untyped-def]
    """Write mean and covariance of where a polar measurement may come from.

    Parameters
    ----------
    measured : float64 (d,), range, azimuth clockwise from north and, in space, elevation; radians
    sigma : float64 (d,), standard deviations of the three
    points : float64 (2d + 1, d), working space
    mean : float64 (d,), measured from the sensor; changed in place
    covariance : float64 (d, d), changed in place

    References
    ----------
    S. Julier and J. Uhlmann, "A consistent, debiased method for converting between polar and
    Cartesian coordinate systems", SPIE 3086, 1997: 2d + 1 points at the square root of d + κ
    standard deviations, d + κ = 3.
    """
    axes = len(measured)
    reach = math.sqrt(3.0)
    side = 1.0 / 6.0
    centre = 1.0 - 2.0 * axes * side
    for point in range(2 * axes + 1):
        distance, azimuth = measured[0], measured[1]
        elevation = measured[2] if axes > 2 else 0.0
        if point > 0:
            axis = (point - 1) // 2
            moved = reach * sigma[axis] * (1.0 if point % 2 == 1 else -1.0)
            if axis == 0:
                distance += moved
            elif axis == 1:
                azimuth += moved
            else:
                elevation += moved
        _position(distance, azimuth, elevation, points[point])
    for row in range(axes):
        mean[row] = centre * points[0, row]
        for point in range(1, 2 * axes + 1):
            mean[row] += side * points[point, row]
    for row in range(axes):
        for column in range(row + 1):
            total = centre * (points[0, row] - mean[row]) * (points[0, column] - mean[column])
            for point in range(1, 2 * axes + 1):
                total += side * (points[point, row] - mean[row]) * (points[point, column] - mean[column])
            covariance[row, column] = total
            covariance[column, row] = total


@kernel
def _converted(measured, sigma, mean, covariance):  # type: ignore[no-untyped-def]
    points = np.empty((2 * measured.shape[1] + 1, measured.shape[1]))
    for row in range(len(measured)):
        convert(measured[row], sigma, points, mean[row], covariance[row])


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
