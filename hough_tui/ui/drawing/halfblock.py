"""Heat-maps: levels on half-block cells, two picture elements one above the other in each."""

from __future__ import annotations

from bisect import bisect
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from rich.style import Style
from textual.strip import Strip

from hough_tui.ui.drawing.cells import BLANK, Codes, cut, text
from hough_tui.ui.drawing.palette import BLACK, LEVELS, WHITE, Palette
from hough_tui.ui.drawing.sampling import DOWN, Levels

HALVES = np.array([ord(character) for character in " ▀▄█"], dtype=np.uint32)
"""Characters by which halves have the ink: none, the upper, the lower, both."""

TRACES = np.array([BLANK, *map(ord, "⠛⣤⣿")], dtype=np.uint32)
"""Characters by which halves a curve goes through: their shape is seen on any ground."""

SHADES = np.array([ord(character) for character in " ..::--==++**#%@"], dtype=np.uint32)
"""The levels where there are no colours at all."""

SEGMENTS_PER_CELL = 0.47
"""With no more changes of colour, each of 24 bytes, a cell takes 14.3 bytes, and 120 × 40 of them 69 kB."""

SAMPLED = 4
"""One row of so many tells how long a picture would be."""


def _flattenings() -> tuple[Levels, ...]:
    tables = [np.arange(LEVELS)]
    for floor in (3, 5, 7, 9, 11, 13, LEVELS - 2):
        table = np.arange(LEVELS)
        table[1 : floor + 1] = (floor + 1) // 2
        tables.append(table)
    # Two colours make one segment a line, whatever there is to show.
    tables.append(np.where(np.arange(LEVELS) == LEVELS - 1, LEVELS - 1, 0))
    return tuple(table.astype(np.uint8) for table in tables)


FLATTENINGS = _flattenings()
"""What becomes of each level: from every level on its own to the greatest and the rest."""


def flattened(shown: Levels) -> tuple[Levels, Levels]:
    """Return levels whose picture keeps within its bytes, and what became of each level.

    Mostly they stay as they are. Where noise leaves too few neighbours alike, the lower levels
    fall together, no more of them than need be: the peaks keep theirs.
    """
    every, sampled = _pairs(shown), _pairs(shown, SAMPLED)
    if np.count_nonzero(_begins(_joined(every))) <= SEGMENTS_PER_CELL * every[..., 0].size:
        # So few cells differ from the one before that there is nothing to join.
        return shown, FLATTENINGS[0]
    # The sampled rows tell where to begin; all of them whether it is enough.
    first = bisect(range(len(FLATTENINGS)), -1, key=lambda index: -_is_long(FLATTENINGS[index][sampled]))
    last = len(FLATTENINGS) - 1
    table = next(
        (table for table in FLATTENINGS[first:last] if not _is_long(table[every])), FLATTENINGS[last]
    )
    return table[shown], table


class Overlay:
    """Characters over a heat-map; the ground of each is the greater level of its cell.

    Attributes
    ----------
    codes : uint32 (height, width), code points; 0 where there is none
    is_trace : bool (height, width), whether it has the ink of a curve in place of black or white
    """

    def __init__(self, width: int, height: int) -> None:
        self.codes: Codes = np.zeros((height, width), np.uint32)
        self.is_trace = np.zeros((height, width), np.bool_)

    def put(self, row: int, column: int, character: str) -> None:
        """Put a character into a cell; one outside the picture is left out."""
        height, width = self.codes.shape
        if 0 <= row < height and 0 <= column < width:
            self.codes[row, column] = ord(character)
            self.is_trace[row, column] = False

    def trace(self, elements: NDArray[np.bool_]) -> None:
        """Put dots where a curve goes through; `elements` has shape (2·height, width)."""
        kind = elements[0::DOWN] + DOWN * elements[1::DOWN].astype(np.uint32)
        self.codes[kind > 0] = TRACES[kind[kind > 0]]
        self.is_trace |= kind > 0


class Inks:
    """The styles of a heat-map in a palette, each made once.

    Ground and ink are counted through: first the levels, then black, white and the two colours
    of curves.
    """

    def __init__(self, palette: Palette) -> None:
        self._colours = (*palette.levels, BLACK, WHITE, palette.dark_trace, palette.bright_trace)
        self._styles: dict[tuple[int, int], Style] = {}
        bright = np.array([palette.is_bright(level) for level in range(LEVELS)])
        self.plain = np.where(bright, LEVELS, LEVELS + 1).astype(np.uint8)
        self.curve = np.where(bright, LEVELS + 2, LEVELS + 3).astype(np.uint8)

    def style(self, ground: int, ink: int) -> Style:
        """Return the style of an ink on a ground."""
        found = self._styles.get((ground, ink))
        if found is None:
            found = Style(
                color=None if ink == ground else self._colours[ink],
                bgcolor=self._colours[ground],
                bold=True if ink >= LEVELS else None,
            )
            self._styles[ground, ink] = found
        return found


