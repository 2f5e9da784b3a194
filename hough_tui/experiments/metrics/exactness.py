"""Metrics of initiation: how exact tracks are, as lines, as states and as a set."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.metrics.estimators import (
    Array,
    Mean,
    MeanSquare,
    RootMeanSquare,
    Squares,
    mean_over_targets,
)
from hough_tui.experiments.metrics.kinds import INITIATION
from hough_tui.experiments.metrics.metric import Metric

if TYPE_CHECKING:
    from hough_tui.experiments.metrics.initiation import TrackSample


def _squares(errors: NDArray[np.float32]) -> Array:
    squares: Array = errors.astype(np.float64) ** 2
    return squares


def _normalised_squares(sample: TrackSample) -> Squares:
    components = 2 * min(sample.cell.entry.algorithm.dimensions, sample.cell.scenario.dimensions)
    return Squares(sample.columns.nees.astype(np.float64), components)


def _gospa(
    key: str, words: str, definition: str, parts: tuple[str, ...], heading: str, rank: int | None = None
) -> Metric[TrackSample]:
    """Return the metric of some parts of the squared GOSPA distance."""

    def squares(sample: TrackSample) -> Array:
        columns = [getattr(sample.columns, f"gospa_{part}").astype(np.float64) for part in parts]
        total: Array = np.sum(columns, axis=0)
        return total

    return Metric(
        key=key,
        kind=INITIATION,
        words=words,
        definition=definition,
        values=squares,
        estimator=RootMeanSquare(),
        heading=f"{heading}\n{{length}}",
        unit="{length}",
        rank=rank,
    )


METRICS: tuple[Metric[TrackSample], ...] = (
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
        key="position_rmse",
        kind=INITIATION,
        words="position RMSE",
        definition="Root of the mean squared error in the initial position of the track that stands for a "
        "found target, at the track's first scan; that is the matching one of the highest score, of equals "
        "the first.",
        values=lambda sample: _squares(sample.columns.position_error),
        estimator=RootMeanSquare(),
        heading="position\nRMSE {length}",
        unit="{length}",
        rank=52,
    ),
    Metric(
        key="velocity_rmse",
        kind=INITIATION,
        words="velocity RMSE",
        definition="Root of the mean squared error of the initial velocity of the same tracks.",
        values=lambda sample: _squares(sample.columns.velocity_error),
        estimator=RootMeanSquare(),
        heading="velocity\nRMSE {length}/s",
        unit="{length}/s",
        rank=53,
    ),
    Metric(
        key="cross_track_rmse",
        kind=INITIATION,
        words="cross-track RMSE",
        definition="Root of the mean squared distance of the same tracks across the target's course, in the "
        "middle of its path.",
        values=lambda sample: _squares(sample.columns.cross_track_error),
        estimator=RootMeanSquare(),
        heading="cross-track\nRMSE {length}",
        unit="{length}",
        rank=72,
    ),
    Metric(
        key="nees",
        kind=INITIATION,
        words="NEES",
        definition="Mean normalised estimation error squared of the initial states of the same tracks: 4 in "
        "the plane and 6 in space where their covariances are right.",
        values=_normalised_squares,
        estimator=MeanSquare(),
        heading="NEES",
        rank=56,
    ),
    _gospa(
        "gospa",
        "GOSPA",
        "Root of the mean squared GOSPA distance (order 2) of tracks, at their first scans, and targets.",
        ("localisation", "missed", "false"),
        "GOSPA",
        rank=74,
    ),
    _gospa(
        "gospa_localisation",
        "GOSPA of localisation",
        "Part of GOSPA by the distances of tracks from their targets.",
        ("localisation",),
        "GOSPA loc.",
    ),
    _gospa(
        "gospa_missed",
        "GOSPA of missed targets",
        "Part of GOSPA by targets without a track; the squares of the three parts add up to that of GOSPA.",
        ("missed",),
        "GOSPA miss.",
    ),
    _gospa(
        "gospa_false",
        "GOSPA of false tracks",
        "Part of GOSPA by tracks without a target.",
        ("false",),
        "GOSPA false",
    ),
)
