"""What the tests of the numerics share: chunks made by hand, and what is measured on the bundled scenes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from algorithms.plots import PlotChunk
from algorithms.scoring.matching import score
from scenarios.files.set_files import load_set
from scenarios.simulate import draw, truth
from scenarios.world import World


def _chunk(*trials, interval=4.0):
    """Return a chunk of trials, each a sequence of (scan, x, y)."""
    rows = np.array([row for trial in trials for row in trial], dtype=float).reshape(-1, 3)
    return PlotChunk(
        rows[:, 0].astype(np.int32),
        rows[:, 0] * interval,
        np.ascontiguousarray(rows[:, 1:]),
        np.cumsum([0, *map(len, trials)], dtype=np.int64),
    )


@pytest.fixture(scope="session")
def chunk_of():
    return _chunk


@pytest.fixture(scope="session")
def course():
    return load_set("course-report")


@dataclass(frozen=True)
class Measured:
    """Per-trial columns: the share of targets found, false tracks, and their share of all tracks."""

    success: np.ndarray
    false: np.ndarray
    false_ratio: np.ndarray


def _measure(scenario, entry, criterion, trials, *, seed=7, control=False, **changes):
    parameters = entry.parameters.model_copy(update=changes).resolved(scenario.context)
    drawn = draw(World.of(scenario), seed, 0, trials)
    if control:
        drawn = drawn.without_targets()
    tracks = entry.algorithm.initiate_chunk(drawn.chunk, scenario.context, parameters)
    scores = score(tracks, truth(scenario, drawn), drawn.chunk.offsets, criterion)
    ratio = scores.false / np.maximum(tracks.counts, 1)
    success = scores.found.mean(axis=1) if scenario.targets else np.zeros(trials)
    return Measured(success, scores.false, ratio)


@pytest.fixture(scope="session")
def measure():
    return _measure


REFERENCE_TRIALS = 1000
"""The fewest trials behind a figure of the reference implementations, which had 1,000 to 4,000."""


def _margin(deviation, trials):
    """Return four standard errors of the difference between a mean over `trials` and a reference figure."""
    return 4.0 * deviation * np.sqrt(1.0 / trials + 1.0 / REFERENCE_TRIALS)


@pytest.fixture(scope="session")
def margin():
    return _margin


@pytest.fixture(scope="session")
def rate_margin():
    """Four standard errors of a rate, and half a unit of the reference figure's last digit."""

    def rate_margin(rate, trials, last_digit):
        # A rate printed as 0 or 1 is known to half a digit only, and so is its spread.
        spread = min(max(rate, 0.5 * last_digit), 1.0 - 0.5 * last_digit)
        return _margin(np.sqrt(spread * (1.0 - spread)), trials) + 0.5 * last_digit

    return rate_margin
