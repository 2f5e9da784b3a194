"""Look: what the three panels tell of one another."""

import numpy as np
import pytest
from textual.widgets import Static

from algorithms.hough.inspection import columns_of, voters
from hough_tui.ui.views.look import LookView
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.plane import Plane
from hough_tui.ui.widgets.track_grid import TrackGrid


async def look(user):
    """Open Look, and return its panel when a trial is seen."""
    view = await user.go("f4")
    panel = view.query_one("LookPanel")
    await user.until(lambda: panel._seen)
    await user.settle()
    return panel


def test_the_layout_follows_the_size_whoever_measures_the_screen_meanwhile(drive, monkeypatch):
    show_set = LookView.show_set

    def measure(view, given):
        # What Textual does by itself at times, when it refreshes something between mounting and layout.
        view.screen._compositor._full_map_invalidated = True
        assert view.size
        show_set(view, given)

    monkeypatch.setattr(LookView, "show_set", measure)

    async def journey(user):
        panel = await look(user)
        await user.until(lambda: panel.has_class("one-plane"))
        await user.press("v")
        await user.until(lambda: panel.has_class("one-accumulator"))

    drive(journey, "course-report", size=(80, 24))


def test_a_peak_is_explained_by_its_plots_and_its_neighbourhood(drive):
    async def journey(user):
        panel = await look(user)
        heatmap, plane = panel.query_one(Heatmap), panel.query_one(Plane)
        heatmap.focus()
        seen = panel._seen
        strongest = seen.accumulator.votes.max()
        assert seen.accumulator.votes[heatmap.cursor] == strongest
        await user.sees(f"{strongest} votes")
        before = user.drawn(plane)
        await user.press("p")
        row, column = heatmap.cursor
        votes = int(seen.accumulator.votes[row, column])
        assert votes < strongest
        # The plots that voted for the cell light up in the plane.
        lit = voters(seen.picture.plots.position, seen.accumulator.grid, row, column)
        assert len(lit) == votes
        await user.until(lambda: np.array_equal(plane._lit, lit))
        await user.until(lambda: user.drawn(plane) != before)
        await user.sees(f"{votes} votes")

        await user.press("enter")
        await user.screen("WhyPeak")
        await user.sees(f"Cell ({row}, {column})", f"{votes} votes", f"the {votes} plots that voted")
        parts = list(user.app.screen.query(Static))
        plots = parts[-1].content
        assert plots.row_count == votes
        scans = [str(cell) for cell in plots.columns[0].cells]
        assert scans == [str(scan) for scan in seen.picture.plots.scan[lit]]
        around = parts[-2].content
        assert (around.row_count, len(around.columns)) == (9, 10)
        assert list(around.columns[5].cells)[4].plain == str(votes)
        await user.press("escape")
        await user.screen("MainScreen")
        assert heatmap.cursor == (row, column)

    drive(journey, "course-report", size=(160, 48))


def test_choosing_a_track_marks_its_cell_and_its_plots(drive):
    async def journey(user):
        panel = await look(user)
        heatmap, plane, grid = (panel.query_one(kind) for kind in (Heatmap, Plane, TrackGrid))
        seen = panel._seen
        cells = seen.accumulator.grid
        grid.focus()
        for index in (1, 2, 3):
            await user.press("j")
            wanted = cells.cell(float(seen.tracks.theta[index]), float(seen.tracks.rho[index]))
            await user.until(lambda wanted=wanted: heatmap.cursor == wanted)
            lit = seen.tracks.plots[index]
            await user.until(lambda lit=lit: np.array_equal(np.sort(plane._lit), np.sort(lit)))
            assert plane._track == index
        # In the plane as well.
        plane.focus()
        await user.press("t")
        wanted = cells.cell(float(seen.tracks.theta[4]), float(seen.tracks.rho[4]))
        await user.until(lambda: heatmap.cursor == wanted)

    drive(journey, "course-report", size=(160, 48))


def test_choosing_a_plot_draws_its_sinusoid_over_the_accumulator(drive):
    async def journey(user):
        panel = await look(user)
        heatmap, plane = panel.query_one(Heatmap), panel.query_one(Plane)
        before = user.drawn(heatmap)
        plane.focus()
        await user.press("n", "enter")
        await user.until(lambda: heatmap._trace is not None)
        seen, chosen = panel._seen, plane.cursor
        grid = seen.accumulator.grid
        curve = columns_of(seen.picture.plots.position[[chosen]], grid, np.arange(grid.theta_bins))[:, 0]
        assert np.array_equal(heatmap._trace, np.where(curve < grid.rho_bins, curve, -1))
        await user.until(lambda: user.drawn(heatmap) != before)

    drive(journey, "course-report", size=(160, 48))


@pytest.mark.parametrize("size", [(160, 48), (80, 24)], ids=["wide", "narrow"])
def test_initiators_and_trials_are_gone_through(drive, size):
    async def journey(user):
        panel = await look(user)
        await user.sees("standard on two-crossing, trial 0: 6 tracks")
        await user.press("]")
        await user.sees("standard on two-crossing, trial 1:")
        await user.press("[", "[")
        await user.sees("standard on two-crossing, trial 0: 6 tracks")
        await user.press("i")
        await user.sees("sequential on two-crossing, trial 0: ")
        await user.press("I", "s")
        await user.sees("standard on three-scans, trial 0: ")
        await user.press("i", "i")
        await user.sees("modified on three-scans, trial 0: ")
        assert panel._seen.accumulator is None or "no accumulator" not in user.text

    drive(journey, "course-report", size=size)


