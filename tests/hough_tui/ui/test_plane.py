from __future__ import annotations

import asyncio
import io

import numpy as np
import pytest
from rich.console import Console
from textual.app import App
from textual.events import MouseScrollDown, MouseScrollUp

from algorithms.context import Box
from hough_tui.ui.drawing.palette import DARK
from hough_tui.ui.widgets.plane import Plane, PlaneScene, PlaneTrack

REGION = Box((0.0, 0.0), (100.0, 100.0))
TRUTH = np.array([[40.0, 20.0], [57.0, 30.0]])


def crowd(count=780, seed=1):
    """Return plots over 15 scans, the last of each scan that of a target on its way."""
    random = np.random.default_rng(seed)
    position, scan = (
        random.uniform(0, 100, (count, 2)),
        np.sort(random.integers(0, 15, count)).astype(np.int32),
    )
    origin = np.full(count, -1, np.int32)
    last = np.flatnonzero(np.diff(scan, append=99))
    origin[last] = 0
    position[last] = np.linspace(TRUTH[0], TRUTH[1], len(last))
    return position, scan, origin


def scene(count=780, **given):
    position, scan, origin = crowd(count)
    tracks = (
        PlaneTrack(position[origin == 0], "found", "T1"),
        PlaneTrack(np.array([[70.0, 90.0], [80.0, 80.0], [90.0, 70.0]]), "false", "F1"),
        PlaneTrack(np.array([[10.0, 90.0], [25.0, 80.0]]), "duplicate", "D1"),
        PlaneTrack(np.array([[10.0, 50.0], [25.0, 60.0]]), "unknown", "U1"),
    )
    return PlaneScene(**({
        "position": position, "scan": scan, "limits": REGION, "unit": "km",
        "origin": origin, "truth": (TRUTH,), "tracks": tracks,
    } | given))  # fmt: skip


def sparse(*points, **given):
    position = np.array(points, float).reshape(-1, 2)
    return PlaneScene(position, np.arange(len(position), dtype=np.int32), REGION, "km", **given)


class Host(App[None]):
    """An application with nothing but a plane, which takes down what it is told."""

    ENABLE_COMMAND_PALETTE = False

    def __init__(self, given_scene=None):
        super().__init__()
        self.given = given_scene
        self.told = []
        self.rendered = []

    def compose(self):
        yield Plane()

    def on_mount(self):
        plane = self.query_one(Plane)
        render = plane.render_line
        plane.render_line = lambda y: (self.rendered.append(y), render(y))[1]
        plane.focus()
        if self.given is not None:
            plane.show(self.given)

    def on_plane_plot_chosen(self, event):
        assert event.control is self.query_one(Plane)
        self.told.append(("plot", event.index))

    def on_plane_track_chosen(self, event):
        assert event.control is self.query_one(Plane)
        self.told.append(("track", event.index))


def play(given_scene, journey, size=(120, 40)):
    """Open a plane and do with it what a journey does."""

    async def work():
        app = Host(given_scene)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await journey(app, app.query_one(Plane), pilot)

    asyncio.run(work())


def lines(plane):
    return [plane.render_line(y) for y in range(plane.size.height)]


def text(plane):
    return "\n".join(line.text for line in lines(plane))


def place(plane, x, y):
    """Return the offset in the widget of the cell of a point."""
    frame, view = plane.layout_of_parts
    return frame.gutter + int(view.column(x)), int(view.row(y))


def at(plane, x, y):
    """Return character and style of the cell of a point."""
    column, row = place(plane, x, y)
    for characters, style, _ in plane.render_line(row):
        if column < len(characters):
            return characters[column], style
        column -= len(characters)
    raise AssertionError


def sent(strips):
    console = Console(color_system="256", file=io.StringIO(), force_terminal=True)
    return sum(len(strip.render(console).encode()) for strip in strips)


def screen_lines(app):
    return [strip.text for strip in app.screen._compositor.render_strips()]


@pytest.mark.parametrize(
    ("keys", "across", "down"),
    [("left h", -0.2, 0), ("right l", 0.2, 0), ("up k", 0, -0.2), ("down j", 0, 0.2)],
)
def test_arrows_and_vim_keys_pan_by_a_tenth(keys, across, down):
    async def journey(app, plane, pilot):
        await pilot.press("plus", "plus")
        view = plane.viewport
        await pilot.press(*keys.split())
        moved = view.panned(across * view.width, down * view.height).limits
        assert plane.limits == pytest.approx(moved)
        await pilot.press("0")
        assert plane.limits == plane.home()

    play(scene(), journey)


