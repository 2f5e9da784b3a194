"""What initiators in space make of their context, and what does not depend on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from algorithms.context import Context, Unit
from algorithms.errors import RequestError
from algorithms.initiators.registry import initiator
from algorithms.parameters import validated
from algorithms.plots import PlotChunk
from scenarios.files.set_files import load_set
from scenarios.simulate import draw
from scenarios.world import World

INITIATORS = ("combinatorial-3d", "hough-logic-3d", "hough-3d")


def resolved(name, context, **given):
    return validated(initiator(name).parameters, given, name).resolved(context)


def chunk_of(place, scan, covariance=None):
    scan = np.asarray(scan, dtype=np.int32)
    return PlotChunk(scan, scan.astype(float), np.asarray(place, float), np.array([0, len(scan)]), covariance)


@pytest.mark.parametrize(("unit", "metres"), [("m", 1.0), ("km", 1000.0), ("nmi", 1852.0)])
def test_defaults_are_in_the_unit_of_the_context(unit, metres):
    context = Context(4, 1.0, unit=Unit(unit))
    for name in INITIATORS:
        found = resolved(name, context)
        assert (found.speed_min * metres, found.speed_max * metres) == pytest.approx((50.0, 400.0))
    assert resolved("combinatorial-3d", context).window_length * metres == pytest.approx(800.0)
    document = resolved("combinatorial-3d", context, mode="document")
    assert document.window_length * metres == pytest.approx(20_000.0)
    assert (document.window_deg, document.votes) == (20.0, 2)
    assert resolved("hough-logic-3d", context).cell_length * metres == pytest.approx(1000.0)


@pytest.mark.parametrize(("scans", "three_quarters"), [(2, 3), (4, 3), (5, 4), (8, 6), (100, 75)])
def test_the_least_plots_follow_from_the_scans(scans, three_quarters):
    context = Context(scans, 1.0)
    assert resolved("combinatorial-3d", context).plots == three_quarters
    assert resolved("hough-3d", context).plots == three_quarters
    assert resolved("hough-logic-3d", context).plots == max(3, scans)


def test_a_speed_beyond_the_default_of_the_other_is_refused_in_words():
    with pytest.raises(RequestError, match=r"speed_min is 500 and speed_max 400 m/s.*give both"):
        resolved("hough-3d", Context(4, 1.0, unit=Unit.METRE), speed_min=500)
    with pytest.raises(RequestError, match="speed_min 5 is given with speed_max 4"):
        resolved("hough-3d", Context(4, 1.0), speed_min=5, speed_max=4)
    with pytest.raises(RequestError, match="first_plane and second_plane are both xz"):
        resolved("hough-logic-3d", Context(4, 1.0), second_plane="xz")


def test_noise_that_is_not_known_is_asked_for():
    flat = chunk_of(np.zeros((2, 3)), [0, 1])
    with pytest.raises(RequestError, match="the noise is not known: give sigma"):
        initiator("hough-3d").initiate_chunk(flat, Context(4, 1.0), resolved("hough-3d", Context(4, 1.0)))


@pytest.mark.parametrize("name", INITIATORS)
def test_more_tracks_than_can_be_compared_are_refused_in_words(name):
    # 15 plots a scan, all within the noise of one motion: 15⁴ tracks fit.
    scan = np.repeat(np.arange(4), 15)
    place = np.random.default_rng(1).normal(size=(60, 3)) + 200.0 * scan[:, None]
    covariance = np.tile(1e4 * np.eye(3), (60, 1, 1))
    context = Context(4, 1.0, unit=Unit.METRE)
    with pytest.raises(
        RequestError, match="more than 20,000 tracks fit the plots of one batch; ask for more"
    ):
        initiator(name).initiate_chunk(chunk_of(place, scan, covariance), context, resolved(name, context))


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("combinatorial-3d", {}),
        ("combinatorial-3d", {"window_length": 100.0, "window_deg": 30.0}),
        ("combinatorial-3d", {"mode": "document", "window_length": 6000.0}),
        ("hough-logic-3d", {"cell_length": 400.0}),
        ("hough-3d", {"tessellation": 3}),
    ],
)
def test_tracks_do_not_depend_on_where_the_origin_lies(name, given):
    scenario = load_set("par-table-2").scenario("together")
    chunk, moved = draw(World.of(scenario), 3, 0, 30).chunk, np.array([90_000.0, -70_000.0, 8_000.0])
    there = replace(scenario.context, station=tuple(moved))
    parameters, algorithm = resolved(name, scenario.context, **given), initiator(name)
    tracks = algorithm.initiate_chunk(chunk, scenario.context, parameters)
    others = algorithm.initiate_chunk(replace(chunk, position=chunk.position + moved), there, parameters)
    np.testing.assert_array_equal(tracks.offsets, others.offsets)
    np.testing.assert_array_equal(tracks.plots, others.plots)
    assert len(tracks.theta) > 60


def passed_by_loop(place, station, axes, rows, length, votes):
    """Return which plots lie in a cell of one plane with enough votes."""
    found = set()
    for row in range(rows):
        theta = (row + 0.5) * np.pi / rows
        cells = {}
        for plot, at in enumerate(place - station):
            column = np.floor((at[axes[0]] * np.cos(theta) + at[axes[1]] * np.sin(theta)) / length)
            cells.setdefault(column, []).append(plot)
        found |= {plot for held in cells.values() if len(held) >= votes for plot in held}
    return found


@pytest.mark.parametrize(("planes", "votes"), [(("xz", "yz"), 8), (("xy", "yz"), 6)])
def test_the_gates_of_two_planes_are_those_of_a_loop(planes, votes):
    # A gate that is narrow for these plots: which pairs are left tells which plots have passed.
    scenario = load_set("par-table-2").scenario("together")
    chunk, context = draw(World.of(scenario), 3, 0, 1).chunk, scenario.context
    station = np.array([300.0, -200.0, 50.0])
    context = replace(context, station=tuple(station))
    given = {
        "first_plane": planes[0],
        "second_plane": planes[1],
        "cell_length": 300.0,
        "plots": votes,
        "speed_min": 0.0,
        "speed_max": 4e5,
    }
    parameters = resolved("hough-logic-3d", context, **given)
    axes = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
    passed = set(range(len(chunk.scan)))
    for plane in planes:
        passed &= passed_by_loop(chunk.position, station, axes[plane], 12, 300.0, parameters.plots)
    tracks = initiator("hough-logic-3d").initiate_chunk(chunk, context, parameters)
    assert 5 < len(passed) < len(chunk.scan)
    every = sum(1 for first in passed for second in passed if 0 < chunk.scan[second] - chunk.scan[first] <= 3)
    assert tracks.effort["pairs_gated"][0] == every


def test_plots_must_be_confirmed_in_so_many_planes():
    # On a straight line in the plane xy, on a zigzag in the two others.
    place = [(200.0 * k, 200.0 * k, 100.0 * (-1) ** k) for k in range(4)]
    chunk = chunk_of(place, range(4), np.tile(100.0 * np.eye(3), (4, 1, 1)))
    context = Context(4, 1.0, unit=Unit.METRE)
    for planes, found in ((1, 1), (2, 0), (3, 0)):
        given = {"mode": "document", "votes": 3, "planes": planes}
        tracks = initiator("combinatorial-3d").initiate_chunk(
            chunk, context, resolved("combinatorial-3d", context, **given)
        )
        assert len(tracks.theta) == found


def test_of_each_scan_the_document_mode_takes_the_plot_nearest_to_the_common_motion():
    place = [(200.0 * k, 100.0 * k, 20.0 * k) for k in range(4)]
    place.insert(3, (400.0, 260.0, 40.0))
    chunk = chunk_of(place, [0, 1, 2, 2, 3], np.tile(100.0 * np.eye(3), (5, 1, 1)))
    context = Context(4, 1.0, unit=Unit.METRE)
    parameters = resolved("combinatorial-3d", context, mode="document")
    tracks = initiator("combinatorial-3d").initiate_chunk(chunk, context, parameters)
    assert tracks.plots.tolist() == [[0, 1, 2, 4]]
