"""Votes and peaks of a chunk of trials in one compiled call."""

from __future__ import annotations

import numpy as np

from algorithms.hough.grid import Grid
from algorithms.hough.peaks.ballots import Ballot
from algorithms.hough.peaks.extraction import Extraction
from algorithms.hough.voting import GridArrays
from algorithms.hough.weighting import Weighting
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk


def search(
    chunk: PlotChunk, grid: Grid, extraction: Extraction, weighting: Weighting | None = None
) -> TrackChunk:
    """Return the tracks at the peaks of each trial's accumulator.

    Parameters
    ----------
    chunk : plots; the z of 3-D plots does not vote
    grid : the quantisation
    extraction : which cells are tracks
    weighting : how votes are weighted; None takes the votes as they are
    """
    x, y = (np.ascontiguousarray(chunk.position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    ballot = Ballot.of(x, y, GridArrays.of(grid), weighting, chunk.largest)
    threshold = np.uint32(extraction.votes) if weighting is None else float(extraction.votes)
    room = np.empty((16 * chunk.trials + 64, 3), np.int64 if weighting is None else np.float64)
    cells, ends, outside = type(extraction).cells_of_trials(
        ballot, chunk.offsets, extraction.rule(grid, threshold), room
    )
    cells, ends = extraction.limited(cells, ends)
    theta, rho = grid.lines(cells[:, 0].astype(np.int64), cells[:, 1].astype(np.int64))
    return TrackChunk(ends, theta, rho, cells[:, 2].astype(np.float64), outside)
