"""Votes and peaks of a chunk of trials in one compiled call."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks import (
    at_threshold,
    best_first,
    least_deviations,
    removed_votes,
    successive_maxima,
)
from algorithms.hough.voting import GridArrays, vote, votes_outside
from algorithms.hough.weighting import Weighting, WeightingSpace, weigh
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk

EVERY = 2**62
"""More cells than there are: what the kernels take where all are wanted."""


class Extraction(IntEnum):
    """How cells are chosen from an accumulator."""

    THRESHOLD = 0
    SUCCESSIVE = 1
    THESIS = 2
    BEST_FIRST = 3
    VOTE_REMOVAL = 4


@dataclass(frozen=True, slots=True)
class PeakSearch:
    """What makes a cell a track.

    Attributes
    ----------
    extraction : the way of choosing
    votes : the least votes, or weighted votes, of a chosen cell
    maxima : how many cells are chosen at most, the greatest; None for all
    suppress_theta, suppress_rho : half the window, in cells, around each chosen cell
    last : whether it takes the last of equal cells in θ-major order
    wrap : whether the window goes on across θ = 0 and π
    """

    extraction: Extraction
    votes: int
    maxima: int | None = None
    suppress_theta: int = 0
    suppress_rho: int = 0
    last: bool = True
    wrap: bool = True


@kernel
def _fill(x, y, cosine, sine, rho_min, rho_step, votes, columns, space):  # type: ignore[no-untyped-def]
    """Fill the votes of one trial, and with `space` the weighted ones."""
    if space is None:
        votes[:] = 0
        vote(x, y, cosine, sine, rho_min, rho_step, votes, columns)
    else:
        weigh(x, y, cosine, sine, rho_min, rho_step, space)


@kernel
def _search(  # type: ignore[no-untyped-def]
    x, y, offsets, cosine, sine, rho_min, rho_step, votes, columns_of_plots, space, values,
    extraction, threshold, maxima, rows, columns, last, wrap, cells,
):  # fmt: skip
    """Return the cells that are chosen by their values alone."""
    trials = len(offsets) - 1
    found = np.zeros(trials + 1, np.int64)
    outside = np.zeros(trials, np.int64)
    count = 0
    for trial in range(trials):
        first, end = offsets[trial], offsets[trial + 1]
        _fill(x[first:end], y[first:end], cosine, sine, rho_min, rho_step, votes, columns_of_plots, space)
        outside[trial] = votes_outside(votes)
        if extraction == Extraction.THRESHOLD:
            cells, count = at_threshold(values, threshold, cells, count)
        else:
            cells, count = successive_maxima(
                values, threshold, maxima, rows, columns, last, wrap, rho_min, rho_step, cells, count
            )
        found[trial + 1] = count
    return cells[:count], found, outside


@kernel
def _search_by_plots(  # type: ignore[no-untyped-def]
    x, y, offsets, cosine, sine, rho_min, rho_step, votes, columns_of_plots, space, values,
    extraction, threshold, maxima, rows, columns, last, wrap, cells,
):  # fmt: skip
    """Return the cells that are chosen by their values and by the plots that voted for them."""
    trials = len(offsets) - 1
    found = np.zeros(trials + 1, np.int64)
    outside = np.zeros(trials, np.int64)
    count = 0
    for trial in range(trials):
        own_x, own_y = x[offsets[trial] : offsets[trial + 1]], y[offsets[trial] : offsets[trial + 1]]
        _fill(own_x, own_y, cosine, sine, rho_min, rho_step, votes, columns_of_plots, space)
        outside[trial] = votes_outside(votes)
        if extraction == Extraction.THESIS:
            cells, count = least_deviations(
                values, threshold, rows, columns, last,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        elif extraction == Extraction.BEST_FIRST:
            cells, count = best_first(
                values, threshold, maxima, rows, columns, last, wrap,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        else:
            cells, count = removed_votes(
                values, votes, space, threshold, maxima, rows, columns, last, wrap,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        found[trial + 1] = count
    return cells[:count], found, outside


def search(chunk: PlotChunk, grid: Grid, peaks: PeakSearch, weighting: Weighting | None = None) -> TrackChunk:
    """Return the tracks at the peaks of each trial's accumulator.

    Parameters
    ----------
    chunk : plots; the z of 3-D plots does not vote
    grid : the quantisation
    peaks : what makes a cell a track
    weighting : how votes are weighted; None takes the votes as they are
    """
    arrays = GridArrays.of(grid)
    x, y = (np.ascontiguousarray(chunk.position[:, axis] - grid.origin[axis]) for axis in (0, 1))
    votes = arrays.accumulator()
    space = None if weighting is None else WeightingSpace.of(weighting, votes, chunk.largest)
    by_value = peaks.extraction in (Extraction.THRESHOLD, Extraction.SUCCESSIVE)
    maxima = EVERY if peaks.maxima is None else peaks.maxima
    cells, offsets, outside = (_search if by_value else _search_by_plots)(
        x, y, chunk.offsets, arrays.cosine, arrays.sine, grid.rho_min, grid.rho_step,
        votes, np.empty(chunk.largest, np.int32), space, votes if space is None else space.weighted,
        int(peaks.extraction), np.uint32(peaks.votes) if space is None else float(peaks.votes), maxima,
        min(peaks.suppress_theta, grid.theta_bins), min(peaks.suppress_rho, grid.rho_bins),
        peaks.last, peaks.wrap,
        np.empty((16 * chunk.trials + 64, 3), np.int64 if space is None else np.float64),
    )  # fmt: skip
    # The others stop by themselves.
    if len(cells) > maxima and peaks.extraction in (Extraction.THRESHOLD, Extraction.THESIS):
        cells, offsets = _greatest(cells, offsets, maxima, peaks.last)
    theta, rho = grid.lines(cells[:, 0].astype(np.int64), cells[:, 1].astype(np.int64))
    return TrackChunk(offsets, theta, rho, cells[:, 2].astype(np.float64), outside)


def _greatest(
    cells: NDArray[Any], offsets: NDArray[np.int64], most: int, last: bool
) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Return the greatest cells of each trial, at most so many, in the order in which they came."""
    counts = np.diff(offsets)
    trial = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(cells))
    order = np.lexsort((-place if last else place, -cells[:, 2], trial))
    rank = np.empty(len(cells), np.int64)
    rank[order] = place - np.repeat(offsets[:-1], counts)
    return cells[rank < most], np.concatenate([[0], np.cumsum(np.minimum(counts, most))])
