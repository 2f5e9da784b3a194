from __future__ import annotations

import asyncio
import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from rich.console import Console
from textual.app import App
from textual.containers import Container
from textual.widgets import ContentSwitcher

from algorithms.hough.grid import Grid
from algorithms.hough.voting import accumulate
from hough_tui.ui.widgets.heatmap import Heatmap, HeatmapScene


def scene(values, rho_min=-150.0, rho_step=0.6, marks=(), unit="km", label="votes"):
    rows, columns = values.shape
    theta = (np.arange(rows) + 0.5) * 180.0 / rows
    rho = rho_min + (np.arange(columns) + 0.5) * rho_step
    return HeatmapScene(values, theta, rho, unit, label, tuple(marks))


def report(plots=760):
    """Return an accumulator as that of the course report, with one line in it."""
    random = np.random.default_rng(3)
    line = np.column_stack([np.linspace(40, 57, 15), np.linspace(20, 30, 15)])
    position = np.concatenate([random.uniform(0, 100, (plots, 2)), line])
    return accumulate(position, Grid(90, 1000, -150.0, 0.6)).votes


class Host(App[None]):
    """An application with nothing but a heat-map, which takes down what it is told."""

    ENABLE_COMMAND_PALETTE = False

    def __init__(self, given_scene=None):
        super().__init__()
        self.given = given_scene
        self.told = []
        self.rendered = []

    def compose(self):
        yield Heatmap()

    def on_mount(self):
        heatmap = self.query_one(Heatmap)
        render = heatmap.render_line
        heatmap.render_line = lambda y: (self.rendered.append(y), render(y))[1]
        heatmap.focus()
        if self.given is not None:
            heatmap.show(self.given)

    def on_heatmap_cell_highlighted(self, event):
        assert event.control is self.query_one(Heatmap)
        self.told.append(("highlighted", event.row, event.column))

    def on_heatmap_cell_chosen(self, event):
        assert event.control is self.query_one(Heatmap)
        self.told.append(("chosen", event.row, event.column))


def play(given_scene, journey, size=(120, 40)):
    """Open a heat-map and do with it what a journey does."""

    async def work():
        app = Host(given_scene)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await journey(app, app.query_one(Heatmap), pilot)

    asyncio.run(work())


def lines(heatmap):
    return [heatmap.render_line(y) for y in range(heatmap.size.height)]


def text(heatmap):
    return "\n".join(line.text for line in lines(heatmap))


def sent(strips):
    console = Console(color_system="256", file=io.StringIO(), force_terminal=True)
    return sum(len(strip.render(console).encode()) for strip in strips)


def cell_of(heatmap, row, column):
    """Return the offset in the widget of the middle of an accumulator cell."""
    frame, view = heatmap.layout_of_parts
    return frame.gutter + int(view.column(column + 0.5)), int(view.row(row + 0.5))


def test_the_cursor_begins_at_the_strongest_cell_and_reads_it_out():
    votes = np.zeros((90, 1000), np.uint32)
    votes[60, 244] = 15

    async def journey(app, heatmap, pilot):
        assert heatmap.cursor == (60, 244)
        assert app.told == [("highlighted", 60, 244)]
        foot = lines(heatmap)[-1].text
        assert foot.startswith("θ 121°  ρ -3.3 km  15 votes")
        assert foot.rstrip().endswith("15")
        assert "ρ [km]" in text(heatmap)

    play(scene(votes), journey)


@pytest.mark.parametrize(
    ("keys", "row", "column"),
    [
        ("left h", 60, 498), ("right l", 60, 502), ("up k", 58, 500), ("down j", 62, 500),
        ("shift+left H", 60, 480), ("shift+right L", 60, 520),
        ("shift+up K", 40, 500), ("shift+down J", 80, 500),
    ],
)  # fmt: skip
def test_arrows_and_vim_keys_move_the_cursor(keys, row, column):
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(60, 500)
        await pilot.pause()
        app.told.clear()
        await pilot.press(*keys.split())
        assert heatmap.cursor == (row, column)
        assert [told[0] for told in app.told] == ["highlighted"] * 2
        assert app.told[-1] == ("highlighted", row, column)

    play(scene(report()), journey)


def test_the_cursor_stays_on_the_accumulator():
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(-5, 99)
        assert heatmap.cursor == (0, 6)
        await pilot.press("up", "right", "K", "L")
        assert heatmap.cursor == (0, 6)
        assert app.told[1:] == [("highlighted", 0, 6)]

    play(scene(np.eye(5, 7, dtype=np.uint32)), journey)


def test_peaks_are_visited_the_strongest_first_and_around():
    votes = np.zeros((20, 60), np.uint32)
    for votes_there, cell in ((9, (3, 40)), (7, (15, 5)), (7, (15, 30)), (2, (19, 59))):
        votes[cell] = votes_there
    votes[3, 41] = 8

    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(10, 10)
        seen = []
        for key in "pppppPP":
            await pilot.press(key)
            seen.append(heatmap.cursor)
        assert seen == [(3, 40), (15, 5), (15, 30), (19, 59), (3, 40), (19, 59), (15, 30)]

    play(scene(votes), journey)


