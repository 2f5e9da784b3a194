"""A target whose line lies at the seam θ = 0 and π: one track, not one on each side."""

from __future__ import annotations

import math

import numpy as np
import pytest

from algorithms.context import Box, Context
from algorithms.hough.lines import line_distance, line_through
from algorithms.initiators.registry import initiator
from algorithms.parameters import validated
from algorithms.plots import PlotChunk

SCANS, TRIALS, INTERVAL, SIGMA = 20, 400, 4.0, 0.1
SCENE = Context(SCANS, INTERVAL, 0.9, (SIGMA, SIGMA), Box((0.0, 0.0), (100.0, 100.0)))
WRAP_AWARE = ("best-first", "vote-removal", "sequential")


def draws():
    """Return trials of one target each, its heading within a row of north, and the lines."""
    generator = np.random.default_rng(11)
    lean = generator.uniform(-2, 2, TRIALS) * math.pi / 180
    velocity = 0.3 * np.stack([np.sin(lean), np.cos(lean)], axis=1)
    # Half-way through the batch it passes near the middle of the region.
    middle = generator.uniform(45, 55, (TRIALS, 2))
    elapsed = INTERVAL * (np.arange(SCANS) - 0.5 * (SCANS - 1))
    place = middle[:, None] + elapsed[:, None] * velocity[:, None]
    place += generator.normal(0, SIGMA, place.shape)
    is_seen = generator.random((TRIALS, SCANS)) < 0.9
    scan = np.broadcast_to(np.arange(SCANS, dtype=np.int32), is_seen.shape)[is_seen]
    offsets = np.concatenate([[0], np.cumsum(is_seen.sum(axis=1))])
    return PlotChunk(scan, scan * INTERVAL, place[is_seen], offsets), line_through(middle, velocity)


DRAWS, LINES = draws()


def found(name, peaks, **given_values):
    algorithm = initiator(name)
    parameters = validated(algorithm.parameters, {"peaks": peaks, **given_values}, name).resolved(SCENE)
    return algorithm.initiate_chunk(DRAWS, SCENE, parameters)


def sides(tracks):
    """Return how many trials have tracks on both sides of the seam."""
    trial = np.repeat(np.arange(TRIALS), tracks.counts)
    near_zero = np.bincount(trial[tracks.theta < math.pi / 2], minlength=TRIALS)
    near_pi = np.bincount(trial[tracks.theta >= math.pi / 2], minlength=TRIALS)
    return int(((near_zero > 0) & (near_pi > 0)).sum())


# On votes the cell nearest to the line has three quarters of them, when it does not lie on a border.
CHOICES = [("standard", {"fraction": 0.75}), ("weighted", {"fraction": 0.6})]


@pytest.mark.parametrize(("name", "choice"), CHOICES)
def test_without_a_window_many_draws_have_tracks_on_both_sides(name, choice):
    assert sides(found(name, "threshold", **choice)) > TRIALS / 10


@pytest.mark.parametrize(("name", "choice"), CHOICES)
@pytest.mark.parametrize("peaks", WRAP_AWARE)
def test_a_target_at_the_seam_has_no_duplicate(name, choice, peaks):
    tracks = found(name, peaks, **choice)
    assert tracks.counts.max() == 1
    assert tracks.counts.mean() > 0.7
    trial = np.repeat(np.arange(TRIALS), tracks.counts)
    angle, _ = line_distance(tracks.theta, tracks.rho, LINES[0][trial], LINES[1][trial])
    assert (np.degrees(angle) < 6).mean() > 0.95
    # Both ends of the range of θ are among the tracks.
    assert 0.1 < (tracks.theta < math.pi / 2).mean() < 0.9


@pytest.mark.parametrize(("name", "choice"), CHOICES)
def test_where_nothing_goes_on_across_the_seam_there_are_duplicates(name, choice):
    assert sides(found(name, "thesis", **choice)) > TRIALS / 10


def test_a_window_that_stops_at_the_edges_leaves_the_duplicates():
    document = {"mode": "document", "maxima": None, "fraction": 0.75}
    for peaks in ("best-first", "sequential"):
        assert sides(found("sequential", peaks, **document)) > TRIALS / 10
        assert sides(found("sequential", peaks, **{**document, "mode": "sound"})) == 0
