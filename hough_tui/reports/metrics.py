"""What the quantities of a result row are called, and which are shares of 1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Metric:
    """One measured quantity.

    Attributes
    ----------
    words : its name for people, without a unit
    unit : `%`, `°`, …; empty for a plain number
    share : it lies between 0 and 1 and is shown as per cent
    interval : the key of its interval in a row, if it has one
    """

    words: str
    unit: str = ""
    share: bool = False
    interval: str | None = None

    @property
    def label(self) -> str:
        """Name and unit."""
        return f"{self.words} {self.unit}".rstrip()


KNOWN = {
    "success_rate": Metric("success", "%", True, "success_ci95"),
    "success_control": Metric("control", "%", True, "success_control_ci95"),
    "false_track_ratio": Metric("false", "%", True, "false_track_ratio_ci95"),
    "p_detection": Metric("detection", "%", True),
    "false_tracks_per_trial": Metric("false tracks a trial"),
    "duplicates_per_trial": Metric("duplicates a trial"),
    "tracks_per_trial": Metric("tracks a trial"),
    "pure_track_ratio": Metric("pure tracks", "%", True),
    "trials_without_track": Metric("trials without track"),
    "votes_outside_per_trial": Metric("votes outside the grid a trial"),
    "theta_rmse_deg": Metric("θ RMSE", "°"),
    "rho_rmse": Metric("ρ RMSE"),
    "theta_mse": Metric("θ MSE", "rad²"),
    "rho_mse": Metric("ρ MSE"),
    "count_exact_rate": Metric("exact counts", "%", True, "count_exact_ci95"),
    "too_few_rate": Metric("too few clusters", "%", True),
    "too_many_rate": Metric("too many clusters", "%", True),
    "excess_per_trial": Metric("excess clusters a trial"),
    "clusters_per_trial": Metric("clusters a trial"),
    "centroid_rmse": Metric("centroid RMSE", "cells", interval="centroid_rmse_ci95"),
    "centroid_mse": Metric("centroid MSE", "cells²"),
    "seconds_per_trial": Metric("time a trial", "s"),
}


def metric(name: str) -> Metric:
    """Return what a metric is called; one that is not known goes by its own name."""
    if name in KNOWN:
        return KNOWN[name]
    words = name.replace("_", " ")
    if name.endswith(("_rate", "_ratio")):
        return Metric(words, "%", True)
    if name.endswith("_deg"):
        return Metric(words.removesuffix(" deg"), "°")
    return Metric(words)


PARTS = ("scenario", "initiator", "scene", "clustering")
"""What rows are told apart by, and swept fields begin with."""


def field_name(key: str) -> str:
    """Return a swept key without the part that says where its field belongs."""
    part, _, rest = key.partition(".")
    return rest if rest and part in PARTS else key


def leading_metric(row: Mapping[str, object]) -> str:
    """Return what a chart of rows shows where nothing else is asked for."""
    return "count_exact_rate" if "scene" in row else "success_rate"
