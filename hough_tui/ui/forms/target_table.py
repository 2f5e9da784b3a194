"""The targets of a scenario, with their speeds and headings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from pydantic import BaseModel

from algorithms.parameters import Dimension, Path
from hough_tui.reports.numerals import significant
from hough_tui.ui.forms.columns import has
from hough_tui.ui.forms.edits import Edit, data_of
from hough_tui.ui.forms.fields import FieldDescription, unit_text
from hough_tui.ui.forms.list_table import ListTable
from scenarios.model import Scenario
from scenarios.sensors import PolarSensor
from scenarios.targets import Target

PART = 0.25
"""The part of the region that a new target crosses within the batch."""


class TargetTable(ListTable):
    """A row for each target; its first speed and heading (clockwise from north) are worked out."""

    def is_of_use(self, column: FieldDescription) -> bool:
        """Leave out what no motion has, and extents where no sensor resolves them."""
        scenario = self._holder
        if column.path[0] == "motion":
            return any(has(element, column) for element in self._elements)
        return column.path[0] != "extended" or not isinstance(scenario, Scenario) or scenario.is_resolved

    def worked_out(self) -> Sequence[tuple[str, str]]:
        return ("Speed", unit_text(Dimension.SPEED, self._unit)), ("Heading", "°")

    def worked_out_cells(self, element: BaseModel) -> Sequence[str]:
        assert isinstance(element, Target)
        # As it begins: through waypoints it does not fly where its velocity points.
        velocity = element.course(np.zeros(1))[1][0]
        east, north = velocity[:2]
        speed = significant(math.hypot(*velocity))
        if east == 0.0 and north == 0.0:
            # At rest, or straight up or down.
            return speed, ""
        return speed, f"{math.degrees(math.atan2(east, north)) % 360.0:.1f}"

    def edit_of(self, element: BaseModel, base: Path, path: Path, value: Any) -> Edit:
        """Return what to ask of the set; another motion begins as one that the target can have."""
        if path[len(base) :] != ("motion", "kind"):
            return super().edit_of(element, base, path, value)
        assert isinstance(element, Target)
        return path[:-1], {"kind": value, **self._started(element, value)}

    def _started(self, target: Target, kind: str) -> dict[str, Any]:
        """Return the fields with which a motion of a kind begins; the noise is that of the motion before."""
        kept = data_of(target.motion)
        start: dict[str, Any] = {"process_noise": kept["process_noise"]} if "process_noise" in kept else {}
        if kind == "acceleration":
            return {**start, "acceleration": [0.0] * len(target.position)}
        if kind == "turn":
            return {**start, "rate_deg": 1.0}
        if kind == "waypoints":
            # Straight ahead, so that the path stays what it is until the point is moved.
            scenario = self._holder
            assert isinstance(scenario, Scenario)
            elapsed = 0.5 * (scenario.scans - 1) * scenario.interval or scenario.interval
            ahead = zip(target.position, target.velocity, strict=True)
            return {**start, "points": [[float(f"{place + speed * elapsed:.6g}") for place, speed in ahead]]}
        return start

    def new_element(self) -> dict[str, Any]:
        """Return a target in the middle of the region, eastward bound, as fast as the last one that moves."""
        scenario = self._holder
        if not isinstance(scenario, Scenario):
            return super().new_element()
        box = scenario.box
        speeds = [math.hypot(*target.velocity) for target in scenario.targets]
        across = PART * (box.upper[0] - box.lower[0]) / (scenario.scans * scenario.interval)
        speed = next(filter(None, reversed(speeds)), across)
        # One figure or three: a start to be edited, not a result.
        digits = 1 if speed == across else 3
        velocity = [float(f"{speed:.{digits}g}"), *[0.0] * (scenario.dimensions - 1)]
        return {"position": _middle(scenario), "velocity": velocity}


def _middle(scenario: Scenario) -> list[float]:
    """Return the middle of what the first sensor sees; the middle of a box around it may lie outside."""
    sensor = scenario.sensor
    if not isinstance(sensor, PolarSensor):
        return list(scenario.box.centre)
    distance, azimuth, elevation = (0.5 * (low + high) for low, high in sensor.limits)
    if sensor.dimensions == 2:
        elevation = 0.0
    ground = distance * math.cos(elevation)
    offset = ground * math.sin(azimuth), ground * math.cos(azimuth), distance * math.sin(elevation)
    return [
        round(place + by, -int(math.log10(distance)) + 2)
        for place, by in zip(sensor.station, offset, strict=False)
    ]
