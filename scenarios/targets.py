"""Targets: where they are, how they move, how long they live."""

from __future__ import annotations

import math
from typing import Annotated, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from algorithms.parameters import (
    Count,
    Declared,
    Dimension,
    Name,
    NotNegative,
    Number,
    Positive,
    Whole,
    parameter,
)
from scenarios.motion import AnyMotion, ConstantVelocity, Course
from scenarios.sensors import Place

Array = NDArray[np.float64]
SLACK = 1e-6
"""Part of an interval by which a scan may miss the time of birth or death: products of times are rounded."""


class Extension(Declared):
    """How a target looks to a sensor of high resolution: points, gaussian about its place and speed."""

    points: Annotated[Count, Field(le=100_000)] = parameter(
        24, dimension=Dimension.COUNT, help="number of its points in a scan"
    )
    range_spread: NotNegative = parameter(
        0.0, dimension=Dimension.LENGTH, help="standard deviation of its points in range"
    )
    doppler_spread: NotNegative = parameter(
        0.0, dimension=Dimension.SPEED, help="standard deviation of its points in radial speed"
    )
    correlation: Annotated[Number, Field(ge=-1, le=1)] = parameter(
        0.0, help="of range and radial speed of its points, -1 to 1"
    )
    amplitude: Positive = parameter(
        1.0, help="parameter σ of the Rayleigh law of its amplitudes; that of clutter is 1"
    )


class Target(Declared):
    """A target: where it appears, how it moves, how long it is there."""

    name: Name | None = parameter(None, help="what it is called in tables")
    position: Place = parameter(
        dimension=Dimension.LENGTH, help="[x, y, z] in the scan in which it appears; z in space only"
    )
    velocity: Place = parameter(
        dimension=Dimension.SPEED, help="[vx, vy, vz], in the unit of length a second; vz in space only"
    )
    motion: AnyMotion = parameter(
        default_factory=ConstantVelocity, help="how it moves on from there; none: at constant velocity"
    )
    birth: Whole = parameter(
        0, dimension=Dimension.COUNT, help="the first scan in which it is there, by the scenario's interval"
    )
    death: Whole | None = parameter(
        None, dimension=Dimension.COUNT, help="the last scan in which it is there; none: to the end"
    )
    spread: NotNegative | tuple[NotNegative, NotNegative] | tuple[NotNegative, NotNegative, NotNegative] = (
        parameter(
            0.0,
            dimension=Dimension.LENGTH,
            help="how far from `position` it may begin, uniform from draw to draw, one number or one an axis",
        )
    )
    extended: Extension | None = parameter(
        None, help="its extent to sensors of high resolution; none: one point a scan"
    )

    @model_validator(mode="after")
    def _dies_after_birth(self) -> Self:
        if self.death is not None and self.death < self.birth:
            raise ValueError(
                f"death {self.death} is given with birth {self.birth}; a target's last scan must not be "
                "before its first"
            )
        vectors: list[tuple[str, object]] = [("velocity", self.velocity), ("spread", self.spread)]
        vectors += [(f"motion.{name}", vector) for name, vector in self.motion.vectors()]
        for name, vector in vectors:
            if isinstance(vector, tuple) and len(vector) != len(self.position):
                raise ValueError(
                    f"{name} has {len(vector)} numbers and position {len(self.position)}; "
                    "give as many of each: 2 in the plane, 3 in space"
                )
        refusal = self.motion.refusal(self.position, self.velocity)
        if refusal is not None:
            raise ValueError(refusal)
        return self

    @property
    def stands_still(self) -> bool:
        """Whether it has no line in the plane (x, y)."""
        return self.motion.stands_still(self.position, self.velocity)

    @property
    def spread_axes(self) -> tuple[float, ...]:
        """How far from `position` it may begin, on each axis."""
        return self.spread if isinstance(self.spread, tuple) else (self.spread,) * len(self.position)

    def lifetime(self, interval: float) -> tuple[float, float]:
        """Return the times of the first and the last scan in which it is there; the last may be infinite."""
        return self.birth * interval, math.inf if self.death is None else self.death * interval

    def is_present(self, time: Array, interval: float) -> NDArray[np.bool_]:
        """Return whether it is there at times, compared with birth and death on the grid of the interval."""
        number = time / interval
        born = number >= self.birth - SLACK
        return born if self.death is None else born & (number <= self.death + SLACK)

    def course(self, elapsed: Array) -> Course:
        """Return how far it has come and its velocity, float64 (n, d) each, without spread and noise.

        Parameters
        ----------
        elapsed : float64 (n,), seconds since it appeared
        """
        return self.motion.course(np.array(self.position), np.array(self.velocity), elapsed)

    def path(self, time: Array, interval: float) -> Array:
        """Return its places, (n, d), at those times at which it is there, without spread and noise."""
        moved, _ = self.course(time[self.is_present(time, interval)] - self.lifetime(interval)[0])
        return np.array(self.position) + moved

    def ends(self, interval: float, last: float) -> Array:
        """Return where its path begins and ends within a batch, float64 (2, d), without spread and noise.

        Parameters
        ----------
        interval : time between scans, in which birth and death are counted
        last : time of the batch's last scan
        """
        begin, end = self.lifetime(interval)
        moved, _ = self.course(np.array([0.0, max(0.0, min(end, last) - begin)]))
        return np.array(self.position) + moved
