"""Initiation: its cells, and a chunk of their trials: draw, find tracks, score, the same for the control."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from algorithms.initiators.base import ChunkInitiator
from algorithms.plots import PlotChunk
from algorithms.scoring import Scores, score
from algorithms.tracks import TrackChunk
from hough_tui.experiments.cases import Cell, CellChunk, Row, SharedDraws, SharedRun
from hough_tui.experiments.chunks.plot_sources import PlotSource, plot_source, stage_key
from hough_tui.experiments.columns import TrialColumns
from hough_tui.experiments.engines.process_worker import initiate_trials
from hough_tui.experiments.tallies import tally
from scenarios.entries import ClusteringEntry, WithoutClustering
from scenarios.experiments import InitiationExperiment, MatchCriterion
from scenarios.model import Scenario
from scenarios.selection import ignores_z
from scenarios.simulate import Draw, truth

POINT = 10.0
"""Plots that a point counts for in the size of a chunk: initiators combine the plots of a target."""


@dataclass(frozen=True, slots=True)
class InitiationCell(Cell):
    """An initiator on a scenario."""

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return self.point.scenario

    @property
    def clustering(self) -> ClusteringEntry | WithoutClustering | None:
        """How points become plots; None of a scenario whose draws are plots."""
        return self.point.elements.get("clustering")

    @property
    def criterion(self) -> MatchCriterion:
        """When a track matches a target."""
        return cast("InitiationExperiment", self.experiment).criterion

    @property
    def has_control(self) -> bool:
        """Whether the draws without targets are scored, too."""
        return cast("InitiationExperiment", self.experiment).control

    @property
    def run_key(self) -> str:
        """What decides what is found in a draw."""
        return f"{stage_key(self.clustering)} {self.entry.initiator} {self.parameters.model_dump_json()}"

    def heading(self, trials: int) -> Row:
        """Return what a row says before what was found."""
        # A zero-argument super() does not find the class that slots make anew.
        return {
            **Cell.heading(self, trials),
            "unit": self.scenario.unit.value,
            "ignores_z": ignores_z(self.entry, self.scenario),
        }

    def blank(self) -> Row:
        """Return the row as it is before any trial is finished."""
        return {**self.heading(0), "criterion": self.criterion.document}

    @property
    def bytes_a_trial(self) -> int:
        """Size of a trial's columns."""
        return 20 + 10 * len(self.scenario.targets)

    def empty_columns(self) -> TrialColumns:
        """Return columns to be filled chunk by chunk."""
        return TrialColumns.empty(
            self.experiment.trials, len(self.scenario.targets), control=self.has_control
        )

    def tally(self, columns: TrialColumns, seconds: float) -> Row:
        """Return the row of rates with intervals; the seconds leave out the control."""
        return tally(self, columns, seconds)

    @classmethod
    def shared(cls, cells: Sequence[Any], runs: tuple[SharedRun, ...]) -> ScenarioDraws:
        """Return the work of cells that share their draws."""
        first: InitiationCell = cells[runs[0].cells[0]]
        return ScenarioDraws(cells, first.experiment.seed, first.experiment.trials, runs, first.scenario)


@dataclass(frozen=True, slots=True)
class TrackCellChunk(CellChunk):
    """The tracks of a chunk, scored.

    Attributes
    ----------
    tracks, scores : of the trials
    control_found : bool (trials, targets), or None without a control
    """

    tracks: TrackChunk
    scores: Scores
    control_found: NDArray[np.bool_] | None

    def fill(self, columns: TrialColumns, first: int) -> None:
        """Put the trials into the columns of the cell."""
        columns.fill(first, self.tracks, self.scores, self.control_found)


@dataclass(frozen=True, slots=True)
class ScenarioDraws(SharedDraws):
    """The cells that see the same draws of a scenario."""

    scenario: Scenario

    @property
    def expected_detections(self) -> float:
        """Number of plots that a trial is expected to hold; points that may all be plots count for more."""
        return self.scenario.expected_plots * (POINT if self.scenario.is_resolved else 1.0)

    @property
    def needs_processes(self) -> bool:
        """Whether an initiator is in plain Python, which would hold the interpreter's lock."""
        return not all(isinstance(run.entry.algorithm, ChunkInitiator) for run in self.runs)

    def prepared(self) -> PlotSource:
        """Return what draws the scenario's plots."""
        return plot_source(self.scenario)

    def run(
        self, prepared: PlotSource, first: int, trials: int, plain: Callable[..., Any]
    ) -> Iterator[TrackCellChunk]:
        """Yield the scored tracks of consecutive trials, cell by cell."""
        chunk = prepared.chunk(self.seed, first, trials)
        for run in self.runs:
            stage = self.cells[run.cells[0]].clustering
            drawn, drawing = chunk.plots(stage)
            tracks, finding = self._tracks(run, drawn.chunk, plain)
            controlled = [cell for cell in run.cells if self.cells[cell].has_control]
            if controlled:
                control = chunk.control(stage)
                control_tracks, _ = self._tracks(run, control.chunk, plain)
            for cell in run.cells:
                began = time.thread_time()
                scores = self._scores(cell, tracks, drawn)
                scoring = time.thread_time() - began
                found = None
                if cell in controlled:
                    found = self._scores(cell, control_tracks, control).found
                yield TrackCellChunk(cell, drawing + finding + scoring, tracks, scores, found)

    def _scores(self, cell: int, tracks: TrackChunk, drawn: Draw) -> Scores:
        known = truth(self.scenario, drawn)
        return score(tracks, known, drawn.chunk.offsets, self.cells[cell].criterion.value)

    def _tracks(
        self, run: SharedRun, chunk: PlotChunk, plain: Callable[..., Any]
    ) -> tuple[TrackChunk, float]:
        """Return the tracks, with their plots where a criterion asks for them, and the seconds."""
        algorithm, context = run.entry.algorithm, self.scenario.context
        if not isinstance(algorithm, ChunkInitiator):
            told: tuple[TrackChunk, float] = plain(
                f"initiator {algorithm.name}", initiate_trials, algorithm.name, run.parameters, context, chunk
            )
            return told
        began = time.thread_time()
        plots = any(self.cells[cell].criterion.plots is not None for cell in run.cells)
        tracks = algorithm.tracks_of_chunk(chunk, context, run.parameters, plots=plots, states=False)
        return tracks, time.thread_time() - began
