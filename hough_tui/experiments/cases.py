"""Parts of a run that do not depend on the kind of experiment: cells, and the draws that they share.

A kind of experiment brings its own `Cell`, `SharedDraws` and `Columns`; plan, engine, results and store
know no more of it than what stands here.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from hough_tui.experiments.columns.schema import Columns
from scenarios.experiments import Experiment
from scenarios.sweeps import EntryT, Point, WorldT

Row = dict[str, Any]

LARGEST_CHUNK = 200
"""Trials of the largest chunk."""

DETECTIONS_A_CHUNK = 60_000
"""Plots that a chunk is expected to hold: some twenty milliseconds of work, not to be interrupted."""


@dataclass(frozen=True, slots=True)
class Cell(ABC, Generic[WorldT, EntryT]):
    """One row of the result: what runs on what, both with the swept values put in.

    Attributes
    ----------
    set_name, experiment : where it comes from
    point : what is drawn and what runs on it, with the swept values and the resolved parameters
    """

    set_name: str
    experiment: Experiment
    point: Point[WorldT, EntryT]

    @property
    def world(self) -> WorldT:
        """What is drawn: a scenario or a scene."""
        return self.point.world

    @property
    def entry(self) -> EntryT:
        """The entry of what runs on it."""
        return self.point.entry

    @property
    def parameters(self) -> Any:
        """The parameters of what runs, resolved."""
        return self.point.parameters

    @property
    def swept(self) -> dict[str, int | float]:
        """The swept values by their keys as they were written."""
        return self.point.swept

    @property
    def names(self) -> Mapping[str, str]:
        """The names of what was combined, by part (`scenario`, `initiator` and so on)."""
        return self.point.names

    @property
    def draws_key(self) -> str:
        """What decides the draws beside the seed: cells of equal keys share them."""
        return f"{type(self).__name__} {self.world.model_dump_json()}"

    @property
    def run_key(self) -> str:
        """What decides the outcome of a draw: cells of equal keys have the same, and score it apart."""
        return str(self.parameters.model_dump_json())

    def heading(self, trials: int) -> Row:
        """Return the beginning of a row: what ran, and how often."""
        return {
            "set": self.set_name,
            "experiment": self.experiment.name,
            **self.names,
            "swept": dict(self.swept),
            "trials": trials,
            "seed": self.experiment.seed,
        }

    def settings(self) -> Row:
        """Return the end of a row: by which settings it ran."""
        return {"parameters": self.parameters.model_dump(mode="json")}

    def blank(self) -> Row:
        """Return the row as it is before any trial is finished."""
        return self.heading(0) | self.settings()

    @property
    @abstractmethod
    def bytes_a_trial(self) -> int:
        """Size of a trial's columns."""

    @abstractmethod
    def empty_columns(self) -> Columns:
        """Return columns to be filled part by part."""

    @abstractmethod
    def shared(self, runs: tuple[SharedRun[Any], ...]) -> SharedDraws[Any, Any]:
        """Return the work of cells that share this one's draws: `runs`, of which it is the first."""


AnyCell = Cell[Any, Any]
"""A cell of any kind of experiment."""

CellT = TypeVar("CellT", bound=AnyCell)
PreparedT = TypeVar("PreparedT")


@dataclass(frozen=True, slots=True)
class SharedRun(Generic[CellT]):
    """Cells that score the same outcome of the same draws: of one entry with one set of parameters.

    Attributes
    ----------
    cells : by their places in the plan, at least one
    """

    cells: Mapping[int, CellT]

    @property
    def first(self) -> CellT:
        """The first cell, whose entry and parameters are those of all."""
        return next(iter(self.cells.values()))


@dataclass(frozen=True, slots=True)
class CellPart:
    """What consecutive trials gave for one cell.

    Attributes
    ----------
    cell : its place in the plan
    columns : of these trials
    seconds : worker time from draw to score
    """

    cell: int
    columns: Columns
    seconds: float


@dataclass(frozen=True, slots=True)
class SharedDraws(ABC, Generic[CellT, PreparedT]):
    """The work of cells that see the same draws: one world and one seed.

    Attributes
    ----------
    runs : what runs on the draws, at least one
    """

    runs: tuple[SharedRun[CellT], ...]

    @property
    def first(self) -> CellT:
        """The first cell, whose world, seed and number of trials are those of all."""
        return self.runs[0].first

    @property
    def seed(self) -> int:
        """Which draws."""
        return self.first.experiment.seed

    @property
    def trials(self) -> int:
        """How many draws."""
        return self.first.experiment.trials

    @property
    @abstractmethod
    def expected_detections(self) -> float:
        """Number of plots or points that a trial is expected to hold."""

    @property
    def chunk(self) -> int:
        """Trials of a chunk; it depends on what is drawn alone, never on the number of workers."""
        return max(1, min(LARGEST_CHUNK, int(DETECTIONS_A_CHUNK / max(1.0, self.expected_detections))))

    @property
    def needs_processes(self) -> bool:
        """Whether anything runs in plain Python, which would hold the interpreter's lock."""
        return False

    @abstractmethod
    def prepared(self) -> PreparedT:
        """Return what is worked out once for all chunks."""

    @abstractmethod
    def run(
        self, prepared: PreparedT, first: int, trials: int, run_in_process: Callable[..., Any]
    ) -> Iterator[CellPart]:
        """Yield what consecutive trials give, cell by cell; to stop between two runs, stop iterating.

        Parameters
        ----------
        prepared : as `prepared` gave it
        first, trials : which trials
        run_in_process : runs a function of the module level in a worker process and returns its result
        """
