"""What the plane and the votes of pairs share: points, of which some light up and one has the cursor."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hough_tui.ui.widgets.chart import KEY_ZOOM, Chart

REACH = 2.0
"""Cells within which a click finds a point."""

NOTHING: NDArray[np.int64] = np.empty(0, np.int64)


class Scatter(Chart):
    """A chart of points that are chosen by keys or by the mouse."""

    def __init__(self, *, name: str | None = None, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(name=name, id=id, classes=classes)
        self._lit = NOTHING
        self._cursor: int | None = None

    @property
    @abstractmethod
    def points(self) -> NDArray[np.float64]:
        """Where the points are: float64 (n, 2)."""

    @abstractmethod
    def tell(self, point: int) -> None:
        """Tell that the cursor was moved to a point."""

    @property
    def cursor(self) -> int | None:
        """The point under the cursor."""
        return self._cursor

    def highlight(self, points: Sequence[int] | NDArray[np.integer]) -> None:
        """Light up points, by their rows in the scene; none of them to put all out."""
        lit = np.unique(np.asarray(points, np.int64))
        lit = lit[(lit >= 0) & (lit < len(self.points))]
        if not np.array_equal(lit, self._lit):
            self._lit = lit
            self.changed()

    def put_cursor(self, point: int | None) -> None:
        """Put the cursor on a point and bring it into view; None for no cursor."""
        if point is not None and not 0 <= point < len(self.points):
            point = None
        if point != self._cursor:
            self._cursor = point
            self.changed()
        if point is None:
            return
        view = self.viewport
        x, y = self.points[point].tolist()
        if np.isfinite(x + y) and not view.limits.holds(x, y):
            left, right, bottom, top = self.bounds()
            x = min(max(x, left), right)
            y = min(max(y, min(bottom, top)), max(bottom, top))
            self.look_at(view.showing(x, y).limits)

    def move_to(self, point: int) -> None:
        """Put the cursor on a point, and tell it."""
        self.put_cursor(point)
        self.tell(point)

    def action_pan(self, across: float, down: float) -> None:
        self.pan(across, down)

    def action_zoom(self, steps: int) -> None:
        view = self.viewport
        x, y = view.x(0.5 * view.width), view.y(0.5 * view.height)
        if self._cursor is not None:
            place = self.points[self._cursor].tolist()
            if view.limits.holds(*place):
                x, y = place
        self.zoom(KEY_ZOOM**steps, x, y)

    def action_next_point(self, step: int) -> None:
        """Go to the next of the points that are lit up, where there are any, or else of all."""
        finite = np.flatnonzero(np.isfinite(self.points).all(axis=1))
        points = np.intersect1d(self._lit, finite) if len(self._lit) else finite
        if not len(points):
            return
        if self._cursor is None:
            place = 0 if step > 0 else -1
        else:
            # The next one even where the cursor is on none of them.
            place = int(np.searchsorted(points, self._cursor, "right" if step > 0 else "left"))
            place = (place if step > 0 else place - 1) % len(points)
        self.move_to(int(points[place]))

    def nearest(self, groups: Sequence[NDArray[np.float64]], row: int, column: int) -> int | None:
        """Return which group has the point nearest to a cell, of equals the last; None beyond the reach."""
        view = self.viewport
        if not len(groups):
            return None
        points = np.concatenate(groups)
        group = np.repeat(np.arange(len(groups)), [len(one) for one in groups])
        with np.errstate(over="ignore"):
            columns, rows = view.column(points[:, 0]), view.row(points[:, 1])
        near = np.flatnonzero(np.hypot(np.floor(columns) - column, np.floor(rows) - row) <= REACH)
        if not len(near):
            return None
        distance = np.hypot(columns[near] - (column + 0.5), rows[near] - (row + 0.5))
        return int(group[near[len(near) - 1 - int(np.argmin(distance[::-1]))]])
