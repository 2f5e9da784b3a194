"""Metrics of clustering: how well targets are counted and placed, and what it costs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hough_tui.experiments.columns.clustering import ClusterColumns
from hough_tui.experiments.metrics.estimators import Mean, MeanCount, RootMeanSquare, Share, Total
from hough_tui.experiments.metrics.kinds import CLUSTERING
from hough_tui.experiments.metrics.metric import Metric, Sample

if TYPE_CHECKING:
    from hough_tui.experiments.chunks.clustering import ClusteringCell

    ClusterSample = Sample[ClusteringCell, ClusterColumns]

METRICS: tuple[Metric[ClusterSample], ...] = (
    Metric(
        key="count_exact_rate",
        kind=CLUSTERING,
        words="exact counts",
        definition="Share of the trials with as many clusters as targets.",
        values=lambda sample: sample.columns.excess == 0,
        estimator=Share(),
        heading="exact\n%",
        unit="%",
        rank=0,
        interval_rank=20,
    ),
    Metric(
        key="too_few_rate",
        kind=CLUSTERING,
        words="too few clusters",
        definition="Share of the trials with fewer clusters than targets.",
        values=lambda sample: sample.columns.excess < 0,
        estimator=Share(),
        heading="too few\n%",
        unit="%",
        rank=40,
    ),
    Metric(
        key="too_many_rate",
        kind=CLUSTERING,
        words="too many clusters",
        definition="Share of the trials with more clusters than targets.",
        values=lambda sample: sample.columns.excess > 0,
        estimator=Share(),
        heading="too many\n%",
        unit="%",
        rank=40,
    ),
    Metric(
        key="excess_per_trial",
        kind=CLUSTERING,
        words="excess clusters a trial",
        definition="Number of clusters less that of targets.",
        values=lambda sample: sample.columns.excess,
        estimator=Mean(),
        heading="excess\n/trial",
        rank=50,
    ),
    Metric(
        key="clusters_per_trial",
        kind=CLUSTERING,
        words="clusters a trial",
        definition="Number of clusters.",
        values=lambda sample: sample.columns.clusters,
        estimator=MeanCount(),
        heading="clusters\n/trial",
        rank=None,
    ),
    Metric(
        key="centroid_rmse",
        kind=CLUSTERING,
        words="centroid RMSE",
        definition="Root of the mean squared distance from a target's centre to the nearest plot, over the "
        "trials that have a plot.",
        values=lambda sample: sample.columns.trial_square,
        estimator=RootMeanSquare(),
        heading="RMSE\ncells",
        unit="cells",
        rank=10,
        interval_rank=30,
    ),
    Metric(
        key="trials_without_plot",
        kind=CLUSTERING,
        words="trials without a plot",
        definition="Number of trials in which there is no plot at all.",
        values=lambda sample: sample.columns.clusters == 0,
        estimator=Total(),
        rank=None,
    ),
)
