"""The votes of pairs of plots in three planes, beside a count by hand."""

import math
from collections import Counter

import numpy as np
import pytest

from algorithms.initiators.registry import initiator
from algorithms.parameters import validated
from scenarios.files.set_files import load_set
from scenarios.simulate import draw
from scenarios.world import World

AXES = ((0, 1), (0, 2), (1, 2))


@pytest.fixture(scope="module")
def trial():
    scenario = load_set("par-table-2").scenario("together")
    return scenario, draw(World.of(scenario), 5, 0).chunk.trial(0)


def votes_of(trial, **changes):
    scenario, plots = trial
    algorithm = initiator("combinatorial-3d")
    parameters = validated(algorithm.parameters, changes, "cht").resolved(scenario.context)
    return algorithm.plane_votes(plots, scenario.context, parameters), parameters


def pairs_by_hand(plots, parameters, allowance):
    """Return all pairs up to three scans apart within reach, and how many were tried."""
    found, tried = [], 0
    for first in range(len(plots)):
        for second in range(len(plots)):
            apart = int(plots.scan[second]) - int(plots.scan[first])
            if not 1 <= apart <= 3:
                continue
            tried += 1
            way = plots.position[second] - plots.position[first]
            distance = np.linalg.norm(way)
            elapsed = plots.time[second] - plots.time[first]
            covariance = plots.covariance[first] + plots.covariance[second]
            noise = allowance * math.sqrt(way @ covariance @ way) / distance
            if parameters.speed_min * elapsed - noise <= distance <= parameters.speed_max * elapsed + noise:
                found.append((first, second))
    return found, tried


def groups_of(pairs):
    """Return the plots that pairs connect, as sets."""
    groups = []
    for pair in pairs:
        touched = [group for group in groups if group & set(pair)]
        groups = [group for group in groups if group not in touched]
        groups.append(set(pair).union(*touched))
    return groups


@pytest.mark.parametrize("mode", ["sound", "document"])
def test_every_pair_within_reach_votes_for_its_line(trial, mode):
    _, plots = trial
    votes, parameters = votes_of(trial, mode=mode)
    pairs, tried = pairs_by_hand(plots, parameters, parameters.allowance if mode == "sound" else 0.0)
    assert votes.tried == tried
    assert Counter(map(tuple, votes.pairs.tolist())) == Counter(pairs)
    groups = groups_of(pairs) if mode == "sound" else [set(range(len(plots)))]
    for k, (first, second) in enumerate(votes.pairs.tolist()):
        (group,) = [group for group in groups if first in group]
        ends = [plot for pair in pairs if pair[0] in group for plot in pair]
        centre = plots.position[ends].mean(axis=0) if mode == "sound" else np.zeros(3)
        for plane, axes in enumerate(AXES):
            theta, d = votes.theta[plane, k], votes.distance[plane, k]
            assert 0.0 <= theta < math.pi
            # Both plots lie on the line with this direction at this distance.
            for plot in (first, second):
                x, y = (plots.position[plot] - centre)[list(axes)]
                assert x * math.sin(theta) - y * math.cos(theta) == pytest.approx(d, abs=1e-6)


def test_a_vote_is_confirmed_by_the_votes_in_a_window(trial):
    votes, parameters = votes_of(trial, window_deg=40.0, window_length=300.0)
    assert votes.window == pytest.approx((math.radians(40.0), 300.0))
    groups = groups_of(map(tuple, votes.pairs.tolist()))
    member = np.array([[first in group for group in groups].index(True) for first, _ in votes.pairs.tolist()])
    width, height = votes.window
    for plane in range(3):
        expected = np.zeros(len(votes), bool)
        for one in range(len(votes)):
            # As the direction of one vote lies, with those that follow it, beyond π turned round.
            beyond = votes.theta[plane] - votes.theta[plane, one]
            distance = np.where(beyond < 0.0, -votes.distance[plane], votes.distance[plane])
            near = (np.where(beyond < 0.0, beyond + math.pi, beyond) <= width) & (member == member[one])
            for other in np.flatnonzero(near):
                window = near & (distance >= distance[other]) & (distance <= distance[other] + height)
                if window.sum() >= parameters.votes:
                    expected |= window
        assert np.array_equal(votes.confirmed[plane], expected)
    # Some are, some are not: the comparison can fail.
    assert 0 < votes.confirmed.sum() < votes.confirmed.size


def test_the_plots_of_tracks_are_confirmed_in_two_planes(trial):
    scenario, plots = trial
    votes, parameters = votes_of(trial)
    tracks = initiator("combinatorial-3d").initiate(plots, scenario.context, parameters)
    assert len(tracks) == 5
    for rows in tracks.plots:
        for plot in rows:
            has = (votes.pairs == plot).any(axis=1)
            assert (votes.confirmed[:, has].any(axis=1)).sum() >= 2


def test_initiators_without_pairs_have_no_such_votes(trial):
    scenario, plots = trial
    for name in ("standard", "hough-3d"):
        algorithm = initiator(name)
        parameters = validated(algorithm.parameters, {}, name).resolved(scenario.context)
        assert algorithm.plane_votes(plots, scenario.context, parameters) is None
