"""Scenarios and sets of them, as validated models: each field is declared once, here."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, Union, cast

from pydantic import AfterValidator, ConfigDict, Discriminator, Field, Tag, create_model, model_validator

from algorithms.context import Box, Context, Unit
from algorithms.initiators.base import Initiator
from algorithms.initiators.registry import initiator, initiators
from algorithms.parameters import (
    Count,
    Declared,
    Dimension,
    Flag,
    Fraction,
    Integer,
    Name,
    NotNegative,
    Number,
    Parameters,
    Positive,
    Whole,
    parameter,
)
from algorithms.scoring import Criterion

MOST_PLOTS = 20_000_000
"""The most plots that a trial may be expected to hold."""

MOST_TRIALS = 10_000_000
LARGEST_SEED = 2**64 - 1
Seed = Annotated[int, Field(strict=True, ge=0, le=LARGEST_SEED)]


def _rising(bounds: tuple[float, float]) -> tuple[float, float]:
    if bounds[0] >= bounds[1]:
        raise ValueError(
            f"[{bounds[0]:g}, {bounds[1]:g}] is given, which spans nothing; "
            "the first bound must be less than the second"
        )
    return bounds


Bounds = Annotated[tuple[Number, Number], AfterValidator(_rising)]
Vector = tuple[Number, Number]


class Region(Declared):
    """A rectangle with sides along the axes."""

    x: Bounds = parameter(dimension=Dimension.LENGTH, help="western and eastern bound")
    y: Bounds = parameter(dimension=Dimension.LENGTH, help="southern and northern bound")

    @property
    def box(self) -> Box:
        """The region as the algorithms take it."""
        return Box((self.x[0], self.y[0]), (self.x[1], self.y[1]))


class CartesianSensor(Declared):
    """A sensor that measures x and y with independent gaussian noise."""

    kind: Literal["cartesian"] = parameter("cartesian", help="how the sensor measures")
    sigma: NotNegative | tuple[NotNegative, NotNegative] = parameter(
        dimension=Dimension.LENGTH, help="standard deviation of the noise, one for both axes or [on x, on y]"
    )
    detection_probability: Fraction = parameter(
        1.0, dimension=Dimension.FRACTION, help="probability Pd that a scan holds a plot of a target"
    )

    @property
    def axes(self) -> tuple[float, float]:
        """Standard deviations of the noise on x and on y."""
        return self.sigma if isinstance(self.sigma, tuple) else (self.sigma, self.sigma)


class Clutter(Declared):
    """Plots that no target caused, uniform over an area."""

    kind: str = parameter("poisson", help="how the number of plots is drawn")
    over: Literal["region", "targets"] = parameter(
        "region", help="the area: a region, or the box around the true paths of the targets"
    )
    region: Region | None = parameter(None, help="where they lie; the scenario's region where none is given")

    @classmethod
    def is_meant(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data are of this kind of clutter; without a kind they are of the Poisson one."""
        return bool(_clutter_kind(data) == cls.model_fields["kind"].default)

    @model_validator(mode="after")
    def _one_area(self) -> Self:
        if self.over == "targets" and self.region is not None:
            raise ValueError("region is given with over: targets; leave one of them out")
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


