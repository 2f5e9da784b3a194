"""Clustering: its cells, and one chunk of their trials: draw points, cluster them, score the clusters."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.clusters import Clusters
from algorithms.clustering.comparisons import TooFewPoints
from algorithms.clustering.modes import cluster
from algorithms.clustering.scoring import ClusterScores, score_clusters
from algorithms.errors import RequestError
from algorithms.intervals import mean_interval, normal_interval
from hough_tui.experiments.cases import Cell, CellChunk, Columns, Row, SharedDraws, SharedRun
from scenarios.range_doppler import draw_scene
from scenarios.scenes import Scene


@dataclass(frozen=True, slots=True)
class ClusterColumns(Columns):
    """The columns of one cell, one row a trial.

    Attributes
    ----------
    trial : int32 (trials,), which trials of the experiment they are, rising
    excess : int32 (trials,), number of clusters less number of targets
    squared_error : float64 (trials, targets), squared distance of each target's centre from the
        nearest plot, in cells; NaN in a trial without plots
    """

    trial: NDArray[np.int32]
    excess: NDArray[np.int32]
    squared_error: NDArray[np.float64]

    @classmethod
    def empty(cls, trials: int, targets: int) -> ClusterColumns:
        """Return columns to be filled chunk by chunk."""
        return cls(
            np.arange(trials, dtype=np.int32),
            np.zeros(trials, np.int32),
            np.full((trials, targets), np.nan),
        )

    @property
    def clusters(self) -> NDArray[np.int32]:
        """Number of clusters of each trial."""
        return self.excess + np.int32(self.squared_error.shape[1])

    @property
    def trial_square(self) -> NDArray[np.float64]:
        """Mean squared error over the targets of each trial; NaN without plots, or without targets."""
        if self.squared_error.shape[1] == 0:
            return np.full(len(self.trial), np.nan)
        mean: NDArray[np.float64] = self.squared_error.mean(axis=1)
        return mean


@dataclass(frozen=True, slots=True)
class ClusteringCell(Cell):
    """A clustering on a scene."""

    @property
    def scene(self) -> Scene:
        """The scene."""
        found: Scene = self.world
        return found

    @property
    def bytes_a_trial(self) -> int:
        """Size of a trial's columns."""
        return 8 + 8 * len(self.scene.targets)

    def empty_columns(self) -> ClusterColumns:
        """Return columns to be filled chunk by chunk."""
        return ClusterColumns.empty(self.experiment.trials, len(self.scene.targets))

    def tally(self, columns: ClusterColumns, seconds: float) -> Row:
        """Return the row of counts and errors, with intervals.

        Notes
        -----
        The interval of `centroid_rmse` is the root of that of the mean square, by the normal
        distribution over trials; trials without a plot have no error.
        """
        exact = columns.excess == 0
        square = columns.trial_square
        square = square[np.isfinite(square)]
        return {
            **self.heading(len(exact)),
            "targets_per_trial": len(self.scene.targets),
            "count_exact_rate": float(exact.mean()),
            "count_exact_ci95": list(mean_interval(exact)),
            "too_few_rate": float((columns.excess < 0).mean()),
            "too_many_rate": float((columns.excess > 0).mean()),
            "excess_per_trial": float(columns.excess.mean()),
            "clusters_per_trial": float(columns.clusters.mean()),
            "centroid_rmse": float(np.sqrt(square.mean())) if len(square) else None,
            "centroid_rmse_ci95": _root_interval(square),
            "trials_without_plot": int((columns.clusters == 0).sum()),
            "parameters": self.parameters.model_dump(mode="json"),
            "seconds_per_trial": seconds / len(exact),
        }

    @classmethod
    def shared(cls, cells: Sequence[Any], runs: tuple[SharedRun, ...]) -> SceneDraws:
        """Return the work of cells that share their draws."""
        first: ClusteringCell = cells[runs[0].cells[0]]
        return SceneDraws(cells, first.experiment.seed, first.experiment.trials, runs, first.scene)


def _root_interval(square: NDArray[np.float64]) -> list[float] | None:
    """Return the interval of the root of the mean of per-trial squares; None of fewer than two trials."""
    if len(square) < 2:
        return None
    low, high = normal_interval(square)
    return [float(np.sqrt(max(0.0, low))), float(np.sqrt(high))]


@dataclass(frozen=True, slots=True)
class SceneCellChunk(CellChunk):
    """The clusters of a chunk, scored."""

    scores: ClusterScores

    def fill(self, columns: ClusterColumns, first: int) -> None:
        """Put the trials into the columns of the cell."""
        rows = slice(first, first + len(self.scores.excess))
        columns.excess[rows] = self.scores.excess
        columns.squared_error[rows] = self.scores.squared_error


@dataclass(frozen=True, slots=True)
class SceneDraws(SharedDraws):
    """The cells that see the same draws of a scene."""

    scene: Scene

    @property
    def expected_detections(self) -> float:
        """Number of points that a trial is expected to hold."""
        return self.scene.expected_points

    def prepared(self) -> Scene:
        """Return the scene: nothing is worked out ahead."""
        return self.scene

    def run(
        self, prepared: Scene, first: int, trials: int, plain: Callable[..., Any]
    ) -> Iterator[SceneCellChunk]:
        """Yield the scored clusters of consecutive trials, cell by cell."""
        began = time.thread_time()
        drawn = draw_scene(prepared, self.seed, first, trials)
        drawing = time.thread_time() - began
        for run in self.runs:
            began = time.thread_time()
            scores = score_clusters(self._clusters(run, drawn.points, first), drawn.centres)
            seconds = drawing + time.thread_time() - began
            for cell in run.cells:
                yield SceneCellChunk(cell, seconds, scores)

    def _clusters(self, run: SharedRun, points: Any, first: int) -> Clusters:
        try:
            return cluster(points, run.parameters)
        except TooFewPoints as error:
            raise RequestError(
                f"{run.entry.name} on {self.scene.name}, trial {first + error.scan}: k-means is to find "
                f"{error.number} targets among {error.different} different points; give a smaller number"
            ) from None
