"""Scenes of extended targets in the range-Doppler plane, as validated models: each field is declared once."""

from __future__ import annotations

from typing import Annotated, Self

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
from scenarios.sensors import Bounds

MOST_POINTS = 1_000_000
"""The most points that a scan of a scene may be expected to hold."""

Correlation = Annotated[Number, Field(ge=-1, le=1)]


class ExtendedTarget(Declared):
    """A target that a high-resolution radar sees as many points, gaussian about its centre."""

    name: Name | None = parameter(None, help="what it is called")
    range: Number = parameter(help="its centre in range, in cells")
    doppler: Number = parameter(help="its centre in Doppler, in cells")
    scatter: tuple[NotNegative, NotNegative] = parameter(
        (0.5, 0.5),
        help="[range, doppler] how far from there its centre may lie, uniform from draw to draw, in cells; "
        "with less than half a cell, results hang on where in its cell the centre is",
    )
    points: Count = parameter(24, dimension=Dimension.COUNT, help="number of its points in a scan")
    spread: tuple[NotNegative, NotNegative] = parameter(
        (3.0, 2.0), help="[range, doppler] standard deviations of its points, in cells"
    )
    correlation: Correlation = parameter(0.0, help="of range and Doppler of its points, -1 to 1")
    amplitude: Positive = parameter(
        1.0, help="parameter σ of the Rayleigh law of its amplitudes; the mean is 1.25 σ"
    )


class SceneRegion(Declared):
    """A rectangle of the range-Doppler plane."""

    range: Bounds = parameter(help="nearest and farthest range, in cells")
    doppler: Bounds = parameter(help="lowest and highest Doppler, in cells")


class Scene(Declared):
    """A piece of the range-Doppler plane as a high-resolution radar sees it: points in cells."""

    name: Name = parameter(help="what it is called in the set")
    description: str = parameter("", help="what it is for")
    region: SceneRegion = parameter(help="where points that no target causes may lie")
    interference: Whole = parameter(
        0, dimension=Dimension.COUNT, help="fixed number of points a scan that no target causes, uniform"
    )
    noise: NotNegative = parameter(
        0.0, dimension=Dimension.COUNT, help="mean number of further such points a scan, Poisson"
    )
    amplitude: Positive = parameter(
        1.0, help="parameter σ of the Rayleigh law of the amplitudes of interference and noise"
    )
    targets: list[ExtendedTarget] = parameter(default_factory=list, help="the targets")

    @model_validator(mode="after")
    def _is_drawable(self) -> Self:
        if self.expected_points > MOST_POINTS:
            raise ValueError(
                f"a scan would hold about {self.expected_points:,.0f} points; the limit is {MOST_POINTS:,}"
            )
        return self

    @property
    def expected_points(self) -> float:
        """Number of points that a scan is expected to hold."""
        return self.interference + self.noise + sum(target.points for target in self.targets)
