"""Clustering of points by any mode."""

from __future__ import annotations

from typing import cast

import numpy as np

from algorithms.clustering.clusters import Clusters, Conclusion, Sets, conclude
from algorithms.clustering.comparisons import compared_sets
from algorithms.clustering.parameters import Clustering, CorrectedPatent, Dbscan, KMeans, Recommended
from algorithms.clustering.points import Points
from algorithms.clustering.splitting import Rule, Splits, split


def cluster(points: Points, parameters: Clustering) -> Clusters:
    """Return the clusters of the points of each scan.

    Parameters
    ----------
    points : of any number of scans; the scans do not meet
    parameters : of one of the modes

    Raises
    ------
    RequestError
        Where a mode for comparison lacks scikit-learn, or a scan has too few points for it.

    References
    ----------
    Patent on clustering the detections of a high-resolution radar by the standard-deviation
    ellipse. `corrected-patent` is its method with formulas that do not contradict each other (see
    `Ellipse`). It finds targets in range alone, cuts the larger of two unequal ones, and takes
    targets on a diagonal, whose chord is short, for one. `recommended` deviates: a set is judged by
    its extents on both axes, 2√2 standard deviations with the cell's own included, and split at the
    widest gap in units of the target's extents; points within 2.5 σ are kept, since √2 σ drop 37 %
    of a gaussian target; a target has at least 4 points.
    """
    return cluster_with_splits(points, parameters)[0]


def cluster_with_splits(points: Points, parameters: Clustering) -> tuple[Clusters, Splits | None]:
    """Return the clusters as `cluster` does, and the splits that led to them; None where none did."""
    is_mean = parameters.result == "mean"
    if isinstance(parameters, Dbscan | KMeans):
        sets = compared_sets(points, parameters)
        return conclude(points, sets, Conclusion(is_mean=is_mean)), None
    splitting = cast("Recommended | CorrectedPatent", parameters)
    rule = Rule.of(splitting)
    splits = split(points, rule)
    leaves = splits.leaves
    scan = np.searchsorted(splits.offsets, leaves, side="right") - 1
    sets = Sets(splits.order, splits.first[leaves], splits.end[leaves], scan)
    conclusion = Conclusion(
        splitting.radius, splitting.least_points, is_mean, rule.range_added, rule.doppler_added
    )
    return conclude(points, sets, conclusion), splits
