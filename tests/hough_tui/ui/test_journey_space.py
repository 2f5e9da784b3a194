"""Scenarios in space: rings, three projections, the votes of each plane."""

from pathlib import Path

import numpy as np
import pytest
from textual.widgets import Static

from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.pair_votes import PairVotes
from hough_tui.ui.widgets.plane import Plane
from hough_tui.ui.widgets.track_grid import TrackGrid

SIZES = [(160, 48), (80, 24)]

MIXED = """
schema: 1
name: mixed
scenarios:
  - name: flat
    scans: 5
    interval: 4
    region: {x: [0, 100], y: [0, 100]}
    sensor: {kind: cartesian, sigma: 0.1}
    clutter: [{kind: poisson, rate: 2}]
    targets: [{position: [40, 20], velocity: [0.3, 0.18]}]
  - name: deep
    unit: m
    scans: 4
    interval: 1
    sensor: {kind: polar, sigma_range: 50, sigma_azimuth_deg: 0.3, sigma_elevation_deg: 0.2,
             range: [1000, 40000], azimuth_deg: [-20, 20], elevation_deg: [0, 10]}
    clutter: [{kind: poisson, rate: 5, over: volume}]
    targets: [{position: [5000, 25000, 3000], velocity: [-200, -200, 0]}]
initiators:
  - {name: standard}
  - {name: cht, initiator: combinatorial-3d}
experiments:
  - {name: all, trials: 20, seed: 1, criterion: {plots: 3}}
"""


async def together(user):
    """Open Look on the scenario of all five targets, seen by `cht`; return its panel."""
    view = await user.go("f4")
    panel = view.query_one("LookPanel")
    await user.press("s", "s", "s", "s", "s", "i")
    await user.sees("cht on together, trial 0")
    await user.settle()
    return panel


@pytest.mark.parametrize("size", SIZES, ids=["wide", "narrow"])
def test_from_the_rings_to_a_track_and_its_votes(drive, size):
    async def journey(user):
        view = await user.go("f2")
        if not view.query_one(Plane).size.area:
            await user.press("f9")
        # Rings at 10, 20 and 30 km, spokes every 10°.
        await user.sees("20000", "30000", "10°", "-10°")

        panel = await together(user)
        planes, votes = list(panel.query(Plane)), list(panel.query(PairVotes))
        seen = panel._seen
        assert [plane._scene.names for plane in planes] == [("x", "y"), ("x", "z"), ("y", "z")]
        is_wide = size[0] > 100
        assert [plane.display for plane in planes] == ([True] * 3 if is_wide else [True, False, False])
        await user.sees(f"{len(seen.plane_votes)} of {seen.plane_votes.tried:,} pairs")

        # A track that is chosen in one plane is chosen in all, and its votes light up.
        panel.take_focus()
        await user.press("t")
        await user.until(lambda: [plane.track for plane in planes] == [0, 0, 0])
        own = seen.tracks.plots[0]
        expected = np.flatnonzero(np.isin(seen.plane_votes.pairs, own).all(axis=1))
        assert len(expected) >= 3
        for plane, chart in zip(planes, votes, strict=True):
            assert np.array_equal(plane._lit, np.sort(own))
            assert np.array_equal(chart._lit, expected)
        await user.sees("track 0")

        # The other planes: side by side, or in turn.
        await user.press("z")
        assert panel.plane == 1
        assert user.app.focused is planes[1]
        assert planes[1].display
        assert planes[0].display is is_wide
        await user.sees("xz track 0")

        # From vote to vote of the track: each lights up its two plots in every plane.
        votes_at_hand = votes[1]
        if is_wide:
            votes_at_hand.focus()
        else:
            await user.press("v")
            assert user.app.focused is votes_at_hand
        await user.press("n")
        first = expected[0]
        await user.until(lambda: all(chart.cursor == first for chart in votes))
        pair = np.sort(seen.plane_votes.pairs[first])
        assert all(np.array_equal(plane._lit, pair) for plane in planes)
        a, b = seen.plane_votes.pairs[first].tolist()
        await user.sees(f"plots {a}, {b}", "confirmed")

    drive(journey, "par-table-2", size=size)


