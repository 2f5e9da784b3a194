"""What a published table is: its figures, and the cells of a bundled set that measure them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.experiments.tallies import false_ratio

PerTrial = Callable[[Any], NDArray[np.float64]]


@dataclass(frozen=True, slots=True)
class Measure:
    """A quantity whose mean over the trials is compared with a printed figure.

    Attributes
    ----------
    values : float64 (trials,), of the columns of a cell; NaN for a trial that does not count
    is_share : whether each value lies in [0, 1], so that the mean is a rate
    is_count : whether each value is a count
    is_root : whether values are squares, and the root of their mean is told
    """

    values: PerTrial
    is_share: bool = False
    is_count: bool = False
    is_root: bool = False


def _square_error(errors: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the mean square over the targets of each trial, NaN where none was found."""
    squares = errors.astype(np.float64) ** 2
    known = np.isfinite(squares)
    count = known.sum(axis=1)
    mean: NDArray[np.float64] = np.where(known, squares, 0.0).sum(axis=1) / np.maximum(count, 1)
    return np.where(count > 0, mean, np.nan)


def _pure(columns: TrialColumns) -> NDArray[np.float64]:
    """Return the share of the matching tracks of each trial that hold plots of their target alone."""
    matching = columns.tracks - columns.false
    known = (matching > 0) & (columns.mixed >= 0)
    share: NDArray[np.float64] = 1.0 - columns.mixed / np.maximum(matching, 1)
    return np.where(known, share, np.nan)


MEASURES: dict[str, Measure] = {
    "success_rate": Measure(lambda columns: columns.found.mean(axis=1), is_share=True),
    "false_track_ratio": Measure(false_ratio, is_share=True),
    "success_control": Measure(lambda columns: columns.control_found.mean(axis=1), is_share=True),
    "false_tracks_per_trial": Measure(lambda columns: columns.false.astype(np.float64), is_count=True),
    "pure_track_ratio": Measure(_pure, is_share=True),
    "duplicates_per_trial": Measure(lambda columns: columns.duplicates.astype(np.float64), is_count=True),
    "theta_mse": Measure(lambda columns: _square_error(columns.theta_error)),
    "rho_mse": Measure(lambda columns: _square_error(columns.rho_error)),
    "count_exact_rate": Measure(lambda columns: (columns.excess == 0).astype(np.float64), is_share=True),
    "centroid_rmse": Measure(lambda columns: columns.trial_square, is_root=True),
}
"""What a figure may measure, by the name of its metric; mean square errors in rad² and the unit²."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One figure of a published table.

    Attributes
    ----------
    case : how the row is called
    experiment, method, swept, world : which cell of the bundled set measures it: the name of an entry
        (initiator or clustering), and of a scenario or scene where the experiment has several
    metric : a name of `MEASURES`
    published : the printed figure; None where the source has none
    note : what a reader must know
    is_judged : whether the printed figure is meant to be reproduced
    """

    case: str
    experiment: str
    method: str
    metric: str
    published: float | None = None
    note: str | None = None
    swept: dict[str, int | float] = field(default_factory=dict)
    is_judged: bool = True
    world: str | None = None


@dataclass(frozen=True, slots=True)
class PublishedTable:
    """A published table and the bundled set that measures it.

    Attributes
    ----------
    name, title, source : what it is
    set_name : which bundled set
    trials : number of trials behind each published figure
    rounding : half the last printed digit; 0 where figures have several sizes
    entries : its figures
    """

    name: str
    title: str
    source: str
    set_name: str
    trials: int
    rounding: float
    entries: tuple[Entry, ...]