@lru_cache(maxsize=4)
def inks(palette: Palette) -> Inks:
    """Return the styles of a palette."""
    return Inks(palette)


def picture(shown: Levels, palette: Palette, overlay: Overlay | None = None) -> list[Strip]:
    """Return the lines of a heat-map.

    Parameters
    ----------
    shown : (2·height, width), the level of each picture element
    palette : the colours of the levels
    overlay : characters over it

    Notes
    -----
    The bytes of a line are mostly changes of colour, not characters: neighbours share a segment
    as long as there are no more than two colours in it, whichever half each is in.
    """
    made = inks(palette)
    upper, lower = shown[0::DOWN], shown[1::DOWN]
    joined = _joined(_pairs(shown))
    if overlay is not None:
        ground = np.maximum(upper, lower)
        ink = np.where(overlay.is_trace, made.curve[ground], made.plain[ground]).astype(np.int32)
        joined = np.where(overlay.codes > 0, ALONE | ink << 8 | ground, joined)
    found = _runs(joined)
    starts = np.array([run[0] for run in found])
    lengths = np.diff(starts, append=joined.size)
    grounds = np.repeat(np.array([run[1] for run in found], np.uint8), lengths).reshape(joined.shape)
    codes = HALVES[(upper > grounds) + DOWN * (lower > grounds).astype(np.intp)]
    if overlay is not None:
        codes = np.where(overlay.codes > 0, overlay.codes, codes)
    return cut(text(codes), starts, [made.style(run[1], run[2]) for run in found], joined.shape[1])


def shaded(shown: Levels, overlay: Overlay | None = None) -> list[Strip]:
    """Return the lines of a heat-map without colours: a character for the greater level of each cell."""
    codes = SHADES[np.maximum(shown[0::DOWN], shown[1::DOWN])]
    if overlay is not None:
        codes = np.where(overlay.codes > 0, overlay.codes, codes)
    height, width = codes.shape
    return cut(text(codes), np.arange(0, height * width, width), [None] * height, width)


ALONE = 1 << 16
"""Marks a cell that shares its segment with its like only."""


def _pairs(shown: Levels, step: int = 1) -> Levels:
    """Return the two levels of each cell, those of one row of every `step`, as a last axis."""
    return np.stack([shown[0 :: DOWN * step], shown[1 :: DOWN * step]], axis=-1)


def _joined(pairs: Levels) -> NDArray[np.int32]:
    """Return the two levels of each cell as one number."""
    return pairs[..., 0].astype(np.int32) << 8 | pairs[..., 1]


def _is_long(pairs: Levels) -> bool:
    """Return whether the segments of a picture are too many for its bytes."""
    joined = _joined(pairs)
    return len(_runs(joined)) > SEGMENTS_PER_CELL * joined.size


def _begins(joined: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Return which cells begin a row or differ from the one before."""
    begins = np.ones(joined.shape, np.bool_)
    begins[:, 1:] = joined[:, 1:] != joined[:, :-1]
    return begins


def _runs(joined: NDArray[np.int32]) -> list[tuple[int, int, int]]:
    """Return beginning, ground and ink of the longest runs of at most two colours, the greater the ink."""
    width = joined.shape[1]
    places = np.flatnonzero(_begins(joined))
    found: list[tuple[int, int, int]] = []
    # `start` < 0: no run is open; `one` = `other`: it has room for a second colour.
    start, one, other, row_end = -1, 0, 0, 0
    for place, pair in zip(places.tolist(), joined.ravel()[places].tolist(), strict=True):
        upper, lower = pair >> 8, pair & 255
        if start >= 0:
            if place < row_end and pair < ALONE:
                if upper in (one, other) and lower in (one, other):
                    continue
                if one == other and upper in (one, lower):
                    other = lower if upper == one else upper
                    continue
                if one == other and lower == one:
                    other = upper
                    continue
            found.append((start, one, other) if one <= other else (start, other, one))
            start = -1
        if pair >= ALONE:
            found.append((place, lower, upper & 255))
        else:
            start, one, other, row_end = place, upper, lower, place - place % width + width
    if start >= 0:
        found.append((start, one, other) if one <= other else (start, other, one))
    return found
