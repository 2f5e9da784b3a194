"""What a run is made of, whatever is tried: cells, the draws that they share, and per-trial columns.

A kind of experiment brings its own `Cell`, `SharedDraws` and `Columns`; plan, engine, results and store
know no more of it than what stands here.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from scenarios.experiments import Experiment
from scenarios.sweeps import Point

Row = dict[str, Any]

LARGEST_CHUNK = 200
"""Trials of the largest chunk."""

DETECTIONS_A_CHUNK = 60_000
"""Plots that a chunk is expected to hold: some twenty milliseconds of work, not to be interrupted."""


class Columns(ABC):
    """The columns of one cell, one row a trial; the subclasses are dataclasses of arrays.

    Attributes
    ----------
    trial : int32 (trials,), which trials of the experiment they are, rising
    """

    trial: NDArray[np.int32]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return the columns by name."""
        return {column.name: getattr(self, column.name) for column in fields(self)}  # type: ignore[arg-type]

    @classmethod
    def of(cls, arrays: Mapping[str, NDArray[Any]]) -> Self:
        """Return the columns that `arrays` gave."""
        return cls(**{column.name: arrays[column.name] for column in fields(cls)})  # type: ignore[arg-type]

    def part(self, rows: slice | NDArray[np.bool_]) -> Self:
        """Return the columns of some of the trials."""
        return type(self).of(
            {
                name: column[rows] if len(column) == len(self.trial) else column
                for name, column in self.arrays().items()
            }
        )


@dataclass(frozen=True, slots=True)
class Cell(ABC):
    """One row of the result: what runs on what, both with the swept values put in.

    Attributes
    ----------
    set_name, experiment : where it comes from
    point : what is drawn and what runs on it, with the swept values and the resolved parameters
    """

    set_name: str
    experiment: Experiment
    point: Point

    @property
    def parameters(self) -> Any:
        """The parameters of what runs, resolved."""
        return self.point.parameters

    @property
    def swept(self) -> dict[str, int | float]:
        """The swept values by their keys as they were written."""
        return self.point.swept

    @property
    def world(self) -> Any:
        """What is drawn: a scenario or a scene."""
        return next(iter(self.point.elements.values()))

    @property
    def entry(self) -> Any:
        """The entry of what runs on it."""
        return list(self.point.elements.values())[-1]

    @property
    def elements(self) -> dict[str, str]:
        """The names of what was combined, by part (`scenario`, `initiator` and so on)."""
        return {part: element.name for part, element in self.point.elements.items() if element is not None}

    @property
    def draws_key(self) -> str:
        """What decides the draws beside the seed: cells of equal keys share them."""
        return f"{type(self).__name__} {self.world.model_dump_json()}"

    @property
    def run_key(self) -> str:
        """What decides what is found in a draw: cells of equal keys find it once."""
        return str(self.parameters.model_dump_json())

    def heading(self, trials: int) -> Row:
        """Return what a row says before what was found."""
        return {
            "set": self.set_name,
            "experiment": self.experiment.name,
            **self.elements,
            "swept": dict(self.swept),
            "trials": trials,
            "seed": self.experiment.seed,
        }

    def blank(self) -> Row:
        """Return the row as it is before any trial is finished."""
        return self.heading(0)

    @property
    @abstractmethod
    def bytes_a_trial(self) -> int:
        """Size of a trial's columns."""

    @abstractmethod
    def empty_columns(self) -> Any:
        """Return columns to be filled chunk by chunk."""

    @abstractmethod
    def tally(self, columns: Any, seconds: float) -> Row:
        """Return the row of the document that tables, charts and files are made of.

        Parameters
        ----------
        columns : what each trial gave, at least one trial
        seconds : worker time from draw to score
        """

    @classmethod
    @abstractmethod
    def shared(cls, cells: Sequence[Any], runs: tuple[SharedRun, ...]) -> SharedDraws:
        """Return the work of cells that share their draws.

        Parameters
        ----------
        cells : all cells of the plan
        runs : what runs, on the draws of any of the cells named there
        """


@dataclass(frozen=True, slots=True)
class SharedRun:
    """The cells that score what is found once: one entry with one set of parameters.

    Attributes
    ----------
    entry, parameters : what runs
    cells : indices of the cells in the plan
    """

    entry: Any
    parameters: Any
    cells: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CellChunk(ABC):
    """What the trials of a chunk gave for one cell.

    Attributes
    ----------
    cell : index of the cell in the plan
    seconds : worker time from draw to score
    """

    cell: int
    seconds: float

    @abstractmethod
    def fill(self, columns: Any, first: int) -> None:
        """Put the trials into the columns of the cell, from trial `first` on."""


@dataclass(frozen=True, slots=True)
class SharedDraws(ABC):
    """The cells that see the same draws: one world and one seed.

    Attributes
    ----------
    cells : all cells of the plan
    seed, trials : which draws
    runs : what runs on them
    """

    cells: Sequence[Any]
    seed: int
    trials: int
    runs: tuple[SharedRun, ...]

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
    def prepared(self) -> Any:
        """Return what is worked out once for all chunks."""

    @abstractmethod
    def run(self, prepared: Any, first: int, trials: int, plain: Callable[..., Any]) -> Iterator[CellChunk]:
        """Yield what consecutive trials give, cell by cell; to stop between two runs, stop iterating.

        Parameters
        ----------
        prepared : as `prepared` gave it
        first, trials : which trials
        plain : runs a function of the module level in a worker process and returns its result
        """
