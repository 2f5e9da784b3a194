from __future__ import annotations

import numpy as np
import pytest

from hough_tui.ui.drawing.palette import DARK, LIGHT
from hough_tui.ui.widgets.heatmap import Heatmap
from tests.hough_tui.ui.test_heatmap import cell_of, lines, play, report, scene, screen_lines, sent, text

FULL_REPAINT = 70_000


def test_every_cell_of_the_screen_shows_the_greatest_that_it_covers():
    votes = report()

    async def journey(app, heatmap, pilot):
        frame, view = heatmap.layout_of_parts
        ceiling = votes.max()
        level = {colour: index for index, colour in enumerate(DARK.levels)}
        edges = np.linspace(0, 1000, view.width + 1), np.linspace(0, 90, 2 * view.height + 1)
        plain = 0
        for row, line in enumerate(lines(heatmap)[: view.height]):
            column = -frame.gutter
            for characters, style, _ in line:
                for character in characters:
                    if column >= 0 and character in " ▀▄█":
                        plain += 1
                        left, right = np.ceil(edges[0][column : column + 2] - 0.5).astype(int)
                        for half, has_ink in ((0, character in "▀█"), (1, character in "▄█")):
                            top, bottom = np.ceil(edges[1][2 * row + half : 2 * row + half + 2] - 0.5).astype(
                                int
                            )
                            greatest = votes[top : max(bottom, top + 1), left:right].max()
                            shown = level[style.color if has_ink else style.bgcolor]
                            assert shown == np.ceil(15 * greatest / ceiling - 1e-9)
                    column += 1
        assert plain >= view.width * view.height - 5

    play(scene(votes), journey)


def test_what_is_on_the_screen_is_what_would_be_drawn_anew():
    async def journey(app, heatmap, pilot):
        for keys in ("plus plus H K", "p p", "minus l", "0 j j j"):
            await pilot.press(*keys.split())
            await pilot.pause()
            shown = screen_lines(app)
            heatmap._draw()
            heatmap.refresh()
            await pilot.pause()
            assert screen_lines(app) == shown

    play(scene(report(), marks=[(60, 244)]), journey, size=(80, 24))


def test_a_curve_is_drawn_in_every_row_that_it_is_in():
    votes = np.zeros((40, 100), np.uint32)

    async def journey(app, heatmap, pilot):
        columns = np.linspace(-30, 130, 40).astype(int)
        columns[(columns < 0) | (columns >= 100)] = -1
        heatmap.trace(columns)
        await pilot.pause()
        frame, _ = heatmap.layout_of_parts
        shown = [line.text[frame.gutter :] for line in lines(heatmap)]
        for row in range(40):
            at = cell_of(heatmap, row, columns[row])
            has_curve = [
                column for column, character in enumerate(shown[at[1]]) if "\u2800" < character < "\u2900"
            ]
            if columns[row] < 0:
                continue
            assert at[0] - frame.gutter in has_curve
        heatmap.trace(np.zeros(7))
        await pilot.pause()
        assert not any("\u2800" < character < "\u2900" for character in text(heatmap))
        heatmap.trace(columns)
        heatmap.show(scene(votes + 1))
        await pilot.pause()
        assert not any("\u2800" < character < "\u2900" for character in text(heatmap))

    play(scene(votes), journey, size=(100, 30))


def test_tracks_and_cursor_are_marked():
    votes = np.full((90, 1000), 1, np.uint32)

    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(45, 500)
        await pilot.pause()
        shown = [line.text for line in lines(heatmap)]
        for row, column in ((10, 100), (80, 900)):
            along, down = cell_of(heatmap, row, column)
            assert shown[down][along] == "○"
        along, down = cell_of(heatmap, 45, 500)
        corners = [shown[down + dy][along + dx] for dy in (-1, 1) for dx in (-1, 1)]
        assert corners == ["┌", "┐", "└", "┘"]
        assert shown[down][heatmap.layout_of_parts[0].gutter - 1] == "▸"
        assert "".join(shown).count("▴") == 1
        await pilot.press(*["plus"] * 8)
        await pilot.pause()
        assert text(heatmap).count("○") == 0
        assert all(text(heatmap).count(corner) == 1 for corner in "┌┐┘")

    play(scene(votes, marks=[(10, 100), (80, 900), (999, 0)]), journey)


