"""The design of a quantisation for a scenario: question, and the trials that confirm an answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.hough.grid import Grid
from algorithms.quantisation.measurement import count_cells
from algorithms.quantisation.question import Clutter, ClutterSource, Question, TargetLine
from scenarios.model import Scenario
from scenarios.simulate import World, draw

CHUNK = 250
"""Trials that are drawn together."""


def target_lines(scenario: Scenario) -> tuple[TargetLine, ...]:
    """Return the lines of the targets that move and are there within the batch."""
    lines = []
    for target in scenario.targets:
        last = scenario.scans - 1 if target.death is None else min(target.death, scenario.scans - 1)
        scans = last - target.birth + 1
        if scans >= 1 and not target.stands_still:
            lines.append(
                TargetLine.of_motion(
                    target.position, target.velocity, scans, scenario.interval, scenario.sensor.axes
                )
            )
    return tuple(lines)


def clutter_of(scenario: Scenario) -> Clutter:
    """Return the clutter of a scenario's batch."""
    return Clutter(
        tuple(
            ClutterSource(source.rate * scenario.scans, (source.region or scenario.region).box)
            for source in scenario.clutter
        )
    )


def question_of(
    scenario: Scenario,
    false_cells: float = 1.0,
    kappa: float = 1.0,
    separation: float | None = None,
    confidence: float = 0.95,
) -> Question:
    """Return the question of a scenario: its targets' lines, each as long as it is, in its clutter.

    Raises
    ------
    RequestError
        Where no target moves, or a bound is not allowed.
    """
    lines = target_lines(scenario)
    if not lines:
        raise RequestError(
            f"{scenario.name}: there is no target that moves, so no line to design a quantisation for; "
            "give a speed in place of a scenario"
        )
    return Question(
        lines,
        scenario.sensor.detection_probability,
        clutter_of(scenario),
        scenario.region.box,
        false_cells,
        kappa,
        separation,
        confidence,
    )


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


def run_trials(
    scenarios: Sequence[Scenario], grid: Grid, trials: int, seed: int, most: int, first: int = 0
) -> Trials:
    """Return the votes of home cells and of clutter in trials, each on a grid that is moved by chance.

    Parameters
    ----------
    scenarios : with equally many moving targets; they share the trials
    grid : the quantisation
    trials, seed, first : how many trials, which draws, the number of the first
    most : votes from which on cells are counted together
    """
    parts = []
    for index, scenario in enumerate(scenarios):
        begin, end = (trials * place // len(scenarios) for place in (index, index + 1))
        world, lines = World.of(scenario), target_lines(scenario)
        theta = np.array([line.theta for line in lines], dtype=float)
        middle = np.array([line.middle for line in lines], dtype=float).reshape(-1, 2)
        for at in range(begin, end, CHUNK):
            count = min(CHUNK, end - at)
            drawn = draw(world, seed, first + at, count)
            shifts = np.random.default_rng([seed, first + at]).random((count, 2))
            own = count_cells(drawn.chunk, grid, theta, middle, shifts, most)
            alone = count_cells(drawn.without_targets().chunk, grid, theta, middle, shifts, most)
            parts.append(Trials(own.home, own.block, alone.cells))
    return Trials(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("home", "block", "cells"))
    )
