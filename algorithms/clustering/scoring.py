"""Clusters against the truth: the number of targets, and where their plots are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.clusters import Clusters
from algorithms.compiled import kernel


@dataclass(frozen=True, slots=True)
class ClusterScores:
    """How good the clusters of each scan are.

    Attributes
    ----------
    excess : int64 (scans,), number of clusters less number of targets
    squared_error : float64 (scans, targets), squared distance of each target's centre from the
        nearest plot; NaN in a scan without plots
    """

    excess: NDArray[np.int64]
    squared_error: NDArray[np.float64]

    @property
    def exact_rate(self) -> float:
        """Share of scans with as many clusters as targets."""
        return float(np.mean(self.excess == 0))

    @property
    def rmse(self) -> float:
        """Root mean square of the distance of a target's centre from its plot; NaN without plots."""
        known = self.squared_error[np.isfinite(self.squared_error)]
        return float(np.sqrt(known.mean())) if len(known) else np.nan


@kernel
def _nearest(along, doppler, offsets, centres):  # type: ignore[no-untyped-def]
    squared = np.full(centres.shape[:2], np.nan)
    for scan in range(centres.shape[0]):
        for target in range(centres.shape[1]):
            for index in range(offsets[scan], offsets[scan + 1]):
                r = along[index] - centres[scan, target, 0]
                d = doppler[index] - centres[scan, target, 1]
                distance = r * r + d * d
                # A distance that is no number yet is greater than none.
                if not squared[scan, target] <= distance:
                    squared[scan, target] = distance
    return squared


def score_clusters(clusters: Clusters, centres: NDArray[np.float64]) -> ClusterScores:
    """Return how good clusters are.

    Parameters
    ----------
    clusters : of any number of scans
    centres : float64 (scans, targets, 2), range and Doppler of the targets' centres
    """
    counts = clusters.counts
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    squared = _nearest(clusters.range, clusters.doppler, offsets, np.ascontiguousarray(centres, np.float64))
    return ClusterScores(counts - centres.shape[1], squared)
