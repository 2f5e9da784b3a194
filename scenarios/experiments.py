"""Experiments: what runs on what, over which swept values, and what counts as success."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from algorithms.context import Context
from algorithms.parameters import (
    Auto,
    Count,
    Declared,
    Dimension,
    Flag,
    Integer,
    Name,
    Number,
    Positive,
    parameter,
    with_default,
)
from algorithms.scoring.matching import Criterion

MOST_TRIALS = 10_000_000
CUTOFF_BY_NOISE = 10.0
"""The cutoff of GOSPA unless it is chosen, as a multiple of the greatest standard deviation of a plot."""
LARGEST_SEED = 2**64 - 1
Seed = Annotated[int, Field(strict=True, ge=0, le=LARGEST_SEED)]


class MatchCriterion(Declared):
    """When a track matches a target: by its line (`rho`, `theta_deg`) or by shared plots (`plots`)."""

    rho: Positive | None = parameter(
        None, dimension=Dimension.LENGTH, help="greatest difference in ρ; none: match by plots"
    )
    at: Literal["origin", "mid-track"] = parameter(
        "origin",
        help="where the lines are compared: at the origin of coordinates, as ρ is, or at the middle of the "
        "target's path",
    )
    nearest: Flag = parameter(
        False, help="whether a track matches only the nearest of the targets within the bounds"
    )
    theta_deg: Annotated[Positive, Field(le=90)] | None = parameter(
        None,
        dimension=Dimension.ANGLE,
        help="greatest difference in θ, degrees; none: ρ alone is compared, and clutter alone may succeed",
    )
    plots: Count | None = parameter(
        None, dimension=Dimension.COUNT, help="least number of a track's plots that are the target's own"
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.rho is None) == (self.plots is None):
            raise ValueError("exactly one of rho and plots must be given: match by line, or by shared plots")
        if self.plots is not None:
            for name, given in (
                ("theta_deg", self.theta_deg is not None),
                ("at: mid-track", self.at != "origin"),
                ("nearest", self.nearest),
            ):
                if given:
                    raise ValueError(f"{name} is given with plots; it goes with rho only")
        elif self.theta_deg is None and (self.at != "origin" or self.nearest):
            raise ValueError("at: mid-track and nearest compare lines by θ and ρ; give theta_deg too")
        return self

    @property
    def value(self) -> Criterion:
        """The criterion as the scorer takes it."""
        theta = None if self.theta_deg is None else math.radians(self.theta_deg)
        return Criterion(self.rho, theta, self.plots, mid_track=self.at == "mid-track", nearest=self.nearest)

    @property
    def document(self) -> dict[str, float | int | str | None]:
        """The criterion as it is printed with results."""
        if self.plots is not None:
            return {"plots": self.plots}
        told: dict[str, float | int | str | None] = {"rho": self.rho, "theta_deg": self.theta_deg}
        if self.at != "origin":
            told["at"] = self.at
        if self.nearest:
            told["nearest"] = True
        return told


class Experiment(Declared):
    """What every kind of experiment has: so many draws of what it runs on, over swept values."""

    name: Name = parameter(help="what it is called in the set")
    kind: str = parameter("initiation", help="what is tried: initiators on scenarios, clusterings on scenes")
    description: str = parameter("", help="what it is to show")
    sweep: dict[str, Annotated[list[Integer | Number], Field(min_length=1)]] = parameter(
        default_factory=dict,
        help="values of numeric fields by dotted path, `scenario.…` or `initiator.…` (`scene.…`, "
        "`clustering.…`), or a short name where it is unambiguous; several make a grid",
    )
    trials: Annotated[Count, Field(le=MOST_TRIALS)] = parameter(
        1000, dimension=Dimension.COUNT, help="draws of each scenario or scene"
    )
    seed: Seed = parameter(1, help="which draws: the same seed gives the same draws")

    @classmethod
    def matches_tag(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data are of this kind of experiment; without a kind they are of initiation."""
        return bool(experiment_kind(data) == cls.model_fields["kind"].default)

    @property
    def parts(self) -> tuple[str, ...]:
        """The lists of a set from which it takes elements: first what is drawn, last what runs on it."""
        raise NotImplementedError


class InitiationExperiment(Experiment):
    """Which initiators run on which scenarios, and what counts as success."""

    kind: Literal["initiation"] = with_default(Experiment, "kind", "initiation")
    scenarios: list[str] | None = parameter(
        None, min_length=1, help="names of scenarios; none: all of the set"
    )
    initiators: list[str] | None = parameter(
        None, min_length=1, help="names of initiator entries; none: all of the set"
    )
    clusterings: list[str] | None = parameter(
        None,
        min_length=1,
        help="how points become plots, for sensors of high resolution: names of clustering entries, `none` "
        "(every point is a plot), `ideal` (each target is one point)",
    )
    control: Flag = parameter(
        True,
        help="whether the same draws without the targets are scored too, to show what chance alone gives",
    )
    criterion: MatchCriterion = parameter(help="when a track matches a target")
    kinematics: Literal["auto", "always", "never"] = parameter(
        "auto",
        help="whether the states of tracks are judged too (position_rmse, nees, gospa and so on), which "
        "needs their plots; auto: where tracks are matched by plots",
    )
    gospa_cutoff: Positive | Auto = parameter(
        "auto",
        dimension=Dimension.LENGTH,
        help="distance from which on GOSPA takes a track and a target for a false track and a missed target",
        auto="ten times the noise of the plots",
    )

    @property
    def judges_states(self) -> bool:
        """Whether the states of tracks are judged."""
        return self.kinematics == "always" or (self.kinematics == "auto" and self.criterion.plots is not None)

    def gospa_cutoff_on(self, context: Context) -> float | None:
        """Return the cutoff of GOSPA on a scenario; None where it hangs on a noise that is none."""
        if self.gospa_cutoff != "auto":
            return self.gospa_cutoff
        return None if context.noise is None else CUTOFF_BY_NOISE * context.noise

    @property
    def parts(self) -> tuple[str, ...]:
        """The lists of a set from which it takes elements by name."""
        return ("scenarios", "initiators") if self.clusterings is None else INITIATION_OF_POINTS


INITIATION_OF_POINTS = ("scenarios", "clusterings", "initiators")


class ClusteringExperiment(Experiment):
    """Which clusterings run on which scenes: how well they count targets, and where they place them."""

    # Without its kind it is no such experiment, which its default does not say.
    model_config = ConfigDict(json_schema_extra={"required": ["name", "kind"]})

    kind: Literal["clustering"] = with_default(Experiment, "kind", "clustering")
    scenes: list[str] | None = parameter(None, min_length=1, help="names of scenes; none: all of the set")
    clusterings: list[str] | None = parameter(
        None, min_length=1, help="names of clustering entries; none: all of the set"
    )

    @property
    def parts(self) -> tuple[str, ...]:
        """The lists of a set from which it takes elements by name."""
        return ("scenes", "clusterings")


def experiment_kind(given: Any) -> Any:
    """Return what kind of experiment data or a model are."""
    if isinstance(given, Mapping):
        return given.get("kind", "initiation")
    return getattr(given, "kind", None)


AnyExperiment = Annotated[
    Annotated[InitiationExperiment, Tag("initiation")] | Annotated[ClusteringExperiment, Tag("clustering")],
    Discriminator(experiment_kind),
]
