"""Tallies of initiation: the per-trial columns of a cell into one row of rates with intervals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.intervals import mean_interval
from hough_tui.experiments.cases import Row
from hough_tui.experiments.columns.initiation import TrialColumns


def false_ratio(columns: TrialColumns) -> NDArray[np.float64]:
    """Return the ratio of false tracks to all tracks of each trial, 0 where a trial has no track."""
    ratio: NDArray[np.float64] = columns.false / np.maximum(columns.tracks, 1)
    return ratio


def tally(columns: TrialColumns, seconds: float) -> Row:
    """Return the figures of a cell's row.

    Parameters
    ----------
    columns : what each trial gave, at least one trial
    seconds : worker time from draw to score, the control left out
    """
    trials = len(columns.tracks)
    success = _rate(columns.found)
    control = _rate(columns.control_found)
    ratio = false_ratio(columns)
    return {
        "success_rate": success[0],
        "success_ci95": success[1],
        "success_by_target": [float(rate) for rate in columns.found.mean(axis=0)],
        "success_control": control[0],
        "success_control_ci95": control[1],
        "false_track_ratio": float(ratio.mean()),
        "false_track_ratio_ci95": list(mean_interval(ratio)),
        "false_tracks_per_trial": float(columns.false.mean()),
        "duplicates_per_trial": float(columns.duplicates.mean()),
        "tracks_per_trial": float(columns.tracks.mean()),
        "trials_without_track": int((columns.tracks == 0).sum()),
        "theta_rmse_deg": _rmse(np.degrees(columns.theta_error.astype(np.float64))),
        "rho_rmse": _rmse(columns.rho_error.astype(np.float64)),
        "votes_outside_per_trial": float(columns.votes_outside.mean()),
        "pure_track_ratio": _pure(columns),
        "effort_per_trial": {name: float(counted.mean()) for name, counted in columns.effort.items()},
        "seconds_per_trial": seconds / trials,
    }


def _rate(found: NDArray[np.bool_]) -> tuple[float | None, list[float] | None]:
    """Return the mean over trials and targets, with the interval of the per-trial means."""
    if found.size == 0:
        return None, None
    per_trial = found.mean(axis=1)
    return float(per_trial.mean()), list(mean_interval(per_trial))


def _pure(columns: TrialColumns) -> float | None:
    """Return the share of the matching tracks that hold plots of their target alone; None if unknown."""
    matching = int((columns.tracks - columns.false).sum())
    if matching == 0 or (columns.mixed < 0).any():
        return None
    return 1.0 - float(columns.mixed.sum()) / matching


def _rmse(errors: NDArray[np.float64]) -> float | None:
    known = errors[np.isfinite(errors)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else None
