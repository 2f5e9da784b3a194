"""Looking into an accumulator: who voted for a cell, how its votes scatter, what lies around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.grid import Grid

Array = NDArray[np.float64]


def columns_of(position: Array, grid: Grid, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the column of each plot's vote in each of some rows, −1 or the number of columns outside.

    Parameters
    ----------
    position : float64 (n, 2) or (n, 3)
    grid : the quantisation
    rows : int64 (k,)

    Returns
    -------
    columns : int64 (k, n), by the arithmetic of the voting kernel
    """
    theta = grid.theta[rows][:, None]
    x, y = (position[None, :, axis] - grid.origin[axis] for axis in (0, 1))
    along_x, along_y = np.cos(theta) / grid.rho_step, np.sin(theta) / grid.rho_step
    columns = np.floor(x * along_x + y * along_y + (1.0 - grid.rho_min / grid.rho_step)) - 1.0
    return np.clip(columns, -1, grid.rho_bins).astype(np.int64)


def voters(position: Array, grid: Grid, row: int, column: int) -> NDArray[np.int64]:
    """Return the plots that voted for a cell."""
    return np.flatnonzero(columns_of(position, grid, np.array([row]))[0] == column)


def votes_spread(position: Array, grid: Grid, row: int, column: int) -> float | None:
    """Return the sample standard deviation of the ρ that voted for a cell; None for fewer than two.

    References
    ----------
    Master's thesis on the Hough transform for track initiation, 2004, chapter 3.
    """
    plots = position[voters(position, grid, row, column)]
    if len(plots) < 2:
        return None
    theta = grid.theta[row]
    return float(np.std(plots[:, 0] * np.cos(theta) + plots[:, 1] * np.sin(theta), ddof=1))


def neighbourhood(
    votes: NDArray[np.integer], grid: Grid, row: int, column: int, radius: int
) -> NDArray[np.int64]:
    """Return the votes in the square of cells around one, across θ = 0 and π; −1 outside the grid.

    Returns
    -------
    block : int64 (2·radius + 1, 2·radius + 1)
    """
    size = 2 * radius + 1
    block = np.full((size, size), -1, dtype=np.int64)
    for i in range(size):
        turns, target = divmod(row - radius + i, grid.theta_bins)
        centre, step = column, 1
        if turns % 2:
            # Beyond the seam ρ changes its sign, and columns run the other way.
            rho = grid.rho_min + (column + 0.5) * grid.rho_step
            centre, step = int(np.floor((-rho - grid.rho_min) / grid.rho_step)), -1
        for j in range(size):
            at = centre + step * (j - radius)
            if 0 <= at < grid.rho_bins:
                block[i, j] = votes[target, at]
    return block
