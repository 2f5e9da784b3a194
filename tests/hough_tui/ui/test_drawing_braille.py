from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from rich.style import Style

from hough_tui.ui.drawing.braille import Canvas
from hough_tui.ui.drawing.viewport import Limits, Viewport

STYLES = [None, *(Style(color=f"color({20 + layer})") for layer in range(1, 9))]

BIT = {
    (0, 0): 0x01,
    (0, 1): 0x02,
    (0, 2): 0x04,
    (1, 0): 0x08,
    (1, 1): 0x10,
    (1, 2): 0x20,
    (0, 3): 0x40,
    (1, 3): 0x80,
}
"""Bit of the dot in a column and a row of a cell, as Unicode numbers them."""


def view(width=6, height=4):
    """Return a viewport in which a dot is one unit, y pointing down."""
    return Viewport(Limits(0.0, 2.0 * width, 4.0 * height, 0.0), width, height)


def cells(canvas, styles=STYLES):
    """Return character and style of every cell."""
    found = {}
    for row, strip in enumerate(canvas.strips(styles)):
        assert strip.cell_length == canvas.viewport.width
        column = 0
        for text, style, _ in strip:
            for character in text:
                found[row, column] = character, style
                column += 1
        assert column == canvas.viewport.width
    return found


def slow(points, width, height):
    """Return the characters and layers of points, one after the other."""
    bits, top = {}, {}
    for x, y, layer in points:
        if not (math.isfinite(x) and math.isfinite(y) and 0 <= x < 2 * width and 0 <= y < 4 * height):
            continue
        cell = int(y) // 4, int(x) // 2
        bits[cell] = bits.get(cell, 0) | BIT[int(x) % 2, int(y) % 4]
        top[cell] = max(top.get(cell, 0), layer)
    return bits, top


# Never on an edge between dots, where rounding decides.
off_edges = st.integers(-120, 160).map(lambda quarters: quarters / 4 + 0.1)
places = off_edges | st.sampled_from([0.0, math.nan, math.inf, -math.inf, 1e300])


@given(
    st.lists(st.tuples(places, places, st.integers(1, 8)), max_size=40), st.integers(1, 8), st.integers(1, 5)
)
def test_points_are_the_dots_of_a_slow_loop(points, width, height):
    canvas = Canvas(view(width, height))
    given_points = np.array([(x, y) for x, y, _ in points]).reshape(-1, 2)
    canvas.points(given_points, np.array([layer for *_, layer in points], int))
    bits, top = slow(points, width, height)
    for cell, (character, style) in cells(canvas).items():
        assert character == (chr(0x2800 + bits[cell]) if cell in bits else " ")
        if cell in bits:
            assert style == STYLES[top[cell]]


def test_a_point_may_be_a_square_of_dots():
    canvas = Canvas(view(2, 1))
    canvas.points(np.array([[1.2, 2.9]]), 1, size=2)
    assert canvas.strips(STYLES)[0].text == chr(0x2800 + 0x20 + 0x80) + chr(0x2800 + 0x04 + 0x40)


paths = st.lists(arrays(np.float64, st.tuples(st.integers(0, 6), st.just(2)), elements=off_edges), max_size=4)


def dots(canvas):
    """Return the dots that are set, as column and row."""
    found = set()
    for (row, column), (character, _) in cells(canvas).items():
        bits = ord(character) - 0x2800 if character != " " else 0
        found |= {(2 * column + x, 4 * row + y) for (x, y), bit in BIT.items() if bits & bit}
    return found


def floors(places):
    """Return the dots that places lie in."""
    return set(map(tuple, np.unique(np.floor(places).astype(int), axis=0).tolist()))


@given(paths)
@example([np.array([[39.6, 40.1], [-23.9, -0.15]])])
def test_lines_are_connected_and_lie_on_their_ways(given_paths):
    canvas = Canvas(view(6, 4))
    canvas.lines(given_paths, [1] * len(given_paths))
    drawn = dots(canvas)
    near, must = set(), set()
    for path in given_paths:
        for start, end in itertools.pairwise(path):
            # Closer to one another than the reach of what counts as near: no corner is missed between two.
            share = np.linspace(0, 1, 1 + int(np.abs(end - start).max() / 1.5e-2))[:, None]
            way = start + share * (end - start)
            must |= floors(way[((way >= 0) & (way < (12, 16))).all(axis=1)])
            near |= set().union(*(floors(way + by) for by in itertools.product((-1e-2, 1e-2), repeat=2)))
    assert drawn <= near
    # Every dot that the way goes through is drawn, or a neighbour in its place.
    for x, y in must:
        assert any((x + dx, y + dy) in drawn for dx in (-1, 0, 1) for dy in (-1, 0, 1))


@given(arrays(np.float64, (2, 2), elements=st.integers(0, 47).map(lambda quarters: quarters / 4 + 0.05)))
def test_a_line_has_a_dot_in_every_step_of_its_longer_side(ends):
    canvas = Canvas(view(6, 3))
    canvas.lines([ends], [1])
    found = dots(canvas)
    for axis in (0, 1):
        steps = {dot[axis] for dot in found}
        reach = range(int(ends[:, axis].min()), int(ends[:, axis].max()) + 1)
        assert steps <= set(reach)
        if np.ptp(ends[:, axis]) == np.ptp(ends, axis=0).max():
            assert steps == set(reach)
    assert tuple(ends[0].astype(int)) in found
    assert tuple(ends[1].astype(int)) in found