class Target(Declared):
    """A target of constant velocity."""

    name: Name | None = parameter(None, help="what it is called in tables")
    position: Vector = parameter(dimension=Dimension.LENGTH, help="[x, y] in the scan in which it appears")
    velocity: Vector = parameter(dimension=Dimension.SPEED, help="[vx, vy], in the unit of length a second")
    birth: Whole = parameter(0, dimension=Dimension.COUNT, help="the first scan in which it is there")
    death: Whole | None = parameter(
        None, dimension=Dimension.COUNT, help="the last scan in which it is there; none: to the end"
    )
    spread: NotNegative | tuple[NotNegative, NotNegative] = parameter(
        0.0,
        dimension=Dimension.LENGTH,
        help="how far from `position` it may begin, uniform from draw to draw, for both axes or [x, y]",
    )

    @model_validator(mode="after")
    def _dies_after_birth(self) -> Self:
        if self.death is not None and self.death < self.birth:
            raise ValueError(
                f"death {self.death} is given with birth {self.birth}; a target's last scan must not be "
                "before its first"
            )
        return self

    @property
    def stands_still(self) -> bool:
        """Whether it has no line."""
        return not any(self.velocity)

    @property
    def spread_axes(self) -> tuple[float, float]:
        """How far from `position` it may begin, on x and on y."""
        return self.spread if isinstance(self.spread, tuple) else (self.spread, self.spread)

    def present(self, scans: int) -> range:
        """Return the scans of a batch in which it is there."""
        return range(self.birth, scans if self.death is None else min(self.death + 1, scans))

    def ends(self, scans: int, interval: float) -> tuple[Vector, Vector]:
        """Return where its path begins and ends within a batch, as it is without `spread`."""
        (x, y), (vx, vy) = self.position, self.velocity
        elapsed = interval * max(0, len(self.present(scans)) - 1)
        return (x, y), (x + vx * elapsed, y + vy * elapsed)


class Scenario(Declared):
    """A piece of the world: targets, clutter, a sensor and its scans."""

    name: Name = parameter(help="what it is called in the set")
    description: str = parameter("", help="what it is for")
    unit: Unit = parameter(Unit.KILOMETRE, help="the unit of all lengths")
    scans: Annotated[Count, Field(le=100_000)] = parameter(
        dimension=Dimension.COUNT, help="number of scans n of a batch"
    )
    interval: Positive = parameter(dimension=Dimension.TIME, help="time T between scans, in seconds")
    region: Region = parameter(help="the region under surveillance")
    sensor: CartesianSensor = parameter(help="what measures")
    clutter: list[AnyClutter] = parameter(default_factory=list, help="sources of clutter; they add up")
    targets: list[Target] = parameter(default_factory=list, help="the targets")

    @model_validator(mode="after")
    def _is_drawable(self) -> Self:
        if self.expected_plots > MOST_PLOTS:
            raise ValueError(
                f"a trial would hold about {self.expected_plots:,.0f} plots; the limit is {MOST_PLOTS:,}; "
                "give fewer scans or less clutter"
            )
        if not self.targets and any(source.over == "targets" for source in self.clutter):
            raise ValueError(
                "clutter is over: targets, and there is no target; give a target, or clutter over: region"
            )
        return self

    @property
    def expected_clutter(self) -> float:
        """The number of plots of clutter that a batch is expected to hold."""
        return sum(source.expected(self.scans) for source in self.clutter)

    @property
    def expected_plots(self) -> float:
        """The number of plots that a batch holds at the most, clutter as expected."""
        return self.expected_clutter + self.scans * len(self.targets)

    def area(self, source: Clutter) -> Box:
        """Return where the plots of a source of clutter lie."""
        if source.over == "region":
            return (source.region or self.region).box
        ends = [end for target in self.targets for end in target.ends(self.scans, self.interval)]
        axes = list(zip(*ends, strict=True))
        return Box(tuple(map(min, axes)), tuple(map(max, axes)))

    @property
    def context(self) -> Context:
        """What an initiator is told of this scenario."""
        return Context(
            self.scans,
            self.interval,
            self.sensor.detection_probability,
            self.sensor.axes,
            self.region.box,
            self.unit,
        )


class InitiatorEntry(Declared):
    """An initiator with its parameters, as a set lists it.

    The entries of a set are of subclasses, one for each known initiator, that have the
    initiator's parameters as further fields.
    """

    name: Name = parameter(help="what it is called in the set; the initiator's own name where that is enough")
    initiator: str = parameter(help="which initiator it is")

    @classmethod
    def is_meant(cls, data: Mapping[str, Any]) -> bool:
        """Return whether data name this initiator, by `initiator` or else by `name`."""
        return bool(_which(data) == cls.model_fields["initiator"].default)

    @property
    def algorithm(self) -> Initiator:
        """The initiator itself."""
        return initiator(self.initiator)

    @property
    def parameters(self) -> Parameters:
        """The initiator's parameters, as they were given."""
        declared = self.algorithm.parameters
        return declared.model_construct(
            self.model_fields_set & set(declared.model_fields),
            **{name: getattr(self, name) for name in declared.model_fields},
        )


