from __future__ import annotations

import itertools
import re
import time

import numpy as np
import pytest

from hough_tui.reports.charts import TrackLine, plane_chart, rate_chart
from hough_tui.reports.dots import span, ticks
from hough_tui.reports.series import MARKERS, rate_series

ESC = "\x1b"
REGION = ((0.0, 100.0), (0.0, 100.0))


def plain(text):
    return re.sub(r"\x1b\[[0-9;]*m", "", text)


def braille_dots(text):
    return sum((ord(letter) - 0x2800).bit_count() for letter in text if "\u2800" <= letter <= "\u28ff")


def plane(x, y, scan=None, tracks=(), limits=REGION, width=80, height=24, colour=False):
    x, y = np.asarray(x, float), np.asarray(y, float)
    scan = np.zeros(len(x), np.int32) if scan is None else scan
    return plane_chart(x, y, scan, tracks, limits, "km", width, height, colour)


@pytest.mark.parametrize("metric", ["success_rate", "false_tracks_per_trial", "theta_rmse_deg"])
@pytest.mark.parametrize(("width", "height"), [(40, 12), (80, 20), (160, 50)])
def test_rate_chart_keeps_its_size_and_has_no_escapes(rows, metric, width, height):
    text = rate_chart(rows[:6], metric, width, height, colour=False)
    assert ESC not in text
    lines = text.split("\n")
    assert len(lines) <= height
    assert max(map(len, lines)) <= width
    assert "● standard" in text
    assert "○ sequential-200" in text
    assert text.count("●") == 4
    assert "scans" in text


def test_colour_changes_nothing_but_the_colour(rows):
    coloured = rate_chart(rows[:6], "success_rate", 80, 20, colour=True)
    assert ESC in coloured
    lines = [line.rstrip() for line in plain(coloured).split("\n")]
    assert lines == rate_chart(rows[:6], "success_rate", 80, 20, colour=False).split("\n")


def test_intervals_are_drawn(row):
    rows = [row(scans=scans, success_rate_ci95=[0.2, 0.99]) for scans in (5, 10)]
    text = rate_chart(rows, "success_rate", 80, 20, colour=False)
    columns = [line.index("●") for line in text.split("\n") if "●" in line]
    above_axis = [line for line in text.split("\n") if len(line) > 5]
    assert sum(line[columns[0]] == "│" for line in above_axis if len(line) > columns[0]) > 5


def test_series_of_several_scenarios_and_swept_fields(rows):
    data = rate_series(rows[6:14], "success_rate")
    assert data.swept == "scans"
    assert [series.label for series in data.series] == [
        "two-crossing, standard",
        "two-crossing, sequential-200",
        "dense-clutter-five-targets, standard",
        "dense-clutter-five-targets, sequential-200",
    ]
    assert len({series.marker for series in data.series}) == 4


def test_points_by_initiator_where_nothing_is_swept(row):
    rows = [row(name, swept={}, success=rate) for name, rate in (("one", 0.2), ("two", 0.8))]
    text = rate_chart(rows, "success_rate", 60, 16, colour=False)
    assert "● one" in text
    assert "○ two" in text
    lines = text.split("\n")[:-1]
    one, two = (next(row for row, line in enumerate(lines) if marker in line) for marker in "●○")
    assert one > two


def test_wide_sweeps_are_logarithmic(row):
    rows = [row(swept={"clutter.0.rate": 10.0**power}) for power in range(4)]
    data = rate_series(rows, "success_rate")
    assert "logarithmic" in data.swept
    assert data.series[0].x == pytest.approx((0, 1, 2, 3))
    assert data.ticks[1] == ["1", "10", "100", "1000"]


def test_rows_without_a_value_are_left_out(rows, row):
    assert "no row has a value" in rate_chart(rows[-1:], "success_rate", 80, 20, colour=False)
    assert "no row has a value" in rate_chart([], "success_rate", 80, 20, colour=False)
    bad = [
        row(scans=5),
        row(scans=10, success_rate=float("nan")),
        row(scans=15, success_rate_ci95=[None, 1.0]),
    ]
    assert rate_chart(bad, "success_rate", 80, 20, colour=False).count("●") == 2


def test_more_series_than_the_legend_has_room_for(row):
    rows = [row(f"initiator-with-a-long-name-{index}", swept={}) for index in range(len(MARKERS) + 3)]
    text = rate_chart(rows, "success_rate", 40, 16, colour=False)
    assert len(text.split("\n")) <= 16
    assert text.endswith(f"and {len(rows) - 6} more")


