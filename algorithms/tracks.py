"""Tracks: what an initiator returns, for one batch and for a chunk of batches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Tracks:
    """The tracks that an initiator found in one batch of plots, as columns of length m.

    Attributes
    ----------
    theta, rho : float64 (m,), the line in normal form, θ in [0, π) radians; for an
        accumulating initiator the centre of its cell
    score : float64 (m,), what the initiator ranks by (for the accumulating ones: votes)
    plots : for each track the rows of its plots, at most one a scan, in order of scan
    position, velocity : float64 (m, 2), for an initiator in space (m, 3): least-squares state
        at `time`; NaN where plots of fewer than two scans leave it open
    fitted_theta, fitted_rho : float64 (m,), the line of that state in the plane (x, y); NaN
        where it is open
    time : seconds, the time of the batch's first scan
    effort : what the initiator counted of its work by name, such as pairs of plots
    """

    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    score: NDArray[np.float64]
    plots: tuple[NDArray[np.int64], ...]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    fitted_theta: NDArray[np.float64]
    fitted_rho: NDArray[np.float64]
    time: float
    effort: Mapping[str, int] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.theta)

    def chosen(self, order: NDArray[np.intp]) -> Tracks:
        """Return some of the tracks, in the given order."""
        return Tracks(
            self.theta[order],
            self.rho[order],
            self.score[order],
            tuple(self.plots[index] for index in order),
            self.position[order],
            self.velocity[order],
            self.fitted_theta[order],
            self.fitted_rho[order],
            self.time,
            self.effort,
        )


@dataclass(frozen=True, slots=True)
class TrackChunk:
    """The tracks of several trials, one after the other, as lines.

    Attributes
    ----------
    offsets : int64 (trials + 1,), where each trial's tracks begin, and the end of the last
    theta, rho, score : float64 (m,), as in `Tracks`
    votes_outside : int64 (trials,), votes that fell outside the grid (zeros without a grid)
    plots : int64 (m, k) or None, the rows of each track's plots counted from the beginning
        of its trial, −1 where there are fewer than k; None until association has run
    effort : int64 (trials,) by name, what the initiator counted of its work, such as pairs of plots
    """

    offsets: NDArray[np.int64]
    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    score: NDArray[np.float64]
    votes_outside: NDArray[np.int64]
    plots: NDArray[np.int64] | None = None
    effort: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)

    def strongest(self, most: int) -> TrackChunk:
        """Return the tracks with the highest scores of a chunk of one trial, the highest first."""
        order = np.argsort(-self.score, kind="stable")[:most]
        return TrackChunk(
            np.array([0, len(order)], dtype=np.int64),
            self.theta[order],
            self.rho[order],
            self.score[order],
            self.votes_outside,
            None if self.plots is None else self.plots[order],
            self.effort,
        )

    @property
    def counts(self) -> NDArray[np.int64]:
        """Number of tracks of each trial."""
        return np.diff(self.offsets)
