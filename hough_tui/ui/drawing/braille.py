"""Points and lines as braille dots, eight to a cell, in colours by layer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from rich.style import Style
from textual.strip import Strip

from hough_tui.ui.drawing.cells import BLANK, strips
from hough_tui.ui.drawing.viewport import Viewport

Array = NDArray[np.float64]
Dots = NDArray[np.int64]

STILL = 1e-9
"""Dots within which a way along an axis is none."""

ACROSS, DOWN = 2, 4
"""Dots of a cell."""

EMPTY = 0x2800
"""The braille character without dots; those of the dots are added to it."""

BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]], dtype=np.uint8)
"""The bit of each dot, row by row from above."""

CODE = 1 << 21
"""More than any code point."""

FARTHEST = 1e12
"""Dots beyond which a point is left out, as one that is not finite: its dot is not known any more."""


class Canvas:
    """A picture of dots and characters under construction.

    A cell shows all the dots that lie in it, in the colour of the highest layer among them; a
    character takes the whole cell, and of two the one of the higher layer. Layers are whole
    numbers from 1; what is not finite is left out.
    """

    def __init__(self, viewport: Viewport) -> None:
        self.viewport = viewport
        cells = viewport.width * viewport.height
        self._bits = np.zeros(cells, np.uint8)
        self._layer = np.zeros(cells, np.int32)
        # Layer and code point in one number, so that the greatest is the one to be seen.
        self._mark = np.zeros(cells, np.int64)
        self._ground_bits, self._ground_layer = np.zeros_like(self._bits), np.zeros_like(self._layer)

    def as_ground(self) -> None:
        """Make all dots so far the ground: it is seen in cells that hold nothing else.

        Dots share a colour with all that lies in their cell, so that those of a ground would be
        taken for what lies above it.
        """
        self._ground_bits, self._ground_layer = self._bits, self._layer
        self._bits, self._layer = np.zeros_like(self._bits), np.zeros_like(self._layer)

    def points(self, position: Array, layer: int | NDArray[np.integer], size: int = 1) -> None:
        """Put points, each a square of `size` × `size` dots with the point in its first.

        Parameters
        ----------
        position : (n, 2)
        layer : of all of them, or of each
        size : side of the square, in dots
        """
        x, y, kept = self._dots(position)
        layers = np.broadcast_to(np.asarray(layer), kept.shape)[kept]
        for down in range(size):
            for along in range(size):
                self._set(x + along, y + down, layers)

    def lines(self, paths: Sequence[Array], layers: Sequence[int], dash: int = 0) -> None:
        """Draw lines through points.

        Parameters
        ----------
        paths : each (k, 2), k ≥ 0
        layers : of each
        dash : dots that are drawn and then left out, in turn; 0 for a solid line
        """
        usable = [np.asarray(path, float).reshape(-1, 2) for path in paths]
        if sum(map(len, usable)) < 2:
            return
        joined = np.concatenate(usable)
        path_of = np.repeat(np.arange(len(usable)), [len(path) for path in usable])
        x, y = self._places(joined)
        is_segment = (path_of[1:] == path_of[:-1]) & np.isfinite(x[1:] + x[:-1] + y[1:] + y[:-1])
        starts = np.flatnonzero(is_segment)
        x0, y0, x1, y1 = x[starts], y[starts], x[starts + 1], y[starts + 1]
        # Where each begins along its line, so that dashes go on from one to the next.
        length = np.maximum(np.abs(x1 - x0), np.abs(y1 - y0))
        begin = np.cumsum(length) - length
        enter, leave = _clipped(x0, y0, x1, y1, ACROSS * self.viewport.width, DOWN * self.viewport.height)
        seen = enter <= leave
        x0, y0, x1, y1, length, begin, enter, leave = (
            part[seen] for part in (x0, y0, x1, y1, length, begin, enter, leave)
        )
        # One more than there are steps: less than a dot apart, they miss none to rounding.
        counts = np.ceil(length * (leave - enter)).astype(np.int64) + 2
        segment = np.repeat(np.arange(len(counts)), counts)
        number = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = enter[segment] + (leave - enter)[segment] * (number / (counts - 1)[segment])
        along_x = x0[segment] + (x1 - x0)[segment] * share
        along_y = y0[segment] + (y1 - y0)[segment] * share
        layer_of = np.asarray(layers, np.int32)[path_of[starts[seen]]][segment]
        if dash:
            drawn = (begin[segment] + length[segment] * share) % (2 * dash) < dash
            along_x, along_y, layer_of = along_x[drawn], along_y[drawn], layer_of[drawn]
        self._set(np.floor(along_x).astype(np.int64), np.floor(along_y).astype(np.int64), layer_of)

    def marks(self, position: Array, character: str, layer: int | NDArray[np.integer]) -> None:
        """Put a character at each of several points."""
        x, y, kept = self._dots(position)
        layers = np.broadcast_to(np.asarray(layer), kept.shape)[kept].astype(np.int64)
        cell = y // DOWN * self.viewport.width + x // ACROSS
        np.maximum.at(self._mark, cell, layers * CODE + ord(character))

    def write(self, row: int, column: int, words: str, layer: int) -> None:
        """Put text into a row of cells; what does not fit is left out."""
        if not 0 <= row < self.viewport.height:
            return
        for place, character in enumerate(words, column):
            if 0 <= place < self.viewport.width:
                cell = row * self.viewport.width + place
                self._mark[cell] = max(self._mark[cell], layer * CODE + ord(character))

    def is_free(self, row: int, column: int, length: int) -> bool:
        """Return whether cells lie within the picture and hold no character yet."""
        if not (0 <= row < self.viewport.height and 0 <= column <= self.viewport.width - length):
            return False
        begin = row * self.viewport.width + column
        return not self._mark[begin : begin + length].any()

    def is_ground(self, row: int, column: int, length: int) -> bool:
        """Return whether cells lie within the picture and show the ground, or nothing at all."""
        if not self.is_free(row, column, length):
            return False
        begin = row * self.viewport.width + column
        return not self._bits[begin : begin + length].any()

    def strips(self, styles: Sequence[Style | None]) -> list[Strip]:
        """Return the lines.

        Parameters
        ----------
        styles : of the layers; the first, of layer 0, is that of the blank
        """
        shape = self.viewport.height, self.viewport.width
        is_ground = self._bits == 0
        bits = np.where(is_ground, self._ground_bits, self._bits)
        layer = np.where(is_ground, self._ground_layer, self._layer)
        marked, dotted = self._mark > 0, bits > 0
        codes = np.where(marked, self._mark % CODE, np.where(dotted, bits + np.int64(EMPTY), BLANK))
        paint = np.where(marked, self._mark // CODE, layer).reshape(shape)
        # A blank looks the same in any colour: as part of what is before it, it costs no change of colour.
        is_plain = np.array([style is None or not (style.reverse or style.bgcolor) for style in styles])
        filled = np.where((marked | dotted).reshape(shape), np.arange(shape[1]), 0)
        before = np.take_along_axis(paint, np.maximum.accumulate(filled, axis=1), axis=1)
        paint = np.where(is_plain[before], before, paint)
        return strips(codes.reshape(shape).astype(np.uint32), paint, styles)

    def _places(self, position: Array) -> tuple[Array, Array]:
        """Return points in dots from the upper left corner, as real numbers."""
        with np.errstate(over="ignore", invalid="ignore"):
            x, y = self.viewport.column(position[:, 0]) * ACROSS, self.viewport.row(position[:, 1]) * DOWN
        return np.where(np.abs(x) < FARTHEST, x, np.nan), np.where(np.abs(y) < FARTHEST, y, np.nan)

    def _dots(self, position: Array) -> tuple[Dots, Dots, NDArray[np.bool_]]:
        """Return the dots of the points that are in the picture, and which those are."""
        x, y = self._places(np.asarray(position, float).reshape(-1, 2))
        kept = self._inside(x, y)
        return x[kept].astype(np.int64), y[kept].astype(np.int64), kept

    def _inside(self, x: NDArray[np.floating] | Dots, y: NDArray[np.floating] | Dots) -> NDArray[np.bool_]:
        # Comparisons with what is no number are false.
        return (x >= 0) & (x < ACROSS * self.viewport.width) & (y >= 0) & (y < DOWN * self.viewport.height)

    def _set(self, x: Dots, y: Dots, layers: NDArray[np.integer]) -> None:
        kept = self._inside(x, y)
        if not kept.all():
            x, y, layers = x[kept], y[kept], layers[kept]
        cell = y // DOWN * self.viewport.width + x // ACROSS
        np.bitwise_or.at(self._bits, cell, BITS[y % DOWN, x % ACROSS])
        np.maximum.at(self._layer, cell, layers.astype(np.int32))


def _clipped(x0: Array, y0: Array, x1: Array, y1: Array, width: float, height: float) -> tuple[Array, Array]:
    """Return the shares of the ways from first to second points at which they enter and leave a rectangle.

    Where a way misses it, it leaves before it enters.

    References
    ----------
    Y.-D. Liang and B. A. Barsky, ACM Trans. Graphics 3, 1984.
    """
    enter, leave = np.zeros(len(x0)), np.ones(len(x0))
    for start, change, size in ((x0, x1 - x0, width), (y0, y1 - y0, height)):
        still = np.abs(change) < STILL
        divisor = np.where(still, 1.0, change)
        at_low, at_high = -start / divisor, (size - start) / divisor
        first, last = np.minimum(at_low, at_high), np.maximum(at_low, at_high)
        outside = still & ((start < 0.0) | (start > size))
        enter = np.maximum(enter, np.where(still, np.where(outside, 2.0, 0.0), first))
        leave = np.minimum(leave, np.where(still, np.where(outside, -1.0, 1.0), last))
    return enter, leave
