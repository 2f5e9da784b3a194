from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from algorithms.context import Box
from hough_tui.ui.drawing.palette import DARK, LIGHT
from hough_tui.ui.widgets.plane import PlaneScene, PlaneTrack
from tests.hough_tui.ui.test_plane import (
    REGION,
    TRUTH,
    at,
    lines,
    place,
    play,
    scene,
    screen_lines,
    sent,
    sparse,
    text,
)

FULL_REPAINT = 70_000


def test_every_plot_has_its_dot():
    async def journey(app, plane, pilot):
        for x, y in plane._scene.position:
            character, _ = at(plane, x, y)
            assert character != " "

    play(scene(), journey)


def test_newer_scans_are_brighter_and_targets_are_told_from_clutter():
    points = [(10.0, 50.0), (30.0, 50.0), (50.0, 50.0), (70.0, 50.0)]

    async def journey(app, plane, pilot):
        assert [at(plane, *point)[1].color for point in points] == list(DARK.clutter)
        one_dot = {bin(ord(at(plane, *point)[0]) - 0x2800).count("1") for point in points}
        assert one_dot == {1}
        plane.show(sparse(*points, origin=np.array([0, 0, 1, 1], np.int32)))
        await pilot.pause()
        assert [at(plane, *point)[1].color for point in points] == list(DARK.target)
        assert "4 of targets" in text(plane)

    play(sparse(*points), journey)


def test_tracks_differ_by_mark_and_by_colour():
    async def journey(app, plane, pilot):
        shown = text(plane)
        for label in ("T1", "F1", "D1", "U1"):
            assert label in shown
        assert [at(plane, *point)[0] for point in ((70, 90), (80, 80), (90, 70))] == ["×"] * 3
        ends = [at(plane, *point) for point in (TRUTH[1], (90, 70), (25, 80), (25, 60))]
        assert [character for character, _ in ends] == ["○", "×", "◇", "□"]
        colours = [style.color for _, style in ends]
        assert colours == [DARK.found, DARK.false, DARK.duplicate, DARK.unknown]
        # The line between the plots of the false track.
        assert at(plane, 75.0, 85.0)[1].color == DARK.false

    play(scene(), journey)


def test_true_paths_are_dashed():
    path = np.array([[10.0, 50.0], [90.0, 50.0]])

    async def journey(app, plane, pilot):
        (left, row), (right, _) = place(plane, 10.0, 50.0), place(plane, 90.0, 50.0)
        drawn = lines(plane)[row].text[left : right + 1]
        dots = sum(bin(ord(character) - 0x2800).count("1") for character in drawn if character != " ")
        assert dots == pytest.approx(right - left, abs=6)
        assert {at(plane, x, 50.0)[1].color for x in (10.0, 30.0, 50.0)} == {DARK.truth}

    play(sparse(truth=(path,)), journey)


def test_lit_plots_stand_out_and_go_out_again():
    points = [(20.0, 20.0), (40.0, 40.0), (60.0, 60.0)]

    async def journey(app, plane, pilot):
        before = text(plane)
        plane.highlight([0, 2, 2, 99, -1])
        await pilot.pause()
        assert [at(plane, *point)[0] for point in points] == ["●", at(plane, *points[1])[0], "●"]
        assert at(plane, *points[1])[0] != "●"
        assert at(plane, *points[0])[1].color == DARK.lit
        plane.highlight([])
        await pilot.pause()
        assert text(plane) == before

    play(sparse(*points), journey)


def test_what_is_on_the_screen_is_what_would_be_drawn_anew():
    async def journey(app, plane, pilot):
        for keys in ("plus plus h k", "n n", "t e", "0 e N"):
            await pilot.press(*keys.split())
            await pilot.pause()
            shown = screen_lines(app)
            plane._draw()
            plane.refresh()
            await pilot.pause()
            assert screen_lines(app) == shown

    play(scene(), journey, size=(80, 24))


