from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import pytest

Row = dict[str, Any]


def _row(initiator: str = "standard", scans: int = 5, success: float = 0.9, **given: Any) -> Row:
    row = {
        "set": "course-report",
        "experiment": "tables",
        "scenario": "two-crossing",
        "unit": "km",
        "initiator": initiator,
        "swept": {"scans": scans},
        "trials": 1000,
        "seed": 7,
        "success_rate": success,
        "success_rate_ci95": [success - 0.02, success + 0.01],
        "success_by_target": [success, success],
        "false_track_ratio": 0.71,
        "false_track_ratio_ci95": [0.69, 0.73],
        "false_tracks_per_trial": 4.1 * scans,
        "duplicates_per_trial": 0.0623 * scans**2,
        "tracks_per_trial": 12.3,
        "success_control": 0.02,
        "success_control_ci95": [0.01, 0.03],
        "trials_without_track": 0,
        "no_track_rate": 0.0,
        "criterion": {"rho": 3.0, "theta_deg": None},
        "theta_rmse_deg": 0.6,
        "rho_rmse": 0.2,
        "votes_outside_per_trial": 0.0,
        "seconds_per_trial": 0.00021,
    }
    return {**row, **given}


@pytest.fixture
def row() -> Callable[..., Row]:
    return _row


@pytest.fixture
def rows() -> list[Row]:
    """Three experiments: a plain one, one with much to name, one without values."""
    plain = [
        _row(name, scans, 0.03 * scans + 0.5, success_control=0.999)
        for name, scans in itertools.product(("standard", "sequential-200"), (5, 10, 15))
    ]
    wide = [
        _row(
            name,
            scans,
            experiment="wide",
            scenario=scenario,
            swept={"scenario.scans": scans, "initiator.grid.theta_bins": 90, "clutter.0.rate": 12.5},
            trials_without_track=120,
            no_track_rate=0.12,
            votes_outside_per_trial=3.2,
            criterion={"rho": 3.0, "theta_deg": 6.0},
        )
        for scenario, name, scans in itertools.product(
            ("two-crossing", "dense-clutter-five-targets"), ("standard", "sequential-200"), (5, 15)
        )
    ]
    nothing = dict.fromkeys(key for key in plain[0] if key.endswith(("_rate", "_ratio", "_rmse", "_deg")))
    empty = [
        _row(
            experiment="nulls",
            swept={},
            success_rate_ci95=None,
            success_by_target=None,
            success_control=None,
            seconds_per_trial=None,
            false_track_ratio_ci95=[None, None],
            criterion={"plots": 3},
            **nothing,
        )
    ]
    return plain + wide + empty


@pytest.fixture
def tracks() -> Row:
    return {
        "initiator": "standard",
        "unit": "km",
        "parameters": {},
        "plots": 780,
        "scans": 15,
        "seconds": 0.0004,
        "tracks": [
            {"theta_deg": 59.0, "rho": 78.9, "score": 14, "plots": [3, 32], "position": [20.0, 80.1],
             "velocity": [0.3, -0.18], "time": 0.0},
            {"theta_deg": 121.0, "rho": -3.47, "score": 15, "plots": [0, 40, 90], "position": [40.0, 20.1],
             "velocity": [-0.3, 0.0], "time": 0.0},
            {"theta_deg": 3.0, "rho": -103.47, "score": 9, "plots": [5], "position": [40.0, 20.1],
             "velocity": None, "time": 0.0},
        ],
        "accumulator": {"theta_bins": 90, "rho_bins": 1000, "rho_min": -150.0, "rho_step": 0.6,
                        "votes": 70200, "votes_outside": 12, "max": 15, "argmax": [60, 244]},
    }  # fmt: skip


@pytest.fixture
def published() -> Row:
    return {
        "table": "course-2-1",
        "trials": 4000,
        "rows": [
            {"case": "standard, 5 scans", "metric": "success_rate", "published": 1.0, "measured": 0.998,
             "ci95": [0.997, 0.999], "consistent": True, "note": None},
            {"case": "standard, 15 scans", "metric": "false_track_ratio", "published": 0.329,
             "measured": 0.345, "ci95": [0.33, 0.36], "consistent": False, "note": "One clutter map."},
            {"case": "binary, σ .1", "metric": "theta_mse", "published": None, "measured": 2.9e-6,
             "ci95": None, "consistent": None, "note": "One clutter map."},
        ],
    }  # fmt: skip
