"""Colours: sixteen levels for a heat-map, and inks for plots, tracks and axes.

The levels follow the map "inferno" of matplotlib, as far as the 256 colours of a terminal allow:
each RGB value is the nearest one for which lightness rises from level to level in full colour,
in the 256 colours that rich puts in its place, and in the greys that Textual shows under NO_COLOR.
"""

from __future__ import annotations

from dataclasses import dataclass

from rich.color import Color
from rich.style import Style

LEVELS = 16
"""How many levels a palette has."""

MIDDLE_GREY = 128
"""Luminance from which dark ink is read more easily than bright ink."""


@dataclass(frozen=True, slots=True)
class Palette:
    """The colours of one kind of theme.

    Attributes
    ----------
    levels : from the least, which is like the background, to the greatest; on a dark theme
        they grow lighter, on a light theme darker
    clutter, target : plots that no target or some target caused, from the oldest to the newest scan
    truth : true paths
    found, false, duplicate, unknown : tracks by their state
    lit : what is chosen or lit up
    text, muted, rule : figures and words, lesser words, lines that frame
    bright_trace, dark_trace : a curve over dark and over light levels
    """

    levels: tuple[Color, ...]
    clutter: tuple[Color, ...]
    target: tuple[Color, ...]
    truth: Color
    found: Color
    false: Color
    duplicate: Color
    unknown: Color
    lit: Color
    text: Color
    muted: Color
    rule: Color
    bright_trace: Color
    dark_trace: Color

    def is_bright(self, level: int) -> bool:
        """Return whether a level needs dark ink."""
        return luminance(self.levels[level]) >= MIDDLE_GREY

    def track(self, state: str) -> Color:
        """Return the colour of a track of a state."""
        colours = {"found": self.found, "false": self.false, "duplicate": self.duplicate}
        return colours.get(state, self.unknown)


def luminance(colour: Color) -> float:
    """Return the grey, 0 to 255, that Textual shows in place of a colour under NO_COLOR."""
    red, green, blue = colour.get_truecolor()
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def ink(colour: Color, *, bold: bool = False, reverse: bool = False) -> Style:
    """Return the style of text in a colour, on whatever ground there is."""
    # An attribute that is not wanted is left open, so that it costs no bytes on the line.
    return Style(color=colour, bold=bold or None, reverse=reverse or None)


def _colours(*given: str) -> tuple[Color, ...]:
    return tuple(Color.parse(one) for one in given)


BLACK, WHITE = _colours("#000000", "#ffffff")

DARK = Palette(
    levels=_colours(
        "#0a0910", "#1d0c43", "#380d5a", "#5b1673", "#73196d", "#9b2674", "#ab2f5d", "#c23d4b",
        "#da523c", "#ec6828", "#f4821b", "#eb9d06", "#fab828", "#eacb3b", "#f9e672", "#fcffa4",
    ),
    clutter=_colours("#585858", "#767676", "#9e9e9e", "#d0d0d0"),
    target=_colours("#875f00", "#af8700", "#d7af00", "#ffd75f"),
    truth=Color.parse("#d7af5f"),
    found=Color.parse("#00d7af"),
    false=Color.parse("#ff5f5f"),
    duplicate=Color.parse("#d787d7"),
    unknown=Color.parse("#5fafff"),
    lit=WHITE,
    text=Color.parse("#c6c6c6"),
    muted=Color.parse("#949494"),
    rule=Color.parse("#585858"),
    bright_trace=Color.parse("#5fffff"),
    dark_trace=Color.parse("#00005f"),
)  # fmt: skip
"""For dark themes."""

LIGHT = Palette(
    levels=_colours(
        "#f5f5f5", "#fce281", "#eac734", "#fab424", "#eb9c00", "#f4821c", "#ed6926", "#dc543a",
        "#c14a45", "#c42c5f", "#9c2a67", "#7d206d", "#651a73", "#450c66", "#2c0d50", "#17072f",
    ),
    clutter=_colours("#b2b2b2", "#949494", "#6c6c6c", "#303030"),
    target=_colours("#d7af5f", "#af8700", "#875f00", "#5f5f00"),
    truth=Color.parse("#875f00"),
    found=Color.parse("#00875f"),
    false=Color.parse("#d70000"),
    duplicate=Color.parse("#af00af"),
    unknown=Color.parse("#005fd7"),
    lit=BLACK,
    text=Color.parse("#303030"),
    muted=Color.parse("#5f5f5f"),
    rule=Color.parse("#9e9e9e"),
    bright_trace=Color.parse("#5fffff"),
    dark_trace=Color.parse("#00005f"),
)  # fmt: skip
"""For light themes."""


def palette(dark: bool) -> Palette:
    """Return the palette of dark or of light themes."""
    return DARK if dark else LIGHT
