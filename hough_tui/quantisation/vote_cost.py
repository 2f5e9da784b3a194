"""What voting costs on this machine: measured once, to tell how long a trial is going to take."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import dataclass

import numpy as np

from algorithms.hough.grid import Grid
from algorithms.hough.peaks.threshold import Threshold
from algorithms.hough.search import search
from algorithms.hough.weighting import Weighting
from algorithms.plots import Plots

ATTEMPTS = 5
"""Measurements of which the shortest counts: whatever else the machine does can only add to it."""

CROWDED, ROOMY = (1_000, Grid(60, 128, -64.0, 1.0)), (4, Grid(256, 1024, -512.0, 1.0))
"""Plots and grid of the two measurements: one of many votes in few cells, one of few votes in many."""

OUT_OF_REACH = 2**31
"""A threshold that no cell reaches: finding peaks costs a look at each cell, and no more."""

_measured: dict[bool, VoteCost] = {}
_measuring = threading.Lock()


@dataclass(frozen=True, slots=True)
class VoteCost:
    """Seconds that one vote takes, and those that clearing one cell and looking at it take."""

    vote: float
    cell: float

    def seconds(self, votes: float, cells: int) -> float:
        """Return how long so many votes into an accumulator of so many cells take."""
        return votes * self.vote + cells * self.cell


def known_cost(is_weighted: bool) -> VoteCost | None:
    """Return what was measured; None before it was."""
    return _measured.get(is_weighted)


def vote_cost(is_weighted: bool) -> VoteCost:
    """Return what votes cost, plain ones or weighted ones; it is measured the first time."""
    with _measuring:
        if is_weighted not in _measured:
            weighting = Weighting(True, 2.0, 5) if is_weighted else None
            crowded, roomy = (_seconds(count, grid, weighting) for count, grid in (CROWDED, ROOMY))
            votes, cells = (
                [count * grid.theta_bins for count, grid in (CROWDED, ROOMY)],
                [math.prod(grid.shape) for _, grid in (CROWDED, ROOMY)],
            )
            vote, cell = np.linalg.solve(np.column_stack([votes, cells]), [crowded, roomy])
            # A measurement that was held up must not make anything cost less than nothing.
            _measured[is_weighted] = VoteCost(max(float(vote), 0.0), max(float(cell), 0.0))
        return _measured[is_weighted]


def _seconds(count: int, grid: Grid, weighting: Weighting | None) -> float:
    reach = grid.rho_min / math.sqrt(2.0)
    position = np.random.default_rng(1).uniform(reach, -reach, (count, 2))
    chunk = Plots(np.zeros(count, np.int32), np.zeros(count), position).chunk()
    peaks = Threshold(OUT_OF_REACH)
    # The first call loads the kernel, or compiles it.
    search(chunk, grid, peaks, weighting)
    found = []
    for _ in range(ATTEMPTS):
        began = time.perf_counter()
        search(chunk, grid, peaks, weighting)
        found.append(time.perf_counter() - began)
    return min(found)
