"""Clustering: its cells, and one chunk of their trials: draw points, cluster them, score the clusters."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from algorithms.clustering.clusters import Clusters
from algorithms.clustering.comparisons import TooFewPoints
from algorithms.clustering.modes import cluster
from algorithms.clustering.points import Points
from algorithms.clustering.scoring import score_clusters
from algorithms.errors import RequestError
from hough_tui.experiments.cases import Cell, CellPart, Row, SharedDraws, SharedRun
from hough_tui.experiments.columns.clustering import ClusterColumns
from scenarios.entries import ClusteringEntry
from scenarios.experiments import ClusteringExperiment
from scenarios.range_doppler import draw_scene
from scenarios.scenes import Scene


@dataclass(frozen=True, slots=True)
class ClusteringCell(Cell[Scene, ClusteringEntry]):
    """A clustering on a scene."""

    experiment: ClusteringExperiment

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.world

    @property
    def bytes_a_trial(self) -> int:
        """Size of a trial's columns."""
        return ClusterColumns.bytes_a_trial(targets=len(self.scene.targets))

    def empty_columns(self) -> ClusterColumns:
        """Return columns to be filled part by part."""
        return ClusterColumns.empty(self.experiment.trials, targets=len(self.scene.targets))

    def heading(self, trials: int) -> Row:
        """Return the beginning of a row: what ran, and how often."""
        # A zero-argument super() does not find the class that slots make anew.
        return {**Cell.heading(self, trials), "targets_per_trial": len(self.scene.targets)}

    def shared(self, runs: tuple[SharedRun[ClusteringCell], ...]) -> SceneDraws:
        """Return the work of cells that share this one's draws."""
        return SceneDraws(runs)


@dataclass(frozen=True, slots=True)
class SceneDraws(SharedDraws[ClusteringCell, Scene]):
    """The work of cells that see the same draws of a scene."""

    @property
    def scene(self) -> Scene:
        """The scene."""
        return self.first.scene

    @property
    def expected_detections(self) -> float:
        """Number of points that a trial is expected to hold."""
        return self.scene.expected_points

    def prepared(self) -> Scene:
        """Return the scene: nothing is worked out ahead."""
        return self.scene

    def run(
        self, prepared: Scene, first: int, trials: int, run_in_process: Callable[..., Any]
    ) -> Iterator[CellPart]:
        """Yield the scored clusters of consecutive trials, cell by cell."""
        began = time.thread_time()
        drawn = draw_scene(prepared, self.seed, first, trials)
        drawing = time.thread_time() - began
        for run in self.runs:
            began = time.thread_time()
            scores = score_clusters(self._clusters(run, drawn.points, first), drawn.centres)
            seconds = drawing + time.thread_time() - began
            for index in run.cells:
                columns = ClusterColumns.of(
                    first, trials, excess=scores.excess, squared_error=scores.squared_error
                )
                yield CellPart(index, columns, seconds)

    def _clusters(self, run: SharedRun[ClusteringCell], points: Points, first: int) -> Clusters:
        try:
            return cluster(points, run.first.parameters)
        except TooFewPoints as error:
            raise RequestError(
                f"{run.first.entry.name} on {self.scene.name}, trial {first + error.scan}: k-means is to "
                f"find {error.number} targets among {error.different} different points; give a smaller number"
            ) from None
