"""Clutter: how many plots no target causes, and over which area they lie."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from algorithms.context import Box
from algorithms.parameters import Declared, Dimension, NotNegative, Whole, parameter
from scenarios.sensors import Bounds

MOST_PLOTS = 20_000_000
"""The most plots that a trial may be expected to hold."""


class Region(Declared):
    """A rectangle with sides along the axes; in space, a box."""

    x: Bounds = parameter(dimension=Dimension.LENGTH, help="western and eastern bound")
    y: Bounds = parameter(dimension=Dimension.LENGTH, help="southern and northern bound")
    z: Bounds | None = parameter(
        None, dimension=Dimension.LENGTH, help="lower and upper bound; none: the region lies in the plane"
    )

    @property
    def box(self) -> Box:
        """The region as the algorithms take it."""
        axes = (self.x, self.y) if self.z is None else (self.x, self.y, self.z)
        return Box(tuple(axis[0] for axis in axes), tuple(axis[1] for axis in axes))


class Clutter(Declared):
    """Plots that no target caused, uniform over an area."""

    kind: str = parameter("poisson", help="how the number of plots is drawn")
    over: Literal["region", "targets", "volume", "sector"] = parameter(
        "region",
        help="the area: a region, the box around the true paths of the targets, or the sector of each polar "
        "sensor, uniform in its volume or in its coordinates (range, azimuth, elevation)",
    )
    region: Region | None = parameter(None, help="where they lie; the scenario's region where none is given")

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data are of this kind of clutter; without a kind they are of the Poisson one."""
        return bool(_clutter_kind(data) == cls.model_fields["kind"].default)

    @model_validator(mode="after")
    def _one_area(self) -> Self:
        if self.over != "region" and self.region is not None:
            raise ValueError(f"region is given with over: {self.over}; leave one of them out")
        return self


class PoissonClutter(Clutter):
    """Clutter of a Poisson number of plots a scan."""

    kind: Literal["poisson"] = parameter("poisson", help="how the number of plots is drawn")
    rate: Annotated[NotNegative, Field(le=1e6)] = parameter(
        dimension=Dimension.COUNT, help="mean number λ of plots a scan"
    )

    def expected(self, scans: int) -> float:
        """Return the number of plots that a batch is expected to hold."""
        return scans * self.rate


class ExactClutter(Clutter):
    """Clutter of a fixed number of plots."""

    kind: Literal["exact"] = parameter("exact", help="how the number of plots is drawn")
    count: Annotated[Whole, Field(le=MOST_PLOTS)] = parameter(
        dimension=Dimension.COUNT, help="the number of plots"
    )
    per: Literal["scan", "batch"] = parameter(
        "scan", help="what holds that number: each scan, or the batch, each plot then in a random scan"
    )

    def expected(self, scans: int) -> float:
        """Return the number of plots of a batch."""
        return float(self.count * scans if self.per == "scan" else self.count)


def _clutter_kind(given: Any) -> Any:
    if isinstance(given, Mapping):
        return given.get("kind", "poisson")
    return getattr(given, "kind", None)


AnyClutter = Annotated[
    Annotated[PoissonClutter, Tag("poisson")] | Annotated[ExactClutter, Tag("exact")],
    Discriminator(_clutter_kind),
]
