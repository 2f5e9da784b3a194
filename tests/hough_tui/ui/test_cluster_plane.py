"""The range-Doppler plane: what is drawn, read back from the characters on the screen."""

import asyncio
import math
from dataclasses import replace

import numpy as np
import pytest
from textual.app import App

from algorithms.clustering.ellipse import Ellipse
from algorithms.clustering.parameters import CorrectedPatent, Dbscan, Recommended
from hough_tui.inspection.scene import cluster_look, scene_picture
from hough_tui.ui.drawing.palette import DARK
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.views.cluster_scenes import cluster_scene, step_scene
from hough_tui.ui.widgets.cluster_plane import EMPTY, ClusterPlane
from hough_tui.ui.widgets.cluster_scene import (
    BOTH,
    DROPPED,
    KEPT,
    NONE,
    PLOT,
    STRAY,
    TRUE,
    ClusterScene,
    colour_of,
    legend,
)
from scenarios.files.set_files import load_set
from tests.hough_tui.ui.test_plane import at, place, screen_lines, text

RECOMMENDED = Recommended(range_extent=16.0, doppler_extent=12.0)
PATENT = CorrectedPatent(range_extent=16.0)
INKS = (DARK.unknown, DARK.found, DARK.target[-1], DARK.duplicate, DARK.false)


def look(name="interference", parameters=RECOMMENDED, trial=0):
    return cluster_look(scene_picture(load_set("range-doppler").scene(name), 1, trial), "it", parameters)


def sparse(points, label, kept=None, plots=(), truth=(), **given):
    """Return a scene of few points, each in a cell of its own."""
    count = len(points)
    return ClusterScene(**({
        "position": np.array(points, float).reshape(-1, 2), "amplitude": np.ones(count),
        "label": np.array(label, np.int64), "kept": np.ones(count, bool) if kept is None else np.array(kept),
        "region": Limits(0.0, 100.0, 0.0, 100.0), "unit": "cells",
        "plots": np.array(plots, float).reshape(-1, 2), "ellipses": (),
        "truth": np.array(truth, float).reshape(-1, 2),
    } | given))  # fmt: skip


class Host(App[None]):
    ENABLE_COMMAND_PALETTE = False

    def __init__(self, scene, step):
        super().__init__()
        self.given, self.told = (scene, step), []

    def compose(self):
        yield ClusterPlane()

    def on_mount(self):
        self.query_one(ClusterPlane).focus()
        self.query_one(ClusterPlane).show(*self.given)

    def on_cluster_plane_point_chosen(self, event):
        assert event.control is self.query_one(ClusterPlane)
        self.told.append(event.index)


def play(scene, journey, step=None, size=(120, 40)):
    async def work():
        app = Host(scene, step)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await journey(app, app.query_one(ClusterPlane), pilot)

    asyncio.run(work())


