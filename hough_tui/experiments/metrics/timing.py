"""Metrics of time, whatever runs."""

from __future__ import annotations

from hough_tui.experiments.metrics.estimators import Single
from hough_tui.experiments.metrics.metric import AnySample, Metric

METRICS: tuple[Metric[AnySample], ...] = (
    Metric(
        key="seconds_per_trial",
        kind=None,
        words="time a trial",
        definition="Processor time of a worker from draw to score, the control left out.",
        values=lambda sample: sample.seconds / len(sample.columns),
        estimator=Single(),
        unit="s",
        rank=65,
    ),
)
