"""DBSCAN and k-means of scikit-learn on points, for comparison."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.clusters import NONE, Sets
from algorithms.clustering.parameters import Dbscan, KMeans
from algorithms.clustering.points import Points
from algorithms.errors import RequestError


class TooFewPoints(RequestError):
    """A scan has fewer different points than k-means is to find targets.

    Attributes
    ----------
    number : of targets that are to be found
    different : number of different points
    scan : which one
    """

    def __init__(self, number: int, different: int, scan: int) -> None:
        super().__init__(
            f"scan {scan}: k-means is to find {number} targets among {different} different points; give a "
            "smaller number, or leave the scan out"
        )
        self.number, self.different, self.scan = number, different, scan


def compared_sets(points: Points, parameters: Dbscan | KMeans) -> Sets:
    """Return the sets that DBSCAN or k-means makes of the points of each scan.

    Both measure range and Doppler in units of the target's extents.

    Raises
    ------
    RequestError
        Where scikit-learn is not installed, or the number of targets is still `auto`.
    TooFewPoints
        Where k-means is to find more targets than a scan has different points.

    References
    ----------
    M. Ester et al., "A density-based algorithm for discovering clusters", KDD 1996.
    S. Lloyd, "Least squares quantization in PCM", IEEE Trans. Information Theory 28, 1982.
    """
    learn, threads = _scikit_learn(parameters.mode)
    scaled = np.column_stack(
        [points.range / parameters.range_extent, points.doppler / parameters.doppler_extent]
    )
    orders, counts, scans = [], [], []
    # For a scan's few points, threads that wait for each other take longer than the work.
    with threads.threadpool_limits(1):
        for scan in range(points.scans):
            first, end = points.offsets[scan], points.offsets[scan + 1]
            if first == end:
                continue
            own = scaled[first:end]
            if isinstance(parameters, Dbscan):
                if len(own) < parameters.least_points:
                    continue  # too few for a core, and so for a cluster
                model = learn.DBSCAN(eps=parameters.eps, min_samples=parameters.least_points)
            else:
                number, different = _number(parameters), len(np.unique(own, axis=0))
                if different < number:
                    raise TooFewPoints(number, different, scan)
                model = learn.KMeans(number, n_init=10, random_state=parameters.seed)
            order, sizes = _grouped(model.fit_predict(own))
            orders.append(first + order)
            counts.append(sizes)
            scans.append(np.full(len(sizes), scan, np.int64))
    return _joined(orders, counts, scans)


def _number(parameters: KMeans) -> int:
    if parameters.number == "auto":
        raise RequestError("k-means: number: auto is known of a scene's draws alone; give the number")
    return parameters.number


def _scikit_learn(mode: str) -> tuple[Any, Any]:
    """Return scikit-learn's clustering, and the module by which it controls its threads."""
    try:
        return importlib.import_module("sklearn.cluster"), importlib.import_module("threadpoolctl")
    except ImportError as error:
        raise RequestError(
            f"mode {mode} needs scikit-learn, which cannot be imported ({error}); install hough-tui with its "
            "extra: pip install 'hough-tui[clustering]'"
        ) from None


def _grouped(label: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the points of each label, one label after the other, and how many each has."""
    rows = np.flatnonzero(label != NONE)
    order = rows[np.argsort(label[rows], kind="stable")]
    return order, np.bincount(label[rows])


def _joined(
    orders: list[NDArray[np.int64]], counts: list[NDArray[np.int64]], scans: list[NDArray[np.int64]]
) -> Sets:
    nothing = np.zeros(0, np.int64)
    sizes = np.concatenate([nothing, *counts])
    end = np.cumsum(sizes)
    return Sets(np.concatenate([nothing, *orders]), end - sizes, end, np.concatenate([nothing, *scans]))
