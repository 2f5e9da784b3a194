"""Base of the extractions: a way to choose the cells of an accumulator that are tracks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.hough.grid import Grid

EVERY = 2**62
"""More cells than there are: what kernels take where all are wanted."""


@dataclass(frozen=True, slots=True)
class Extraction(ABC):
    """A way to choose cells; each class has a module of its own and the parameters that it uses.

    Attributes
    ----------
    name : what it is called everywhere
    summary : which cells with enough votes it takes, for people
    windows : its default half window in θ rows and in ρ columns, for people; None without a window
    half_window : the same as numbers, where it depends on nothing
    cells_of_trials : kernel that `ballots.trial_loop` makes
    votes : the least votes, or weighted votes, of a chosen cell
    maxima : how many cells are chosen at most, the greatest; None for all
    last : whether of equal cells the last in θ-major order is taken
    """

    name: ClassVar[str]
    summary: ClassVar[str]
    windows: ClassVar[tuple[str, str] | None] = None
    half_window: ClassVar[tuple[int, int]] = (0, 0)
    cells_of_trials: ClassVar[Callable[..., Any]]

    votes: int
    maxima: int | None = None
    last: bool = True

    @classmethod
    def of(cls, choices: Mapping[str, Any]) -> Self:
        """Return the extraction with those of the choices that are its parameters.

        Parameters
        ----------
        choices : `votes`, `maxima`, `last`, `rows` and `columns` of half the window, and `wrap`
        """
        return cls(**{declared.name: choices[declared.name] for declared in fields(cls)})

    @classmethod
    def default_window(cls, grid: Grid, context: Context, votes: float) -> tuple[int, int]:
        """Return half the window around a chosen cell whose votes belong to its peak, in rows and columns."""
        return cls.half_window

    @property
    def most(self) -> int:
        """How many cells are chosen at most, as a number."""
        return EVERY if self.maxima is None else self.maxima

    @abstractmethod
    def rule(self, grid: Grid, threshold: Any) -> NamedTuple:
        """Return what the kernel needs to know.

        Parameters
        ----------
        grid : the quantisation
        threshold : `votes` in the type of the accumulator
        """

    def limited(self, cells: NDArray[Any], ends: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[np.int64]]:
        """Return at most `maxima` cells of each trial; here all, since the kernel counts them itself."""
        return cells, ends


def greatest(
    cells: NDArray[Any], ends: NDArray[np.int64], most: int, last: bool
) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Return the greatest cells of each trial, at most so many, in the order in which they came."""
    if len(cells) <= most:
        return cells, ends
    counts = np.diff(ends)
    trial = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(cells))
    order = np.lexsort((-place if last else place, -cells[:, 2], trial))
    rank = np.empty(len(cells), np.int64)
    rank[order] = place - np.repeat(ends[:-1], counts)
    return cells[rank < most], np.concatenate([[0], np.cumsum(np.minimum(counts, most))])