def test_panning_and_zooming_out_have_an_end():
    async def journey(app, plane, pilot):
        await pilot.press(*["minus"] * 9)
        assert plane.limits == plane.bounds()
        await pilot.press("0", *["right"] * 40)
        bounds = plane.bounds()
        assert plane.limits.right == pytest.approx(bounds.right)
        await pilot.press(*["plus"] * 60)
        assert 0 < plane.limits.right - plane.limits.left < 1e-2

    play(scene(), journey)


def test_equal_scales():
    async def journey(app, plane, pilot):
        await pilot.press("e")
        view = plane.viewport
        limits = view.limits
        assert (limits.right - limits.left) / view.width == pytest.approx(
            (limits.top - limits.bottom) / (2 * view.height), rel=0.03
        )
        assert len({line.cell_length for line in lines(plane)}) == 1
        await pilot.press("e")
        assert plane.viewport.limits == plane.home()

    play(scene(), journey)


def test_n_steps_through_the_plots_and_enter_chooses():
    async def journey(app, plane, pilot):
        await pilot.press("enter")
        assert app.told == []
        await pilot.press("n", "n")
        assert plane.cursor == 1
        await pilot.press("N", "N")
        assert plane.cursor == 2
        await pilot.press("n", "enter")
        assert app.told == [("plot", 0)]
        assert "plot 0  scan 0  x 20.0  y 20.0 km" in text(plane)

    play(sparse((20.0, 20.0), (40.0, 40.0), (60.0, 60.0)), journey)


def test_n_steps_through_lit_plots_where_there_are_any():
    points = [(10.0 * k + 5.0, 50.0) for k in range(9)]

    async def journey(app, plane, pilot):
        await pilot.press("n", "n", "n")
        plane.highlight([1, 4, 7])
        seen = []
        for key in "nnnN":
            await pilot.press(key)
            seen.append(plane.cursor)
        assert seen == [4, 7, 1, 7]

    play(sparse(*points), journey)


def test_the_plot_under_the_cursor_comes_into_view():
    async def journey(app, plane, pilot):
        await pilot.press("n")
        await pilot.press(*["plus"] * 8)
        assert plane.limits.holds(20.0, 20.0)
        await pilot.press("n")
        assert plane.limits.holds(90.0, 90.0)

    play(sparse((20.0, 20.0), (90.0, 90.0)), journey)


def test_a_click_chooses_the_nearest_plot_within_two_cells():
    async def journey(app, plane, pilot):
        column, row = place(plane, 50.0, 50.0)
        for across, down in ((0, 0), (2, 0), (0, -2), (-1, 1)):
            await pilot.click(Plane, offset=(column + across, row + down))
        assert app.told == [("plot", 1)] * 4
        assert plane.cursor == 1
        for across, down in ((4, 0), (0, 4), (3, 3)):
            await pilot.click(Plane, offset=(column + across, row + down))
        await pilot.click(Plane, offset=(0, row))
        await pilot.click(Plane, offset=(column, plane.size.height - 1))
        assert app.told == [("plot", 1)] * 4

    play(sparse((10.0, 10.0), (50.0, 50.0), (np.nan, 50.0)), journey)


def test_of_plots_in_one_place_the_newest_is_chosen():
    async def journey(app, plane, pilot):
        await pilot.click(Plane, offset=place(plane, 50.0, 50.0))
        assert app.told == [("plot", 2)]

    play(sparse((50.0, 50.0), (50.0, 50.0), (50.0, 50.0), (90.0, 90.0)), journey)


def test_tracks_are_chosen_by_key_label_and_double_click():
    async def journey(app, plane, pilot):
        await pilot.press("t", "t", "T")
        assert app.told == [("track", 0), ("track", 1), ("track", 0)]
        assert plane.track == 0
        assert "track T1  found, 15 plots" in text(plane)
        await pilot.press("T")
        assert plane.track == 3
        app.told.clear()
        row = next(index for index, line in enumerate(lines(plane)) if "F1" in line.text)
        await pilot.click(Plane, offset=(lines(plane)[row].text.index("F1"), row))
        assert app.told == [("track", 1)]
        await pilot.double_click(Plane, offset=place(plane, 10.0, 90.0))
        assert app.told[-1] == ("track", 2)

    play(scene(), journey)


def test_a_chosen_track_has_a_mark_at_every_plot():
    async def journey(app, plane, pilot):
        assert at(plane, 10.0, 90.0)[0] != "◇"
        plane.choose_track(2)
        await pilot.pause()
        assert [at(plane, *point)[0] for point in ((10.0, 90.0), (25.0, 80.0))] == ["◇", "◇"]
        assert at(plane, 10.0, 90.0)[1].color == DARK.lit
        for nothing in (None, 99, -1):
            plane.choose_track(2)
            plane.choose_track(nothing)
            assert plane.track is None
        await pilot.pause()
        assert at(plane, 10.0, 90.0)[0] != "◇"
        assert app.told == []

    play(scene(), journey)