def test_planes_have_the_room_of_votes_that_an_initiator_has_not(drive):
    async def journey(user):
        panel = await together(user)
        height = panel.query_one(Plane).size.height
        await user.press("i", "i")
        await user.sees("logic on together, trial 0", "This initiator has no accumulator.", "climb m/s")
        await user.settle()
        assert panel.query_one(Plane).size.height >= 1.4 * height
        assert panel.query_one(TrackGrid).size.height >= 6
        await user.press("I", "I")
        await user.sees("cht on together, trial 0")
        await user.settle()
        assert panel.query_one(Plane).size.height == height

    drive(journey, "par-table-2", size=(160, 48))


def test_cursor_and_shared_axes_are_the_same_in_all_planes(drive):
    async def journey(user):
        panel = await together(user)
        xy, xz, yz = panel.query(Plane)
        xy.focus()
        await user.press("n", "plus", "plus", "l")
        await user.until(lambda: xz.limits.left == xy.limits.left)
        assert xy.cursor == xz.cursor == yz.cursor == 0
        assert (xz.limits.left, xz.limits.right) == (xy.limits.left, xy.limits.right)
        assert (yz.limits.left, yz.limits.right) == (xy.limits.bottom, xy.limits.top)
        # z is not shown in xy: it stays as it was, and the two others share it.
        assert (xz.limits.bottom, xz.limits.top) == (xz.home().bottom, xz.home().top)
        yz.focus()
        await user.press("plus")
        await user.until(lambda: xz.limits.top == yz.limits.top)
        assert xz.limits.top < xz.home().top
        assert (xy.limits.bottom, xy.limits.top) == (yz.limits.left, yz.limits.right)
        await user.press("0")
        await user.until(lambda: xz.limits.top == xz.home().top)
        assert (xy.limits.bottom, xy.limits.top) == (xy.home().bottom, xy.home().top)

    drive(journey, "par-table-2", size=(160, 48))


def test_a_plot_lights_up_the_votes_that_it_has_a_part_in(drive):
    async def journey(user):
        panel = await together(user)
        pairs = panel._seen.plane_votes.pairs
        plane = list(panel.query(Plane))[2]
        plane.focus()
        plot = int(pairs[3, 0])
        plane.move_to(plot)
        await user.press("enter")
        expected = np.flatnonzero((pairs == plot).any(axis=1))
        await user.until(lambda: all(np.array_equal(one._lit, expected) for one in panel.query(PairVotes)))

    drive(journey, "par-table-2", size=(160, 48))


@pytest.mark.parametrize("size", SIZES, ids=["wide", "narrow"])
def test_initiators_and_scenarios_of_other_dimensions_say_what_is_amiss(drive, home, size):
    Path("mixed.yaml").write_text(MIXED)

    async def journey(user):
        view = await user.go("f4")
        panel = view.query_one("LookPanel")
        await user.sees("standard on flat, trial 0")
        await user.press("z")
        assert "This trial lies in the plane" in user.notes
        await user.press("i")
        # No dialogue, no crash: the draw is there, and why there is nothing more.
        await user.sees("combinatorial-3d works in space, and the plots have no z")
        assert type(user.app.screen).__name__ == "MainScreen"
        assert len(panel.query_one(Plane)._scene.position) > 5
        await user.press("v", "v", "v")
        await user.press("I", "s")
        await user.sees("standard on deep, trial 0", "z is ignored")
        heatmap = panel.query_one(Heatmap)
        while not heatmap.size.area:
            await user.press("v")
        heatmap.focus()
        await user.press("p", "enter")
        await user.screen("WhyPeak")
        await user.press("escape")
        await user.press("i")
        await user.sees("cht on deep, trial 0")
        assert "z is ignored" not in user.text

        await user.go("f3")
        await user.sees("standard: ")
        await user.press("f10")
        await user.sees("z of deep is ignored")
        user.view.take_focus()
        await user.press("j")
        await user.press("f10")
        caption = user.view.query_one(".caption", Static)
        await user.until(lambda: "flat lies in the plane: it cannot run there" in str(caption.content))

        # A run says what `batch` says.
        await user.go("f6")
        await user.press("f5")
        await user.sees("combinatorial-3d works in space, and the plots have no z")

    drive(journey, "mixed.yaml", size=size)


