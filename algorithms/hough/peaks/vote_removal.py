"""The greatest cell, again and again, the votes of its plots removed from every cell."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.peaks.best_first import window_column, window_row
from algorithms.hough.peaks.cells import centroid, column_of, least_scattered, maximum, written
from algorithms.hough.weighting import weigh


@kernel
def _take_plots(  # type: ignore[no-untyped-def]
    row, column, rows, columns, wrap, x, y, left, cosine, sine, rho_min, rho_step, width, height
):
    """Move the plots that voted in the window of a cell behind those that are left; return how many stay."""
    centre_x, centre_y = centroid(
        x[:left], y[:left], cosine[row], sine[row], rho_min, rho_step, width, column
    )
    for offset in range(-rows, rows + 1):
        target = window_row(offset, row, height, wrap)
        if target < 0:
            continue
        centre = column
        if offset != 0:
            centre = window_column(centre_x, centre_y, cosine[target], sine[target], rho_min, rho_step)
        plot = 0
        while plot < left:
            voted = column_of(x[plot], y[plot], cosine[target], sine[target], rho_min, rho_step, width)
            if 0 < voted < width - 1 and abs(voted - centre) <= columns:
                left -= 1
                x[plot], x[left] = x[left], x[plot]
                y[plot], y[left] = y[left], y[plot]
            else:
                plot += 1
    return left


@kernel
def removed_votes(  # type: ignore[no-untyped-def]
    values, votes, space, threshold, maxima, rows, columns, last, wrap,
    x, y, cosine, sine, rho_min, rho_step, cells, count,
):  # fmt: skip
    """Append the greatest cell and take back every vote of its plots, until none reaches the threshold.

    Of equal cells the one whose votes scatter least is taken. Its plots are those that voted within
    ±columns of it in its row (with ±rows, also within the window of `best_first` in the rows
    beside it).

    Weighted votes are no sums over plots: without the plots of a peak the deviations of the cells
    that they crossed shrink, and the least of a θ or a ρ may be another one. So the plots that are
    left are weighed anew.

    Parameters
    ----------
    values : what is greatest and reaches the threshold: `votes`, or those of `space` weighted
    votes : uint32 (rows, ρ columns + 2), changed to the votes of the plots that are left
    space : the filled `WeightingSpace` of these votes, changed alike; None to go by the votes
    threshold : least value of a cell, positive
    maxima : how many are taken at most
    last : whether of cells that are equal in that, too, the last in θ-major order is taken
    x, y : float64 (n,), measured from the grid's origin
    cosine, sine : float64 (rows,)
    cells, count : int64 or float64 (≥ count, 3), the cells written so far and their number
    """
    height, width = votes.shape
    x, y = x.copy(), y.copy()
    left = len(x)
    for _ in range(maxima):
        _, _, best = maximum(values, last)
        if best < threshold or best == 0:
            break
        row, column = least_scattered(values, best, last, x[:left], y[:left], cosine, sine, rho_min, rho_step)
        cells, count = written(cells, count, row, column, best)
        before = left
        left = _take_plots(
            row, column, rows, columns, wrap, x, y, left, cosine, sine, rho_min, rho_step, width, height
        )
        if space is None:
            for target in range(height):
                for plot in range(left, before):
                    voted = column_of(
                        x[plot], y[plot], cosine[target], sine[target], rho_min, rho_step, width
                    )
                    votes[target, voted] -= np.uint32(1)
        else:
            weigh(x[:left], y[:left], cosine, sine, rho_min, rho_step, space)
    return cells, count
