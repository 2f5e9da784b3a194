"""Window of a peak that follows its slant."""

from __future__ import annotations

from typing import Any, NamedTuple

from algorithms.compiled import kernel
from algorithms.hough.voting import FIRST
from algorithms.rounding import floored


class PeakRule(NamedTuple):
    """What an extraction with a slanted window needs to know.

    Attributes
    ----------
    least : least value of a cell, positive
    most : how many are taken at most
    rows, columns : half the window: ±rows and, in each of them, ±columns about its middle there
    wrap : whether the window goes on across θ = 0 and π
    last : whether of cells that are equal in value and scatter the last in θ-major order is taken
    """

    least: Any
    most: int
    rows: int
    columns: int
    wrap: bool
    last: bool


@kernel
def window_row(offset, row, height, wrap):  # type: ignore[no-untyped-def]
    """Return the row so many rows beside another, −1 past the edges where nothing goes on there."""
    other = row + offset
    if 0 <= other < height:
        return other
    return other % height if wrap else -1


@kernel
def window_column(x, y, row, grid):  # type: ignore[no-untyped-def]
    """Return the accumulator column about which a window lies in a row: where its centroid votes.

    The votes of a line lie about the sinusoid of the centroid of its plots, whatever the row:
    that is its slant, dρ/dθ = y·cos θ − x·sin θ, and beyond θ = 0 and π the changed sign of ρ,
    too. Not clipped to the accumulator.
    """
    along_x, along_y = grid.cosine[row] / grid.rho_step, grid.sine[row] / grid.rho_step
    return floored(x * along_x + y * along_y + (FIRST - grid.rho_min / grid.rho_step))
