"""What measures: sensors with their noise, their sector and their scan times."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Discriminator, Field, Tag, model_validator

from algorithms.context import Box
from algorithms.parameters import (
    LARGEST,
    LEAST,
    Count,
    Declared,
    Deviation,
    Dimension,
    Fraction,
    NotNegative,
    Number,
    Positive,
    parameter,
)
from scenarios.conversion import converted, polar


def _rising(bounds: tuple[float, float]) -> tuple[float, float]:
    if bounds[1] - bounds[0] < LEAST:
        raise ValueError(
            f"[{bounds[0]:g}, {bounds[1]:g}] is given, which spans nothing; "
            f"the first bound must be less than the second, by {LEAST:g} or more"
        )
    return bounds


Bounds = Annotated[tuple[Number, Number], AfterValidator(_rising)]
Place = tuple[Number, Number] | tuple[Number, Number, Number]
"""A vector in the plane, or in space."""

Angle = Annotated[Number, Field(ge=-720, le=720)]
Elevation = Annotated[Number, Field(ge=-90, le=90)]


class Sensor(Declared):
    """What every sensor has."""

    kind: str = parameter("cartesian", help="how the sensor measures")
    detection_probability: Fraction = parameter(
        1.0, dimension=Dimension.FRACTION, help="probability Pd that a scan holds a plot of a target"
    )
    period: Positive | None = parameter(
        None,
        dimension=Dimension.TIME,
        help="time between its scans, in seconds; none: the interval of the scenario",
    )
    first_scan: NotNegative = parameter(0.0, dimension=Dimension.TIME, help="time of its first scan")

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data are of this kind of sensor; without a kind they are of the cartesian one."""
        return bool(sensor_kind(data) == cls.model_fields["kind"].default)


class CartesianSensor(Sensor):
    """A sensor that measures x, y and, in space, z with independent gaussian noise."""

    kind: Literal["cartesian"] = parameter("cartesian", help="how the sensor measures")
    sigma: Deviation | tuple[Deviation, Deviation] | tuple[Deviation, Deviation, Deviation] = parameter(
        dimension=Dimension.LENGTH,
        help="standard deviation of the noise, one for all axes or [on x, on y, in space on z]",
    )

    def axes(self, dimensions: int) -> tuple[float, ...]:
        """Return the standard deviations of the noise on each axis."""
        return self.sigma if isinstance(self.sigma, tuple) else (self.sigma,) * dimensions

    @property
    def dimensions(self) -> int | None:
        """How many axes it measures: 2 or 3; None where it does not say."""
        return len(self.sigma) if isinstance(self.sigma, tuple) else None

    @property
    def sector_box(self) -> Box | None:
        """The box around what it sees; None: it sees everything."""
        return None


class Resolution(Declared):
    """What a sensor of high resolution tells apart: targets are many points, not one plot."""

    range_cell: Positive = parameter(dimension=Dimension.LENGTH, help="size of a range cell")
    beam_width_deg: Annotated[Positive, Field(le=360)] = parameter(
        dimension=Dimension.ANGLE,
        help="width of the beam, degrees: the points of a dwell have the azimuth of its centre",
    )
    doppler_cell: Positive = parameter(
        dimension=Dimension.SPEED, help="size of a Doppler cell, as radial speed"
    )
    doppler_cells: Annotated[Count, Field(ge=2, le=1_000_000)] = parameter(
        dimension=Dimension.COUNT,
        help="number of Doppler cells; Doppler folds: speeds that differ by so many cells look alike",
    )

    @property
    def span(self) -> float:
        """The unambiguous span of radial speed; it lies about 0."""
        return self.doppler_cell * self.doppler_cells


