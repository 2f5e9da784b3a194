"""The further sensors of a scenario."""

from __future__ import annotations

from typing import Any

from hough_tui.ui.forms.columns import has
from hough_tui.ui.forms.edits import data_of
from hough_tui.ui.forms.fields import FieldDescription
from hough_tui.ui.forms.list_table import ListTable
from scenarios.model import Scenario


class SensorTable(ListTable):
    """A row for each further sensor; a new one is like the scenario's first."""

    def is_of_use(self, column: FieldDescription) -> bool:
        """Leave out what none of the sensors has, and resolution, which sensors in space have not."""
        scenario = self._holder
        if column.path[0] == "resolution" and isinstance(scenario, Scenario) and scenario.dimensions == 3:
            return False
        return any(has(element, column) for element in self._elements)

    def new_element(self) -> dict[str, Any]:
        """Return the scenario's own sensor once more: any other kind may not go with its targets."""
        if not isinstance(self._holder, Scenario):
            return super().new_element()
        data: dict[str, Any] = data_of(self._holder.sensor)
        return {"kind": self._holder.sensor.kind, **data}
