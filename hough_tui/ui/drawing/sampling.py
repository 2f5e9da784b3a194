"""From an array to the picture elements of a heat-map: the greatest value in each, and its level."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hough_tui.ui.drawing.palette import LEVELS
from hough_tui.ui.drawing.viewport import Viewport

Levels = NDArray[np.uint8]

DOWN = 2
"""Picture elements of a character cell, one above the other."""


@dataclass(frozen=True, slots=True)
class Sampling:
    """Which elements of one axis of an array lie in each picture element.

    Attributes
    ----------
    first, last : int64 (picture elements,), both included; where several of them lie in one
        element of the array, they share it
    """

    first: NDArray[np.int64]
    last: NDArray[np.int64]

    @classmethod
    def over(cls, start: float, end: float, count: int, size: int) -> Sampling:
        """Return the sampling of a part of an axis.

        Parameters
        ----------
        start, end : the part, in elements; element k reaches from k to k + 1
        count : number of picture elements
        size : number of elements

        Notes
        -----
        An element belongs to the picture element in which its middle lies, so that each is in
        one and none is skipped; a picture element without any shows the nearest.
        """
        edges = np.linspace(start, end, count + 1)
        bounds = np.clip(np.ceil(edges - 0.5), 0, size).astype(np.int64)
        nearest = np.clip(np.floor(0.5 * (edges[:-1] + edges[1:])), 0, size - 1).astype(np.int64)
        is_empty = bounds[1:] <= bounds[:-1]
        first = np.where(is_empty, nearest, bounds[:-1])
        return cls(first, np.where(is_empty, nearest, bounds[1:] - 1))

    def where(self, element: int | NDArray[np.integer]) -> tuple[Any, Any]:
        """Return the first picture element that shows an element, and the one after the last.

        For an element outside the part both are equal.
        """
        begin = np.searchsorted(self.last, element, "left")
        return begin, np.maximum(begin, np.searchsorted(self.first, element, "right"))


def samplings(viewport: Viewport, shape: tuple[int, ...]) -> tuple[Sampling, Sampling]:
    """Return the samplings of rows and columns of an array whose indices the viewport is in."""
    limits = viewport.limits
    rows = Sampling.over(limits.top, limits.bottom, DOWN * viewport.height, shape[0])
    return rows, Sampling.over(limits.left, limits.right, viewport.width, shape[1])


def pooled(values: NDArray[Any], rows: Sampling, columns: Sampling) -> NDArray[Any]:
    """Return the greatest value in each picture element."""
    return _pooled(_pooled(values, columns, 1), rows, 0)


def _pooled(values: NDArray[Any], sampling: Sampling, axis: int) -> NDArray[Any]:
    first, last = sampling.first, sampling.last
    if (first == last).all():
        return np.take(values, first, axis)
    # The last of the slices that `reduceat` makes ends where the array does.
    end = int(last[-1]) + 1
    found: NDArray[Any] = np.maximum.reduceat(values[:, :end] if axis else values[:end], first, axis)
    return found


def levels(values: NDArray[Any], low: float, high: float) -> Levels:
    """Return the level of each value.

    Level 0 is what is no greater than `low`, the highest level is what reaches `high`, and the
    others divide what is between evenly: whatever has votes looks different from what has none.
    """
    if not high > low:
        return np.where(values > low, LEVELS - 1, 0).astype(np.uint8)
    # A quotient that is whole but for rounding stays in its level.
    parts = np.ceil((values - low) * ((LEVELS - 1) / (high - low)) - 1e-9)
    return np.clip(parts, 0, LEVELS - 1).astype(np.uint8)