def test_points_show_their_clusters_by_glyph_and_colour():
    # As many clusters as there are glyphs, and one more: glyph and colour together tell all apart.
    clusters = list(range(len(KEPT) + 1))
    points = [(10.0 + 12.0 * index, 50.0) for index in clusters]

    async def journey(app, plane, pilot):
        drawn = [at(plane, *point) for point in points]
        assert [character for character, _ in drawn] == [*KEPT, KEPT[0]]
        assert [style.color for _, style in drawn] == [INKS[(k + k // 5) % 5] for k in clusters]
        assert len({(character, style.color) for character, style in drawn}) == len(clusters)

    play(sparse(points, clusters), journey)


def test_glyph_and_colour_come_again_after_25_clusters_only():
    clusters = np.arange(25)
    assert len(set(zip(clusters % 5, colour_of(clusters), strict=True))) == 25


def test_points_beyond_the_radius_are_hollow_and_those_in_no_cluster_dim():
    points = [(20.0, 20.0), (40.0, 20.0), (60.0, 20.0), (80.0, 20.0)]

    async def journey(app, plane, pilot):
        drawn = [at(plane, *point) for point in points]
        assert [character for character, _ in drawn] == [KEPT[0], DROPPED[0], DROPPED[1], STRAY]
        assert drawn[0][1].color == drawn[1][1].color == INKS[0]
        assert drawn[3][1].color == DARK.muted
        assert "● 1 kept   ○ 2 beyond the radius   · 1 in no cluster" in text(plane)

    play(sparse(points, [0, 0, 1, NONE], [True, False, False, False]), journey)


def test_plots_and_true_centres_have_marks_of_their_own_and_one_where_they_meet():
    async def journey(app, plane, pilot):
        assert [at(plane, x, 50.0)[0] for x in (20.0, 50.0, 80.0)] == [PLOT, BOTH, TRUE]
        # The number of a cluster stands beside its plot.
        for index, x in enumerate((20.0, 50.0)):
            column, row = place(plane, x, 50.0)
            assert plane.render_line(row).text[column + 1] == str(index)

    play(sparse([], [], plots=[(20, 50), (50, 50)], truth=[(50, 50), (80, 50)]), journey)


def test_the_ellipse_is_the_one_by_which_points_are_kept():
    ellipse = Ellipse((50.0, 50.0), 80.0, 40.0, 30.0)
    radius = 2.5
    scene = sparse([], [], ellipses=(np.column_stack(ellipse.outline(radius)),))
    inverse = np.linalg.inv([[80.0, 30.0], [30.0, 40.0]])

    async def journey(app, plane, pilot):
        frame, view = plane.layout_of_parts
        found = set()
        for row in range(2, view.height - 2):
            for column, character in enumerate(plane.render_line(row).text[frame.gutter :][: view.width]):
                x, y = view.x(column + 0.5), view.y(row + 0.5)
                if 5.0 < x < 95.0 and 5.0 < y < 95.0 and character != " ":
                    found.add((column, row))
        # By brute force: a cell whose corners lie on both sides of the ellipse is drawn, no other one
        # but those that it just touches.
        crossed = set()
        for row in range(view.height):
            for column in range(view.width):
                sides = set()
                for across in (0.0, 0.5, 1.0):
                    for down in (0.0, 0.5, 1.0):
                        away = np.array([view.x(column + across) - 50.0, view.y(row + down) - 50.0])
                        sides.add(away @ inverse @ away < radius**2)
                if len(sides) == 2:
                    crossed.add((column, row))
        assert len(crossed) > 60
        assert len(crossed - found) <= 0.06 * len(crossed)
        assert len(found - crossed) <= 0.06 * len(crossed)

    play(scene, journey)


@pytest.mark.parametrize("parameters", [RECOMMENDED, PATENT], ids=["recommended", "corrected-patent"])
def test_a_step_shows_its_set_bright_with_its_two_parts(parameters):
    seen = look(parameters=parameters)
    step = seen.steps[0]
    assert step.axis is not None
    shown = step_scene(seen, step)
    points = seen.found.clusters.points
    values = points.range if step.axis == "range" else points.doppler
    lower, upper = (set(seen.steps[part].points.tolist()) for part in step.parts)
    # Its parts are the sets of the next steps, and the line lies between them.
    assert set(shown.members[shown.is_upper].tolist()) == upper
    assert set(shown.members[~shown.is_upper].tolist()) == lower
    assert max(values[list(lower)]) <= shown.cut <= min(values[list(upper)])

    async def journey(app, plane, pilot):
        for member, is_upper in zip(shown.members, shown.is_upper, strict=True):
            character, style = at(plane, *plane.scene.position[member])
            marks = {KEPT[1 if is_upper else 0], TRUE}
            assert character in marks | {KEPT[0], KEPT[1]}
            assert style.color in (*INKS, DARK.truth)
        assert PLOT not in "".join(text(plane).splitlines()[:-1])
        assert "lower part" in text(plane)
        assert "upper part" in text(plane)

    play(cluster_scene(seen), journey, shown)


def test_points_that_are_not_in_the_set_are_dim():
    seen = look()
    step = next(step for step in seen.steps if step.cluster is not None)
    shown, scene = step_scene(seen, step), cluster_scene(seen)
    others = np.setdiff1d(np.arange(len(scene.position)), step.points)
    far = [point for point in others if seen.picture.drawn.origin[point] < 0]

    async def journey(app, plane, pilot):
        for point in far:
            character, style = at(plane, *scene.position[point])
            assert (character, style.color) == (STRAY, DARK.rule)
        drawn = "".join(text(plane).splitlines()[:-1])
        glyph = KEPT[step.cluster % len(KEPT)]
        assert glyph in drawn
        assert not set(drawn) & (set(KEPT) - {glyph})
        assert f"{glyph} {len(step.points)} in the set" in text(plane)

    play(scene, journey, shown)


def test_the_chord_and_the_extents_are_those_of_the_ellipse():
    seen = look("diagonal", PATENT)
    step = seen.steps[0]
    shown = step_scene(seen, step)
    # The chord ends on the outline: there the quadratic form is 2.
    a, b, c = step.ellipse.range_variance, step.ellipse.doppler_variance, step.ellipse.covariance
    inverse = np.linalg.inv([[a, c], [c, b]])
    for end in shown.chord - np.array(step.ellipse.centre):
        assert end @ inverse @ end == pytest.approx(2.0)
    assert len(shown.box) == 0
    other = step_scene(look("diagonal"), look("diagonal").steps[0])
    assert other.box.max(axis=0) == pytest.approx(other.ellipse.max(axis=0), rel=1e-2)
    assert other.box.min(axis=0) == pytest.approx(other.ellipse.min(axis=0), rel=2e-2)


def test_axes_have_round_figures_and_units():
    async def journey(app, plane, pilot):
        shown = text(plane).splitlines()
        assert shown[0].lstrip(" │").startswith("Doppler, cells")
        figures = shown[-2]
        assert figures.rstrip().endswith("range, cells")
        assert [figures.split()[index] for index in range(3)] == ["0", "20", "40"]

    play(cluster_scene(look()), journey, size=(90, 34))


def test_points_and_clusters_are_told_one_by_one():
    seen = look()

    async def journey(app, plane, pilot):
        await pilot.press("t")
        assert plane.cluster == 0
        members = np.flatnonzero(seen.found.clusters.label == 0)
        kept = int(seen.found.clusters.kept[members].sum())
        assert f"● cluster 0  range {seen.found.clusters.range[0]:.1f}" in text(plane)
        assert f"{len(members)} points, {kept} kept" in text(plane)
        away = np.hypot(
            *(
                seen.picture.drawn.centres[0] - (seen.found.clusters.range[0], seen.found.clusters.doppler[0])
            ).T
        )
        assert f"{away.min():.2f} from target {away.argmin()}" in text(plane)
        await pilot.press("T")
        assert plane.cluster == len(seen.found.clusters) - 1
        await pilot.press("n", "n")
        assert (plane.cursor, plane.cluster) == (1, None)
        assert app.told == [0, 1]
        r, d = plane.scene.position[1]
        assert f"point 1  range {r:g}  Doppler {d:g}" in text(plane)
        assert "of target 0" in text(plane)
        await pilot.press("N", "N")
        assert plane.cursor == len(plane.scene.position) - 1
        assert "of no target" in text(plane)

    play(cluster_scene(seen), journey)


def test_keys_zoom_about_what_is_chosen_and_fit_again():
    async def journey(app, plane, pilot):
        await pilot.press("t", "plus", "plus", "plus")
        x, y = plane.scene.plots[0]
        limits = plane.limits
        assert limits.holds(x, y)
        assert limits.right - limits.left < 50.0
        await pilot.press("l", "l")
        assert plane.limits.left > limits.left
        await pilot.press("0")
        assert plane.limits == plane.home()

    play(cluster_scene(look()), journey)


def test_a_click_chooses_the_nearest_point():
    async def journey(app, plane, pilot):
        column, row = place(plane, 60.0, 30.0)
        await pilot.click(ClusterPlane, offset=(column + 1, row))
        assert (plane.cursor, app.told) == (1, [1])
        await pilot.click(ClusterPlane, offset=place(plane, 30.0, 70.0))
        assert app.told == [1]

    play(sparse([(20.0, 30.0), (60.0, 30.0)], [0, 0]), journey)


def test_the_view_stays_with_the_region_and_the_cursor_with_the_points():
    seen, other = look(), look(parameters=Dbscan(range_extent=16.0, doppler_extent=12.0))

    async def journey(app, plane, pilot):
        await pilot.press("n", "plus")
        limits = plane.limits
        plane.show(cluster_scene(other))
        assert (plane.limits, plane.cursor) == (limits, 0)
        plane.show(cluster_scene(look(trial=1)))
        assert (plane.limits, plane.cursor) == (limits, None)
        plane.show(replace(cluster_scene(other), region=Limits(0.0, 10.0, 0.0, 10.0)))
        assert plane.limits == plane.home()

    play(cluster_scene(seen), journey)


@pytest.mark.parametrize(
    "scene",
    [EMPTY, sparse([], []), sparse([(5.0, 5.0)] * 3, [0, 0, 0], plots=[(5, 5)]),
     sparse([(1e15, -1e15), (3.0, 3.0)], [NONE, NONE]), sparse([(2.0, 3.0)], [0], truth=[(1e15, 0.0)])],
    ids=["nothing", "no points", "one place", "far away", "far truth"],
)  # fmt: skip
@pytest.mark.parametrize("size", [(120, 40), (80, 24), (12, 3), (1, 1)])
def test_odd_scenes_are_drawn_at_any_size(scene, size):
    async def journey(app, plane, pilot):
        await pilot.press("n", "t", "plus", "0")
        shown = screen_lines(app)
        plane._draw()
        plane.refresh()
        await pilot.pause()
        assert screen_lines(app) == shown

    play(scene, journey, size=size)


def test_home_holds_points_beside_the_region_but_not_those_a_world_away():
    home = sparse([(-20.0, 50.0), (1e9, 0.0)], [NONE, NONE]).home()
    assert home.holds(-20.0, 50.0)
    assert not home.holds(1e9, 0.0)
    assert math.isclose(Viewport(home, 10, 10).x(10), home.right)


def test_numbers_of_clusters_never_hide_a_plot():
    async def journey(app, plane, pilot):
        column, row = place(plane, 50.0, 50.0)
        view = plane.viewport
        beside = view.x(column - plane.layout_of_parts[0].gutter + 1.5)
        plane.show(sparse([], [], plots=[(50.0, 50.0), (beside, 50.0)]))
        await pilot.pause()
        assert plane.render_line(row).text[column : column + 3] == f"{PLOT}{PLOT}1"

    play(sparse([], []), journey)


def test_without_colour_nothing_and_something_are_drawn(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")

    async def journey(app, plane, pilot):
        assert not text(plane).strip()
        plane.show(cluster_scene(look()))
        await pilot.pause()
        drawn = text(plane)
        assert KEPT[0] in drawn
        assert KEPT[1] in drawn
        colours = {
            segment.style.color.get_truecolor()
            for strip in app.screen._compositor.render_strips()
            for segment in strip
            if segment.style is not None and segment.style.color is not None
        }
        assert all(red == green == blue for red, green, blue in colours)

    play(EMPTY, journey)


def test_the_legend_tells_one_plot_from_several():
    def words(count):
        places = [(10.0 * index, 50.0) for index in range(count)]
        scene = sparse(places, [0] * count, plots=places, truth=places)
        return "".join(part for part, _ in legend(scene, DARK, 200))

    assert words(1) == "● 1 kept   + 1 plot   × 1 true centre"
    assert words(2) == "● 2 kept   + 2 plots   × 2 true centres"
