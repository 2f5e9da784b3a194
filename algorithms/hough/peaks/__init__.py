"""Peak extraction: from an accumulator to the cells that are tracks, one module an extraction.

Accumulators here are those of the voting kernels, with a sentinel column on each side, or the
weighted votes in the same shape. A found cell is written as (row, column, value), the column
counted without the sentinel. Rows are θ and columns are ρ; the thesis's matrices are turned.
"""

from algorithms.hough.peaks.best_first import best_first
from algorithms.hough.peaks.cells import maximum
from algorithms.hough.peaks.sequential import clear_window, successive_maxima
from algorithms.hough.peaks.thesis import least_deviations
from algorithms.hough.peaks.threshold import at_threshold
from algorithms.hough.peaks.vote_removal import removed_votes

__all__ = [
    "at_threshold",
    "best_first",
    "clear_window",
    "least_deviations",
    "maximum",
    "removed_votes",
    "successive_maxima",
]
