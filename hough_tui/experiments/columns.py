"""Per-trial columns of initiation: what each trial of a cell gave."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from algorithms.scoring import Scores
from algorithms.tracks import TrackChunk
from hough_tui.experiments.cases import Columns


@dataclass(frozen=True, slots=True)
class TrialColumns(Columns):
    """The columns of one cell, one row a trial.

    Attributes
    ----------
    trial : int32 (trials,), which trials of the experiment they are, rising
    found : bool (trials, targets), whether the target was found
    tracks, false, duplicates : int32 (trials,), numbers of tracks
    theta_error, rho_error : float32 (trials, targets), radians and the unit of length; NaN
        where the target was not found
    votes_outside : int64 (trials,)
    control_found : bool (trials, targets), whether the draw without targets seems to have the
        target; no rows where the experiment has no control
    mixed : int32 (trials,), matching tracks with plots of several origins; −1 where it is not known
    effort : int64 (trials,) by name, what the initiator counted of its work
    """

    trial: NDArray[np.int32]
    found: NDArray[np.bool_]
    tracks: NDArray[np.int32]
    false: NDArray[np.int32]
    duplicates: NDArray[np.int32]
    theta_error: NDArray[np.float32]
    rho_error: NDArray[np.float32]
    votes_outside: NDArray[np.int64]
    control_found: NDArray[np.bool_]
    mixed: NDArray[np.int32]
    effort: dict[str, NDArray[np.int64]] = field(default_factory=dict)

    @classmethod
    def empty(cls, trials: int, targets: int, *, control: bool) -> TrialColumns:
        """Return columns to be filled chunk by chunk."""
        return cls(
            np.arange(trials, dtype=np.int32),
            np.zeros((trials, targets), np.bool_),
            np.zeros(trials, np.int32),
            np.zeros(trials, np.int32),
            np.zeros(trials, np.int32),
            np.full((trials, targets), np.nan, np.float32),
            np.full((trials, targets), np.nan, np.float32),
            np.zeros(trials, np.int64),
            np.zeros((trials if control else 0, targets), np.bool_),
            np.full(trials, -1, np.int32),
        )

    def fill(
        self, first: int, tracks: TrackChunk, scores: Scores, control_found: NDArray[np.bool_] | None
    ) -> None:
        """Put in the trials of a chunk that begins at trial `first`."""
        rows = slice(first, first + len(tracks.counts))
        self.found[rows] = scores.found
        self.tracks[rows] = tracks.counts
        self.false[rows] = scores.false
        self.duplicates[rows] = scores.duplicates
        self.theta_error[rows] = scores.theta_error
        self.rho_error[rows] = scores.rho_error
        self.votes_outside[rows] = tracks.votes_outside
        self.mixed[rows] = scores.mixed
        for name, counted in tracks.effort.items():
            # One of several threads makes the column, and all write into it.
            self.effort.setdefault(name, np.zeros(len(self.trial), np.int64))[rows] = counted
        if control_found is not None:
            self.control_found[rows] = control_found

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return the columns by name, those of the effort as `effort.NAME`."""
        plain = {name: getattr(self, name) for name in PLAIN}
        return plain | {f"{EFFORT}{name}": column for name, column in tuple(self.effort.items())}

    @classmethod
    def of(cls, arrays: Mapping[str, NDArray[Any]]) -> Self:
        """Return the columns that `arrays` gave."""
        effort = {
            name.removeprefix(EFFORT): column for name, column in arrays.items() if name.startswith(EFFORT)
        }
        return cls(**{name: arrays[name] for name in PLAIN}, effort=effort)


EFFORT = "effort."
PLAIN = tuple(column.name for column in fields(TrialColumns) if column.name != "effort")
"""The columns that every cell has."""
