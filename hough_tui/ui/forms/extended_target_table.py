"""The targets of a scene of the range-Doppler plane, with what they spread over."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel

from hough_tui.reports.numerals import significant
from hough_tui.ui.forms.list_table import ListTable
from scenarios.scenes import ExtendedTarget, Scene

WIDTH = 2.0 * math.sqrt(2.0)
"""Of an extent, in standard deviations, as clustering measures it."""


class ExtendedTargetTable(ListTable):
    """A row for each target; the extents by which clustering judges it are worked out."""

    def worked_out(self) -> Sequence[tuple[str, str]]:
        return ("Range extent", ""), ("Doppler extent", "")

    def worked_out_cells(self, element: BaseModel) -> Sequence[str]:
        assert isinstance(element, ExtendedTarget)
        return [significant(WIDTH * deviation) for deviation in element.spread]

    def new_element(self) -> dict[str, Any]:
        """Return a target in the middle of the region."""
        scene = self._holder
        if not isinstance(scene, Scene):
            return super().new_element()
        return {
            "range": 0.5 * sum(scene.region.range),
            "doppler": 0.5 * sum(scene.region.doppler),
        }
