"""Initiation: its cells, and a chunk of their trials: draw, find tracks, score, the same for the control."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from algorithms.initiators.base import ChunkInitiator
from algorithms.initiators.guard import PlugInError, located
from algorithms.plots import PlotChunk
from algorithms.scoring.gospa import gospa
from algorithms.scoring.kinematics import kinematic_errors
from algorithms.scoring.latency import scans_to_initiate
from algorithms.scoring.matching import Scores, score
from algorithms.tracks import TrackChunk
from hough_tui.experiments.cases import Cell, CellPart, Row, SharedDraws, SharedRun
from hough_tui.experiments.chunks.plot_sources import PlotSource, plot_source, stage_key
from hough_tui.experiments.columns.initiation import CONTROL, TARGETS, TrialColumns
from hough_tui.experiments.engines.process_worker import initiate_trials
from scenarios.entries import InitiatorEntry
from scenarios.experiments import InitiationExperiment, MatchCriterion
from scenarios.model import Scenario
from scenarios.selection import ignores_z
from scenarios.simulate import Draw, truth
from scenarios.sweeps import Stage

POINT = 10.0
"""Plots that a point counts for in the size of a chunk: initiators combine the plots of a target."""


@dataclass(frozen=True, slots=True)
class InitiationCell(Cell[Scenario, InitiatorEntry]):
    """An initiator on a scenario."""

    experiment: InitiationExperiment

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return self.world

    @property
    def clustering(self) -> Stage:
        """How points become plots; None of a scenario whose draws are plots."""
        return self.point.stage

    @property
    def criterion(self) -> MatchCriterion:
        """When a track matches a target."""
        return self.experiment.criterion

    @property
    def has_control(self) -> bool:
        """Whether the draws without targets are scored, too."""
        return self.experiment.control

    @property
    def sizes(self) -> dict[str, int]:
        """Sizes of the second axes of the columns."""
        targets = len(self.scenario.targets)
        return {TARGETS: targets, CONTROL: targets if self.has_control else 0}

    @property
    def run_key(self) -> str:
        """What decides the tracks of a draw."""
        return f"{stage_key(self.clustering)} {self.entry.initiator} {self.parameters.model_dump_json()}"

    def heading(self, trials: int) -> Row:
        """Return the beginning of a row: what ran, and how often."""
        # A zero-argument super() does not find the class that slots make anew.
        return {
            **Cell.heading(self, trials),
            "unit": self.scenario.unit.value,
            "ignores_z": ignores_z(self.entry, self.scenario),
            "target_names": [target.name for target in self.scenario.targets],
        }

    def settings(self) -> Row:
        """Return the end of a row: by which settings it ran."""
        return {
            "criterion": self.criterion.document,
            "gospa_cutoff": self.gospa_cutoff,
            **Cell.settings(self),
        }

    @property
    def gospa_cutoff(self) -> float | None:
        """Cutoff of GOSPA; None where states are not judged, or where it hangs on a noise that is none."""
        if not self.experiment.judges_states:
            return None
        return self.experiment.gospa_cutoff_on(self.scenario.context)

    @property
    def bytes_a_trial(self) -> int:
        """Size of a trial's columns."""
        return TrialColumns.bytes_a_trial(**self.sizes)

    def empty_columns(self) -> TrialColumns:
        """Return columns to be filled chunk by chunk."""
        return TrialColumns.empty(self.experiment.trials, **self.sizes)

    def shared(self, runs: tuple[SharedRun[InitiationCell], ...]) -> ScenarioDraws:
        """Return the work of cells that share this one's draws."""
        return ScenarioDraws(runs)


