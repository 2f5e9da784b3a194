"""The further sensors of a scenario."""

from __future__ import annotations

from typing import Any

from hough_tui.ui.forms.edits import data_of
from hough_tui.ui.forms.list_table import ListTable
from scenarios.model import Scenario


class SensorTable(ListTable):
    """A row for each further sensor; a new one is like the scenario's first."""

    def new_element(self) -> dict[str, Any]:
        """Return the scenario's own sensor once more: any other kind may not go with its targets."""
        if not isinstance(self._holder, Scenario):
            return super().new_element()
        data: dict[str, Any] = data_of(self._holder.sensor)
        return {"kind": self._holder.sensor.kind, **data}