def test_the_wheel_zooms_about_the_pointer():
    async def journey(app, plane, pilot):
        offset = place(plane, 70.0, 30.0)
        for _ in range(5):
            await pilot._post_mouse_events([MouseScrollUp], Plane, offset)
        assert plane.limits.right - plane.limits.left == pytest.approx(106 / 1.25**5)
        assert place(plane, 70.0, 30.0) == pytest.approx(offset, abs=1)
        for _ in range(5):
            await pilot._post_mouse_events([MouseScrollDown], Plane, offset)
        # Longer figures at the left may have moved the picture by a column.
        assert list(plane.limits) == pytest.approx(list(plane.home()), abs=2)

    play(scene(), journey)


def test_dragging_pans_and_chooses_nothing():
    async def journey(app, plane, pilot):
        view = plane.viewport
        await pilot.mouse_down(Plane, offset=(60, 20))
        await pilot.hover(Plane, offset=(50, 24))
        await pilot.mouse_up(Plane, offset=(50, 24))
        await pilot.pause()
        assert plane.limits == pytest.approx(view.panned(10, -4).limits)
        await pilot.hover(Plane, offset=(80, 10))
        assert plane.limits == pytest.approx(view.panned(10, -4).limits)
        assert app.told == []
        # A drag that ends where it began was still a drag.
        await pilot.press("0")
        await pilot.mouse_down(Plane, offset=(60, 20))
        await pilot.hover(Plane, offset=(50, 24))
        await pilot.hover(Plane, offset=(60, 20))
        await pilot.mouse_up(Plane, offset=(60, 20))
        assert plane.limits == pytest.approx(plane.home())

    play(scene(), journey)


def test_nothing_is_repainted_when_nothing_changed():
    given_scene = scene()

    async def journey(app, plane, pilot):
        plane.highlight([3, 4])
        plane.choose_track(1)
        await pilot.pause()
        app.rendered.clear()
        plane.show(given_scene)
        plane.highlight(np.array([4, 3]))
        plane.choose_track(1)
        await pilot.press("0")
        await pilot.hover(Plane, offset=(40, 10))
        await pilot.pause()
        assert app.rendered == []

    play(given_scene, journey)


def test_an_equal_scene_is_shown_without_a_repaint():
    async def journey(app, plane, pilot):
        plane.highlight([5])
        await pilot.pause()
        app.rendered.clear()
        plane.show(scene())
        await pilot.pause()
        assert app.rendered == []

    play(scene(), journey)


def test_a_change_repaints_the_lines_that_differ():
    async def journey(app, plane, pilot):
        app.rendered.clear()
        plane.highlight([0])
        await pilot.pause()
        assert len(app.rendered) == 1
        app.rendered.clear()
        for plot in range(50):
            plane.highlight([plot % 2])
        await pilot.pause()
        assert len(app.rendered) <= 2

    play(sparse((20.0, 20.0), (40.0, 40.0)), journey)


def test_another_draw_keeps_the_view_and_another_initiator_keeps_what_is_lit():
    async def journey(app, plane, pilot):
        await pilot.press("plus", "n")
        plane.highlight([1, 2])
        limits = plane.limits
        plane.show(scene(tracks=()))
        await pilot.pause()
        assert (plane.limits, plane.cursor, plane._lit.tolist()) == (limits, 0, [1, 2])
        other = crowd(seed=2)
        plane.show(PlaneScene(other[0], other[1], REGION, "km"))
        await pilot.pause()
        assert (plane.limits, plane.cursor, len(plane._lit)) == (limits, None, 0)
        plane.show(PlaneScene(other[0], other[1], Box((-50.0, 0.0), (50.0, 10.0)), "km"))
        await pilot.pause()
        assert plane.limits == plane.home()

    play(scene(), journey)


def test_bindings_can_be_remapped_and_explain_themselves():
    ids = [binding.id for binding in Plane.BINDINGS]
    assert len(set(ids)) == len(ids)
    assert all(binding.description and binding.id.startswith("plane.") for binding in Plane.BINDINGS)

    async def journey(app, plane, pilot):
        app.set_keymap({"plane.next-plot": "z"})
        await pilot.press("z")
        assert plane.cursor == 0

    play(scene(), journey)


def test_a_plane_that_changes_unseen_is_up_to_date_when_it_is_seen_again():
    def seen(app):
        return "\n".join(line.text for line in app.screen._compositor.render_strips())

    async def journey(app, plane, pilot):
        before = seen(app)
        plane.display = False
        await pilot.pause()
        plane.show(sparse((10.0, 10.0), (20.0, 30.0)))
        await pilot.pause()
        plane.display = True
        await pilot.pause()
        assert seen(app) != before
        assert "2 plots" in seen(app)

    play(scene(), journey)
