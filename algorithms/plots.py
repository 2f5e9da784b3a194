"""Plots: the columns of one batch of detections, and of a chunk of batches."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Plots:
    """One batch of detections as columns of equal length n, sorted by scan.

    Attributes
    ----------
    scan : int32 (n,), numbered from 0
    time : float64 (n,), seconds
    position : float64 (n, 2) or (n, 3), in the unit of the scenario
    amplitude, doppler : float64 (n,), where the sensor gives them
    covariance : float64 (n, d, d), of the noise of each position, where it is known for each plot
    """

    scan: NDArray[np.int32]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    amplitude: NDArray[np.float64] | None = None
    doppler: NDArray[np.float64] | None = None
    covariance: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        return len(self.scan)

    def chunk(self) -> PlotChunk:
        """Return the chunk that holds this batch alone."""
        offsets = np.array([0, len(self)], dtype=np.int64)
        return PlotChunk(
            self.scan, self.time, self.position, offsets, self.covariance, self.amplitude, self.doppler
        )


@dataclass(frozen=True, slots=True)
class PlotChunk:
    """The plots of several trials, one after the other.

    Attributes
    ----------
    scan, time, position, covariance, amplitude, doppler : as in `Plots`, sorted by trial, then by scan
    offsets : int64 (trials + 1,), where each trial's plots begin, and the end of the last
    """

    scan: NDArray[np.int32]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    offsets: NDArray[np.int64] = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    covariance: NDArray[np.float64] | None = None
    amplitude: NDArray[np.float64] | None = None
    doppler: NDArray[np.float64] | None = None

    @property
    def trials(self) -> int:
        """Number of trials."""
        return len(self.offsets) - 1

    @property
    def largest(self) -> int:
        """Number of plots of the largest trial."""
        return int(np.diff(self.offsets).max(initial=0))

    @property
    def most_scans(self) -> int:
        """Greatest number of scans with plots that one trial has, at least 1."""
        if len(self.scan) == 0:
            return 1
        begins = np.ones(len(self.scan), dtype=np.int64)
        begins[1:] = self.scan[1:] != self.scan[:-1]
        starts = self.offsets[:-1][np.diff(self.offsets) > 0]
        begins[starts] = 1
        return int(np.add.reduceat(begins, starts).max())

    def trial(self, index: int) -> Plots:
        """Return the plots of one trial (views, not copies)."""
        rows = slice(self.offsets[index], self.offsets[index + 1])
        return Plots(
            self.scan[rows],
            self.time[rows],
            self.position[rows],
            _part(self.amplitude, rows),
            _part(self.doppler, rows),
            _part(self.covariance, rows),
        )

    def chosen(self, kept: NDArray[np.bool_]) -> PlotChunk:
        """Return the chunk with some of its plots only; a trial may be left without any.

        Parameters
        ----------
        kept : bool (n,)
        """
        before = np.concatenate([[0], np.cumsum(kept)]).astype(np.int64)
        return PlotChunk(
            self.scan[kept],
            self.time[kept],
            self.position[kept],
            before[self.offsets],
            _part(self.covariance, kept),
            _part(self.amplitude, kept),
            _part(self.doppler, kept),
        )


def _part(column: NDArray[np.float64] | None, rows: slice | NDArray[np.bool_]) -> NDArray[np.float64] | None:
    return None if column is None else column[rows]
