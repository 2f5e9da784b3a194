"""Points: the detections of a high-resolution radar, as columns, scan after scan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from algorithms.errors import RequestError

FARTHEST = 1e15
"""Beyond it two neighbouring cells are one floating-point number."""

ALLOWED = {
    "range": f"a number from {-FARTHEST:g} to {FARTHEST:g}",
    "doppler": f"a number from {-FARTHEST:g} to {FARTHEST:g}",
    "amplitude": "a finite number, at least 0; amplitudes are linear, x dB are 10^(x/20)",
}
"""What each column may hold, in words."""


def is_allowed(column: str, values: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which values a column may hold."""
    if column == "amplitude":
        return np.asarray(np.isfinite(values) & (values >= 0.0))
    return np.asarray(np.abs(values) <= FARTHEST)


@dataclass(frozen=True, slots=True)
class Points:
    """The points of several scans, one after the other.

    Attributes
    ----------
    range, doppler : float64 (n,), in cells or in any other unit
    amplitude : float64 (n,), linear, ≥ 0
    offsets : int64 (scans + 1,), where each scan's points begin, and the end of the last; of a chunk
        of trials each scan of each trial has its own
    """

    range: NDArray[np.float64]
    doppler: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    offsets: NDArray[np.int64]

    @classmethod
    def of(
        cls, range: ArrayLike, doppler: ArrayLike, amplitude: ArrayLike, offsets: ArrayLike | None = None
    ) -> Points:
        """Return points, checked; without offsets they are those of one scan.

        Raises
        ------
        RequestError
            Where columns differ in length, a value is not allowed, or the offsets are none.
        """
        given: dict[str, Any] = {"range": range, "doppler": doppler, "amplitude": amplitude}
        columns = {name: np.ascontiguousarray(values, np.float64) for name, values in given.items()}
        sizes = {name: column.shape for name, column in columns.items()}
        if len(set(sizes.values())) > 1 or columns["range"].ndim != 1:
            shapes = ", ".join(f"{name} {shape}" for name, shape in sizes.items())
            raise RequestError(f"points: columns of one length are needed; the shapes are {shapes}")
        for name, column in columns.items():
            wrong = np.flatnonzero(~is_allowed(name, column))
            if len(wrong):
                value = column[wrong[0]]
                raise RequestError(f"point {wrong[0]}: {name} {value:g} is given; it must be {ALLOWED[name]}")
        count = len(columns["range"])
        at = np.array([0, count], np.int64) if offsets is None else np.ascontiguousarray(offsets, np.int64)
        if len(at) < 1 or at[0] != 0 or at[-1] != count or (np.diff(at) < 0).any():
            raise RequestError(f"points: offsets must rise from 0 to the number of points, {count:,}")
        return cls(**columns, offsets=at)

    def __len__(self) -> int:
        return len(self.range)

    @property
    def scans(self) -> int:
        """Number of scans."""
        return len(self.offsets) - 1

    def scan(self, index: int) -> Points:
        """Return the points of one scan."""
        rows = slice(self.offsets[index], self.offsets[index + 1])
        count = int(self.offsets[index + 1] - self.offsets[index])
        return Points(
            self.range[rows], self.doppler[rows], self.amplitude[rows], np.array([0, count], np.int64)
        )
