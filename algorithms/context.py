"""What an initiator is told about the sensor and the batch, beside the plots."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray


class Unit(StrEnum):
    """The unit of all lengths of a scenario."""

    KILOMETRE = "km"
    METRE = "m"
    NAUTICAL_MILE = "nmi"

    @property
    def metres(self) -> float:
        """Length of the unit in metres."""
        return {"km": 1000.0, "m": 1.0, "nmi": 1852.0}[self.value]


@dataclass(frozen=True, slots=True)
class Box:
    """An axis-parallel region: its lower and its upper corner, in the unit of the scenario."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]

    @property
    def centre(self) -> tuple[float, ...]:
        """The middle of the region."""
        return tuple(0.5 * (low + high) for low, high in zip(self.lower, self.upper, strict=True))

    @property
    def plane(self) -> Box:
        """The region in the plane (x, y)."""
        return Box(self.lower[:2], self.upper[:2])

    @property
    def area(self) -> float:
        """Area of the region in the plane (x, y)."""
        return (self.upper[0] - self.lower[0]) * (self.upper[1] - self.lower[1])

    def farthest(self, point: tuple[float, float]) -> float:
        """Return the greatest distance in the plane from a point to the region."""
        x = max(abs(self.lower[0] - point[0]), abs(self.upper[0] - point[0]))
        y = max(abs(self.lower[1] - point[1]), abs(self.upper[1] - point[1]))
        return float(np.hypot(x, y))

    @classmethod
    def around(cls, position: NDArray[np.float64]) -> Box:
        """Return the bounding box of positions of shape (n, d), n ≥ 1."""
        return cls(tuple(map(float, position.min(axis=0))), tuple(map(float, position.max(axis=0))))


@dataclass(frozen=True, slots=True)
class Context:
    """What is known of the sensor and of the batch of scans.

    Attributes
    ----------
    scans : number of scans n of the batch
    interval : time between scans T, in seconds
    detection_probability : probability Pd that a scan holds a plot of a target
    sigma : standard deviation of the measurement noise on each axis, in `unit`; None if unknown
    region : where plots can lie; None if unknown
    unit : unit of all lengths
    station : where the sensor stands; None if unknown
    """

    scans: int
    interval: float
    detection_probability: float = 1.0
    sigma: tuple[float, ...] | None = None
    region: Box | None = None
    unit: Unit = Unit.KILOMETRE
    station: tuple[float, ...] | None = None

    @property
    def noise(self) -> float | None:
        """The greatest standard deviation of the axes of the plane; None if unknown or zero."""
        if self.sigma is None:
            return None
        return max(self.sigma[:2]) or None

    @property
    def expected_votes(self) -> float:
        """The plots n·Pd that a target is expected to give."""
        return self.scans * self.detection_probability
