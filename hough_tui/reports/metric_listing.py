"""The list of metrics as a table and as a document."""

from __future__ import annotations

from typing import Any

from hough_tui.experiments.metrics.kinds import KINDS
from hough_tui.experiments.metrics.registry import METRICS, AnyMetric
from hough_tui.reports.layout import Column, Sheet, repeats

SHOWN = {True: "yes", False: ""}


def metric_sheet() -> Sheet:
    """Return the metrics with their definitions."""
    metrics = list(METRICS.values())
    kinds = tuple(_kind_words(metric) for metric in metrics)
    columns = (
        Column("of", kinds, prose=True, rank=20, styles=repeats(kinds)),
        Column("metric", tuple(metric.key for metric in metrics), prose=True),
        Column("unit", tuple(_unit_words(metric) for metric in metrics), prose=True, rank=10),
        Column("definition", tuple(metric.definition for metric in metrics), prose=True),
        Column(
            "interval",
            tuple(SHOWN[metric.interval_key is not None] for metric in metrics),
            prose=True,
            rank=30,
        ),
    )
    note = "The 95 % interval of a metric that has one is METRIC_ci95, in documents and in --columns."
    return Sheet("metrics", columns, (note,))


def metric_document() -> dict[str, Any]:
    """Return the metrics as scripts read them."""
    return {
        "metrics": [
            {
                "key": metric.key,
                "of": [kind.world for kind in KINDS if metric.kind in (kind, None)],
                "name": metric.words,
                "unit": _unit_words(metric),
                "definition": metric.definition,
                "interval": metric.interval_key,
            }
            for metric in METRICS.values()
        ]
    }


def _kind_words(metric: AnyMetric) -> str:
    return "any" if metric.kind is None else f"{metric.kind.world}s"


def _unit_words(metric: AnyMetric) -> str:
    """Return the unit, `length` for the scenario's unit of length."""
    return metric.unit.format(length="length")