@pytest.mark.parametrize(
    "given_scene",
    [
        None,
        sparse(),
        sparse((50.0, 50.0)),
        sparse((np.nan, 1.0), (np.inf, -np.inf), (1e300, 0.0)),
        PlaneScene(np.full((3, 3), 5.0), np.zeros(3, np.int32), Box((5.0, 5.0, 5.0), (5.0, 5.0, 5.0)), "m"),
        PlaneScene(np.full((2, 2), 1e9), np.zeros(2, np.int32), Box((1e9, 1e9), (1e9, 1e9)), ""),
        sparse(truth=(np.empty((0, 2)), np.array([[1.0, 1.0]]))),
        sparse(
            tracks=(
                PlaneTrack(np.empty((0, 2)), "found", "a"),
                PlaneTrack(np.full((2, 2), np.nan), "odd", "b"),
            )
        ),
        scene(),
    ],
    ids=[
        "none",
        "no plots",
        "one plot",
        "nowhere",
        "a point",
        "far away",
        "short paths",
        "empty tracks",
        "crowd",
    ],
)
@pytest.mark.parametrize("size", [(10, 5), (28, 9), (80, 24), (33, 3), (1, 1)])
def test_odd_scenes_in_all_sizes(given_scene, size):
    async def journey(app, plane, pilot):
        for key in ("n", "t", "e", "j", "plus", "plus", "minus", "enter", "0"):
            await pilot.press(key)
            await pilot.pause()
            shown = lines(plane)
            assert len(shown) == size[1]
            assert all(line.cell_length == len(line.text) == size[0] for line in shown)

    play(given_scene, journey, size=size)


def test_resizing_draws_anew():
    async def journey(app, plane, pilot):
        for size in ((200, 60), (80, 24), (10, 5), (200, 60)):
            await pilot.resize_terminal(*size)
            await pilot.pause()
            shown = lines(plane)
            assert (len(shown), {line.cell_length for line in shown}) == (size[1], {size[0]})
            assert screen_lines(app) == [line.text for line in shown]

    play(scene(), journey, size=(120, 40))


def test_targets_outside_the_region_are_in_view_but_no_stray_plot_is():
    async def journey(app, plane, pilot):
        limits = plane.home()
        assert limits.right > 130
        assert limits.right < 1000
        assert "1 out of view" in text(plane)

    play(sparse((130.0, 50.0), (1e6, 50.0), (10.0, 10.0)), journey)


def test_the_legend_shortens_itself():
    async def journey(app, plane, pilot):
        assert "1 duplicate" in text(plane)
        await pilot.resize_terminal(40, 20)
        await pilot.pause()
        foot = lines(plane)[-1].text
        assert "duplicate" not in foot
        for mark in "·▪╌○◇×□":
            assert mark in foot

    play(scene(), journey)


def test_many_tracks_are_no_burden_to_the_eye():
    random = np.random.default_rng(5)
    tracks = tuple(PlaneTrack(random.uniform(0, 100, (3, 2)), "false", f"track {k}") for k in range(300))

    async def journey(app, plane, pilot):
        plane.choose_track(299)
        await pilot.pause()
        assert "track 299" in text(plane).rsplit("\n", 1)[0]
        assert len(plane._labels) <= 40
        rows = {}
        for label in plane._labels:
            rows.setdefault(label.row, []).append((label.column, label.column + len(label.words)))
        for spans in rows.values():
            spans.sort()
            assert all(end < begin for (_, end), (begin, _) in pairwise(spans))

    play(scene(tracks=tracks), journey)


def test_it_follows_the_theme():
    async def journey(app, plane, pilot):
        assert at(plane, 50.0, 50.0)[1].color == DARK.clutter[-1]
        dark_ground = at(plane, 50.0, 50.0)[1].bgcolor
        app.theme = "textual-light"
        await pilot.pause()
        await pilot.pause()
        assert at(plane, 50.0, 50.0)[1].color == LIGHT.clutter[-1]
        assert at(plane, 50.0, 50.0)[1].bgcolor != dark_ground
        shown = [segment for strip in app.screen._compositor.render_strips() for segment in strip]
        assert any(segment.style.color == LIGHT.clutter[-1] for segment in shown if segment.style)
        assert all(segment.style is None or segment.style.bgcolor != dark_ground for segment in shown)

    play(sparse((50.0, 50.0)), journey)


def test_on_the_linux_console_there_is_no_braille(monkeypatch):
    monkeypatch.setenv("TERM", "linux")

    async def journey(app, plane, pilot):
        shown = text(plane)
        assert not any("\u2800" <= character < "\u2900" or character in "×◇●□▪" for character in shown)
        assert any(character in shown for character in "'.:")

    play(scene(), journey)


def test_a_full_repaint_keeps_within_its_bytes():
    random = np.random.default_rng(6)
    position = random.uniform(0, 100, (5000, 2))
    full = PlaneScene(
        position,
        np.sort(random.integers(0, 15, 5000)).astype(np.int32),
        REGION,
        "km",
        random.integers(-1, 2, 5000).astype(np.int32),
        (TRUTH,),
        scene().tracks,
    )

    async def journey(app, plane, pilot):
        for given_scene, most in ((scene(), 30_000), (full, FULL_REPAINT)):
            plane.show(given_scene)
            plane.highlight(np.arange(0, 700, 30))
            await pilot.pause()
            assert sent(app.screen._compositor.render_strips()) <= most

    play(scene(), journey)
