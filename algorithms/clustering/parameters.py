"""The parameters of plot clustering: one model a mode."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, Tag

from algorithms.errors import RequestError
from algorithms.parameters import (
    Auto,
    Count,
    Declared,
    Dimension,
    NotNegative,
    Positive,
    Whole,
    parameter,
    with_default,
)


class Clustering(Declared):
    """What every mode of clustering needs."""

    mode: str = parameter("recommended", help="how the points of a target are gathered")
    range_extent: Positive = parameter(
        help="the greatest extent D_r of a target in range, in the unit of the points"
    )
    result: Literal["mean", "strongest"] = parameter(
        "mean",
        help="the plot of a cluster: the mean of its kept points, weighted by amplitude, or the strongest",
    )

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data are of this mode; without a mode they are of the recommended one."""
        return bool(mode_of(data) == cls.model_fields["mode"].default)

    def resolved(self, targets: int) -> Self:
        """Return these parameters with every `auto` worked out.

        Parameters
        ----------
        targets : number of targets of the scene
        """
        return self


class SplittingClustering(Clustering):
    """What the modes need that split a set of points until each part is one target."""

    radius: Positive = parameter(
        2.5,
        help="how far from the centre of its cluster a point is kept, in standard deviations; √2 is the "
        "standard-deviation ellipse itself",
    )
    least_points: Count = parameter(
        4, dimension=Dimension.COUNT, help="the least number of points of a target; fewer are interference"
    )


class Recommended(SplittingClustering):
    """Split at the widest gap until a set is as narrow as a target, in range and in Doppler."""

    mode: Literal["recommended"] = parameter("recommended", help="how the points of a target are gathered")
    doppler_extent: Positive = parameter(
        help="the greatest extent D_d of a target in Doppler, in the unit of the points"
    )
    range_cell: NotNegative = parameter(
        1.0, help="size of a range cell; a twelfth of its square is added to the variance"
    )
    doppler_cell: NotNegative = parameter(
        1.0, help="size of a Doppler cell; a twelfth of its square is added to the variance"
    )


class CorrectedPatent(SplittingClustering):
    """Split at the mean range until the chord of the ellipse along range is as short as a target."""

    mode: Literal["corrected-patent"] = parameter(
        "corrected-patent", help="how the points of a target are gathered"
    )
    radius: Positive = with_default(SplittingClustering, "radius", math.sqrt(2.0))
    least_points: Count = with_default(SplittingClustering, "least_points", 1)


class Dbscan(Clustering):
    """Gather points that are dense, by DBSCAN; for comparison."""

    mode: Literal["dbscan"] = parameter("dbscan", help="how the points of a target are gathered")
    doppler_extent: Positive = with_default(Recommended, "doppler_extent", ...)
    eps: Positive = parameter(0.4, help="how near neighbours are, in units of the two extents")
    least_points: Count = parameter(
        4,
        dimension=Dimension.COUNT,
        help="the least number of neighbours, itself among them, that make a point the core of a cluster",
    )


class KMeans(Clustering):
    """Gather points about so many centres, by k-means; for comparison, where the number is known."""

    mode: Literal["k-means"] = parameter("k-means", help="how the points of a target are gathered")
    doppler_extent: Positive = with_default(Recommended, "doppler_extent", ...)
    number: Count | Auto = parameter(
        dimension=Dimension.COUNT,
        help="the number of targets of each scan",
        auto="as many as the scene has; of recorded points it must be given",
    )
    seed: Annotated[Whole, Field(le=2**31 - 1)] = parameter(
        1, help="decides from which centres it begins, the best of ten draws"
    )

    def resolved(self, targets: int) -> Self:
        """Return these parameters with the number worked out where it is `auto`.

        Raises
        ------
        RequestError
            Where the scene has no target.
        """
        if self.number != "auto":
            return self
        if targets == 0:
            raise RequestError("number: auto is as many as the scene has targets, and it has none")
        return self.model_copy(update={"number": targets})


MODES: dict[str, type[Clustering]] = {
    "recommended": Recommended,
    "corrected-patent": CorrectedPatent,
    "dbscan": Dbscan,
    "k-means": KMeans,
}


def mode_of(given: Any) -> Any:
    """Return which mode data or parameters are of."""
    if isinstance(given, Mapping):
        return given.get("mode", "recommended")
    return getattr(given, "mode", None)


AnyClustering = Annotated[
    Annotated[Recommended, Tag("recommended")]
    | Annotated[CorrectedPatent, Tag("corrected-patent")]
    | Annotated[Dbscan, Tag("dbscan")]
    | Annotated[KMeans, Tag("k-means")],
    Discriminator(mode_of),
]
"""A field of a model that takes the parameters of any mode."""