def test_a_trial_of_a_run_in_space_opens_in_look(drive):
    async def journey(user):
        await user.go("f6")
        await user.until(lambda: user.view.query("RunField"))
        user.view.query("RunField").first().focus()
        await user.type("20")
        await user.press("f5")
        await user.until(lambda: not user.view.is_at_work and user.view.query_one("RatePanel").display)
        user.view.query_one("RatePanel").take_focus()
        await user.press("o")
        assert "No scenario has several targets: success is that of the one" in user.notes
        await user.press("enter")
        await user.screen("TrialsScreen")
        await user.press("enter")
        await user.screen("MainScreen")
        await user.sees("cht-document on T1, trial", "of a run")
        panel = user.view.query_one("LookPanel")
        await user.until(lambda: panel._seen is not None and panel._seen.plane_votes is not None)
        headings = [column.label.plain for column in panel.query_one(TrackGrid).ordered_columns]
        assert "climb m/s" in headings

    drive(journey, "par-table-2", size=(160, 48))


def test_a_set_in_space_is_edited_in_its_forms(drive):
    async def journey(user):
        await user.go("f2")
        await user.fill(("scenarios", 0, "sensor", "azimuth_deg"), "-45, 45")
        await user.press("tab")
        await user.until(lambda: user.value("scenarios", 0, "sensor", "azimuth_deg") == (-45.0, 45.0))
        await user.fill(("scenarios", 0, "sensor", "elevation_deg"), "0, 20")
        await user.press("tab")
        await user.until(lambda: user.value("scenarios", 0, "sensor", "elevation_deg") == (0.0, 20.0))
        # The picture follows: spokes as far as the sector reaches.
        await user.sees("-30°", "30°")

        sensors = user.form.table(("scenarios", 0, "further_sensors"))
        assert "Detection probability" not in sensors._table.ordered_columns
        assert not sensors._table.show_header
        sensors._table.focus()
        await user.press("a")
        await user.until(lambda: len(user.value("scenarios", 0, "further_sensors")) == 1)
        assert user.value("scenarios", 0, "further_sensors", 0) == user.value("scenarios", 0, "sensor")
        assert sensors._table.show_header
        await user.press("d")
        await user.until(lambda: not user.value("scenarios", 0, "further_sensors"))

        targets = user.form.table(("scenarios", 0, "targets"))
        targets._table.focus()
        await user.press("a")
        await user.until(lambda: len(user.value("scenarios", 0, "targets")) == 2)
        assert len(user.value("scenarios", 0, "targets", 1).position) == 3
        plane = user.view.query_one(Plane)
        await user.until(lambda: len(plane._scene.truth) == 2)
        assert "trial 0 of seed 1" in user.view.query_one(Caption).parts[0].text

    drive(journey, "par-table-2", size=(160, 60))


def test_lists_of_a_set_in_space_are_filled_on_a_small_terminal(drive):
    async def journey(user):
        await user.go("f2")
        sensors = user.form.table(("scenarios", 0, "further_sensors"))
        targets = user.form.table(("scenarios", 0, "targets"))
        # Where an empty list has the focus it is seen, and so is what is added to it.
        await user.until(lambda: "Further sensors" not in user.text)
        sensors._table.focus()
        await user.sees("no further sensors yet; a adds one")
        # The arrows do not end there: there is no row that they could go to.
        clutter = user.form.table(("scenarios", 0, "clutter"))
        await user.press("down")
        assert user.app.focused is clutter._table
        sensors._table.focus()
        await user.press("up")
        above = user.form.field(("scenarios", 0, "sensor", "resolution", "doppler_cells"))
        assert above in user.app.focused.ancestors
        sensors._table.focus()
        await user.press("a")
        await user.sees("  0  polar")
        headings = [column.label.plain.split("\n")[0] for column in sensors._table.ordered_columns]
        # Columns that say of what they are, and none that no sensor here can have.
        assert {"Range nearest", "Range farthest", "Azimuth first", "Azimuth last", "Elevation"} <= set(
            headings
        )
        assert not [name for name in headings if name == "σ" or name.startswith("Resolution")]

        # A new target flies where the radar sees it, at a speed that the set has already.
        targets._table.focus()
        await user.press("a")
        await user.until(lambda: len(user.value("scenarios", 0, "targets")) == 2)
        new = user.value("scenarios", 0, "targets", 1)
        assert new.position == pytest.approx((0.0, 20400.0, 1800.0), abs=50)
        assert new.velocity == (251.0, 0.0, 0.0)
        # Speed is that in space, and a target that climbs straight up has one.
        assert targets.worked_out_cells(new) == ("251", "90.0")
        climbing = new.model_copy(update={"velocity": (0.0, 0.0, 100.0)})
        assert targets.worked_out_cells(climbing) == ("100", "")

    drive(journey, "par-table-2", size=(80, 24))