@pytest.mark.parametrize("far", [1e3, 1e8, 1e11])
def test_a_line_from_far_outside_crosses_the_picture(far):
    canvas = Canvas(view(6, 4))
    canvas.lines([np.array([[-far, 5.5], [far, 5.5]]), np.array([[3.5, far], [3.5, -far]])], [1, 2])
    assert dots(canvas) == {(x, 5) for x in range(12)} | {(3, y) for y in range(16)}


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e300])
def test_a_line_is_left_out_where_an_end_is_nowhere(bad):
    canvas = Canvas(view(6, 4))
    canvas.lines([np.array([[0.5, 0.5], [3.5, 0.5], [bad, 0.5], [8.5, 0.5], [11.5, 0.5]])], [1])
    assert dots(canvas) == {(x, 0) for x in (0, 1, 2, 3, 8, 9, 10, 11)}


def test_dashes_go_on_around_corners():
    path = np.array([[0.5, 0.5], [20.5, 0.5], [20.5, 22.5], [41.5, 22.5]])
    dashed, solid = Canvas(view(22, 6)), Canvas(view(22, 6))
    dashed.lines([path], [1], dash=3)
    solid.lines([path], [1])
    way = [*((x, 0) for x in range(20)), *((20, y) for y in range(22)), *((x, 22) for x in range(20, 42))]
    assert dots(solid) == set(way)
    assert dots(dashed) < set(way)
    runs = "".join("#" if dot in dots(dashed) else " " for dot in way)
    assert {len(run) for run in runs.split()[:-1]} <= {2, 3, 4}
    assert {len(gap) for gap in runs.strip().replace("#", "|").split("|") if gap} <= {2, 3, 4}
    assert len(runs.split()) == 11


def test_no_lines_at_all():
    canvas = Canvas(view())
    canvas.lines([], [])
    canvas.lines([np.empty((0, 2)), np.array([[1.0, 1.0]])], [1, 1])
    assert {character for character, _ in cells(canvas).values()} == {" "}


def test_the_highest_layer_colours_a_cell_and_a_mark_takes_it():
    canvas = Canvas(view(3, 1))
    canvas.points(np.array([[0.5, 0.5], [1.5, 0.5], [2.5, 0.5], [4.5, 0.5]]), np.array([3, 2, 1, 8]))
    canvas.marks(np.array([[2.5, 3.5]]), "a", 4)
    canvas.marks(np.array([[3.5, 1.5]]), "b", 6)
    canvas.marks(np.array([[3.5, 1.5]]), "c", 5)
    canvas.marks(np.array([[4.5, 0.5], [99.0, 0.0], [math.nan, 0.0]]), "d", np.array([7, 1, 1]))
    found = cells(canvas)
    assert found[0, 0] == (chr(0x2809), STYLES[3])
    assert found[0, 1] == ("b", STYLES[6])
    assert found[0, 2] == ("d", STYLES[7])


def test_text_is_cut_at_the_edges():
    canvas = Canvas(view(5, 2))
    canvas.write(0, 3, "abc", 1)
    canvas.write(1, -1, "abc", 1)
    canvas.write(2, 0, "abc", 1)
    canvas.write(-1, 0, "abc", 1)
    assert [strip.text for strip in canvas.strips(STYLES)] == ["   ab", "bc   "]
    assert canvas.is_free(0, 0, 3)
    assert not canvas.is_free(0, 0, 4)
    assert not canvas.is_free(1, 3, 3)
    assert not canvas.is_free(2, 0, 1)


def test_blanks_take_no_colour_of_their_own():
    canvas = Canvas(view(6, 1))
    canvas.points(np.array([[2.5, 0.5], [6.5, 0.5], [10.5, 0.5]]), np.array([1, 1, 2]))
    (strip,) = canvas.strips(STYLES)
    assert [(segment.text, segment.style) for segment in strip] == [
        (" ", None),
        ("⠁ ⠁ ", STYLES[1]),
        ("⠁", STYLES[2]),
    ]


def test_a_ground_does_not_spread_over_blanks():
    canvas = Canvas(view(4, 1))
    canvas.marks(np.array([[2.5, 0.5]]), "x", 1)
    for style in (Style(reverse=True), Style(bgcolor="red")):
        (strip,) = canvas.strips([None, style])
        assert [(segment.text, segment.style) for segment in strip] == [
            (" ", None),
            ("x", style),
            ("  ", None),
        ]


def test_north_is_up():
    canvas = Canvas(Viewport(Limits(0.0, 4.0, 0.0, 4.0), 2, 2))
    canvas.marks(np.array([[0.5, 3.5], [3.5, 0.5]]), "x", 1)
    assert [strip.text for strip in canvas.strips(STYLES)] == ["x ", " x"]