@given(arrays(np.uint32, st.tuples(st.integers(1, 8), st.integers(1, 8)), elements=st.integers(0, 4)))
def test_peaks_are_the_local_maxima(votes):
    expected = []
    for row, column in np.ndindex(*votes.shape):
        value = votes[row, column]
        around = [
            (other, beside)
            for other in range(max(0, row - 1), min(votes.shape[0], row + 2))
            for beside in range(max(0, column - 1), min(votes.shape[1], column + 2))
            if (other, beside) != (row, column)
        ]
        earlier = [cell for cell in around if cell < (row, column)]
        later = [cell for cell in around if cell > (row, column)]
        if (
            value
            and all(votes[cell] < value for cell in earlier)
            and all(votes[cell] <= value for cell in later)
        ):
            expected.append((-int(value), row, column))
    found = scene(votes).peaks.tolist()
    assert found == [[row, column] for _, row, column in sorted(expected)]
    if votes.any():
        assert tuple(found[0]) == scene(votes).strongest


def test_enter_and_a_double_click_choose():
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(10, 20)
        await pilot.pause()
        app.told.clear()
        await pilot.press("enter")
        assert app.told == [("chosen", 10, 20)]
        await pilot.double_click(Heatmap, offset=cell_of(heatmap, 30, 700))
        assert app.told[-1][0] == "chosen"
        assert app.told[-1][1:] == heatmap.cursor

    play(scene(report()), journey)


def test_a_click_goes_to_what_shines_there():
    votes = np.zeros((90, 1000), np.uint32)
    votes[45, 503] = 9

    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(0, 0)
        await pilot.pause()
        await pilot.click(Heatmap, offset=cell_of(heatmap, 45, 503))
        assert heatmap.cursor == (45, 503)
        assert app.told[-1] == ("highlighted", 45, 503)
        before = heatmap.cursor
        # On the figures there is nothing to click.
        await pilot.click(Heatmap, offset=(0, 5))
        await pilot.click(Heatmap, offset=(20, heatmap.size.height - 1))
        assert heatmap.cursor == before

    play(scene(votes), journey)


def test_zooming_by_key_keeps_the_cursor_in_view():
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(2, 990)
        for _ in range(12):
            await pilot.press("plus")
            limits = heatmap.limits
            assert limits.holds(990.5, 2.5)
        assert (limits.right - limits.left, limits.bottom - limits.top) == pytest.approx((8, 4))
        await pilot.press("H", "H", "J")
        assert heatmap.limits.holds(970.5, 12.5)
        assert heatmap.limits.right - heatmap.limits.left == pytest.approx(8)
        await pilot.press("0")
        assert heatmap.limits == heatmap.home()
        await pilot.press("equals_sign", "minus", "minus")
        assert heatmap.limits == heatmap.home()

    play(scene(report()), journey)


def test_f_fits_the_view_to_the_votes():
    votes = np.zeros((90, 1000), np.uint32)
    votes[10, 300], votes[80, 399] = 1, 2

    async def journey(app, heatmap, pilot):
        await pilot.press("f")
        assert heatmap.limits.right - heatmap.limits.left < 106
        assert heatmap.limits.holds(300.0, 10.0)
        assert heatmap.limits.holds(400.0, 80.0)
        assert (heatmap.limits.top, heatmap.limits.bottom) == (0.0, 90.0)
        heatmap.show(scene(np.zeros((90, 1000), np.uint32)))
        await pilot.press("f")
        assert heatmap.limits == heatmap.home()

    play(scene(votes), journey)


async def wheel(pilot, offset, times, up=True):
    from textual.events import MouseScrollDown, MouseScrollUp

    for _ in range(times):
        await pilot._post_mouse_events([MouseScrollUp if up else MouseScrollDown], Heatmap, offset)


def test_the_wheel_zooms_about_the_pointer():
    async def journey(app, heatmap, pilot):
        offset = cell_of(heatmap, 30, 700)
        await wheel(pilot, offset, 4)
        limits = heatmap.limits
        assert limits.right - limits.left == pytest.approx(1000 / 1.25**4)
        assert cell_of(heatmap, 30, 700) == pytest.approx(offset, abs=1)
        await wheel(pilot, offset, 4, up=False)
        assert heatmap.limits == heatmap.home()
        assert heatmap.cursor == scene(report()).strongest

    play(scene(report()), journey)


