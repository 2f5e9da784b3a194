"""Small symmetric matrices, as kernels."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel

PLANE, SPACE = (0, 1), (0, 1, 2)
"""Axes of the plane and of space. Kernels loop over one of these: the length of a tuple is part of
its type, so that the compiler knows the number of turns."""


def axes_of(dimensions: int) -> tuple[int, ...]:
    """Return the axes of two or of three dimensions.

    Raises
    ------
    ValueError
        For any other number.
    """
    if dimensions not in (2, 3):
        raise ValueError(f"{dimensions} dimensions are asked for; kinematics are of 2 or 3")
    return PLANE if dimensions == 2 else SPACE


@kernel
def inverse(a, made, axes):  # type: ignore[no-untyped-def]
    """Write the inverse of a symmetric matrix, and return its determinant; not in place.

    Parameters
    ----------
    a, made : float64 (d, d)
    axes : `PLANE` or `SPACE`
    """
    if len(axes) == 2:
        determinant = a[0, 0] * a[1, 1] - a[0, 1] * a[0, 1]
        scale = 1.0 / determinant
        made[0, 0] = a[1, 1] * scale
        made[0, 1] = made[1, 0] = -a[0, 1] * scale
        made[1, 1] = a[0, 0] * scale
        return determinant
    c00 = a[1, 1] * a[2, 2] - a[1, 2] * a[1, 2]
    c01 = a[0, 2] * a[1, 2] - a[0, 1] * a[2, 2]
    c02 = a[0, 1] * a[1, 2] - a[0, 2] * a[1, 1]
    determinant = a[0, 0] * c00 + a[0, 1] * c01 + a[0, 2] * c02
    scale = 1.0 / determinant
    made[0, 0] = c00 * scale
    made[0, 1] = made[1, 0] = c01 * scale
    made[0, 2] = made[2, 0] = c02 * scale
    made[1, 1] = (a[0, 0] * a[2, 2] - a[0, 2] * a[0, 2]) * scale
    made[1, 2] = made[2, 1] = (a[0, 1] * a[0, 2] - a[0, 0] * a[1, 2]) * scale
    made[2, 2] = (a[0, 0] * a[1, 1] - a[0, 1] * a[0, 1]) * scale
    return determinant


@kernel
def inverses(matrices, axes):  # type: ignore[no-untyped-def]
    """Return the inverses of symmetric matrices, float64 (n, d, d)."""
    made = np.empty_like(matrices)
    for row in range(len(matrices)):
        inverse(matrices[row], made[row], axes)
    return made
