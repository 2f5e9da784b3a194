"""Scenarios and sets of them, as validated models: each field is declared once, here."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, Union, cast

import numpy as np
from pydantic import ConfigDict, Discriminator, Field, Tag, create_model, model_validator

from algorithms.context import Box, Context, Unit
from algorithms.initiators.base import Initiator
from algorithms.initiators.registry import initiator, initiators
from algorithms.parameters import (
    Count,
    Declared,
    Dimension,
    Flag,
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
from scenarios.conversion import converted
from scenarios.sensors import AnySensor, Bounds, CartesianSensor, Place, PolarSensor

MOST_PLOTS = 20_000_000
"""The most plots that a trial may be expected to hold."""

MOST_TRIALS = 10_000_000
LARGEST_SEED = 2**64 - 1
Seed = Annotated[int, Field(strict=True, ge=0, le=LARGEST_SEED)]


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
    def is_meant(cls, data: Mapping[str, Any]) -> bool:
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


class Target(Declared):
    """A target of constant velocity."""

    name: Name | None = parameter(None, help="what it is called in tables")
    position: Place = parameter(
        dimension=Dimension.LENGTH, help="[x, y, z] in the scan in which it appears; z in space only"
    )
    velocity: Place = parameter(
        dimension=Dimension.SPEED, help="[vx, vy, vz], in the unit of length a second; vz in space only"
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

    @model_validator(mode="after")
    def _dies_after_birth(self) -> Self:
        if self.death is not None and self.death < self.birth:
            raise ValueError(
                f"death {self.death} is given with birth {self.birth}; a target's last scan must not be "
                "before its first"
            )
        for name, given in (("velocity", self.velocity), ("spread", self.spread)):
            if isinstance(given, tuple) and len(given) != len(self.position):
                raise ValueError(
                    f"{name} has {len(given)} numbers and position {len(self.position)}; "
                    "give as many of each: 2 in the plane, 3 in space"
                )
        return self

    @property
    def stands_still(self) -> bool:
        """Whether it has no line in the plane (x, y)."""
        return not any(self.velocity[:2])

    @property
    def spread_axes(self) -> tuple[float, ...]:
        """How far from `position` it may begin, on each axis."""
        return self.spread if isinstance(self.spread, tuple) else (self.spread,) * len(self.position)

    def lifetime(self, interval: float) -> tuple[float, float]:
        """Return the times of the first and the last scan in which it is there; the last may be infinite."""
        return self.birth * interval, math.inf if self.death is None else self.death * interval

    def ends(self, interval: float, last: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return where its path begins and ends within a batch, as it is without `spread`.

        Parameters
        ----------
        interval : time between scans, in which birth and death are counted
        last : time of the batch's last scan
        """
        begin, end = self.lifetime(interval)
        elapsed = max(0.0, min(end, last) - begin)
        moved = zip(self.position, self.velocity, strict=True)
        return self.position, tuple(place + speed * elapsed for place, speed in moved)