def test_dragging_pans_and_chooses_nothing():
    async def journey(app, heatmap, pilot):
        await wheel(pilot, (60, 20), 6)
        app.told.clear()
        before, view = heatmap.limits, heatmap.viewport
        await pilot.mouse_down(Heatmap, offset=(60, 20))
        await pilot.hover(Heatmap, offset=(50, 24))
        await pilot.mouse_up(Heatmap, offset=(50, 24))
        await pilot.pause()
        moved = view.panned(10, -4).limits
        assert heatmap.limits == pytest.approx(moved)
        assert before != heatmap.limits
        # The pointer no longer holds it.
        await pilot.hover(Heatmap, offset=(80, 10))
        assert heatmap.limits == pytest.approx(moved)
        assert app.told == []

    play(scene(report()), journey)


def test_hovering_does_nothing():
    async def journey(app, heatmap, pilot):
        app.rendered.clear()
        app.told.clear()
        for offset in ((30, 10), (60, 20)):
            await pilot.hover(Heatmap, offset=offset)
        assert app.rendered == []
        assert app.told == []

    play(scene(report()), journey)


def test_nothing_is_repainted_when_nothing_changed():
    votes = report()
    given_scene = scene(votes)

    async def journey(app, heatmap, pilot):
        curve = np.full(90, 300)
        heatmap.trace(curve)
        await pilot.pause()
        app.rendered.clear()
        app.told.clear()
        heatmap.show(given_scene)
        heatmap.move_cursor(*heatmap.cursor)
        heatmap.trace(curve.copy())
        await pilot.press("0", "minus")
        await pilot.pause()
        assert app.rendered == []
        assert app.told == []

    play(given_scene, journey)


def test_an_equal_scene_is_shown_without_a_repaint():
    async def journey(app, heatmap, pilot):
        app.rendered.clear()
        heatmap.show(scene(report()))
        await pilot.pause()
        assert app.rendered == []

    play(scene(report()), journey)


def test_a_step_of_the_cursor_repaints_few_lines():
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(45, 500)
        await pilot.pause()
        app.rendered.clear()
        await pilot.press("l")
        await pilot.pause()
        assert 1 <= len(app.rendered) <= 8
        assert heatmap.size.height - 1 in app.rendered

    play(scene(report()), journey)


def test_many_changes_at_once_are_drawn_once():
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(45, 500)
        await pilot.pause()
        app.rendered.clear()
        for column in range(501, 900):
            heatmap.move_cursor(45, column)
        await pilot.pause()
        assert len(app.rendered) <= heatmap.size.height

    play(scene(report()), journey)


def screen_lines(app):
    return [strip.text for strip in app.screen._compositor.render_strips()]


def test_what_changes_while_it_is_hidden_is_seen_when_it_comes_back():
    class Pages(App[None]):
        # A chart that loses the focus as it is hidden would be painted anew for that alone.
        AUTO_FOCUS = None

        def compose(self):
            with ContentSwitcher(initial="shown"):
                with Container(id="shown"):
                    yield Heatmap()
                yield Container(id="other")

    async def work():
        app = Pages()
        async with app.run_test(size=(120, 40)) as pilot:
            heatmap, pages = app.query_one(Heatmap), app.query_one(ContentSwitcher)
            heatmap.show(scene(report()))
            await pilot.pause()
            before = screen_lines(app)
            pages.current = "other"
            await pilot.pause()
            heatmap.show(scene(report(40)))
            await pilot.pause()
            pages.current = "shown"
            await pilot.pause()
            after = screen_lines(app)
            assert after != before
            heatmap.move_cursor(3, 700)
            await pilot.pause()
            assert screen_lines(app) != after

    asyncio.run(work())


def test_another_quantisation_keeps_the_view_and_the_cursor_where_they_are():
    async def journey(app, heatmap, pilot):
        heatmap.move_cursor(60, 244)
        await pilot.press("plus", "plus", "plus")
        before = heatmap.limits
        app.told.clear()
        finer = scene(np.ones((180, 2000), np.uint32), rho_step=0.3)
        heatmap.show(finer)
        await pilot.pause()
        assert heatmap.cursor in {(row, column) for row in (120, 121) for column in (488, 489)}
        assert heatmap.limits == pytest.approx([2 * end for end in before])
        assert app.told == [("highlighted", *heatmap.cursor)]
        # There the old view lies outside.
        heatmap.show(scene(np.ones((10, 20), np.uint32), rho_min=500.0, rho_step=10.0))
        await pilot.pause()
        assert heatmap.cursor == (6, 0)
        assert 0 <= heatmap.limits.left < heatmap.limits.right <= 20

    play(scene(report()), journey)


def test_bindings_can_be_remapped_and_explain_themselves():
    ids = [binding.id for binding in Heatmap.BINDINGS]
    assert len(set(ids)) == len(ids)
    assert all(binding.description and binding.id.startswith("heatmap.") for binding in Heatmap.BINDINGS)

    async def journey(app, heatmap, pilot):
        app.set_keymap({"heatmap.next-peak": "z"})
        heatmap.move_cursor(0, 0)
        await pilot.press("z")
        assert heatmap.cursor == scene(report()).strongest

    play(scene(report()), journey)
