"""Tracks: what an initiator returns, for one batch and for a chunk of batches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.lines import line_through


class TrackStates(NamedTuple):
    """Kinematic states of m tracks in d dimensions: what a tracking filter starts with.

    Each state holds at the scan and the time of its track's first plot. It is NaN where it is open:
    the velocity of a track with plots of one time, the covariance where the noise is not known,
    everything of a track without plots.

    Attributes
    ----------
    scan : int64 (m,), the scan of the first plot; −1 for a track without plots
    time : float64 (m,), the time of the first plot, in seconds
    position, velocity : float64 (m, d), d 2 in the plane (x, y) and 3 in space, in the unit of the plots
    covariance : float64 (m, 2d, 2d), of position and velocity together, in the order x, y[, z],
        vx, vy[, vz]
    """

    scan: NDArray[np.int64]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    covariance: NDArray[np.float64]

    @classmethod
    def open(cls, tracks: int, dimensions: int) -> TrackStates:
        """Return open states of so many tracks."""
        return cls(
            np.full(tracks, -1, np.int64),
            np.full(tracks, np.nan),
            np.full((tracks, dimensions), np.nan),
            np.full((tracks, dimensions), np.nan),
            np.full((tracks, 2 * dimensions, 2 * dimensions), np.nan),
        )

    @property
    def dimensions(self) -> int:
        """Number d of dimensions."""
        return int(self.position.shape[1])

    @property
    def lines(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lines (θ, ρ) of the motions in the plane (x, y), float64 (m,) each; NaN where open."""
        return line_through(self.position[:, :2], self.velocity[:, :2])

    def select(self, rows: slice | NDArray[np.intp]) -> TrackStates:
        """Return the states of some tracks, in the order of `rows`."""
        return TrackStates(
            self.scan[rows],
            self.time[rows],
            self.position[rows],
            self.velocity[rows],
            self.covariance[rows],
        )


@dataclass(frozen=True, slots=True)
class Tracks:
    """The tracks of one batch of plots, as columns of length m.

    Attributes
    ----------
    theta, rho : float64 (m,), the line in normal form, θ in [0, π) radians; for an
        accumulating initiator the centre of its cell
    score : float64 (m,), what the initiator ranks by (for the accumulating ones: votes)
    plots : for each track the rows of its plots, at most one a scan, in order of scan
    states : kinematic states
    confirmed_scan : int64 (m,), the scan with which the initiator could declare each track
    effort : what the initiator counted of its work by name, such as pairs of plots
    """

    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    score: NDArray[np.float64]
    plots: tuple[NDArray[np.int64], ...]
    states: TrackStates
    confirmed_scan: NDArray[np.int64]
    effort: Mapping[str, int] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.theta)

    def select(self, order: NDArray[np.intp]) -> Tracks:
        """Return some of the tracks, in the order of `order`."""
        return Tracks(
            self.theta[order],
            self.rho[order],
            self.score[order],
            tuple(self.plots[index] for index in order),
            self.states.select(order),
            self.confirmed_scan[order],
            self.effort,
        )


@dataclass(frozen=True, slots=True)
class TrackChunk:
    """The tracks of several trials, one after the other.

    An initiator gives lines and scores; plots and states are added by stages of their own, since
    most experiments need neither (see `ChunkInitiator.tracks_of_chunk`).

    Attributes
    ----------
    offsets : int64 (trials + 1,), where each trial's tracks begin, and the end of the last
    theta, rho, score : float64 (m,), as in `Tracks`
    votes_outside : int64 (trials,), votes that fell outside the grid (zeros without a grid)
    plots : int64 (m, k) or None, the rows of each track's plots counted from the beginning
        of its trial, −1 where there are fewer than k; None until association has run
    effort : int64 (trials,) by name, what the initiator counted of its work, such as pairs of plots
    confirmed_scan : int64 (m,), as in `Tracks`; None stands for the last scan of the batch, in which
        an initiator that looks at whole batches declares its tracks
    states : kinematic states, one a track; None until they have been asked for
    """

    offsets: NDArray[np.int64]
    theta: NDArray[np.float64]
    rho: NDArray[np.float64]
    score: NDArray[np.float64]
    votes_outside: NDArray[np.int64]
    plots: NDArray[np.int64] | None = None
    effort: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)
    confirmed_scan: NDArray[np.int64] | None = None
    states: TrackStates | None = None

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
            None if self.confirmed_scan is None else self.confirmed_scan[order],
            None if self.states is None else self.states.select(order),
        )

    def with_confirmation(self, last_scan: int) -> TrackChunk:
        """Return the tracks with `confirmed_scan` filled: where it is None, the last scan of the batch."""
        if self.confirmed_scan is not None:
            return self
        return replace(self, confirmed_scan=np.full(len(self.theta), last_scan, np.int64))

    @property
    def only_trial(self) -> Tracks:
        """Tracks of a chunk of one trial that is complete, with plots, states and scans of confirmation."""
        assert self.plots is not None
        assert self.states is not None
        assert self.confirmed_scan is not None
        return Tracks(
            self.theta,
            self.rho,
            self.score,
            tuple(row[row >= 0] for row in self.plots),
            self.states,
            self.confirmed_scan,
            {name: int(counted[0]) for name, counted in self.effort.items()},
        )

    @property
    def counts(self) -> NDArray[np.int64]:
        """Number of tracks of each trial."""
        return np.diff(self.offsets)
