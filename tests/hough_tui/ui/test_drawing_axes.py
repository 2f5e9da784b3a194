from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from hough_tui.ui.drawing.axes import Axis, Frame, decimals_of, figures, foot, framed, ticks
from hough_tui.ui.drawing.cells import strips
from hough_tui.ui.drawing.console import for_console
from hough_tui.ui.drawing.palette import DARK
from hough_tui.ui.drawing.viewport import Limits

ends = st.tuples(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6)).map(lambda pair: (pair[0], pair[0] + pair[1]))


@given(ends, st.integers(1, 30))
def test_ticks_are_round_even_and_inside(given_ends, most):
    low, high = given_ends
    values, step = ticks(low, high, most)
    assert len(values) <= most + 1
    mantissa = step / 10.0 ** math.floor(math.log10(step) + 1e-9)
    assert min(abs(mantissa - round_one) for round_one in (1, 2, 5, 10)) < 1e-6
    assert all(low - 2e-6 * step <= value <= high + 2e-6 * step for value in values)
    assert all(value / step == pytest.approx(round(value / step), rel=1e-12, abs=1e-6) for value in values)
    if len(values) > 1:
        np.testing.assert_allclose(np.diff(values), step, rtol=1e-5)
    # There is no finer round step that would do.
    assert step <= 2.51 * (high - low) / most


@given(ends, st.integers(1, 30))
def test_figures_of_ticks_differ_and_read_back(given_ends, most):
    values, step = ticks(*given_ends, most)
    words = figures(values, step)
    assert len(set(words)) == len(values)
    assert all(abs(float(word) - value) < 0.01 * step for word, value in zip(words, values, strict=True))
    assert not any(word.startswith("-") and not float(word) for word in words)


@pytest.mark.parametrize(
    ("most", "expected"),
    [(12, [0, 15, 30]), (6, [0, 30, 60]), (4, [0, 45, 90]), (2, [0, 90, 180]), (1, [0, 180])],
)
def test_wide_ranges_of_angles_are_parted_as_turns_are(most, expected):
    values, _ = ticks(0.0, 180.0, most, is_angle=True)
    assert values[: len(expected)] == expected


@pytest.mark.parametrize(
    ("step", "decimals"), [(2.0, 0), (0.5, 1), (0.25, 2), (0.6, 1), (1 / 3, 3), (1e-9, 6)]
)
def test_decimals_that_a_step_needs(step, decimals):
    assert decimals_of(step) == decimals


def test_figures_beyond_all_measure_stay_short():
    assert figures([1e15, 2e15], 1e15) == ["1e+15", "2e+15"]
    assert figures([2e-9], 1e-9) == ["2e-09"]


@given(st.integers(1, 250), st.integers(1, 80), ends)
def test_a_frame_fills_its_room(width, height, given_ends):
    frame = Frame.within(width, height, Axis(*given_ends))
    assert frame.gutter + frame.width == width
    assert frame.height + frame.below + frame.foot == height
    assert min(frame.width, frame.height) >= 1
    if width >= 10 and height >= 5:
        assert frame.foot == 1
        assert frame.height >= 3


@given(
    st.integers(1, 250),
    st.integers(1, 80),
    ends,
    ends,
    st.booleans(),
    st.none() | st.tuples(*[st.integers(-3, 90)] * 2),
)
def test_a_framed_picture_has_lines_of_one_length(width, height, across, up, points_down, cursor):
    axes = Axis(*across, "km"), Axis(*up, "°", is_angle=True)
    frame = Frame.within(width, height, axes[1])
    picture = [Strip([Segment("p" * frame.width)], frame.width)] * frame.height
    limits = Limits(*across, *(reversed(up) if points_down else up))
    lines = framed(picture, frame, axes, limits, DARK, cursor)
    assert len(lines) == height - frame.foot
    for line in lines:
        assert line.cell_length == len(line.text) == width
        assert all(segment.text for segment in line)


def lines_of(limits, up, cursor=None, width=60, height=20):
    axes = Axis(limits.left, limits.right, "km"), up
    frame = Frame.within(width, height, up)
    picture = [Strip([Segment(" " * frame.width)], frame.width)] * frame.height
    return frame, [line.text for line in framed(picture, frame, axes, limits, DARK, cursor)]


def test_figures_stand_beside_what_they_name():
    limits = Limits(0.0, 100.0, 0.0, 100.0)
    frame, lines = lines_of(limits, Axis(0.0, 100.0))
    assert lines[0].startswith("100┤")
    assert lines[frame.height - 1].startswith("  0┤")
    rule, below = lines[-2:]
    assert rule[: frame.gutter] == "   └"
    assert below.endswith(" km")
    for value in (0, 20, 40, 60, 80):
        column = frame.gutter + value * frame.width // 100
        assert rule[column] == "┬"
        assert str(value) in below[max(0, column - 2) : column + 3]


def test_an_axis_that_points_down_begins_above():
    _, lines = lines_of(Limits(0.0, 10.0, 180.0, 0.0), Axis(0.0, 180.0, "°", is_angle=True))
    assert lines[0].startswith("  0°┤")


def test_the_axes_point_at_the_cursor():
    frame, lines = lines_of(Limits(0.0, 10.0, 0.0, 10.0), Axis(0.0, 10.0), (3, 7))
    assert lines[3][frame.gutter - 1] == "▸"
    assert lines[-2][frame.gutter + 7] == "▴"
    assert "".join(lines).count("▸") == "".join(lines).count("▴") == 1


def test_a_single_place_has_a_single_figure():
    values, words = Axis(11.5, 12.5, only=12.0).ticks(10)
    assert (values, words) == ([12.0], ["12"])


def test_words_at_the_foot_make_room_from_the_right():
    left, right = [("left", None), (" more", Style(bold=True))], [("right", None)]
    assert foot(left, right, 20).text == "left more      right"
    assert foot(left, right, 15).text == "left more      "
    assert foot(left, right, 6).text == "left… "
    assert foot([], [], 4).text == "    "
    assert foot([], right, 5).text == "right"
    assert all(foot(left, right, width).cell_length == width for width in range(1, 30))


@given(st.integers(1, 5), st.integers(1, 12), st.randoms())
def test_neighbours_of_one_style_share_a_segment(rows, columns, random):
    styles = [None, Style(bold=True), Style(color="red")]
    codes = np.array(
        [[random.choice([ord("a"), 0x2801, ord("▀")]) for _ in range(columns)] for _ in range(rows)]
    )
    paint = np.array([[random.randrange(3) for _ in range(columns)] for _ in range(rows)])
    for row, strip in enumerate(strips(codes.astype(np.uint32), paint, styles)):
        found = [(character, segment.style) for segment in strip for character in segment.text]
        assert found == [(chr(codes[row, column]), styles[paint[row, column]]) for column in range(columns)]
        changes = np.count_nonzero(np.diff(paint[row]))
        assert len(strip._segments) == changes + 1


def test_the_linux_console_gets_characters_that_it_has():
    style = Style(bold=True)
    line = Strip([Segment("⠁⡀⣿⠀ ○×", style), Segment("▀│θ")], 10)
    (found,) = for_console([line])
    assert found.text == "'.:  ○x▀│θ"
    assert found.cell_length == 10
    assert found._segments[0].style == style