def entry_model(declared: Initiator) -> type[InitiatorEntry]:
    """Return the model of the entries of one initiator."""
    kind: Any = Literal[declared.name]
    bases: Any = (InitiatorEntry, declared.parameters)
    return cast(
        "type[InitiatorEntry]",
        create_model(
            f"{declared.name.title().replace('-', '')}Entry",
            __base__=bases,
            __doc__=declared.summary,
            # Without `initiator` the name says which it is; a schema has no other way to tell that.
            __cls_kwargs__={
                "json_schema_extra": {
                    "anyOf": [
                        {"required": ["initiator"]},
                        {"properties": {"name": {"const": declared.name}}},
                    ]
                }
            },
            initiator=(kind, parameter(declared.name, help="which initiator it is")),
        ),
    )


def _which(entry: Any) -> str | None:
    if isinstance(entry, Mapping):
        named = entry.get("initiator", entry.get("name"))
        return named if isinstance(named, str) else None
    return getattr(entry, "initiator", None)


if TYPE_CHECKING:
    Entry = InitiatorEntry
else:
    Entry = Annotated[
        Union[tuple(Annotated[entry_model(known), Tag(known.name)] for known in initiators().values())],  # noqa: UP007
        Discriminator(_which),
    ]


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
    """Which initiators run on which scenarios, over which swept values, and what counts as success."""

    name: Name = parameter(help="what it is called in the set")
    description: str = parameter("", help="what it is to show")
    scenarios: list[str] | None = parameter(
        None, min_length=1, help="names of scenarios; none: all of the set"
    )
    initiators: list[str] | None = parameter(
        None, min_length=1, help="names of initiator entries; none: all of the set"
    )
    sweep: dict[str, Annotated[list[Integer | Number], Field(min_length=1)]] = parameter(
        default_factory=dict,
        help="values of numeric fields by dotted path, `scenario.…` or `initiator.…`, or a short name "
        "where it is unambiguous; several make a grid",
    )
    trials: Annotated[Count, Field(le=MOST_TRIALS)] = parameter(
        1000, dimension=Dimension.COUNT, help="draws of each scenario"
    )
    seed: Seed = parameter(1, help="which draws: the same seed gives the same draws")
    control: Flag = parameter(
        True,
        help="whether the same draws without the targets are scored too, to show what chance alone gives",
    )
    criterion: MatchCriterion = parameter(help="when a track matches a target")


class ScenarioSet(Declared):
    """Scenarios, initiators with their parameters, and experiments."""

    model_config = ConfigDict(title="hough-tui scenario set", populate_by_name=True)

    version: Literal[1] = parameter(1, help="the version of this layout", alias="schema")
    name: Name = parameter(help="what the set is called")
    description: str = parameter("", help="what it is for")
    scenarios: list[Scenario] = parameter(min_length=1, help="the scenarios")
    initiators: list[Entry] = parameter(default_factory=list, help="the initiators with their parameters")
    experiments: list[Experiment] = parameter(default_factory=list, help="the experiments")

    def scenario(self, name: str) -> Scenario:
        """Return the scenario of a name that the set is known to have."""
        return next(found for found in self.scenarios if found.name == name)

    def entry(self, name: str) -> InitiatorEntry:
        """Return the initiator entry of a name that the set is known to have."""
        return next(found for found in self.initiators if found.name == name)

    def chosen_scenarios(self, experiment: Experiment) -> list[Scenario]:
        """Return the scenarios of an experiment."""
        if experiment.scenarios is None:
            return list(self.scenarios)
        return [self.scenario(name) for name in experiment.scenarios]

    def chosen_entries(self, experiment: Experiment) -> list[InitiatorEntry]:
        """Return the initiator entries of an experiment."""
        if experiment.initiators is None:
            return list(self.initiators)
        return [self.entry(name) for name in experiment.initiators]
