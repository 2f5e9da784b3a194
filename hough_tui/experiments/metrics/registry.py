"""The list of metrics, in the order in which documents have them and charts offer them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from algorithms.errors import RequestError
from algorithms.parameters import unknown
from hough_tui.experiments.columns.schema import Columns
from hough_tui.experiments.metrics import clustering, exactness, initiation, timing
from hough_tui.experiments.metrics.kinds import INITIATION, KINDS, Kind, kind_of
from hough_tui.experiments.metrics.metric import Metric

AnyMetric = Metric[Any]

LISTS: tuple[Sequence[AnyMetric], ...] = (
    initiation.METRICS,
    exactness.METRICS,
    clustering.METRICS,
    timing.METRICS,
)

METRICS: dict[str, AnyMetric] = {metric.key: metric for metrics in LISTS for metric in metrics}
"""All metrics by key. Whatever shows, writes or offers metrics loops over them when it is called."""


def metric(key: str) -> AnyMetric:
    """Return a metric.

    Raises
    ------
    RequestError
        Where there is none of that key.
    """
    if key not in METRICS:
        raise RequestError(unknown(key, list(METRICS), "metric"))
    return METRICS[key]


def metrics_of(kind: Kind) -> Iterator[AnyMetric]:
    """Yield the metrics of a kind of experiment."""
    return (metric for metric in METRICS.values() if metric.kind in (kind, None))


def metrics_of_columns(columns: Columns) -> Iterator[AnyMetric]:
    """Yield the metrics that per-trial columns give."""
    (kind,) = (kind for kind in KINDS if kind.columns is type(columns))
    return metrics_of(kind)


def leading_metric(rows: Sequence[Mapping[str, Any]]) -> AnyMetric:
    """Return what a chart or comparison of rows shows unless asked otherwise."""
    return metric(kind_of(rows[0]).leading if rows else INITIATION.leading)
