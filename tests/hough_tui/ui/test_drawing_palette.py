from __future__ import annotations

import itertools

import numpy as np
import pytest
from rich.color import Color, ColorSystem
from textual.color import Color as TextualColor

from hough_tui.ui.drawing.palette import DARK, LEVELS, LIGHT, ink, luminance, palette

PALETTES = pytest.mark.parametrize(("colours", "sign"), [(DARK, 1), (LIGHT, -1)], ids=["dark", "light"])


def lightness(colour: Color) -> float:
    """Return L* of CIE 1976 of a colour."""
    channels = np.array(colour.get_truecolor()) / 255
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    y = float(linear @ [0.2126729, 0.7151522, 0.0721750])
    return 116 * y ** (1 / 3) - 16 if y > 0.008856 else 903.3 * y


def in_256(colour: Color) -> Color:
    return Color.from_ansi(colour.downgrade(ColorSystem.EIGHT_BIT).number)


def grey(colour: Color) -> Color:
    return TextualColor.from_rich_color(colour).monochrome.rich_color


@PALETTES
def test_levels_rise_evenly_away_from_the_background(colours, sign):
    steps = sign * np.diff([lightness(colour) for colour in colours.levels])
    assert len(colours.levels) == LEVELS
    assert steps.min() >= 3
    assert steps.max() <= 12


@PALETTES
def test_levels_rise_in_256_colours(colours, sign):
    shown = [in_256(colour) for colour in colours.levels]
    assert len({colour.number for colour in shown}) == LEVELS
    assert (sign * np.diff([lightness(colour) for colour in shown])).min() >= 2


@PALETTES
def test_levels_rise_in_grey_and_stay_apart_in_the_greys_of_256_colours(colours, sign):
    shown = [in_256(grey(colour)) for colour in colours.levels]
    assert (sign * np.diff([luminance(colour) for colour in shown])).min() > 0


@PALETTES
def test_the_least_level_is_like_the_background(colours, sign):
    assert luminance(colours.levels[0]) < 24 if sign > 0 else luminance(colours.levels[0]) > 236


@PALETTES
def test_newer_plots_stand_out_more(colours, sign):
    for shades in (colours.clutter, colours.target):
        assert (sign * np.diff([luminance(colour) for colour in shades])).min() > 0


def contrast(one: Color, other: Color) -> float:
    """Return the contrast ratio of WCAG 2."""

    def relative(colour: Color) -> float:
        channels = np.array(colour.get_truecolor()) / 255
        linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    low, high = sorted([relative(one), relative(other)])
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize(
    ("colours", "ground"),
    [(DARK, "#121212"), (DARK, "#1e1e1e"), (LIGHT, "#e0e0e0"), (LIGHT, "#f5f5f5")],
)
def test_inks_read_on_the_grounds_of_the_themes(colours, ground):
    below = Color.parse(ground)
    tracks = [colours.found, colours.false, colours.duplicate, colours.unknown]
    for colour in (*tracks, colours.truth, colours.lit, colours.text, colours.muted):
        assert contrast(colour, below) >= 3.0, colour
        assert contrast(in_256(colour), below) >= 3.0, colour
    assert len({in_256(colour).number for colour in (*tracks, colours.truth, colours.lit)}) == 6


@PALETTES
def test_dark_ink_is_for_bright_levels(colours, sign):
    bright = [colours.is_bright(level) for level in range(LEVELS)]
    assert bright == sorted(bright, reverse=sign < 0)
    assert set(bright) == {False, True}


def test_there_is_a_palette_for_either_kind_of_theme():
    assert palette(True) is DARK
    assert palette(False) is LIGHT
    assert DARK.track("no state") == DARK.unknown


def test_inks_set_what_is_asked_for_and_nothing_else():
    for bold, reverse in itertools.product((False, True), repeat=2):
        style = ink(DARK.lit, bold=bold, reverse=reverse)
        assert (style.bold, style.reverse) == (bold or None, reverse or None)
        assert style.bgcolor is None
