"""What part of a plane is on the screen: from coordinates to character cells and back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", float, NDArray[np.float64])

CELL_ASPECT = 2.0
"""Height of a character cell by its width."""


class Limits(NamedTuple):
    """The coordinates at the four edges of a picture; `bottom` > `top` where an axis points down."""

    left: float
    right: float
    bottom: float
    top: float

    def expanded(self, factor: float) -> Limits:
        """Return limits about the same centre, each side so many times as long."""
        more = 0.5 * (factor - 1.0)
        x, y = more * (self.right - self.left), more * (self.top - self.bottom)
        return Limits(self.left - x, self.right + x, self.bottom - y, self.top + y)

    def holds(self, x: Number, y: Number) -> bool | NDArray[np.bool_]:
        """Return whether points lie inside or on the edges."""
        low, high = min(self.bottom, self.top), max(self.bottom, self.top)
        return (x >= self.left) & (x <= self.right) & (y >= low) & (y <= high)


@dataclass(frozen=True, slots=True)
class Viewport:
    """A part of the plane on a rectangle of character cells.

    Columns and rows are real numbers counted from the upper left corner: 0.5 is the middle of
    the first cell.

    Attributes
    ----------
    limits : coordinates at the outer edges of the outer cells
    width, height : in cells, ≥ 1
    """

    limits: Limits
    width: int
    height: int

    def column(self, x: Number) -> Number:
        """Return the columns of abscissas."""
        limits = self.limits
        return (x - limits.left) * (self.width / (limits.right - limits.left))

    def row(self, y: Number) -> Number:
        """Return the rows of ordinates."""
        limits = self.limits
        return (y - limits.top) * (self.height / (limits.bottom - limits.top))

    def x(self, column: Number) -> Number:
        """Return the abscissas of columns."""
        limits = self.limits
        return limits.left + column * ((limits.right - limits.left) / self.width)

    def y(self, row: Number) -> Number:
        """Return the ordinates of rows."""
        limits = self.limits
        return limits.top + row * ((limits.bottom - limits.top) / self.height)

    def zoomed(self, factor: float, x: float, y: float, least: tuple[float, float] = (0.0, 0.0)) -> Viewport:
        """Return a view in which things are so many times as large, with one point where it was.

        Parameters
        ----------
        factor : > 0
        x, y : the point
        least : how much of each axis is shown at least
        """
        left, right, bottom, top = self.limits
        across = max(1.0 / factor, min(1.0, least[0] / abs(right - left)))
        up = max(1.0 / factor, min(1.0, least[1] / abs(top - bottom)))
        return self._with(
            x - (x - left) * across, x + (right - x) * across, y - (y - bottom) * up, y + (top - y) * up
        )

    def panned(self, columns: float, rows: float) -> Viewport:
        """Return a view so many columns further right and rows further down."""
        left, right, bottom, top = self.limits
        x, y = columns * (right - left) / self.width, rows * (bottom - top) / self.height
        return self._with(left + x, right + x, bottom + y, top + y)

    def resized(self, width: int, height: int) -> Viewport:
        """Return a view of the same part on more or fewer cells."""
        return replace(self, width=width, height=height)

    def within(self, bounds: Limits) -> Viewport:
        """Return the view moved, and where it is too large cut down, so that it lies within bounds."""
        left, right = _inside(self.limits.left, self.limits.right, bounds.left, bounds.right)
        bottom, top = _inside(self.limits.bottom, self.limits.top, bounds.bottom, bounds.top)
        return self._with(left, right, bottom, top)

    def showing(self, x: float, y: float) -> Viewport:
        """Return the view moved as little as need be to have a point inside."""
        left, right, bottom, top = self.limits
        along = min(x - left, 0.0) + max(x - right, 0.0)
        low, high = min(bottom, top), max(bottom, top)
        up = min(y - low, 0.0) + max(y - high, 0.0)
        return self._with(left + along, right + along, bottom + up, top + up)

    def squared(self) -> Viewport:
        """Return the least view around this one in which both axes have the same scale."""
        left, right, bottom, top = self.limits
        x = abs(right - left) / self.width
        y = abs(top - bottom) / (self.height * CELL_ASPECT)
        wider, taller = max(1.0, y / x), max(1.0, x / y)
        across, up = 0.5 * (right - left) * (wider - 1.0), 0.5 * (top - bottom) * (taller - 1.0)
        return self._with(left - across, right + across, bottom - up, top + up)

    def _with(self, left: float, right: float, bottom: float, top: float) -> Viewport:
        return replace(self, limits=Limits(left, right, bottom, top))


def _inside(start: float, end: float, first: float, last: float) -> tuple[float, float]:
    """Return an interval moved or cut so that it lies between two ends; all may run downwards."""
    if abs(end - start) >= abs(last - first):
        return first, last
    low, high = min(first, last), max(first, last)
    shift = max(low - min(start, end), 0.0) + min(high - max(start, end), 0.0)
    return start + shift, end + shift
