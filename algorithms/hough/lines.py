"""Lines in normal form ρ = x·cos θ + y·sin θ, with θ in [0, π) and ρ signed.

(θ, ρ) and (θ + π, −ρ) are one line, so every comparison is made across that seam.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from algorithms.compiled import kernel

Array = NDArray[np.float64]


def normal_form(theta: ArrayLike, rho: ArrayLike) -> tuple[Array, Array]:
    """Return lines with θ brought into [0, π) and the sign of ρ to match.

    Parameters
    ----------
    theta, rho : arrays of one shape; radians, and any unit of length
    """
    theta, rho = np.broadcast_arrays(np.asarray(theta, dtype=float), np.asarray(rho, dtype=float))
    turns = np.floor(theta / np.pi)
    inside = theta - turns * np.pi
    # A tiny negative angle rounds up to π itself, which is outside the half-open interval.
    seam = inside >= np.pi
    inside = np.where(seam, 0.0, np.maximum(inside, 0.0))
    flips = (turns + seam) % 2 == 1
    return inside, np.where(flips, -rho, rho)


def line_through(position: ArrayLike, direction: ArrayLike) -> tuple[Array, Array]:
    """Return the line through a point along a direction, NaN where the direction is zero.

    Parameters
    ----------
    position, direction : arrays of shape (…, 2)

    Returns
    -------
    theta, rho : arrays of shape (…)
    """
    position, direction = np.asarray(position, dtype=float), np.asarray(direction, dtype=float)
    speed = np.hypot(direction[..., 0], direction[..., 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        normal = np.stack([-direction[..., 1], direction[..., 0]], axis=-1) / speed[..., None]
    theta = np.arctan2(normal[..., 1], normal[..., 0])
    return normal_form(theta, (position * normal).sum(axis=-1))


def line_distance(
    theta: ArrayLike, rho: ArrayLike, other_theta: ArrayLike, other_rho: ArrayLike
) -> tuple[Array, Array]:
    """Return how far lines are apart in angle and in signed distance from the origin.

    Returns
    -------
    angle : in [0, π/2], across the seam at 0 and π
    distance : |ρ − ρ'|, with ρ' taken in the orientation in which the angles are nearest
    """
    theta, other_theta = np.asarray(theta, dtype=float), np.asarray(other_theta, dtype=float)
    turns = np.rint((theta - other_theta) / np.pi)
    angle = np.abs(theta - other_theta - turns * np.pi)
    return angle, np.abs(np.asarray(rho) - np.where(turns % 2 == 0, 1.0, -1.0) * np.asarray(other_rho))


@kernel
def separation(theta: float, rho: float, other_theta: float, other_rho: float) -> tuple[float, float]:
    """Return `line_distance` of one pair of lines that are in normal form, signed."""
    angle = theta - other_theta
    if angle > 0.5 * math.pi:
        return angle - math.pi, rho + other_rho
    if angle < -0.5 * math.pi:
        return angle + math.pi, rho + other_rho
    return angle, rho - other_rho