@pytest.mark.parametrize("size", [(200, 60), (160, 48)], ids=str)
def test_two_initiators_stand_side_by_side_on_the_same_draw(drive, size):
    async def journey(user):
        assert user.main.query_one("#tree-place").region.width > 20
        await look(user)
        await user.press("b")
        await user.sees("standard on two-crossing, trial 0", "sequential on two-crossing, trial 0")
        first, second = user.view.query("LookPanel")
        await user.until(lambda: second._seen is not None)
        assert first._seen.picture is second._seen.picture
        assert first.region.width > 60
        assert second.region.width > 60
        await user.press("]")
        await user.sees("standard on two-crossing, trial 1", "sequential on two-crossing, trial 1")
        await user.press("b")
        await user.until(lambda: len(user.view.query("LookPanel")) == 1)

    drive(journey, "course-report", size=size)


def test_without_room_for_two_it_is_said_how_much_they_need(drive):
    async def journey(user):
        await look(user)
        await user.press("b")
        assert "Two initiators side by side need 120 columns, and the view has 104: F8 hides the tree" in (
            user.notes
        )
        await user.press("f8", "b")
        await user.until(lambda: len(user.view.query("LookPanel")) == 2)

    drive(journey, "course-report", size=(130, 40))


def test_the_accumulator_shows_votes_their_deviation_and_weighted_votes(drive):
    async def journey(user):
        panel = await look(user)
        heatmap = panel.query_one(Heatmap)
        heatmap.focus()
        await user.press("w")  # the first initiator of the set counts votes as they are
        assert panel.layer == "votes"
        await user.press("i", "i", "i", "i")
        await user.until(lambda: panel._seen.entry.initiator == "weighted")
        await user.settle()
        seen = panel._seen.accumulator
        row, column = np.unravel_index(np.nanargmin(seen.std), seen.std.shape)
        heatmap.move_cursor(int(row), int(column))
        await user.press("w")
        await user.settle()
        assert panel.layer == "deviation"
        scene = heatmap._scene
        # The least deviation is the brightest, and cells without one are the darkest.
        assert scene.strongest == (row, column)
        assert (scene.comparable[~np.isfinite(seen.std)] == 0.0).all()
        assert scene.comparable[np.isfinite(seen.std)].min() > 0.0
        told = f"{seen.std[row, column]:.4g} deviation · {seen.votes[row, column]} votes"
        assert told in scene.words(int(row), int(column))[2]
        dark = np.argwhere(~np.isfinite(seen.std))[0]
        assert "no deviation" in scene.words(*dark.tolist())[2]
        await user.press("w")
        await user.settle()
        assert panel.layer == "weighted votes"
        assert heatmap._scene.values is seen.weighted
        await user.press("enter")
        await user.screen("WhyPeak")
        await user.sees(f"Weighted by their standard deviation: {seen.weighted[row, column]:.4g} votes")
        assert "too few" not in user.text
        await user.press("escape")
        heatmap.move_cursor(*np.argwhere((seen.votes > 1) & np.isnan(seen.std))[0].tolist())
        await user.press("enter")
        await user.screen("WhyPeak")
        await user.sees("Weighted by their standard deviation: 0 votes, as there are too few")
        await user.press("escape", "w")
        assert panel.layer == "votes"

    drive(journey, "thesis-five-targets")


def test_points_become_plots_in_the_ways_of_the_set(drive):
    async def journey(user):
        panel = await look(user)
        await user.sees("standard on crossing, trial 0", "plots by recommended")
        assert len(panel._seen.picture.plots) == 16
        await user.press("o")
        await user.until(lambda: panel._seen.picture.stage.name == "corrected-patent")
        await user.sees("plots by corrected-patent")
        assert len(panel._seen.picture.plots) > 100
        await user.press("O", "O")
        await user.until(lambda: panel._seen.picture.stage.name == "ideal")
        await user.press("O")
        await user.until(lambda: panel._seen.picture.stage is None)
        await user.sees("every point a plot")
        assert len(panel._seen.picture.plots) == 551

    drive(journey, "range-doppler", size=(160, 48))


def test_where_no_sensor_gives_points_there_is_nothing_to_cluster(drive):
    async def journey(user):
        panel = await look(user)
        await user.press("o")
        await user.sees("No sensor of the scenario gives points")
        assert panel._seen.picture.stage is None

    drive(journey, "course-report", size=(120, 40))


def test_a_clustering_that_cannot_be_done_says_why(drive, monkeypatch):
    from algorithms.errors import RequestError
    from hough_tui.ui.views import look as module

    def fails(*_):
        raise RequestError("mode dbscan needs scikit-learn")

    async def journey(user):
        await look(user)
        monkeypatch.setattr(module, "picture", fails)
        await user.press("o")
        await user.sees("mode dbscan needs scikit-learn")

    drive(journey, "range-doppler", size=(120, 40))


def test_a_plug_in_that_fails_says_where(drive, monkeypatch):
    from algorithms.errors import WorkFailedError
    from hough_tui.ui.views import look as module

    def fails(*_):
        raise WorkFailedError("trial 1: plug-in 'theirs': KeyError")

    async def journey(user):
        await look(user)
        monkeypatch.setattr(module, "look", fails)
        await user.press("]")
        await user.sees("standard: trial 1: plug-in 'theirs': KeyError")

    drive(journey, "course-report", size=(120, 40))
