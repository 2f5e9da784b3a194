"""The greatest cell, again and again, the neighbourhood of each cleared."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.peaks.cells import maximum, written


@kernel
def clear_window(accumulator, row, column, rows, columns, wrap, rho_min, rho_step):  # type: ignore[no-untyped-def]
    """Set the counts to zero in the window of ±rows, ±columns around a cell.

    With `wrap` the window goes on across θ = 0 and π, where ρ changes its sign; without it
    the window ends at the edges of the accumulator.
    """
    height = accumulator.shape[0]
    for other in range(row - rows, row + rows + 1):
        target, centre = other, column
        if other < 0 or other >= height:
            if not wrap:
                continue
            target = other % height
            if ((other - target) // height) % 2 != 0:
                rho = rho_min + (column - 0.5) * rho_step
                centre = int(np.floor((-rho - rho_min) / rho_step)) + 1
        low = max(centre - columns, 1)
        high = min(centre + columns + 1, accumulator.shape[1] - 1)
        for cleared in range(low, high):
            accumulator[target, cleared] = 0


@kernel
def successive_maxima(  # type: ignore[no-untyped-def]
    accumulator, votes, maxima, rows, columns, last, wrap, rho_min, rho_step, cells, count
):
    """Append the greatest cell and clear the window around it, `maxima` times; the accumulator is changed.

    It ends early where no cell is left with at least `votes` (and one) votes.
    """
    for _ in range(maxima):
        row, column, best = maximum(accumulator, last)
        if best < votes or best == 0:
            break
        cells, count = written(cells, count, row, column, best)
        clear_window(accumulator, row, column, rows, columns, wrap, rho_min, rho_step)
    return cells, count
