from __future__ import annotations

import io
import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from rich.console import Console

from algorithms.hough.grid import Grid
from algorithms.hough.voting import accumulate
from hough_tui.ui.drawing.halfblock import (
    FLATTENINGS,
    SEGMENTS_PER_CELL,
    Overlay,
    flattened,
    inks,
    picture,
    shaded,
)
from hough_tui.ui.drawing.palette import BLACK, DARK, LEVELS, LIGHT, WHITE
from hough_tui.ui.drawing.sampling import Sampling, levels, pooled, samplings
from hough_tui.ui.drawing.viewport import Limits, Viewport

FULL_REPAINT = 70_000
"""Bytes that 120 × 40 cells may take."""


def whole(values, width, height):
    """Return a viewport with all of an array in view, the first row above."""
    rows, columns = values.shape
    return Viewport(Limits(0.0, columns, rows, 0.0), width, height)


def sent(strips):
    """Return the bytes that go to a terminal with 256 colours."""
    console = Console(color_system="256", file=io.StringIO(), force_terminal=True)
    return sum(len(strip.render(console).encode()) for strip in strips)


def slow_pooled(values, viewport):
    """Return what each picture element shows, element by element."""
    limits = viewport.limits
    row_edges = np.linspace(limits.top, limits.bottom, 2 * viewport.height + 1)
    column_edges = np.linspace(limits.left, limits.right, viewport.width + 1)

    def inside(start, end, size):
        found = [index for index in range(size) if start <= index + 0.5 < end]
        return found or [min(max(int(np.floor(0.5 * (start + end))), 0), size - 1)]

    return np.array(
        [
            [
                max(
                    values[row, column]
                    for row in inside(top, bottom, values.shape[0])
                    for column in inside(left, right, values.shape[1])
                )
                for left, right in itertools.pairwise(column_edges)
            ]
            for top, bottom in itertools.pairwise(row_edges)
        ]
    )


@st.composite
def views(draw, most=25):
    """Return an array and a view of a part of it."""
    shape = draw(st.tuples(st.integers(1, most), st.integers(1, most)))
    values = draw(arrays(np.int64, shape, elements=st.integers(0, 50)))
    ends = []
    for size in shape:
        # Eighths are exact, so that whether a middle lies on an edge is no matter of rounding.
        start = draw(st.integers(0, 8 * size - 1))
        ends.append((start / 8, draw(st.integers(start + 1, 8 * size)) / 8))
    (top, bottom), (left, right) = ends
    width, height = draw(st.sampled_from([1, 2, 4, 8, 16])), draw(st.sampled_from([1, 2, 4, 8]))
    return values, Viewport(Limits(left, right, bottom, top), width, height)


@given(views())
def test_pooling_takes_the_greatest_of_what_a_picture_element_covers(view):
    values, viewport = view
    np.testing.assert_array_equal(
        pooled(values, *samplings(viewport, values.shape)), slow_pooled(values, viewport)
    )


@given(
    arrays(np.uint32, st.tuples(st.integers(1, 40), st.integers(1, 90)), elements=st.integers(0, 20)),
    st.integers(1, 60),
    st.integers(1, 30),
)
def test_no_element_is_skipped_whatever_the_sizes(values, width, height):
    rows, columns = samplings(whole(values, width, height), values.shape)
    shown = pooled(values, rows, columns)
    assert shown.max() == values.max()
    for row, column in np.ndindex(*values.shape):
        top, bottom = rows.where(row)
        left, right = columns.where(column)
        seen = shown[top:bottom, left:right]
        assert seen.size
        assert (seen >= values[row, column]).all()
    # Nor is anything shown that is not there.
    assert set(np.unique(shown)) <= set(np.unique(values))


@given(st.integers(1, 200), st.integers(1, 200), st.floats(0, 0.9), st.floats(0.01, 1))
def test_sampling_goes_on_from_where_it_was(size, count, start, share):
    begin = start * size
    sampling = Sampling.over(begin, begin + share * (size - begin), count, size)
    assert (np.diff(sampling.first) >= 0).all()
    assert (np.diff(sampling.last) >= 0).all()
    assert (sampling.first <= sampling.last).all()
    assert sampling.first[0] >= 0
    assert sampling.last[-1] < size
    # No gaps.
    assert (sampling.first[1:] <= sampling.last[:-1] + 1).all()


