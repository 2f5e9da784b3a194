"""The targets of a scenario, with their speeds and headings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel

from algorithms.parameters import Dimension
from hough_tui.reports.numerals import significant
from hough_tui.ui.forms.fields import FieldDescription, unit_text
from hough_tui.ui.forms.list_table import ListTable
from scenarios.model import Scenario
from scenarios.targets import Target

PART = 0.25
"""The part of the region that a new target crosses within the batch."""


class TargetTable(ListTable):
    """A row for each target; speed and heading (clockwise from north) are worked out."""

    def shown(self, columns: tuple[FieldDescription, ...]) -> tuple[FieldDescription, ...]:
        """Leave the extent out where the scenario has no sensor to which a target is more than a plot."""
        if isinstance(self._holder, Scenario) and self._holder.is_resolved:
            return columns
        return tuple(column for column in columns if column.path[0] != "extended")

    def worked_out(self) -> Sequence[tuple[str, str]]:
        return ("Speed", unit_text(Dimension.SPEED, self._unit)), ("Heading", "°")

    def worked_out_cells(self, element: BaseModel) -> Sequence[str]:
        assert isinstance(element, Target)
        east, north = element.velocity[:2]
        if element.stands_still:
            return "0", ""
        return significant(math.hypot(east, north)), f"{math.degrees(math.atan2(east, north)) % 360.0:.1f}"

    def new_element(self) -> dict[str, Any]:
        """Return a target in the middle of the region, eastward bound."""
        scenario = self._holder
        if not isinstance(scenario, Scenario):
            return super().new_element()
        box = scenario.box
        speed = PART * (box.upper[0] - box.lower[0]) / (scenario.scans * scenario.interval)
        # One figure: a start to be edited, not a result.
        velocity = [float(f"{speed:.1g}"), *[0.0] * (scenario.dimensions - 1)]
        return {"position": list(box.centre), "velocity": velocity}
