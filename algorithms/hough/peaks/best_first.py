"""The greatest cell first, with a window that follows the slant of its peak."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.peaks.cells import centroid, scatter, written
from algorithms.hough.peaks.threshold import at_threshold
from algorithms.hough.voting import FIRST


@kernel
def window_row(offset, row, height, wrap):  # type: ignore[no-untyped-def]
    """Return the row so many rows beside another, −1 past the edges where nothing goes on there."""
    other = row + offset
    if 0 <= other < height:
        return other
    return other % height if wrap else -1


@kernel
def window_column(x, y, cosine, sine, rho_min, rho_step):  # type: ignore[no-untyped-def]
    """Return the accumulator column about which a window lies in a row: where its centroid votes.

    The votes of a line lie about the sinusoid of the centroid of its plots, whatever the row:
    that is its slant, dρ/dθ = y·cos θ − x·sin θ, and beyond θ = 0 and π the changed sign of ρ,
    too. Not clipped to the accumulator.
    """
    return np.int64(np.floor(x * (cosine / rho_step) + y * (sine / rho_step) + (FIRST - rho_min / rho_step)))


@kernel
def _clear_along(  # type: ignore[no-untyped-def]
    values, row, rows, columns, wrap, centre_x, centre_y, cosine, sine, rho_min, rho_step
):
    height, width = values.shape
    for offset in range(-rows, rows + 1):
        target = window_row(offset, row, height, wrap)
        if target < 0:
            continue
        centre = window_column(centre_x, centre_y, cosine[target], sine[target], rho_min, rho_step)
        for column in range(max(centre - columns, 1), min(centre + columns + 1, width - 1)):
            values[target, column] = 0


@kernel
def best_first(  # type: ignore[no-untyped-def]
    values, threshold, maxima, rows, columns, last, wrap, x, y, cosine, sine, rho_min, rho_step, cells, count
):
    """Append the cells at the threshold from the greatest down, each clearing what belongs to its peak.

    The window has ±rows rows and, in each of them, ±columns columns about the vote of the
    centroid of the cell's own plots; with `wrap` it goes on across θ = 0 and π.

    Of equal cells the one whose votes scatter least comes first: the cells on both sides of a
    peak's best row often have as many votes as it has.

    Parameters
    ----------
    values : votes or weighted votes, changed
    threshold : least value of a cell, positive
    maxima : how many are taken at most
    last : whether of cells that are equal in that, too, the last in θ-major order is taken
    x, y : float64 (n,), measured from the grid's origin
    cosine, sine : float64 (rows,)
    cells, count : int64 or float64 (≥ count, 3), the cells written so far and their number
    """
    first, width = count, values.shape[1]
    cells, end = at_threshold(values, threshold, cells, count)
    candidates = cells[first:end].copy()
    if last:
        candidates = candidates[::-1].copy()
    order = np.argsort(-candidates[:, 2], kind="mergesort")
    scatters = np.empty(len(order))
    begin = 0
    while begin < len(order) and count - first < maxima:
        run = begin + 1
        while run < len(order) and candidates[order[run], 2] == candidates[order[begin], 2]:
            run += 1
        if run > begin + 1:
            for place in range(begin, run):
                row, column = int(candidates[order[place], 0]), int(candidates[order[place], 1]) + 1
                scatters[place] = np.inf
                if values[row, column] != 0:
                    scatters[place] = scatter(x, y, cosine[row], sine[row], rho_min, rho_step, width, column)
            order[begin:run] = order[begin:run][np.argsort(scatters[begin:run], kind="mergesort")]
        for place in range(begin, run):
            row, column = int(candidates[order[place], 0]), int(candidates[order[place], 1]) + 1
            if values[row, column] == 0 or count - first == maxima:
                continue
            cells, count = written(cells, count, row, column, values[row, column])
            values[row, column] = 0
            centre_x, centre_y = centroid(x, y, cosine[row], sine[row], rho_min, rho_step, width, column)
            _clear_along(
                values, row, rows, columns, wrap, centre_x, centre_y, cosine, sine, rho_min, rho_step
            )
        begin = run
    return cells, count