def test_letters_are_markers_of_a_legend_in_colour_too(row):
    # As many series as there are markers, "m" among them, with which an escape code of colour ends; and
    # names whose words end in letters that are markers.
    rows = [row(scenario="alpha em", initiator=f"gamma {index}", swept={}) for index in range(len(MARKERS))]
    text = rate_chart(rows, "success_rate", 200, 40, True)
    legend = [line for line in text.split("\n") if "gamma" in line]
    assert plain("\n".join(legend)) == "\n".join(
        line for line in rate_chart(rows, "success_rate", 200, 40, False).split("\n") if "gamma" in line
    )
    painted = re.findall(r"\x1b\[38;5;\d+m(.)\x1b\[0m", "\n".join(legend))
    assert painted == list(MARKERS)


def test_every_plot_is_a_dot():
    x, y = np.meshgrid(np.linspace(2, 98, 7), np.linspace(2, 98, 5))
    text = plane(x.ravel(), y.ravel())
    assert ESC not in text
    assert braille_dots(text) == 35
    assert "35 plots" in text


@pytest.mark.parametrize(("width", "height"), [(40, 12), (80, 24), (161, 51)])
def test_corners_lie_in_the_corners(width, height):
    text = plane([0, 100, 0, 100], [0, 0, 100, 100], width=width, height=height)
    lines = text.split("\n")
    assert len(lines) == height
    assert max(map(len, lines)) <= width
    framed = [line for line in lines if line.endswith("│")]
    for line in (framed[0], framed[-1]):
        inside = re.split("[│┤]", line)[1]
        assert braille_dots(inside[0]) == braille_dots(inside[-1]) == 1
    assert sum(map(braille_dots, framed)) == 4


def test_tracks_go_from_first_to_last_and_are_labelled():
    tracks = [TrackLine(np.array([10.0, 50.0, 90.0]), np.array([10.0, 50.0, 90.0]), "7")]
    text = plane([], [], tracks=tracks)
    assert "1 track" in text
    assert sum(letter in "▘▖▗▝▌▐▄▀▚▞▛▙▟▜█" for letter in text) > 40
    assert "7" in text.split("\n")[3] + text.split("\n")[4]


def test_what_is_not_finite_or_outside_is_counted():
    text = plane([1.0, np.nan, np.inf, 500.0], [1.0, 1.0, 1.0, 1.0])
    assert "4 plots (3 outside)" in text
    assert braille_dots(text) == 1


@pytest.mark.parametrize("limits", [None, ((5.0, 5.0), (0.0, 0.0))])
def test_planes_without_extent(limits):
    assert braille_dots(plane([5.0], [0.0], limits=limits)) == 1
    assert "0 plots" in plane([], [], limits=limits)


def test_many_plots_are_fast():
    random = np.random.default_rng(1)
    x, y = random.uniform(0, 100, (2, 100_000))
    scan = np.sort(random.integers(0, 15, 100_000)).astype(np.int32)
    tracks = [TrackLine(np.array([0.0, 1e12]), np.array([0.0, 1e12]), "far")]
    start = time.perf_counter()
    for colour in (False, True):
        plane(x, y, scan, tracks, width=160, height=50, colour=colour)
    assert time.perf_counter() - start < 2.0


def test_newer_plots_have_another_colour():
    text = plane([10.0, 90.0], [50.0, 50.0], np.array([0, 9], np.int32), colour=True)
    colours = re.findall(r"\x1b\[38;5;(\d+)m[\u2801-\u28ff]", text)
    assert len(set(colours)) == 2


def test_charts_share_no_figure(rows):
    alone = rate_chart(rows[:6], "success_rate", 80, 20, colour=False)
    plane([1.0], [1.0])
    assert rate_chart(rows[:6], "success_rate", 80, 20, colour=False) == alone


def test_ticks_are_round_and_inside():
    for low, high in itertools.product((-150.0, 0.0, 0.013), (0.02, 1.0, 97.0, 30000.0)):
        marks = ticks(low, high, 6)
        assert 1 <= len(marks) <= 7
        assert all(low - 1e-9 * abs(high) <= mark <= high + 1e-9 * high for mark in marks)


def test_span_is_never_empty():
    assert span(np.array([np.nan])) == (0.0, 1.0)
    low, high = span(np.array([7.0, 7.0]))
    assert low < 7.0 < high
