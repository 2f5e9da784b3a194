"""Counting what is predicted: votes of home cells and of clutter, on simulated plots."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.voting import FIRST, GridArrays, vote
from algorithms.plots import PlotChunk
from algorithms.rounding import floored

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


class CellCounts(NamedTuple):
    """Votes that were counted in the accumulators of trials.

    Attributes
    ----------
    home : int64 (trials, targets), votes of the home cells; −1 where one lies outside the grid
    block : int64 (trials, targets), the greatest of the 3 × 3 cells about each
    cells : int64 (trials, most + 1), number of cells with 0 … `most` votes, the last: or more
    """

    home: Counts
    block: Counts
    cells: Counts


class TargetLines(NamedTuple):
    """Lines of the targets of a chunk.

    Attributes
    ----------
    theta : float64 (targets,)
    middle_x, middle_y : float64 (trials, targets), places of mid-track from the grid's origin
    """

    theta: Array
    middle_x: Array
    middle_y: Array


class Rows(NamedTuple):
    """Where the rows of a grid lie: row i has the angle (i + offset)·step."""

    step: float
    offset: float


@kernel
def _count(x, y, offsets, shifts, lines, angles, fixed, accumulator, columns, counts):  # type: ignore[no-untyped-def]
    """Write the counts of each trial, whose grid is the fixed one moved by its shifts.

    Parameters
    ----------
    lines : `TargetLines`
    angles : `Rows`
    fixed : `GridArrays`; cosine and sine are written
    counts : `CellCounts`, written
    """
    theta, home, block, cells = lines.theta, counts.home, counts.block, counts.cells
    cosine, sine, rho_step, theta_step = fixed.cosine, fixed.sine, fixed.rho_step, angles.step
    rows, width = len(cosine), accumulator.shape[1] - 2
    most = cells.shape[1] - 1
    for trial in range(len(offsets) - 1):
        first, end = offsets[trial], offsets[trial + 1]
        offset = angles.offset + shifts[trial, 0]
        begin = fixed.rho_min - shifts[trial, 1] * rho_step
        for row in range(rows):
            angle = (row + offset) * theta_step
            cosine[row], sine[row] = math.cos(angle), math.sin(angle)
        accumulator[:] = 0
        moved = GridArrays(cosine, sine, width, begin, rho_step, fixed.origin)
        vote(x[first:end], y[first:end], moved, accumulator, columns)
        for row in range(rows):
            for column in range(FIRST, FIRST + width):
                cells[trial, min(np.int64(accumulator[row, column]), most)] += 1
        for target in range(len(theta)):
            # The row as the angle counts it may lie beyond the seam; ρ is taken in the row itself.
            beyond = floored(theta[target] / theta_step - offset + 0.5)
            row = beyond % rows
            rho = lines.middle_x[trial, target] * cosine[row] + lines.middle_y[trial, target] * sine[row]
            column = floored((rho - begin) / rho_step)
            home[trial, target] = block[trial, target] = -1
            if 0 <= column < width:
                home[trial, target] = accumulator[row, FIRST + column]
            for away in range(-1, 2):
                for beside in range(-1, 2):
                    near, across = row + away, column + beside
                    if not 0 <= near < rows:
                        near %= rows
                        # Across the seam the cell of the same line has −ρ.
                        centre = begin + (across + 0.5) * rho_step
                        across = floored((-centre - begin) / rho_step)
                    if 0 <= across < width:
                        votes = np.int64(accumulator[near, FIRST + across])
                        block[trial, target] = max(block[trial, target], votes)


def count_cells(
    chunk: PlotChunk, grid: Grid, theta: Array, middle: Array, shifts: Array, most: int
) -> CellCounts:
    """Return the votes of home cells, and how many cells have how many votes, of each trial.

    Parameters
    ----------
    chunk : plots
    grid : the quantisation
    theta : float64 (targets,), of the targets' lines
    middle : float64 (trials, targets, 2), places of mid-track
    shifts : float64 (trials, 2), in [0, 1): by which share of Δθ and of Δρ each trial's grid is moved, so
        that a line has no fixed place in its cell
    most : the number of votes from which on cells are counted together
    """
    x, y = (np.ascontiguousarray(chunk.position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    home, block = (np.empty((chunk.trials, len(theta)), np.int64) for _ in range(2))
    counts = CellCounts(home, block, np.zeros((chunk.trials, most + 1), np.int64))
    lines = TargetLines(
        np.asarray(theta, dtype=float),
        *(np.ascontiguousarray(middle[..., axis] - grid.origin[axis]) for axis in (0, 1)),
    )
    # One more column, so that the moved grid still reaches as far.
    fixed = GridArrays.of(grid)._replace(columns=grid.rho_bins + 1)
    _count(
        x, y, chunk.offsets, shifts, lines, Rows(grid.theta_step, grid.theta_offset), fixed,
        fixed.accumulator(), np.empty(max(chunk.largest, 1), np.int32), counts,
    )  # fmt: skip
    return counts