class PolarSensor(Sensor):
    """A sensor that measures range, azimuth and, in space, elevation with independent gaussian noise.

    It sees targets in its sector only. Its plots are converted to cartesian coordinates, with
    their covariance, by the unscented transform; see `scenarios.conversion`.
    """

    kind: Literal["polar"] = parameter("polar", help="how the sensor measures")
    position: Place = parameter((0.0, 0.0), dimension=Dimension.LENGTH, help="where it stands")
    sigma_range: Deviation = parameter(
        dimension=Dimension.LENGTH, help="standard deviation of the noise on range"
    )
    sigma_azimuth_deg: Deviation = parameter(
        dimension=Dimension.ANGLE, help="standard deviation of the noise on azimuth, degrees"
    )
    sigma_elevation_deg: Deviation | None = parameter(
        None,
        dimension=Dimension.ANGLE,
        help="standard deviation of the noise on elevation, degrees; none: it measures in the plane",
    )
    range: Annotated[tuple[NotNegative, NotNegative], AfterValidator(_rising)] = parameter(
        dimension=Dimension.LENGTH, help="[nearest, farthest] that it sees"
    )
    azimuth_deg: Annotated[tuple[Angle, Angle], AfterValidator(_rising)] = parameter(
        (0.0, 360.0),
        dimension=Dimension.ANGLE,
        help="[first, last] azimuth that it sees, degrees clockwise from north (the y axis)",
    )
    elevation_deg: Annotated[tuple[Elevation, Elevation], AfterValidator(_rising)] | None = parameter(
        None,
        dimension=Dimension.ANGLE,
        help="[lowest, highest] elevation that it sees, degrees up from the horizon; none: -90 to 90",
    )
    resolution: Resolution | None = parameter(
        None, help="what a sensor of high resolution tells apart; none: a target is one plot"
    )

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if self.azimuth_deg[1] - self.azimuth_deg[0] > 360.0:
            span = self.azimuth_deg[1] - self.azimuth_deg[0]
            raise ValueError(f"azimuth_deg spans {span:g}°; it may span 360° at the most")
        farthest = max(map(abs, self.position)) + self.range[1]
        if farthest > LARGEST:
            raise ValueError(
                f"position and range reach {farthest:g} far; no coordinate may be greater than {LARGEST:g}"
            )
        if self.resolution is not None and self.sigma_elevation_deg is not None:
            raise ValueError("resolution is given with sigma_elevation_deg; it needs a sensor in the plane")
        if self.sigma_elevation_deg is None:
            if self.elevation_deg is not None:
                raise ValueError(
                    "elevation_deg is given without sigma_elevation_deg; a sensor in space needs both"
                )
            if len(self.position) == 3:
                raise ValueError("position has three numbers; without sigma_elevation_deg it has two")
        return self

    @property
    def dimensions(self) -> int:
        """How many coordinates it measures: 2 or 3."""
        return 2 if self.sigma_elevation_deg is None else 3

    @property
    def noise(self) -> tuple[float, ...]:
        """Standard deviations of the noise on range, azimuth and, in space, elevation; radians."""
        noise = (self.sigma_range, math.radians(self.sigma_azimuth_deg))
        return noise if self.sigma_elevation_deg is None else (*noise, math.radians(self.sigma_elevation_deg))

    @property
    def sigmas(self) -> tuple[float, ...]:
        """Standard deviations of its plots: of the noise and of rounding to cell and beam; radians."""
        if self.resolution is None:
            return self.noise
        steps = (self.resolution.range_cell, math.radians(self.resolution.beam_width_deg))
        # A value that is rounded to a cell is off by an even distribution over the cell.
        parts = zip(self.noise, steps, strict=True)
        return tuple(math.hypot(sigma, step / math.sqrt(12.0)) for sigma, step in parts)

    @property
    def limits(self) -> tuple[tuple[float, float], ...]:
        """Bounds of range, azimuth and elevation; radians."""
        elevation = self.elevation_deg or (-90.0, 90.0)
        return (
            self.range,
            (math.radians(self.azimuth_deg[0]), math.radians(self.azimuth_deg[1])),
            (math.radians(elevation[0]), math.radians(elevation[1])),
        )

    @property
    def station(self) -> tuple[float, ...]:
        """Where it stands, with as many numbers as it measures."""
        return (*self.position, 0.0) if len(self.position) < self.dimensions else self.position

    def covariance(self, position: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the covariance of the noise of plots at positions of shape (n, d), as (n, d, d)."""
        return converted(polar(position - np.array(self.station)), np.array(self.sigmas))[1]

    @property
    def sector_box(self) -> Box:
        """The box around its sector."""
        near, far = self.range
        first, last = self.azimuth_deg
        quarters = [angle for angle in range(-720, 721, 90) if first <= angle <= last]
        azimuths = [math.radians(angle) for angle in (first, last, *quarters)]
        elevations = self.limits[2] if self.dimensions == 3 else (0.0, 0.0)
        level = [min(max(0.0, elevations[0]), elevations[1])]
        grounds = [
            distance * math.cos(elevation) for distance in (near, far) for elevation in (*elevations, *level)
        ]
        x = [ground * math.sin(azimuth) for ground in grounds for azimuth in azimuths]
        y = [ground * math.cos(azimuth) for ground in grounds for azimuth in azimuths]
        axes = [x, y]
        if self.dimensions == 3:
            axes.append(
                [distance * math.sin(elevation) for distance in (near, far) for elevation in elevations]
            )
        return Box(
            tuple(at + min(axis) for at, axis in zip(self.station, axes, strict=True)),
            tuple(at + max(axis) for at, axis in zip(self.station, axes, strict=True)),
        )


def sensor_kind(given: Any) -> Any:
    """Return what kind of sensor data or a model are."""
    if isinstance(given, Mapping):
        return given.get("kind", "cartesian")
    return getattr(given, "kind", None)


AnySensor = Annotated[
    Annotated[CartesianSensor, Tag("cartesian")] | Annotated[PolarSensor, Tag("polar")],
    Discriminator(sensor_kind),
]
