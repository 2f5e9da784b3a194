"""What the heat-map shows: an array over θ and ρ, and where in it is what."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hough_tui.ui.drawing.axes import Axis, decimals_of
from hough_tui.ui.drawing.viewport import Limits

FAINTEST = 0.05
"""How bright the greatest of descending values is, beside the span of all: brighter than none."""


@dataclass(frozen=True, eq=False)
class HeatmapScene:
    """An accumulator, or another array over the same cells.

    Positions in it are counted in cells from the outer corner of the first one: cell (0, 0) has
    its middle at 0.5, 0.5.

    Attributes
    ----------
    values : (theta bins, rho bins); what is no number counts as the least
    theta_deg, rho : centres of rows and columns, evenly spaced and ascending
    unit : of ρ
    label : what the values are
    marks : row and column of the cells that are tracks
    beside : further values of the cells, which the read-out tells too, each with its label
    is_descending : whether the least value is the brightest, and what is no finite number the darkest
    """

    values: NDArray[Any]
    theta_deg: NDArray[np.float64]
    rho: NDArray[np.float64]
    unit: str
    label: str = "votes"
    marks: tuple[tuple[int, int], ...] = ()
    beside: tuple[tuple[str, NDArray[Any]], ...] = ()
    is_descending: bool = False

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rows and of columns."""
        rows, columns = self.values.shape
        return rows, columns

    @property
    def is_empty(self) -> bool:
        """Whether there is no cell at all."""
        return self.values.size == 0

    @cached_property
    def comparable(self) -> NDArray[Any]:
        """The values as they are shown: the greater, the brighter.

        What is not finite is replaced by the least or the greatest that is; where the values are
        descending, by 0, and the others by how far they lie below the greatest, and a little more.
        """
        if self.is_descending and not self.is_empty:
            finite = np.isfinite(self.values)
            known = self.values[finite] if finite.any() else np.zeros(1)
            span = float(known.max() - known.min()) or 1.0
            shown: NDArray[Any] = np.zeros(self.values.shape)
            shown[finite] = known.max() - known + FAINTEST * span
            return shown
        if self.is_empty or np.issubdtype(self.values.dtype, np.integer):
            return self.values
        finite = np.isfinite(self.values)
        if finite.all():
            return self.values
        known = self.values[finite] if finite.any() else np.zeros(1)
        found: NDArray[Any] = np.nan_to_num(
            self.values, nan=known.min(), posinf=known.max(), neginf=known.min()
        )
        return found

    @cached_property
    def mark_cells(self) -> NDArray[np.int64]:
        """Row and column (k, 2) of the marks."""
        return np.array(self.marks, np.int64).reshape(-1, 2)

    @cached_property
    def extremes(self) -> tuple[float, float]:
        """What the lowest and the highest level stand for: 0 or what is below it, and the greatest value."""
        if self.is_empty:
            return 0.0, 0.0
        return min(0.0, float(self.comparable.min())), float(self.comparable.max())

    @cached_property
    def ends(self) -> tuple[str, str]:
        """What the lowest and the highest level stand for, in words."""
        if not self.is_descending:
            low, high = self.extremes
            return f"{low:.4g}", f"{high:.4g}"
        finite = self.values[np.isfinite(self.values)]
        return "none", f"{finite.min():.4g}" if finite.size else "none"

    @cached_property
    def peaks(self) -> NDArray[np.int64]:
        """Row and column (k, 2) of the local maxima, the strongest first, equals in the order of the cells.

        A cell is one if it exceeds the least, and no neighbour exceeds it; of neighbours that are
        equal, the first.
        """
        values = self.comparable
        found = values > self.extremes[0]
        for down, along in ((1, 1), (1, 0), (1, -1), (0, 1)):
            first = values[: len(values) - down, max(0, -along) : values.shape[1] - max(0, along)]
            second = values[down:, max(0, along) : values.shape[1] + min(0, along)]
            found[: len(values) - down, max(0, -along) : values.shape[1] - max(0, along)] &= first >= second
            found[down:, max(0, along) : values.shape[1] + min(0, along)] &= second > first
        cells = np.argwhere(found)
        order = np.argsort(-values[found].astype(np.float64), kind="stable")
        return cells[order]

    @property
    def strongest(self) -> tuple[int, int]:
        """Row and column of the greatest value, the first of equals."""
        row, column = np.unravel_index(int(np.argmax(self.comparable)), self.shape)
        return int(row), int(column)

    def home(self) -> Limits:
        """Return limits with every cell in view, the first row at the top as in a printed matrix."""
        rows, columns = self.shape
        return Limits(0.0, max(1.0, columns), max(1.0, rows), 0.0)

    def occupied(self) -> Limits:
        """Return limits with every cell in view that exceeds the least, and a little room beside ρ."""
        (columns,) = np.nonzero((self.comparable > self.extremes[0]).any(axis=0))
        left, right, bottom, top = self.home()
        if not len(columns):
            return Limits(left, right, bottom, top)
        room = max(1.0, 0.02 * (columns[-1] - columns[0]))
        return Limits(max(left, columns[0] - room), min(right, columns[-1] + 1.0 + room), bottom, top)

    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        """Return the axes of ρ and θ of a part."""
        across = Axis(
            *self._ends(self.rho, limits.left, limits.right),
            f"ρ [{self.unit}]" if self.unit else "ρ",
            only=_only(self.rho),
        )
        ends = self._ends(self.theta_deg, limits.top, limits.bottom)
        return across, Axis(*ends, "°", is_angle=True, only=_only(self.theta_deg))

    def words(self, row: int, column: int) -> tuple[str, str, str]:
        """Return θ, ρ and the values of a cell as text, the value that is shown first."""
        theta = _centre(self.theta_deg, row)
        rho = _centre(self.rho, column)
        told = [
            _value(values[row, column], label) for label, values in ((self.label, self.values), *self.beside)
        ]
        return f"{theta}°", f"{rho} {self.unit}", " · ".join(told)

    def at(self, other: HeatmapScene, limits: Limits) -> Limits:
        """Return the part of another scene with the θ and ρ of a part of this one."""
        rho = [other._place(other.rho, value) for value in self._ends(self.rho, limits.left, limits.right)]
        theta = self._ends(self.theta_deg, limits.top, limits.bottom)
        top, bottom = (other._place(other.theta_deg, value) for value in theta)
        return Limits(rho[0], rho[1], bottom, top)

    @staticmethod
    def _ends(centres: NDArray[np.float64], start: float, end: float) -> tuple[float, float]:
        first, step = spacing(centres)
        return first + (start - 0.5) * step, first + (end - 0.5) * step

    @staticmethod
    def _place(centres: NDArray[np.float64], value: float) -> float:
        first, step = spacing(centres)
        return (value - first) / step + 0.5


def spacing(centres: NDArray[np.float64]) -> tuple[float, float]:
    """Return the first of evenly spaced centres and their distance, which for a single one is 1."""
    if len(centres) < 2:
        return (float(centres[0]) if len(centres) else 0.0), 1.0
    return float(centres[0]), float(centres[-1] - centres[0]) / (len(centres) - 1) or 1.0


def _value(value: Any, label: str) -> str:
    if isinstance(value, np.integer):
        return f"{int(value)} {label}"
    return f"{float(value):.4g} {label}" if np.isfinite(value) else f"no {label}"


def _only(centres: NDArray[np.float64]) -> float | None:
    return float(centres[0]) if len(centres) == 1 else None


def _centre(centres: NDArray[np.float64], index: int) -> str:
    """Return a centre with as many decimals as tell it from its neighbours and name it rightly."""
    first, step = spacing(centres)
    # Centres often lie half a step beside multiples of the step.
    decimals = max(decimals_of(step), decimals_of(abs(first % step) or step)) if len(centres) > 1 else 3
    return f"{round(float(centres[index]), min(4, decimals)) + 0.0:.{min(4, decimals)}f}"
