"""Kinds of experiments that metrics are of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hough_tui.experiments.columns.clustering import ClusterColumns
from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.experiments.columns.schema import Columns


@dataclass(frozen=True, slots=True)
class Kind:
    """Kind of experiment.

    Attributes
    ----------
    world : the key of a row that names what was drawn; rows of other kinds do not have it
    columns : what each trial gives
    leading : the key of the metric that charts and comparisons show unless asked otherwise
    """

    world: str
    columns: type[Columns]
    leading: str


INITIATION = Kind("scenario", TrialColumns, "success_rate")
"""Initiators on scenarios."""

CLUSTERING = Kind("scene", ClusterColumns, "count_exact_rate")
"""Clusterings on scenes."""

KINDS = (INITIATION, CLUSTERING)
"""All of them."""


def kind_of(row: Mapping[str, Any]) -> Kind:
    """Return the kind of experiment that a row of a result document is of."""
    return next((kind for kind in KINDS if kind.world in row), INITIATION)
