"""Cells of an accumulator: keeping them, finding the greatest, following the plots of one."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.voting import FIRST


@kernel
def row_maximum(accumulator, row):  # type: ignore[no-untyped-def]
    """Return the greatest count of a row, sentinels left out."""
    greatest = accumulator.dtype.type(0)
    counts = accumulator[row]
    for column in range(1, accumulator.shape[1] - 1):
        greatest = max(greatest, counts[column])
    return greatest


@kernel
def with_room(cells, needed):  # type: ignore[no-untyped-def]
    """Return the array of cells, enlarged where it has not the rows that are needed."""
    if needed <= cells.shape[0]:
        return cells
    larger = np.empty((max(needed, 2 * cells.shape[0]), cells.shape[1]), cells.dtype)
    larger[: cells.shape[0]] = cells
    return larger


@kernel
def maximum(accumulator, last):  # type: ignore[no-untyped-def]
    """Return row, accumulator column and count of the greatest cell.

    Among equals the first in θ-major order is taken, or with `last` the last.
    """
    best_row = 0
    best = accumulator.dtype.type(0)
    for row in range(accumulator.shape[0]):
        greatest = row_maximum(accumulator, row)
        if greatest > best or (last and greatest == best):
            best_row, best = row, greatest
    best_column = 1
    for column in range(1, accumulator.shape[1] - 1):
        if accumulator[best_row, column] == best:
            best_column = column
            if not last:
                break
    return best_row, best_column, best


@kernel
def written(cells, count, row, column, value):  # type: ignore[no-untyped-def]
    """Append one cell, the column given with the sentinel; return the cells and their number."""
    cells = with_room(cells, count + 1)
    cells[count, 0] = row
    cells[count, 1] = column - 1
    cells[count, 2] = value
    return cells, count + 1


@kernel
def column_of(ballot, row, plot):  # type: ignore[no-untyped-def]
    """Return the accumulator column of a plot's vote in a row, by the arithmetic of the voting kernel."""
    grid, top = ballot.grid, ballot.votes.shape[1] - 1.0
    # The order of the operations is that of `vote`, so that a vote near an edge is found where it went.
    place = (
        ballot.x[plot] * (grid.cosine[row] / grid.rho_step)
        + ballot.y[plot] * (grid.sine[row] / grid.rho_step)
        + (FIRST - grid.rho_min / grid.rho_step)
    )
    place = place if place > 0.0 else 0.0
    return np.int64(place if place < top else top)


@kernel
def centroid(ballot, row, column):  # type: ignore[no-untyped-def]
    """Return the mean position of the plots that voted for a column of a row; at least one did."""
    voters, sum_x, sum_y = 0, 0.0, 0.0
    for plot in range(len(ballot.x)):
        if column_of(ballot, row, plot) == column:
            voters += 1
            sum_x += ballot.x[plot]
            sum_y += ballot.y[plot]
    return sum_x / voters, sum_y / voters


@kernel
def scatter(ballot, row, column):  # type: ignore[no-untyped-def]
    """Return the sample variance of the ρ that voted for a column of a row; infinite for fewer than two."""
    cosine, sine = ballot.grid.cosine[row], ballot.grid.sine[row]
    voters, mean, squares = 0, 0.0, 0.0
    for plot in range(len(ballot.x)):
        if column_of(ballot, row, plot) == column:
            rho = ballot.x[plot] * cosine + ballot.y[plot] * sine
            voters += 1
            step = rho - mean
            mean += step / voters
            squares += step * (rho - mean)
    return squares / (voters - 1) if voters > 1 else np.inf


@kernel
def least_scattered(ballot, value, last):  # type: ignore[no-untyped-def]
    """Return row and accumulator column of the cell, of those with a value, whose votes scatter least.

    Of equals the first in θ-major order is taken, or with `last` the last.
    """
    values = ballot.values
    width = values.shape[1]
    best_row, best_column, least = -1, -1, np.inf
    for row in range(values.shape[0]):
        hits = np.int32(0)
        for column in range(1, width - 1):
            hits += np.int32(values[row, column] == value)
        if hits == 0:
            continue
        for column in range(1, width - 1):
            if values[row, column] != value:
                continue
            spread = scatter(ballot, row, column)
            if best_row < 0 or spread < least or (last and spread == least):
                best_row, best_column, least = row, column, spread
    return best_row, best_column
