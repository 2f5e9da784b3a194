"""The greatest cell, again and again, the votes of its plots removed from every cell."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.peaks.best_first import window_column, window_row
from algorithms.hough.peaks.cells import centroid, column_of, maximum, written
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
    votes, threshold, maxima, rows, columns, last, wrap, x, y, cosine, sine, rho_min, rho_step, cells, count
):
    """Append the greatest cell and take back every vote of its plots, until none reaches the threshold.

    The plots of a cell are those that voted within ±columns of it in its row (with ±rows, also
    within the window of `best_first` in the rows beside it).

    Parameters
    ----------
    votes : uint32 (rows, ρ columns + 2), changed to the votes of the plots that are left
    threshold : least votes of a cell, at least 1
    maxima : how many are taken at most
    last : whether of equal cells the last in θ-major order is taken
    x, y : float64 (n,), measured from the grid's origin
    cosine, sine : float64 (rows,)
    cells, count : int64 (≥ count, 3), the cells written so far and their number
    """
    height, width = votes.shape
    x, y = x.copy(), y.copy()
    left = len(x)
    for _ in range(maxima):
        row, column, best = maximum(votes, last)
        if best < threshold or best == 0:
            break
        cells, count = written(cells, count, row, column, best)
        before = left
        left = _take_plots(
            row, column, rows, columns, wrap, x, y, left, cosine, sine, rho_min, rho_step, width, height
        )
        for target in range(height):
            for plot in range(left, before):
                voted = column_of(x[plot], y[plot], cosine[target], sine[target], rho_min, rho_step, width)
                votes[target, voted] -= np.uint32(1)
    return cells, count


@kernel
def removed_weighted_votes(  # type: ignore[no-untyped-def]
    votes, weighted, deviation, several, eta, least_votes, by_theta, by_rho, inverse, places,
    threshold, maxima, rows, columns, last, wrap, x, y, cosine, sine, rho_min, rho_step, cells, count,
):  # fmt: skip
    """Append the cell of the greatest weighted votes, and weigh the votes of the other plots anew.

    Weights are no sums over plots: without the plots of a peak the deviations of the cells that
    they crossed shrink, and the least of a row or a column may be another one.

    Parameters
    ----------
    votes, weighted, deviation, several, eta, least_votes, by_theta, by_rho, inverse, places : see
        `weigh`; the first three are changed
    threshold, maxima, rows, columns, last, wrap, x, y, cosine, sine, cells, count : see
        `removed_votes`; here the cells are float64
    """
    height, width = votes.shape
    x, y = x.copy(), y.copy()
    left = len(x)
    for _ in range(maxima):
        row, column, best = maximum(weighted, last)
        if best < threshold or best == 0:
            break
        cells, count = written(cells, count, row, column, best)
        left = _take_plots(
            row, column, rows, columns, wrap, x, y, left, cosine, sine, rho_min, rho_step, width, height
        )
        weigh(
            x[:left], y[:left], cosine, sine, rho_min, rho_step, several, eta, least_votes,
            votes, weighted, deviation, by_theta, by_rho, inverse, places,
        )  # fmt: skip
    return cells, count