@given(st.integers(1, 60), st.integers(1, 60))
def test_where_an_element_is_shown(size, count):
    sampling = Sampling.over(0.0, size, count, size)
    for element in range(-1, size + 1):
        begin, end = sampling.where(element)
        expected = [k for k in range(count) if sampling.first[k] <= element <= sampling.last[k]]
        assert list(range(begin, end)) == expected


@given(st.integers(1, 1000))
def test_levels_are_votes_where_there_are_few(high):
    values = np.arange(high + 1)
    found = levels(values, 0.0, float(high))
    assert found[0] == 0
    assert found[-1] == LEVELS - 1
    assert (np.diff(found.astype(int)) >= 0).all()
    assert (found[1:] > 0).all()
    if high == LEVELS - 1:
        assert found.tolist() == list(range(LEVELS))
    if high < LEVELS:
        assert len(set(found.tolist())) == high + 1


def test_levels_of_what_is_all_alike():
    assert levels(np.zeros((2, 2), np.uint32), 0.0, 0.0).tolist() == [[0, 0], [0, 0]]
    assert levels(np.full((1, 2), 7), 0.0, 7.0).tolist() == [[LEVELS - 1] * 2]
    assert levels(np.array([-5.0, -5.0]), -5.0, -5.0).tolist() == [0, 0]


def drawn(strips, palette):
    """Return the levels that lines show, picture element by picture element."""
    level = {colour: index for index, colour in enumerate(palette.levels)}
    rows = []
    for strip in strips:
        upper, lower = [], []
        for text, style, _ in strip:
            ground = level[style.bgcolor]
            for character in text:
                over, under = {" ": (0, 0), "▀": (1, 0), "▄": (0, 1), "█": (1, 1)}[character]
                upper.append(level[style.color] if over else ground)
                lower.append(level[style.color] if under else ground)
        rows += [upper, lower]
    return rows


shown_levels = arrays(
    np.uint8,
    st.tuples(st.sampled_from([2, 4, 10]), st.integers(1, 30)),
    elements=st.integers(0, LEVELS - 1),
)


