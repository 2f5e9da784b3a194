"""Groups of neighbouring cells at the threshold, each represented by its least deviation."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.peaks.cells import scatter
from algorithms.hough.peaks.threshold import at_threshold


@kernel
def least_deviations(  # type: ignore[no-untyped-def]
    values, threshold, rows, columns, last, x, y, cosine, sine, rho_min, rho_step, cells, count
):
    """Append one cell a group of neighbouring cells at the threshold.

    The first cell in θ-major order that is left, and those within ±rows and ±columns of it, are
    a group. The cell of the group whose votes have the least standard deviation represents it;
    of equals the first, or with `last` the last.

    Parameters
    ----------
    values : votes or weighted votes; the standard deviation is that of all votes of a cell
    threshold : least value of a cell
    x, y : float64 (n,), measured from the grid's origin
    cosine, sine : float64 (rows,)
    cells, count : int64 or float64 (≥ count, 3), the cells written so far and their number

    References
    ----------
    Master's thesis on the Hough transform for track initiation, 2004, section 4.2. Deviations:
    a group that is cleared is passed over (taken literally, its step 4 ends there, after the
    first group or two); ρ is counted upwards within one θ (its matrices count downwards).
    """
    width = values.shape[1]
    first = count
    cells, end = at_threshold(values, threshold, cells, count)
    is_left = np.ones(end - first, np.bool_)
    for here in range(first, end):
        if not is_left[here - first]:
            continue
        row, column = int(cells[here, 0]), int(cells[here, 1])
        best, least = here, -1.0
        for other in range(here + 1, end):
            other_row, other_column = int(cells[other, 0]), int(cells[other, 1])
            if other_row - row > rows:
                break
            if not is_left[other - first] or abs(other_column - column) > columns:
                continue
            is_left[other - first] = False
            if least < 0.0:
                least = scatter(x, y, cosine[row], sine[row], rho_min, rho_step, width, column + 1)
            found = scatter(
                x, y, cosine[other_row], sine[other_row], rho_min, rho_step, width, other_column + 1
            )
            if found < least or (last and found == least):
                best, least = other, found
        # Never behind `here`, so what is overwritten has been dealt with.
        cells[count] = cells[best]
        count += 1
    return cells, count
