"""Metrics of initiation: success, false tracks and duplicates, exactness, work."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.experiments.metrics.estimators import (
    Array,
    Mean,
    MeanByName,
    MeanByTarget,
    MeanCount,
    PooledShare,
    RootMeanSquare,
    Share,
    Total,
    mean_over_targets,
)
from hough_tui.experiments.metrics.metric import Kind, Metric, Sample

if TYPE_CHECKING:
    from hough_tui.experiments.chunks.initiation import InitiationCell

    TrackSample = Sample[InitiationCell, TrialColumns]

INITIATION = Kind("scenario", TrialColumns, "success_rate")
"""Experiments of initiators on scenarios."""


def _share_of_targets(found: NDArray[np.bool_]) -> Array:
    """Return the share of the targets of each trial; NaN without targets."""
    if found.shape[1] == 0:
        return np.full(len(found), np.nan)
    share: Array = found.mean(axis=1)
    return share


def _false_ratio(sample: TrackSample) -> Array:
    ratio: Array = sample.columns.false / np.maximum(sample.columns.tracks, 1)
    return ratio


def _pure_and_matching(sample: TrackSample) -> Array:
    """Return the numbers of pure and of matching tracks of each trial; NaN where plots are not at hand."""
    matching = (sample.columns.tracks - sample.columns.false).astype(np.float64)
    counts = np.stack([matching - sample.columns.mixed, matching], axis=1)
    counts[sample.columns.mixed < 0] = np.nan
    return counts


def _squares(errors: NDArray[np.float32]) -> Array:
    squares: Array = errors.astype(np.float64) ** 2
    return squares


METRICS: tuple[Metric[TrackSample], ...] = (
    Metric(
        key="success_rate",
        kind=INITIATION,
        words="success",
        definition="Share of the targets that at least one track matches, over targets and trials.",
        values=lambda sample: _share_of_targets(sample.columns.found),
        estimator=Share(),
        unit="%",
        rank=0,
        interval_rank=20,
    ),
    Metric(
        key="success_by_target",
        kind=INITIATION,
        words="success by target",
        definition="Share of the trials in which at least one track matches the target, for each target.",
        values=lambda sample: sample.columns.found,
        estimator=MeanByTarget(),
        unit="%",
    ),
    Metric(
        key="success_control",
        kind=INITIATION,
        words="control",
        definition="Success on the same draws with all plots of targets taken out: what chance alone gives.",
        values=lambda sample: _share_of_targets(sample.columns.control_found),
        estimator=Share(),
        unit="%",
        rank=10,
    ),
    Metric(
        key="false_track_ratio",
        kind=INITIATION,
        words="false",
        definition="Share of the tracks of a trial that match no target, 0 where it has no track; the mean "
        "over trials.",
        values=_false_ratio,
        estimator=Share(),
        unit="%",
        rank=0,
        interval_rank=75,
    ),
    Metric(
        key="false_tracks_per_trial",
        kind=INITIATION,
        words="false tracks a trial",
        definition="Number of tracks that match no target.",
        values=lambda sample: sample.columns.false,
        estimator=MeanCount(),
        heading="false\n/trial",
        rank=30,
    ),
    Metric(
        key="duplicates_per_trial",
        kind=INITIATION,
        words="duplicates a trial",
        definition="Number of tracks that match only targets which an earlier track of the trial matches.",
        values=lambda sample: sample.columns.duplicates,
        estimator=MeanCount(),
        heading="duplic.\n/trial",
        rank=40,
    ),
    Metric(
        key="tracks_per_trial",
        kind=INITIATION,
        words="tracks a trial",
        definition="Number of tracks.",
        values=lambda sample: sample.columns.tracks,
        estimator=MeanCount(),
        heading="tracks\n/trial",
        rank=70,
    ),
    Metric(
        key="pure_track_ratio",
        kind=INITIATION,
        words="pure tracks",
        definition="Share of the matching tracks of all trials that hold plots of one target alone.",
        values=_pure_and_matching,
        estimator=PooledShare(),
        heading="pure\n%",
        unit="%",
        rank=60,
    ),
    Metric(
        key="theta_rmse_deg",
        kind=INITIATION,
        words="θ RMSE",
        definition="Root of the mean squared error in θ of the matching track of the highest score, over all "
        "found targets.",
        values=lambda sample: np.degrees(sample.columns.theta_error.astype(np.float64)) ** 2,
        estimator=RootMeanSquare(),
        unit="°",
        rank=50,
    ),
    Metric(
        key="rho_rmse",
        kind=INITIATION,
        words="ρ RMSE",
        definition="Root of the mean squared error in ρ of the same tracks.",
        values=lambda sample: _squares(sample.columns.rho_error),
        estimator=RootMeanSquare(),
        unit="{length}",
        rank=60,
    ),
    Metric(
        key="theta_mse",
        kind=INITIATION,
        words="θ MSE",
        definition="Mean squared error in θ over the found targets of a trial; the mean over trials.",
        values=lambda sample: mean_over_targets(_squares(sample.columns.theta_error)),
        estimator=Mean(least=0.0),
        unit="rad²",
        rank=None,
    ),
    Metric(
        key="rho_mse",
        kind=INITIATION,
        words="ρ MSE",
        definition="Mean squared error in ρ over the found targets of a trial; the mean over trials.",
        values=lambda sample: mean_over_targets(_squares(sample.columns.rho_error)),
        estimator=Mean(least=0.0),
        unit="{length}²",
        rank=None,
    ),
    Metric(
        key="no_track_rate",
        kind=INITIATION,
        words="trials without a track",
        definition="Share of the trials in which there is no track at all.",
        values=lambda sample: sample.columns.tracks == 0,
        estimator=Share(),
        heading="no track\n%",
        unit="%",
        rank=80,
        is_hidden_at_zero=True,
    ),
    Metric(
        key="trials_without_track",
        kind=INITIATION,
        words="number of trials without a track",
        definition="Number of trials in which there is no track at all.",
        values=lambda sample: sample.columns.tracks == 0,
        estimator=Total(),
        rank=None,
    ),
    Metric(
        key="votes_outside_per_trial",
        kind=INITIATION,
        words="votes outside the grid a trial",
        definition="Number of votes that fall outside the grid.",
        values=lambda sample: sample.columns.votes_outside,
        estimator=MeanCount(),
        heading="votes out\n/trial",
        rank=None,
    ),
    Metric(
        key="effort_per_trial",
        kind=INITIATION,
        words="work a trial",
        definition="What the initiator counts of its work, such as pairs of plots; the mean of each.",
        values=lambda sample: sample.columns.effort,
        estimator=MeanByName(),
        rank=None,
    ),
)
