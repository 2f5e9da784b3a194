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
    Quantile,
    Share,
    Total,
)
from hough_tui.experiments.metrics.kinds import INITIATION
from hough_tui.experiments.metrics.metric import Metric, Sample

if TYPE_CHECKING:
    from hough_tui.experiments.chunks.initiation import InitiationCell

    TrackSample = Sample[InitiationCell, TrialColumns]


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


def _scans_to_initiate(sample: TrackSample) -> Array:
    scans = sample.columns.scans_to_initiate
    return np.where(scans > 0, scans, np.nan)


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
        key="scans_to_initiate",
        kind=INITIATION,
        words="scans to initiate",
        definition="Number of scans from a target's first to the one in which a track on it is confirmed, "
        "the mean over all found targets.",
        values=_scans_to_initiate,
        estimator=Mean(least=1.0),
        heading="initiated\nscans",
        unit="scans",
        rank=68,
    ),
    Metric(
        key="scans_to_initiate_p90",
        kind=INITIATION,
        words="scans in which 90 % are initiated",
        definition="Number of scans by which nine of ten found targets have a confirmed track.",
        values=_scans_to_initiate,
        estimator=Quantile(0.9),
        heading="90 % in\nscans",
        unit="scans",
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
