"""Peak extraction: from an accumulator to the cells that are tracks.

Accumulators here are those of the voting kernels, with a sentinel column on each side. A
found cell is written as (row, column, votes), the column counted without the sentinel.
"""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel


@kernel
def row_maximum(accumulator, row):  # type: ignore[no-untyped-def]
    """Return the greatest count of a row, sentinels left out."""
    greatest = np.uint32(0)
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
def _row_hits(accumulator, row, votes):  # type: ignore[no-untyped-def]
    hits = np.int32(0)
    counts = accumulator[row]
    for column in range(1, accumulator.shape[1] - 1):
        hits += np.int32(counts[column] >= votes)
    return hits


@kernel
def _write_hits(accumulator, row, votes, cells, count):  # type: ignore[no-untyped-def]
    counts = accumulator[row]
    for column in range(1, accumulator.shape[1] - 1):
        if counts[column] >= votes:
            cells[count, 0] = row
            cells[count, 1] = column - 1
            cells[count, 2] = counts[column]
            count += 1
    return count


@kernel
def at_threshold(accumulator, votes, cells, count):  # type: ignore[no-untyped-def]
    """Append every cell with at least so many votes, in θ-major order.

    Returns
    -------
    cells : int64 (≥ count, 3), perhaps enlarged
    count : number of cells written so far
    """
    for row in range(accumulator.shape[0]):
        # A vectorised pass tells which few rows are worth a search cell by cell.
        hits = _row_hits(accumulator, row, votes)
        if hits > 0:
            cells = with_room(cells, count + hits)
            count = _write_hits(accumulator, row, votes, cells, count)
    return cells, count


@kernel
def maximum(accumulator, last):  # type: ignore[no-untyped-def]
    """Return row, accumulator column and count of the greatest cell.

    Among equals the first in θ-major order is taken, or with `last` the last.
    """
    best_row = 0
    best = np.uint32(0)
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
        cells = with_room(cells, count + 1)
        cells[count, 0] = row
        cells[count, 1] = column - 1
        cells[count, 2] = best
        count += 1
        clear_window(accumulator, row, column, rows, columns, wrap, rho_min, rho_step)
    return cells, count