class Scenario(Declared):
    """A piece of the world: targets, clutter, a sensor and its scans."""

    name: Name = parameter(help="what it is called in the set")
    description: str = parameter("", help="what it is for")
    unit: Unit = parameter(Unit.KILOMETRE, help="the unit of all lengths")
    scans: Annotated[Count, Field(le=100_000)] = parameter(
        dimension=Dimension.COUNT, help="number of scans n of a batch"
    )
    interval: Positive = parameter(dimension=Dimension.TIME, help="time T between scans, in seconds")
    region: Region | None = parameter(
        None, help="the region under surveillance; none: the box around what polar sensors see"
    )
    sensor: AnySensor = parameter(help="what measures")
    further_sensors: list[AnySensor] = parameter(
        default_factory=list, help="further sensors; the plots of all are merged in the order of time"
    )
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
        flat = next((sensor for sensor in self.sensors if not isinstance(sensor, PolarSensor)), None)
        if flat is not None and self.region is None:
            raise ValueError("region is missing; a cartesian sensor sees everything, so it must be given")
        for source in self.clutter:
            if flat is not None and source.over in ("volume", "sector"):
                raise ValueError(
                    f"clutter is over: {source.over}, and a cartesian sensor has no sector; "
                    "give over: region, or polar sensors alone"
                )
        return self

    @model_validator(mode="after")
    def _is_flat_or_not(self) -> Self:
        """Refuse parts that lie in the plane beside others that lie in space."""
        said = [("region", None if self.region is None else len(self.region.box.lower))]
        said += [
            (f"further_sensors[{index - 1}]" if index else "sensor", sensor.dimensions)
            for index, sensor in enumerate(self.sensors)
        ]
        said += [(f"targets[{index}]", len(target.position)) for index, target in enumerate(self.targets)]
        for index, source in enumerate(self.clutter):
            if source.region is not None:
                said.append((f"clutter[{index}].region", len(source.region.box.lower)))
        known = [(name, number) for name, number in said if number is not None]
        for name, number in known:
            if number != known[0][1]:
                words = {2: "in the plane (two numbers a vector, no z)", 3: "in space (three numbers, z)"}
                raise ValueError(
                    f"{known[0][0]} is {words[known[0][1]]}, {name} is {words[number]}; make them alike"
                )
        return self

    @property
    def sensors(self) -> list[AnySensor]:
        """All sensors."""
        return [self.sensor, *self.further_sensors]

    @property
    def dimensions(self) -> int:
        """2 in the plane, 3 in space."""
        if self.region is not None:
            return len(self.region.box.lower)
        return self.sensor.dimensions or 2

    @property
    def box(self) -> Box:
        """The region, or the box around what the sensors see."""
        if self.region is not None:
            return self.region.box
        boxes = [sensor.sector_box for sensor in self.sensors]
        known = [box for box in boxes if box is not None]
        return Box(
            tuple(map(min, zip(*(box.lower for box in known), strict=True))),
            tuple(map(max, zip(*(box.upper for box in known), strict=True))),
        )

    @property
    def last_time(self) -> float:
        """Time of the last scan of any sensor."""
        return max(
            sensor.first_scan + (self.scans - 1) * (sensor.period or self.interval) for sensor in self.sensors
        )

    @property
    def timetable(self) -> list[tuple[float, int, int]]:
        """The scans of all sensors in the order of time: time, which sensor, its own number of the scan."""
        return sorted(
            (sensor.first_scan + number * (sensor.period or self.interval), index, number)
            for index, sensor in enumerate(self.sensors)
            for number in range(self.scans)
        )

    @property
    def expected_clutter(self) -> float:
        """The number of plots of clutter that a batch is expected to hold."""
        return sum(source.expected(self.scans * len(self.sensors)) for source in self.clutter)

    @property
    def expected_plots(self) -> float:
        """The number of plots that a batch holds at the most, clutter as expected."""
        return self.expected_clutter + self.scans * len(self.sensors) * len(self.targets)

    def area(self, source: Clutter) -> Box:
        """Return where the plots of a source of clutter lie."""
        if source.over != "targets":
            return source.region.box if source.region is not None else self.box
        ends = [end for target in self.targets for end in target.ends(self.interval, self.last_time)]
        axes = list(zip(*ends, strict=True))
        return Box(tuple(map(min, axes)), tuple(map(max, axes)))

    @property
    def context(self) -> Context:
        """What an initiator is told of this scenario.

        With several sensors the interval is the mean one between scans, the detection probability
        the mean, σ the greatest of theirs, and the station that of the first.
        """
        noise = [self._typical_noise(sensor) for sensor in self.sensors]
        scans, interval = self.scans, self.sensor.period or self.interval
        if self.further_sensors:
            first = min(sensor.first_scan for sensor in self.sensors)
            scans *= len(self.sensors)
            interval = (self.last_time - first) / (scans - 1)
        return Context(
            scans,
            interval,
            sum(sensor.detection_probability for sensor in self.sensors) / len(self.sensors),
            tuple(map(max, zip(*noise, strict=True))),
            self.box,
            self.unit,
            self.sensor.station if isinstance(self.sensor, PolarSensor) else None,
        )

    def _typical_noise(self, sensor: CartesianSensor | PolarSensor) -> tuple[float, ...]:
        """Return the standard deviations on each axis: of a polar sensor, in the middle of its sector."""
        if not isinstance(sensor, PolarSensor):
            return sensor.axes(self.dimensions)
        middle = [0.5 * (low + high) for low, high in sensor.limits[: sensor.dimensions]]
        _, covariance = converted(np.array([middle]), np.array(sensor.sigmas))
        return tuple(map(float, np.sqrt(np.diagonal(covariance[0]))))


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