@given(shown_levels, st.sampled_from([DARK, LIGHT]))
def test_lines_show_the_level_of_every_picture_element(shown, palette):
    strips = picture(shown, palette)
    assert [strip.cell_length for strip in strips] == [shown.shape[1]] * (shown.shape[0] // 2)
    assert drawn(strips, palette) == shown.tolist()


@given(arrays(np.uint8, st.tuples(st.just(2), st.integers(1, 60)), elements=st.integers(0, 3)))
def test_a_line_has_as_few_segments_as_two_colours_each_allow(shown):
    (strip,) = picture(shown, DARK)
    count, colours = 0, set()
    for pair in shown.T:
        if count == 0 or len(colours | set(pair.tolist())) > 2:
            count, colours = count + 1, set()
        colours |= set(pair.tolist())
    assert len(strip._segments) == count


@given(shown_levels)
def test_without_colours_a_character_tells_the_greater_level(shown):
    ramp = " ..::--==++**#%@"
    assert [strip.text for strip in shaded(shown)] == [
        "".join(ramp[level] for level in row) for row in np.maximum(shown[0::2], shown[1::2])
    ]


def test_an_overlay_keeps_the_greater_level_as_its_ground():
    shown = np.zeros((4, 6), np.uint8)
    shown[1, 2], shown[2, 4] = 15, 3
    overlay = Overlay(6, 2)
    overlay.put(0, 2, "┌")
    overlay.put(1, 4, "○")
    overlay.put(5, 5, "x")
    overlay.put(0, -1, "x")
    first, second = picture(shown, DARK, overlay)
    assert (first.text, second.text) == ("  ┌   ", "    ○ ")
    corner = next(segment for segment in first if segment.text == "┌")
    mark = next(segment for segment in second if segment.text == "○")
    assert (corner.style.bgcolor, corner.style.color, corner.style.bold) == (DARK.levels[15], BLACK, True)
    assert (mark.style.bgcolor, mark.style.color) == (DARK.levels[3], WHITE)
    assert [strip.text for strip in shaded(shown, overlay)] == ["  ┌   ", "    ○ "]


def test_a_curve_tells_the_halves_that_it_goes_through():
    shown = np.zeros((4, 3), np.uint8)
    shown[2] = 15
    elements = np.zeros((4, 3), bool)
    elements[0, 0] = elements[1, 1] = elements[2:, 2] = True
    overlay = Overlay(3, 2)
    overlay.trace(elements)
    first, second = picture(shown, DARK, overlay)
    assert (first.text, second.text) == ("⠛⣤ ", "▀▀⣿")
    assert first._segments[0].style.color == DARK.bright_trace
    assert second._segments[-1].style.color == DARK.dark_trace
    overlay.put(0, 0, "○")
    assert picture(shown, DARK, overlay)[0]._segments[0].style.color == WHITE


@given(shown_levels, st.data())
def test_overlays_change_nothing_but_their_cells(shown, data):
    height, width = shown.shape[0] // 2, shown.shape[1]
    cells = data.draw(st.sets(st.tuples(st.integers(0, height - 1), st.integers(0, width - 1)), max_size=8))
    overlay = Overlay(width, height)
    for row, column in cells:
        overlay.put(row, column, "○")
    for row, strip in enumerate(picture(shown, DARK, overlay)):
        assert strip.text.count("○") == sum(cell[0] == row for cell in cells)
        for column, cell in enumerate(strip.divide(range(1, width + 1))):
            ((text, style, _),) = cell
            if (row, column) in cells:
                assert text == "○"
                assert style.bgcolor == DARK.levels[max(shown[2 * row : 2 * row + 2, column])]
            else:
                assert drawn([cell], DARK) == shown[2 * row : 2 * row + 2, [column]].tolist()


def test_styles_are_made_once():
    assert inks(DARK).style(3, 5) is inks(DARK).style(3, 5)
    assert inks(DARK) is not inks(LIGHT)


@pytest.mark.parametrize("table", FLATTENINGS)
def test_flattening_keeps_the_order_and_the_greatest(table):
    assert (np.diff(table.astype(int)) >= 0).all()
    assert (table[0], table[-1]) == (0, LEVELS - 1)


def accumulators():
    random = np.random.default_rng(4)
    yield "report", accumulate(random.uniform(0, 100, (780, 2)), Grid(90, 1000, -150.0, 0.6)).votes
    for plots in (100, 780, 5000):
        yield (
            f"tight {plots}",
            accumulate(random.uniform(-50, 50, (plots, 2)), Grid(90, 118, -70.8, 1.2)).votes,
        )
    yield "noise", random.integers(0, 1000, (80, 120))
    yield "real noise", random.random((90, 1000))
    yield "nothing and all", random.integers(0, 2, (80, 120)) * 9
    yield "checks", np.indices((80, 120)).sum(axis=0) % 16
    yield "three", random.integers(0, 3, (80, 120))


@pytest.mark.parametrize(("name", "values"), accumulators(), ids=[name for name, _ in accumulators()])
@pytest.mark.parametrize(("width", "height"), [(120, 40), (80, 24)])
def test_a_full_repaint_keeps_within_its_bytes(name, values, width, height):
    shown = levels(pooled(values, *samplings(whole(values, width, height), values.shape)), 0.0, values.max())
    kept, table = flattened(shown)
    np.testing.assert_array_equal(kept, table[shown])
    strips = picture(kept, DARK)
    assert sent(strips) <= FULL_REPAINT * width * height / 4800
    assert sum(len(strip._segments) for strip in strips) <= SEGMENTS_PER_CELL * width * height
    if name == "report":
        assert table.tolist() == list(range(LEVELS))
    # What stands out goes on standing out.
    assert (kept[shown == LEVELS - 1] == LEVELS - 1).all()


@given(arrays(np.uint8, (20, 40), elements=st.integers(0, LEVELS - 1)))
def test_no_levels_whatever_make_a_long_picture(shown):
    kept, _ = flattened(shown)
    assert sent(picture(kept, DARK)) <= FULL_REPAINT * kept.size / 2 / 4800
