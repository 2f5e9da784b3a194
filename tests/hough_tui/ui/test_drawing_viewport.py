from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hough_tui.ui.drawing.viewport import CELL_ASPECT, Limits, Viewport

coordinates = st.floats(-1e6, 1e6)
spans = st.floats(1e-2, 1e6)
signs = st.sampled_from([1.0, -1.0])
sizes = st.integers(1, 300)


@st.composite
def viewports(draw):
    left, bottom = draw(coordinates), draw(coordinates)
    up = draw(signs) * draw(spans)
    return Viewport(Limits(left, left + draw(spans), bottom, bottom + up), draw(sizes), draw(sizes))


def close(one, other, scale):
    return one == pytest.approx(other, rel=1e-7, abs=1e-7 * scale)


def scale_of(view):
    return max(map(abs, view.limits))


def same(one, other, scale):
    return all(close(a, b, scale) for a, b in zip(one.limits, other.limits, strict=True))


@given(viewports(), st.floats(0, 1), st.floats(0, 1))
def test_cells_and_coordinates_lead_to_each_other(view, across, down):
    column, row = across * view.width, down * view.height
    # Far from the origin, a coordinate is not told more finely than this.
    exact = (
        1e-9
        * scale_of(view)
        / min(view.limits.right - view.limits.left, abs(view.limits.top - view.limits.bottom))
    )
    assert view.column(view.x(column)) == pytest.approx(column, abs=exact * view.width + 1e-6)
    assert view.row(view.y(row)) == pytest.approx(row, abs=exact * view.height + 1e-6)


@given(viewports())
def test_corners_are_where_they_belong(view):
    limits = view.limits
    assert (view.column(limits.left), view.row(limits.top)) == (0, 0)
    assert view.column(limits.right) == pytest.approx(view.width)
    assert view.row(limits.bottom) == pytest.approx(view.height)
    assert close(view.x(view.width), limits.right, scale_of(view))
    assert close(view.y(view.height), limits.bottom, scale_of(view))


@given(viewports(), st.floats(0.1, 10), st.floats(0, 1), st.floats(0, 1))
def test_zooming_keeps_its_point_and_goes_back(view, factor, across, down):
    x, y = view.x(across * view.width), view.y(down * view.height)
    nearer = view.zoomed(factor, x, y)
    limits = nearer.limits
    assert close((limits.right - limits.left) * factor, view.limits.right - view.limits.left, scale_of(view))
    assert close((limits.top - limits.bottom) * factor, view.limits.top - view.limits.bottom, scale_of(view))
    assume(
        limits.right - limits.left > 1e-6 * scale_of(view)
        and abs(limits.top - limits.bottom) > 1e-6 * scale_of(view)
    )
    assert nearer.column(x) == pytest.approx(across * view.width, abs=1e-3 * view.width)
    assert nearer.row(y) == pytest.approx(down * view.height, abs=1e-3 * view.height)
    assert same(nearer.zoomed(1 / factor, x, y), view, scale_of(view))


@given(viewports(), st.floats(1, 1e6), spans, spans)
def test_zooming_stops_at_the_least(view, factor, least_x, least_y):
    before = view.limits
    after = view.zoomed(factor, view.x(0.0), view.y(0.0), (least_x, least_y)).limits
    for span, was, least in (
        (after.right - after.left, before.right - before.left, least_x),
        (abs(after.top - after.bottom), abs(before.top - before.bottom), least_y),
    ):
        assert span >= min(was, least) - 1e-7 * scale_of(view)
        assert span <= was + 1e-7 * scale_of(view)


@given(viewports(), st.floats(-500, 500), st.floats(-500, 500))
def test_panning_shifts_cells_and_goes_back(view, columns, rows):
    moved = view.panned(columns, rows)
    reach = scale_of(view) + 500 * max(
        view.limits.right - view.limits.left, abs(view.limits.top - view.limits.bottom)
    )
    assert close(moved.x(0.0), view.x(columns), reach)
    assert close(moved.y(0.0), view.y(rows), reach)
    assert same(moved.panned(-columns, -rows), view, reach)


@given(viewports(), sizes, sizes)
def test_another_size_shows_the_same_part(view, width, height):
    other = view.resized(width, height)
    assert other.limits == view.limits
    assert (other.width, other.height) == (width, height)


@given(viewports(), viewports())
def test_a_view_is_held_within_bounds(view, around):
    bounds = around.limits
    # The axes of both point the same way.
    if (view.limits.top > view.limits.bottom) != (bounds.top > bounds.bottom):
        bounds = Limits(bounds.left, bounds.right, bounds.top, bounds.bottom)
    held = view.within(bounds).limits
    room = 1e-9 * max(map(abs, (*bounds, *view.limits)))
    assert bounds.left - room <= held.left < held.right <= bounds.right + room
    low, high = sorted((bounds.bottom, bounds.top))
    assert all(low - room <= end <= high + room for end in (held.bottom, held.top))
    assert (held.top > held.bottom) == (view.limits.top > view.limits.bottom)
    wanted = min(view.limits.right - view.limits.left, bounds.right - bounds.left)
    assert held.right - held.left == pytest.approx(wanted, abs=2 * room)
    assert Viewport(held, 3, 3).within(bounds).limits == pytest.approx(held, abs=2 * room)


@given(viewports(), coordinates, coordinates)
def test_a_point_is_brought_into_view_without_zooming(view, x, y):
    shown = view.showing(x, y).limits
    room = 1e-7 * max(map(abs, (*view.limits, *shown, x, y)))
    assert shown.left - room <= x <= shown.right + room
    low, high = sorted((shown.bottom, shown.top))
    assert low - room <= y <= high + room
    assert shown.right - shown.left == pytest.approx(view.limits.right - view.limits.left, abs=2 * room)
    if view.limits.holds(x, y):
        assert shown == view.limits


@given(viewports())
def test_equal_scales_show_all_that_was_seen(view):
    square = view.squared().limits
    room = 1e-7 * max(map(abs, (*view.limits, *square)))
    assert square.left <= view.limits.left + room
    assert square.right >= view.limits.right - room
    across = (square.right - square.left) / view.width
    up = abs(square.top - square.bottom) / (view.height * CELL_ASPECT)
    assert across == pytest.approx(up, rel=1e-6, abs=room)
    assert (square.top > square.bottom) == (view.limits.top > view.limits.bottom)


@given(viewports(), st.floats(0.1, 10))
def test_expanding_keeps_the_centre(view, factor):
    limits, wider = view.limits, view.limits.expanded(factor)
    reach = 10 * scale_of(view)
    assert close(wider.left + wider.right, limits.left + limits.right, reach)
    assert close(wider.right - wider.left, factor * (limits.right - limits.left), reach)
    assert close(wider.top - wider.bottom, factor * (limits.top - limits.bottom), reach)


def test_limits_tell_what_they_hold():
    down = Limits(0.0, 10.0, 5.0, -5.0)
    assert down.holds(0.0, 5.0)
    assert not down.holds(0.0, 5.1)
    x, y = np.array([1.0, 11.0, np.nan]), np.array([0.0, 0.0, 0.0])
    assert down.holds(x, y).tolist() == [True, False, False]