@pytest.mark.parametrize(
    "values",
    [
        np.zeros((0, 0), np.uint32),
        np.zeros((0, 5), np.uint32),
        np.zeros((1, 1), np.uint32),
        np.full((1, 1), 7, np.uint32),
        np.full((90, 1000), 3, np.uint32),
        np.zeros((90, 1000), np.uint32),
        np.full((3, 4), np.nan),
        np.array([[np.inf, -np.inf, np.nan, 1.0]]),
        np.array([[-3.0, -1.5], [-2.0, -7.25]]),
        np.array([[True, False]]),
        np.ones((1, 5000), np.uint32),
        np.ones((3000, 1), np.uint32),
    ],
    ids=str,
)
@pytest.mark.parametrize("size", [(10, 5), (28, 9), (80, 24), (33, 3), (1, 1)])
def test_odd_accumulators_in_all_sizes(values, size):
    async def journey(app, heatmap, pilot):
        heatmap.trace(np.zeros(len(values), np.int64))
        for key in ("p", "j", "L", "plus", "plus", "minus", "enter", "0"):
            await pilot.press(key)
            shown = lines(heatmap)
            assert len(shown) == size[1]
            assert all(line.cell_length == len(line.text) == size[0] for line in shown)

    play(scene(values), journey, size=size)


def test_without_a_scene_there_is_an_empty_picture():
    async def journey(app, heatmap, pilot):
        await pilot.press("p", "l", "enter", "plus")
        heatmap.move_cursor(3, 3)
        heatmap.trace(None)
        await pilot.click(Heatmap, offset=(20, 5))
        assert app.told == []
        assert all(line.cell_length == 60 for line in lines(heatmap))

    play(None, journey, size=(60, 20))


def test_resizing_draws_anew():
    async def journey(app, heatmap, pilot):
        for size in ((200, 60), (80, 24), (10, 5), (200, 60)):
            await pilot.resize_terminal(*size)
            await pilot.pause()
            shown = lines(heatmap)
            assert (len(shown), {line.cell_length for line in shown}) == (size[1], {size[0]})
            assert screen_lines(app) == [line.text for line in shown]

    play(scene(report()), journey, size=(120, 40))


def test_the_unit_is_not_taken_for_markup():
    async def journey(app, heatmap, pilot):
        assert "ρ [m]" in text(heatmap)
        assert " m  3 [b]votes" in text(heatmap)

    play(scene(np.full((5, 5), 3, np.uint32), unit="m", label="[b]votes"), journey)


def test_it_follows_the_theme():
    votes = np.zeros((10, 10), np.uint32)
    votes[0, 0] = 5

    async def journey(app, heatmap, pilot):
        def grounds():
            return {
                segment.style.bgcolor.get_truecolor()
                for strip in app.screen._compositor.render_strips()
                for segment in strip
                if segment.style is not None and segment.style.bgcolor is not None
            }

        dark, light = (palette.levels[0].get_truecolor() for palette in (DARK, LIGHT))
        assert dark in grounds()
        for theme, there, gone in (("textual-light", light, dark), ("textual-dark", dark, light)):
            app.theme = theme
            await pilot.pause()
            await pilot.pause()
            assert there in grounds()
            assert gone not in grounds()

    play(scene(votes), journey)


def test_without_any_colour_characters_tell_the_levels(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    votes = np.zeros((4, 4), np.uint32)
    votes[0, 0], votes[3, 3] = 15, 5

    async def journey(app, heatmap, pilot):
        app.theme = "ansi-dark"
        await pilot.pause()
        await pilot.pause()
        shown = text(heatmap)
        assert shown.startswith("  0°┤@@@@")
        assert shown.splitlines()[7].endswith("-" * 9)
        assert "▀" not in shown

    play(scene(votes), journey, size=(40, 12))


def test_no_color_leaves_sixteen_greys(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")

    async def journey(app, heatmap, pilot):
        colours = {
            colour.get_truecolor()
            for strip in app.screen._compositor.render_strips()
            for segment in strip
            if segment.style is not None
            for colour in (segment.style.color, segment.style.bgcolor)
            if colour is not None
        }
        assert all(red == green == blue for red, green, blue in colours)
        assert len(colours) >= 16

    play(scene(np.arange(16, dtype=np.uint32).reshape(4, 4)), journey, size=(60, 20))


@pytest.mark.parametrize(
    "values",
    [
        report(),
        report(5000),
        np.random.default_rng(1).random((90, 120)),
        np.random.default_rng(2).random((90, 1000)),
    ],
    ids=["report", "many plots", "noise", "much noise"],
)
def test_a_full_repaint_keeps_within_its_bytes(values):
    async def journey(app, heatmap, pilot):
        heatmap.trace(np.arange(90) * values.shape[1] // 90)
        for keys in ("0", "plus plus", "plus plus plus plus"):
            await pilot.press(*keys.split())
            await pilot.pause()
            assert sent(app.screen._compositor.render_strips()) <= FULL_REPAINT

    play(scene(values), journey, size=(120, 40))
