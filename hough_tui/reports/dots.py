"""Points as braille dots: what many thousand plots look like in a few thousand cells."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ACROSS, DOWN = 2, 4
"""Dots of a cell."""

BITS = np.array([[0x40, 0x80], [0x04, 0x20], [0x02, 0x10], [0x01, 0x08]], dtype=np.uint8)
"""The bit of each dot in Unicode's braille block, row by row from below."""


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis of a chart.

    Attributes
    ----------
    low, high : what its first and its last cell stand for, low < high
    cells : how many there are
    """

    low: float
    high: float
    cells: int

    def dots(self, values: Array, per_cell: int) -> NDArray[np.int64]:
        """Return the dot of each value, counted from 0, as plotext counts them."""
        count = self.cells * per_cell
        places = 0.5 + (count - 1) * (values - self.low) / (self.high - self.low)
        return np.floor(np.round(places, 8)).astype(np.int64)

    def centres(self, cells: NDArray[np.int64]) -> Array:
        """Return values that plotext puts into the cells."""
        return self.low + cells.astype(np.float64) * ((self.high - self.low) / max(1, self.cells - 1))

    def snapped(self, values: Array, shift: int = 0) -> Array:
        """Return values moved to the centres of their cells, or of cells so many further on.

        Only there do plotext's lines, which count dots, meet its markers, which count cells.
        """
        return self.centres(np.clip(self.dots(values, 1) + shift, 0, self.cells - 1))

    def reach(self, values: Array) -> Array:
        """Return values with those far beyond the axis moved nearer.

        plotext follows a line cell by cell even where nobody sees it.
        """
        far = 10.0 * (self.high - self.low)
        return np.clip(values, self.low - far, self.high + far)

    def holds(self, values: Array) -> NDArray[np.bool_]:
        """Return which values lie on the axis; NaN and infinities do not."""
        return (values >= self.low) & (values <= self.high)


@dataclass(frozen=True, slots=True)
class Cells:
    """The cells of a chart that hold points.

    Attributes
    ----------
    x, y : where they are, in the units of the axes
    glyphs : the braille character of each
    newest : the greatest rank of the points in each
    """

    x: Array
    y: Array
    glyphs: list[str]
    newest: NDArray[np.int64]


def dotted(x: Array, y: Array, rank: NDArray[np.int64], across: Axis, up: Axis) -> Cells:
    """Return the cells in which points lie.

    Parameters
    ----------
    x, y : of the points, all of them on the axes
    rank : of the points, ≥ 0; the greatest colours the cell
    across, up : the axes
    """
    column, row = across.dots(x, ACROSS), up.dots(y, DOWN)
    cell = (row // DOWN) * across.cells + column // ACROSS
    size = across.cells * up.cells
    bits, newest = np.zeros(size, np.uint8), np.full(size, -1, np.int64)
    np.bitwise_or.at(bits, cell, BITS[row % DOWN, column % ACROSS])
    np.maximum.at(newest, cell, rank)
    (used,) = np.nonzero(bits)
    glyphs = [chr(0x2800 + int(pattern)) for pattern in bits[used]]
    centres = across.centres(used % across.cells), up.centres(used // across.cells)
    return Cells(*centres, glyphs, newest[used])


def ticks(low: float, high: float, most: int) -> list[float]:
    """Return round numbers between two, at equal steps of 1, 2 or 5 times a power of ten.

    Parameters
    ----------
    low, high : the ends, low < high
    most : how many at most, ≥ 2
    """
    rough = (high - low) / max(1, most - 1)
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= 0.999 * rough)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [index * step for index in range(first, last + 1)]


def span(values: Array, margin: float = 0.0) -> tuple[float, float]:
    """Return ends between which all values lie, never equal ends."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if high - low <= 1e-9 * max(1.0, abs(low), abs(high)):
        half = 0.5 * max(1.0, abs(low))
        return low - half, high + half
    room = margin * (high - low)
    return low - room, high + room
