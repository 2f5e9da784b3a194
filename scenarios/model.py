"""Scenarios and sets of them, as validated models: each field is declared once."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, field_validator, model_validator

from algorithms.clustering.points import FARTHEST
from algorithms.context import Box, Context, Unit
from algorithms.parameters import (
    LARGEST,
    Count,
    Declared,
    Dimension,
    Name,
    Positive,
    missing_either,
    parameter,
)
from scenarios.clutter import MOST_PLOTS, AnyClutter, Clutter, Region
from scenarios.conversion import converted
from scenarios.entries import WITHOUT_CLUSTERING, AnyClusteringEntry, Entry, InitiatorEntry
from scenarios.experiments import AnyExperiment, Experiment
from scenarios.scenes import Scene
from scenarios.sensors import AnySensor, CartesianSensor, PolarSensor
from scenarios.targets import Target

MOST_STEPS = 1_000_000
"""The most intervals in which the noise of a motion may be drawn."""

MOST_DEVIATIONS = 10.0
"""No normal number that is drawn is farther from the mean, in standard deviations."""


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
    def _is_disturbed_seldom_enough(self) -> Self:
        """Refuse process noise over more intervals than anyone would wait for in every trial."""
        steps = self.last_time / self.interval
        for index, target in enumerate(self.targets):
            if target.motion.is_disturbed and steps > MOST_STEPS:
                raise ValueError(
                    f"targets[{index}] has process noise, drawn in each of {steps:,.0f} intervals until the "
                    f"last scan; the limit is {MOST_STEPS:,}; give a longer interval or an earlier last scan"
                )
        return self

    @model_validator(mode="after")
    def _stays_within_bounds(self) -> Self:
        """Refuse times, places and cells that follow from numbers within their bounds, and lie beyond."""
        last = self.last_time
        if last > LARGEST:
            raise ValueError(f"the last scan is at {last:g} s; no time may be greater than {LARGEST:g} s")
        for index, target in enumerate(self.targets):
            end = max(map(abs, target.ends(self.interval, last)[1]))
            if end > LARGEST:
                raise ValueError(
                    f"targets[{index}] has a coordinate of {end:g} in its last scan; none may be greater "
                    f"than {LARGEST:g}; give a lower speed, or fewer scans"
                )
        for sensor in self.sensors:
            resolution = sensor.resolution if isinstance(sensor, PolarSensor) else None
            if isinstance(sensor, PolarSensor) and resolution is not None:
                spread = max((one.extended.range_spread for one in self.targets if one.extended), default=0.0)
                farthest = sensor.range[1] + MOST_DEVIATIONS * (spread + sensor.sigma_range)
                if farthest / resolution.range_cell > FARTHEST:
                    raise ValueError(
                        f"range_cell {resolution.range_cell:g} is given, and points lie up to {farthest:.3g} "
                        f"far; the limit is {FARTHEST:g} cells; give a larger range_cell"
                    )
        return self

    @model_validator(mode="after")
    def _is_resolved_or_not(self) -> Self:
        """Refuse extended targets that no sensor resolves, and sensors that do not all give points."""
        resolved = [getattr(sensor, "resolution", None) is not None for sensor in self.sensors]
        if any(resolved) and not all(resolved):
            raise ValueError("some sensors have a resolution and some have none; make them alike")
        for index, target in enumerate(self.targets):
            if target.extended is not None and not any(resolved):
                raise ValueError(
                    f"targets[{index}] is extended, and no sensor tells its points apart; give the sensor a "
                    "resolution, or leave extended out"
                )
        for index, source in enumerate(self.clutter):
            if any(resolved) and source.over not in ("volume", "sector"):
                raise ValueError(
                    f"clutter[{index}] is over: {source.over}, and a sensor with a resolution sees its "
                    "sector alone; give over: sector or over: volume"
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
    def is_resolved(self) -> bool:
        """Whether its sensors have a high resolution, so that a target is many points."""
        return isinstance(self.sensor, PolarSensor) and self.sensor.resolution is not None

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
        """The number of plots, or points, that a batch holds at the most, clutter as expected."""
        each = sum(target.extended.points if target.extended is not None else 1 for target in self.targets)
        return self.expected_clutter + self.scans * len(self.sensors) * each

    def area(self, source: Clutter) -> Box:
        """Return where the plots of a source of clutter lie."""
        if source.over != "targets":
            return source.region.box if source.region is not None else self.box
        times = np.array([time for time, _, _ in self.timetable])
        ends = [target.ends(self.interval, self.last_time) for target in self.targets]
        paths = [target.path(times, self.interval) for target in self.targets]
        return Box.around(np.vstack([*ends, *paths]))

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
            # One scan each, all at one time, leave no time between them.
            interval = (self.last_time - first) / (scans - 1) or interval
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


class ScenarioSet(Declared):
    """Scenarios, initiators with their parameters, and experiments; the same of clustering."""

    model_config = ConfigDict(
        title="hough-tui scenario set",
        populate_by_name=True,
        json_schema_extra={
            "anyOf": [
                {"required": [part], "properties": {part: {"minItems": 1}}}
                for part in ("scenarios", "scenes")
            ]
        },
    )

    version: Literal[1] = parameter(1, help="the version of this layout", alias="schema")
    name: Name = parameter(help="what the set is called")
    description: str = parameter("", help="what it is for")
    scenes: list[Scene] = parameter(
        default_factory=list, help="scenes of the range-Doppler plane, whose points are clustered"
    )
    scenarios: Annotated[list[Scenario], Field(validate_default=True)] = parameter(
        default_factory=list, help="the scenarios"
    )
    initiators: list[Entry] = parameter(default_factory=list, help="the initiators with their parameters")
    clusterings: list[AnyClusteringEntry] = parameter(
        default_factory=list, help="the ways to cluster points, with their parameters"
    )
    experiments: list[AnyExperiment] = parameter(default_factory=list, help="the experiments")

    @field_validator("scenarios")
    @classmethod
    def _or_scenes(cls, scenarios: list[Scenario], others: ValidationInfo) -> list[Scenario]:
        # Scenes that are not as declared are told of as such.
        if not scenarios and not others.data.get("scenes", True):
            raise missing_either("scenes in place of it")
        return scenarios

    def scenario(self, name: str) -> Scenario:
        """Return the scenario of a name that the set is known to have."""
        return next(found for found in self.scenarios if found.name == name)

    def scene(self, name: str) -> Scene:
        """Return the scene of a name that the set is known to have."""
        return next(found for found in self.scenes if found.name == name)

    def entry(self, name: str) -> InitiatorEntry:
        """Return the initiator entry of a name that the set is known to have."""
        return next(found for found in self.initiators if found.name == name)

    def chosen(self, experiment: Experiment, part: str) -> list[Any]:
        """Return the elements of a list that an experiment runs with; none where its kind takes none.

        Parameters
        ----------
        part : the list, such as `scenarios`; an experiment that names none of it takes all
        """
        if part not in experiment.parts:
            return []
        listed, names = getattr(self, part), getattr(experiment, part)
        if names is None:
            return list(listed)
        known = {**WITHOUT_CLUSTERING, **{element.name: element for element in listed}}
        return [known[name] for name in names]

    def chosen_scenarios(self, experiment: Experiment) -> list[Scenario]:
        """Return the scenarios of an experiment; none of one of clustering."""
        return self.chosen(experiment, "scenarios")

    def chosen_entries(self, experiment: Experiment) -> list[InitiatorEntry]:
        """Return the initiator entries of an experiment; none of one of clustering."""
        return self.chosen(experiment, "initiators")
