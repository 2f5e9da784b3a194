"""Votes and peaks of a chunk of trials in one compiled call."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.hough.grid import Grid
from algorithms.hough.peaks import (
    at_threshold,
    best_first,
    least_deviations,
    removed_votes,
    removed_weighted_votes,
    successive_maxima,
)
from algorithms.hough.voting import GridArrays, vote, votes_outside
from algorithms.hough.weighting import Weighting, WeightingArrays, weigh
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
def _extract(  # type: ignore[no-untyped-def]
    values, extraction, threshold, maxima, rows, columns, last, wrap,
    x, y, cosine, sine, rho_min, rho_step, cells, count,
):  # fmt: skip
    """Append the cells that an extraction chooses by their values alone; they are changed."""
    if extraction == Extraction.THRESHOLD:
        return at_threshold(values, threshold, cells, count)
    if extraction == Extraction.SUCCESSIVE:
        return successive_maxima(
            values, threshold, maxima, rows, columns, last, wrap, rho_min, rho_step, cells, count
        )
    if extraction == Extraction.THESIS:
        return least_deviations(
            values, threshold, rows, columns, last, x, y, cosine, sine, rho_min, rho_step, cells, count
        )
    return best_first(
        values, threshold, maxima, rows, columns, last, wrap,
        x, y, cosine, sine, rho_min, rho_step, cells, count,
    )  # fmt: skip


@kernel
def _search(  # type: ignore[no-untyped-def]
    x, y, offsets, cosine, sine, rho_min, rho_step, accumulator, columns_of_plots,
    extraction, votes, maxima, rows, columns, last, wrap,
):  # fmt: skip
    trials = len(offsets) - 1
    found = np.zeros(trials + 1, np.int64)
    outside = np.zeros(trials, np.int64)
    cells = np.empty((16 * trials + 64, 3), np.int64)
    count = 0
    for trial in range(trials):
        own_x, own_y = x[offsets[trial] : offsets[trial + 1]], y[offsets[trial] : offsets[trial + 1]]
        accumulator[:] = 0
        vote(own_x, own_y, cosine, sine, rho_min, rho_step, accumulator, columns_of_plots)
        outside[trial] = votes_outside(accumulator)
        if extraction == Extraction.VOTE_REMOVAL:
            cells, count = removed_votes(
                accumulator, votes, maxima, rows, columns, last, wrap,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        else:
            cells, count = _extract(
                accumulator, extraction, votes, maxima, rows, columns, last, wrap,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        found[trial + 1] = count
    return cells[:count], found, outside


@kernel
def _search_weighted(  # type: ignore[no-untyped-def]
    x, y, offsets, cosine, sine, rho_min, rho_step, several, eta, least_votes,
    votes, weighted, deviation, by_theta, by_rho, inverse, places,
    extraction, threshold, maxima, rows, columns, last, wrap,
):  # fmt: skip
    trials = len(offsets) - 1
    found = np.zeros(trials + 1, np.int64)
    outside = np.zeros(trials, np.int64)
    cells = np.empty((16 * trials + 64, 3), np.float64)
    count = 0
    for trial in range(trials):
        own_x, own_y = x[offsets[trial] : offsets[trial + 1]], y[offsets[trial] : offsets[trial + 1]]
        weigh(
            own_x, own_y, cosine, sine, rho_min, rho_step, several, eta, least_votes,
            votes, weighted, deviation, by_theta, by_rho, inverse, places,
        )  # fmt: skip
        outside[trial] = votes_outside(votes)
        if extraction == Extraction.VOTE_REMOVAL:
            cells, count = removed_weighted_votes(
                votes, weighted, deviation, several, eta, least_votes, by_theta, by_rho, inverse, places,
                threshold, maxima, rows, columns, last, wrap,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        else:
            cells, count = _extract(
                weighted, extraction, threshold, maxima, rows, columns, last, wrap,
                own_x, own_y, cosine, sine, rho_min, rho_step, cells, count,
            )  # fmt: skip
        found[trial + 1] = count
    return cells[:count], found, outside


def search(
    chunk: PlotChunk, grid: Grid, peaks: PeakSearch, weighting: Weighting | None = None
) -> TrackChunk:
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
    plots = x, y, chunk.offsets, arrays.cosine, arrays.sine, grid.rho_min, grid.rho_step
    maxima = EVERY if peaks.maxima is None else peaks.maxima
    choice = (
        maxima, min(peaks.suppress_theta, grid.theta_bins), min(peaks.suppress_rho, grid.rho_bins),
        peaks.last, peaks.wrap,
    )  # fmt: skip
    extraction = int(peaks.extraction)
    if weighting is None:
        cells, offsets, outside = _search(
            *plots, arrays.accumulator(), np.empty(chunk.largest, np.int32),
            extraction, np.uint32(peaks.votes), *choice,
        )  # fmt: skip
    else:
        space = WeightingArrays.of(arrays, chunk.largest)
        cells, offsets, outside = _search_weighted(
            *plots, weighting.several, weighting.eta, weighting.least_votes,
            space.votes, space.weighted, space.deviation, space.by_theta, space.by_rho,
            space.inverse, space.places, extraction, float(peaks.votes), *choice,
        )  # fmt: skip
    if len(cells) > maxima:
        cells, offsets = _greatest(cells, offsets, maxima, peaks.last)
    theta, rho = grid.lines(cells[:, 0].astype(np.int64), cells[:, 1].astype(np.int64))
    return TrackChunk(offsets, theta, rho, cells[:, 2].astype(np.float64), outside)


def _greatest(
    cells: NDArray[np.generic], offsets: NDArray[np.int64], most: int, last: bool
) -> tuple[NDArray[np.generic], NDArray[np.int64]]:
    """Return the greatest cells of each trial, at most so many, in the order in which they came."""
    counts = np.diff(offsets)
    trial = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(cells))
    order = np.lexsort((-place if last else place, -cells[:, 2], trial))
    rank = np.empty(len(cells), np.int64)
    rank[order] = place - np.repeat(offsets[:-1], counts)
    return cells[rank < most], np.concatenate([[0], np.cumsum(np.minimum(counts, most))])