@dataclass(frozen=True, slots=True)
class ScenarioDraws(SharedDraws[InitiationCell, PlotSource]):
    """The work of cells that see the same draws of a scenario."""

    @property
    def scenario(self) -> Scenario:
        """The scenario."""
        return self.first.scenario

    @property
    def expected_detections(self) -> float:
        """Number of plots that a trial is expected to hold; points that may all be plots count for more."""
        return self.scenario.expected_plots * (POINT if self.scenario.is_resolved else 1.0)

    @property
    def needs_processes(self) -> bool:
        """Whether an initiator is in plain Python, which would hold the interpreter's lock."""
        return not all(isinstance(run.first.entry.algorithm, ChunkInitiator) for run in self.runs)

    def prepared(self) -> PlotSource:
        """Return what draws the scenario's plots."""
        return plot_source(self.scenario)

    def run(
        self, prepared: PlotSource, first: int, trials: int, run_in_process: Callable[..., Any]
    ) -> Iterator[CellPart]:
        """Yield the scored tracks of consecutive trials, cell by cell."""
        chunk = prepared.chunk(self.seed, first, trials)
        for run in self.runs:
            stage = run.first.clustering
            drawn, drawing = chunk.plots(stage)
            states = any(cell.experiment.judges_states for cell in run.cells.values())
            where = f"set {run.first.set_name}, scenario {self.scenario.name}, seed {self.seed}"
            tracks, finding = self._tracks(run, drawn.chunk, run_in_process, first, where, states=states)
            has_control = any(cell.has_control for cell in run.cells.values())
            if has_control:
                control, where = chunk.control(stage), f"{where} (the control)"
                control_tracks, _ = self._tracks(
                    run, control.chunk, run_in_process, first, where, states=False
                )
            for index, cell in run.cells.items():
                began = time.thread_time()
                columns = scored(cell, tracks, drawn)
                seconds = drawing + finding + time.thread_time() - began
                if has_control and cell.has_control:
                    columns["control_found"] = scores_of(cell, control_tracks, control).found
                yield CellPart(index, TrialColumns.of(first, trials, **columns), seconds)

    def _tracks(
        self,
        run: SharedRun[InitiationCell],
        chunk: PlotChunk,
        run_in_process: Callable[..., Any],
        first: int,
        where: str,
        *,
        states: bool,
    ) -> tuple[TrackChunk, float]:
        """Return the tracks, with their plots where a criterion asks for them, and the seconds.

        Parameters
        ----------
        first, where : number of the first trial, and whose trials they are, for messages
        states : whether their states are judged
        """
        algorithm, parameters = run.first.entry.algorithm, run.first.parameters
        context = self.scenario.context
        if not isinstance(algorithm, ChunkInitiator):
            timed: tuple[TrackChunk, float] = run_in_process(
                f"{where}, trials {first} to {first + chunk.trials - 1}: initiator {algorithm.name}",
                initiate_trials,
                algorithm.name,
                parameters,
                context,
                chunk,
                first,
                where,
            )
            return timed
        began = time.thread_time()
        plots = any(cell.criterion.plots is not None for cell in run.cells.values())
        try:
            tracks = algorithm.tracks_of_chunk(chunk, context, parameters, plots=plots, states=states)
        except PlugInError:
            # Its trials one by one, so that the message names the one that fails.
            for trial in range(chunk.trials):
                with located(f"{where}, trial {first + trial}"):
                    alone = chunk.trial(trial).chunk()
                    algorithm.tracks_of_chunk(alone, context, parameters, plots=plots, states=states)
            with located(f"{where}, trials {first} to {first + chunk.trials - 1}"):
                raise
        return tracks, time.thread_time() - began


def scores_of(cell: InitiationCell, tracks: TrackChunk, drawn: Draw) -> Scores:
    """Return how the tracks of draws score by the criterion of a cell."""
    return score(tracks, truth(cell.scenario, drawn), drawn.chunk.offsets, cell.criterion.value)


def scored(cell: InitiationCell, tracks: TrackChunk, drawn: Draw) -> dict[str, Any]:
    """Return the columns of trials, from their tracks."""
    scores = scores_of(cell, tracks, drawn)
    columns = {
        "found": scores.found,
        "tracks": tracks.counts,
        "false": scores.false,
        "duplicates": scores.duplicates,
        "theta_error": scores.theta_error,
        "rho_error": scores.rho_error,
        "votes_outside": tracks.votes_outside,
        "mixed": scores.mixed,
        "scans_to_initiate": scans_to_initiate(scores.confirmed, drawn.states.present),
        "effort": tracks.effort,
    }
    if cell.experiment.judges_states and tracks.states is not None:
        errors = kinematic_errors(scores.best, tracks.states, drawn.states)
        columns |= {
            "position_error": errors.position,
            "velocity_error": errors.velocity,
            "cross_track_error": errors.cross_track,
            "nees": errors.nees,
        }
        if cell.gospa_cutoff is not None:
            parts = gospa(tracks.offsets, tracks.states, drawn.states, cell.gospa_cutoff)
            columns |= {
                "gospa_localisation": parts.localisation,
                "gospa_missed": parts.missed,
                "gospa_false": parts.false,
            }
    return columns
