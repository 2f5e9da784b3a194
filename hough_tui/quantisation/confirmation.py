"""Trials that confirm what is predicted of a quantisation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.grid import Grid
from algorithms.intervals import Z95, mean_interval
from algorithms.quantisation.measurement import count_cells
from hough_tui.quantisation.designs import Design, moving_targets
from scenarios.model import Scenario
from scenarios.simulate import draw
from scenarios.world import World

CHUNK = 100
"""Trials that are drawn together, so that their plots stay few."""


@dataclass(frozen=True, slots=True)
class Trials:
    """What trials of a quantisation gave.

    Attributes
    ----------
    home : int64 (trials, targets), votes of the home cells
    block : int64 (trials, targets), the greatest of the 3 × 3 cells about each
    cells : int64 (trials, most + 1), number of cells with so many votes by clutter alone
    """

    home: NDArray[np.int64]
    block: NDArray[np.int64]
    cells: NDArray[np.int64]

    def rate(self, votes: int) -> float:
        """Return the rate at which home cells reach a threshold."""
        return float((self.home >= votes).mean())

    def block_rate(self, votes: int) -> float:
        """Return the rate at which some cell of the 3 × 3 block reaches a threshold."""
        return float((self.block >= votes).mean())

    def false_cells(self, votes: int) -> NDArray[np.int64]:
        """Return how many cells of each trial clutter alone lifts to a threshold."""
        return np.asarray(self.cells[:, votes:].sum(axis=1))


def run_trials(scenarios: Sequence[Scenario], grid: Grid, trials: int, seed: int, most: int) -> Trials:
    """Return the votes of home cells and of clutter in trials, each on a grid that is moved by chance.

    Parameters
    ----------
    scenarios : with equally many moving targets; they share the trials
    grid : the quantisation
    trials, seed : how many trials, which draws
    most : votes from which on cells are counted together
    """
    parts = []
    for index, scenario in enumerate(scenarios):
        begin, end = (trials * place // len(scenarios) for place in (index, index + 1))
        world, lines = World.of(scenario), moving_targets(scenario)
        theta = np.array([line.theta for line in lines.values()], dtype=float)
        place = np.array([line.middle for line in lines.values()], dtype=float).reshape(-1, 2)
        for first in range(begin, end, CHUNK):
            count = min(CHUNK, end - first)
            drawn = draw(world, seed, first, count)
            middle = place + drawn.states.shift[:, list(lines), :2]
            shifts = np.random.default_rng([seed, first]).random((count, 2))
            own = count_cells(drawn.chunk, grid, theta, middle, shifts, most)
            alone = count_cells(drawn.without_targets().chunk, grid, theta, middle, shifts, most)
            parts.append(Trials(own.home, own.block, alone.cells))
    return Trials(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("home", "block", "cells"))
    )


def confirm(design: Design, grid: Grid, votes: int, trials: int, seed: int) -> dict[str, Any]:
    """Return measured rates of a quantisation as a document, each with its 95 % interval.

    Parameters
    ----------
    design : what it is for
    grid, votes : the quantisation and the threshold
    trials, seed : how many trials, which draws
    """
    found = run_trials(design.scenarios, grid, trials, seed, votes)
    home, block = found.home >= votes, found.block >= votes
    cells = found.false_cells(votes).astype(float)
    error = Z95 * float(cells.std(ddof=1)) / len(cells) ** 0.5 if len(cells) > 1 else None
    mean = float(cells.mean())
    return {
        "trials": trials,
        "seed": seed,
        **_rates(home.mean(axis=1), block.mean(axis=1)),
        "targets": [_rates(home[:, index], block[:, index]) for index in range(home.shape[1])],
        "false_cells": mean,
        "false_cells_ci95": None if error is None else [max(0.0, mean - error), mean + error],
    }


def _rates(home: NDArray[Any], block: NDArray[Any]) -> dict[str, Any]:
    return {
        "home_cell_rate": float(home.mean()),
        "home_cell_ci95": list(mean_interval(home)),
        "success_rate": float(block.mean()),
        "success_rate_ci95": list(mean_interval(block)),
    }
