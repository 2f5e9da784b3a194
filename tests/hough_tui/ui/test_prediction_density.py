"""The density of votes over the bins: what the strips show, read dot by dot."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from algorithms.parameters import replaced
from hough_tui.quantisation.forecast import forecast
from hough_tui.ui.drawing.palette import DARK
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.widgets.prediction_density import (
    CURVE,
    EDGE,
    HOME,
    HOME_WORDS,
    WORDS,
    legend,
    painted,
    styles,
)
from scenarios.files.set_files import load_set
from scenarios.sweeps import place

BITS = {
    0x01: (0, 0), 0x02: (0, 1), 0x04: (0, 2), 0x08: (1, 0),
    0x10: (1, 1), 0x20: (1, 2), 0x40: (0, 3), 0x80: (1, 3),
}  # fmt: skip
STYLES = styles(DARK)


def picture(rho_step, sigma=None, target=0):
    """Return the picture of a target of the course report, with another Δρ."""
    given_set = load_set("course-report")
    scenario, entry = given_set.scenarios[0], given_set.initiators[0]
    if sigma is not None:
        scenario = replaced(scenario, {place("sigma", scenario, [])[1]: sigma})
    entry = replaced(entry, {("grid", "rho_step"): rho_step, ("grid", "rho_bins"): "auto"})
    return forecast(entry, scenario).pictures[target]


def seen(shown, width, height):
    """Return viewport, the dots of each layer, and the characters that are no dots, with their layer."""
    view = Viewport(Limits(shown.low, shown.high, 0.0, height / max(1, height - 1)), width, height)
    dots, words = {}, {}
    for row, strip in enumerate(painted(shown, view).strips(STYLES)):
        column = 0
        for text, style, _ in strip:
            for character in text:
                code = ord(character) - 0x2800
                layer = STYLES.index(style)
                if 0 < code < 256:
                    for bit, (x, y) in BITS.items():
                        if code & bit:
                            dots[2 * column + x, 4 * row + y] = layer
                elif character != " ":
                    words[row, column] = character, layer
                column += 1
        assert column == width
    return view, dots, words


def written(words, layer):
    """Return what is written in a layer."""
    return "".join(character for _, (character, found) in sorted(words.items()) if found == layer)


@given(
    st.sampled_from([0.05, 0.2, 0.6, 2.0, 30.0]), st.integers(20, 90), st.integers(3, 20), st.integers(0, 1)
)
def test_the_home_cell_is_filled_up_to_the_density(step, width, height, target):
    shown = picture(step, target=target)
    view, dots, _ = seen(shown, width, height)
    begin = shown.first + shown.home * shown.step
    dot = (height / (height - 1)) / (4 * height)
    for x in range(2 * width):
        rho = shown.low + (x + 0.5) / (2 * width) * (shown.high - shown.low)
        density = float(np.interp(rho, shown.curve[:, 0], shown.curve[:, 1]))
        filled = [y for (column, y), layer in dots.items() if column == x and layer == HOME]
        if begin <= rho < begin + shown.step and density > 2.0 * dot:
            # From the lowest row of dots without a gap to the one that the density reaches.
            top = 4 * height - density / dot
            assert set(filled) >= set(range(math.ceil(top), 4 * height)), (x, rho)
            assert min(filled) >= math.floor(top) - 1 - _jump(shown, rho, view, dot)
        elif (
            not begin - 2 * (shown.high - shown.low) / width
            <= rho
            < begin + shown.step + 2 * (shown.high - shown.low) / width
        ):
            assert not filled


def _jump(shown, rho, view, dot):
    """Return by how many dots the curve changes in the cell of a place, which has one colour."""
    near = (shown.high - shown.low) / view.width
    places = np.linspace(rho - near, rho + near, 50)
    heights = np.interp(places, shown.curve[:, 0], shown.curve[:, 1])
    return math.ceil(float(np.ptp(heights)) / dot) + 1


@given(st.sampled_from([0.05, 0.2, 0.6, 2.0]), st.integers(30, 90), st.integers(4, 20))
def test_the_curve_passes_through_the_density_at_every_column_of_dots(step, width, height):
    shown = picture(step)
    _, dots, words = seen(shown, width, height)
    dot = (height / (height - 1)) / (4 * height)
    for x in range(2 * width):
        rho = shown.low + (x + 0.5) / (2 * width) * (shown.high - shown.low)
        density = float(np.interp(rho, shown.curve[:, 0], shown.curve[:, 1]))
        y = 4 * height - density / dot
        if density < 2.0 * dot or (int(y) // 4, x // 2) in words:
            continue
        assert any(
            layer >= CURVE and abs(column - x) <= 1 and abs(row + 0.5 - y) <= 2 + 4
            for (column, row), layer in dots.items()
        ), (x, y)


def test_the_edges_of_the_bins_are_where_the_columns_begin():
    shown = picture(0.6)
    _, dots, _ = seen(shown, 60, 12)
    places = {x for (x, _), layer in dots.items() if layer == EDGE}
    wanted = {
        int((shown.first + column * shown.step - shown.low) / (shown.high - shown.low) * 120)
        for column in range(shown.bins + 1)
        if shown.low <= shown.first + column * shown.step < shown.high
    }
    # One edge lies under the filled home cell, whose colour goes before.
    assert places <= wanted
    assert len(wanted - places) <= 2
    assert len(wanted) == 4


def test_edges_that_nobody_could_tell_apart_are_left_out():
    shown = picture(0.005)
    _, dots, _ = seen(shown, 60, 12)
    assert {layer for layer in dots.values()} == {CURVE, HOME}


def test_the_shares_of_the_bins_are_written_above_them():
    shown = picture(0.6)
    _, _, words = seen(shown, 60, 12)
    share = shown.shares[shown.home]
    assert written(words, HOME_WORDS) == f"{100 * share:.1f}%"
    others = [shown.shares[shown.home + side] for side in (-1, 1)]
    assert written(words, WORDS) == "".join(f"{100 * other:.1f}%" for other in others)
    assert sum(shown.shares.values()) == pytest.approx(1.0, abs=1e-9)


def test_the_share_of_the_home_cell_is_written_even_where_cells_are_narrow():
    shown = picture(0.05)
    _, _, words = seen(shown, 60, 12)
    assert written(words, HOME_WORDS) == f"{100 * shown.shares[shown.home]:.0f}"


def test_without_noise_all_votes_of_a_row_lie_within_the_spread_by_the_extent():
    shown = picture(0.6, sigma=0.0)
    inside = np.abs(shown.curve[:, 0] - 0.5 * (shown.low + shown.high)) <= shown.step
    assert shown.curve[~inside, 1].max() == 0.0
    assert set(np.round(shown.curve[:, 1], 9)) == {0.0, 1.0}
    _, dots, _ = seen(shown, 60, 12)
    assert HOME in dots.values()


def test_the_legend_says_whose_votes_they_are():
    shown = picture(0.6, target=1)
    text = " · ".join(part.text for part in legend(shown, "km", 1, 2))
    assert text.startswith(f"{shown.name}, 2 of 2 · row {shown.row}, θ {shown.theta:.2f}° · ")
    assert f"R {shown.spread:.3f}"[:6] in text
