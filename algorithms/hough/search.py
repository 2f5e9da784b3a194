"""Votes and peaks of a chunk of trials in one compiled call."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks import at_threshold, successive_maxima
from algorithms.hough.voting import GridArrays, vote, votes_outside
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk


class Extraction(IntEnum):
    """How cells are chosen from an accumulator."""

    THRESHOLD = 0
    SUCCESSIVE = 1


@dataclass(frozen=True, slots=True)
class PeakSearch:
    """What makes a cell a track.

    Attributes
    ----------
    extraction : the way of choosing
    votes : the least votes of a chosen cell
    maxima : how many cells `SUCCESSIVE` takes at most
    suppress_theta, suppress_rho : half the window, in cells, that it clears around each
    last : whether it takes the last of equal cells in θ-major order
    wrap : whether the window goes on across θ = 0 and π
    """

    extraction: Extraction
    votes: int
    maxima: int = 0
    suppress_theta: int = 0
    suppress_rho: int = 0
    last: bool = True
    wrap: bool = True


@kernel
def _search(  # type: ignore[no-untyped-def]
    x, y, offsets, cosine, sine, rho_min, rho_step, accumulator, columns,
    extraction, votes, maxima, suppress_theta, suppress_rho, last, wrap,
):  # fmt: skip
    trials = len(offsets) - 1
    found = np.zeros(trials + 1, np.int64)
    outside = np.zeros(trials, np.int64)
    cells = np.empty((16 * trials + 64, 3), np.int64)
    count = 0
    for trial in range(trials):
        first, end = offsets[trial], offsets[trial + 1]
        accumulator[:] = 0
        vote(x[first:end], y[first:end], cosine, sine, rho_min, rho_step, accumulator, columns)
        outside[trial] = votes_outside(accumulator)
        if extraction == 0:
            cells, count = at_threshold(accumulator, votes, cells, count)
        else:
            cells, count = successive_maxima(
                accumulator, votes, maxima, suppress_theta, suppress_rho, last, wrap, rho_min, rho_step,
                cells, count,
            )  # fmt: skip
        found[trial + 1] = count
    return cells[:count], found, outside


def search(chunk: PlotChunk, grid: Grid, peaks: PeakSearch) -> TrackChunk:
    """Return the tracks at the peaks of each trial's accumulator.

    Parameters
    ----------
    chunk : plots; the z of 3-D plots does not vote
    grid : the quantisation
    peaks : what makes a cell a track
    """
    arrays = GridArrays.of(grid)
    x, y = (np.ascontiguousarray(chunk.position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    cells, offsets, outside = _search(
        x, y, chunk.offsets, arrays.cosine, arrays.sine, grid.rho_min, grid.rho_step,
        arrays.accumulator(), np.empty(chunk.largest, np.int32),
        int(peaks.extraction), np.uint32(peaks.votes), peaks.maxima,
        min(peaks.suppress_theta, grid.theta_bins), min(peaks.suppress_rho, grid.rho_bins),
        peaks.last, peaks.wrap,
    )  # fmt: skip
    theta, rho = grid.lines(cells[:, 0], cells[:, 1])
    return TrackChunk(offsets, theta, rho, cells[:, 2].astype(np.float64), outside)
