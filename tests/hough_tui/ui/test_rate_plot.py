"""Charts of rates and of ratios by trial."""

import asyncio
import time
from types import SimpleNamespace

import numpy as np
import plotext
import pytest
from textual.app import App
from textual.widgets import Select

from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.reports.charts import ESCAPES
from hough_tui.ui.runs.shown_run import LiveRun
from hough_tui.ui.screens.relayout_workaround import AttentiveScreen
from hough_tui.ui.widgets.chart_pane import BY_TRIAL, ChartPane
from hough_tui.ui.widgets.rate_plot import RatePlot
from hough_tui.ui.widgets.trial_chart import trial_chart
from scenarios.files.set_files import load_set


@pytest.fixture(scope="module")
def live():
    job = Job(plan_run([load_set("course-report")], trials=40), 2)
    assert job.wait()
    live = LiveRun(job)
    live.rows = live.snapshot()
    return live


def mounted(widget, journey, size=(100, 30)):
    class Host(App[None]):
        def get_default_screen(self):
            return AttentiveScreen()

        def compose(self):
            yield widget

    async def work():
        app = Host()
        async with app.run_test(size=size) as pilot:

            async def until(condition):
                limit = time.monotonic() + 60
                while not condition():
                    assert time.monotonic() < limit
                    await pilot.pause(0.01)

            await pilot.pause()
            await journey(SimpleNamespace(app=app, pilot=pilot, until=until))

    asyncio.run(work())


def text(widget):
    return "\n".join(line.text for line in widget.query_one(RatePlot)._drawn)


def plain(chart):
    return ESCAPES.sub("", chart)


@pytest.mark.parametrize("count", [1, 2, 30, 5000])
def test_ratios_by_trial_fill_the_room_and_no_more(count):
    ratio = np.random.default_rng(2).random(count)
    lines = plain(trial_chart("a row", np.arange(count), ratio, 80, 20)).split("\n")
    assert len(lines) == 20
    assert max(map(len, lines)) <= 80
    assert f"in the end {100 * ratio.mean():.1f}" in lines[0]
    assert ("drawn" in lines[0]) == (count == 5000)
    assert "trial" in lines[-1]


def test_a_ratio_that_never_changes_is_drawn():
    for value in (0.0, 1.0, 0.5):
        assert "━" in plain(trial_chart("a row", np.arange(9), np.full(9, value), 60, 15)).split("\n", 1)[1]


def test_trials_of_a_part_stand_at_their_numbers():
    numbers = np.concatenate([np.arange(100), np.arange(900, 1000)])
    chart = plain(trial_chart("a row", numbers, np.full(200, 0.4), 80, 16)).split("\n")
    assert "800" in chart[-2]
    (line,) = [line for line in chart[1:] if "━" in line]
    assert "━" not in line[25:60]


def test_charts_of_a_run_follow_metric_and_row(live):
    pane = ChartPane()

    async def journey(user):
        pane.fill(live, live.rows, 0)
        await user.until(lambda: "success %" in text(pane) and "sequential" in text(pane))
        pane.next_metric(1)
        await user.until(lambda: "control %" in text(pane))
        pane.query_one(Select).value = "tracks_per_trial"
        await user.until(lambda: "tracks a trial" in text(pane))
        pane.turn_to(12)  # the experiment of the modified transform
        await user.until(lambda: "detection_probability" in text(pane))
        pane.turn_by_trial()
        assert pane.metric == BY_TRIAL
        await user.until(lambda: "modified · detection_probability 1" in text(pane))
        pane.turn_to(1)
        await user.until(lambda: "standard · scans 10" in text(pane))
        pane.turn_by_trial()
        await user.until(lambda: "tracks a trial" in text(pane))
        pane.fill(None, (), None)
        await user.until(lambda: not text(pane))

    mounted(pane, journey)


def test_a_chart_fits_the_room_that_it_has(live):
    pane = ChartPane()

    async def journey(user):
        pane.fill(live, live.rows, 0)
        for width, height in ((100, 30), (60, 16)):
            await user.pilot.resize_terminal(width, height)
            plot = pane.query_one(RatePlot)
            await user.until(
                lambda plot=plot: (
                    plot._drawn
                    and max(line.cell_length for line in plot._drawn) <= plot.content_size.width
                    and len(plot._drawn) == plot.content_size.height
                )
            )

    mounted(pane, journey)


def test_a_chart_that_cannot_be_drawn_says_why():
    plot = RatePlot()

    def broken(width, height):
        raise ValueError("no such chart")

    async def journey(user):
        plot.show(broken)
        await user.until(lambda: any("no such chart" in line.text for line in plot._drawn))

    mounted(plot, journey)


def test_only_the_last_of_many_charts_is_waited_for():
    plot, drawn = RatePlot(), []

    def drawing(name):
        def draw(width, height):
            drawn.append(name)
            time.sleep(0.02)
            return name

        return draw

    async def journey(user):
        for index in range(50):
            plot.show(drawing(f"chart {index}"))
        await user.until(lambda: plot._drawn and plot._drawn[0].text == "chart 49")
        assert len(drawn) <= 3

    mounted(plot, journey)


def test_the_global_figure_of_plotext_stays_untouched():
    plotext.clear_figure()
    plotext.scatter([1, 2], [3, 4])
    before = plotext.build()
    trial_chart("a row", np.arange(9), np.full(9, 0.5), 60, 15)
    assert plotext.build() == before
    plotext.clear_figure()


def test_a_chart_that_changes_unseen_is_up_to_date_when_it_is_seen_again(live):
    pane = ChartPane()

    def seen(user):
        return "\n".join(line.text for line in user.app.screen._compositor.render_strips())

    async def journey(user):
        pane.fill(live, live.rows, 0)
        await user.until(lambda: "success %" in seen(user))
        for turn, wanted in ((1, "control %"), (-1, "success %")):
            pane.display = False
            await user.pilot.pause()
            pane.next_metric(turn)
            await user.pilot.pause(0.05)
            pane.display = True
            await user.until(lambda wanted=wanted: wanted in seen(user).splitlines()[1])

    mounted(pane, journey)


def test_what_is_drawn_already_is_not_drawn_again():
    plot, drawn = RatePlot(), []

    async def journey(user):
        plot.show(lambda width, height: drawn.append((width, height)) or "chart")
        await user.until(lambda: drawn and not plot._is_busy)
        plot.on_resize()
        await user.pilot.pause(0.05)
        assert len(drawn) == 1

    mounted(plot, journey)
