"""The trials of a row of initiation: targets found, tracks, false ones, errors."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.chunks.initiation import InitiationCell
from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.reports.numerals import fixed, number
from hough_tui.ui.runs.shown_run import RowTrials
from hough_tui.ui.widgets.trial_table import PLAIN, QUIET, WRONG, Rows, TrialColumn, TrialTable, by_number

TracksOfTrials = RowTrials[InitiationCell, TrialColumns]


def _failed_first(trials: TracksOfTrials) -> Rows:
    columns = trials.columns
    found = columns.found.sum(axis=1)
    # The last key counts most.
    return np.lexsort((trials.numbers, -columns.duplicates, -columns.false, found))


def _by_false(trials: TracksOfTrials) -> Rows:
    return np.argsort(-trials.columns.false, kind="stable")


def _by_duplicates(trials: TracksOfTrials) -> Rows:
    return np.argsort(-trials.columns.duplicates, kind="stable")


def _by_rho_error(trials: TracksOfTrials) -> Rows:
    return _by_greatest(trials.columns.rho_error)


def _by_theta_error(trials: TracksOfTrials) -> Rows:
    return _by_greatest(trials.columns.theta_error)


def _by_greatest(errors: NDArray[np.float32]) -> Rows:
    if errors.shape[1] == 0:
        return np.arange(len(errors))
    known = np.where(np.isnan(errors), -1.0, np.abs(errors))
    return np.argsort(-known.max(axis=1), kind="stable")


class TrackTrials(TrialTable[InitiationCell, TrialColumns]):
    """The trials behind a row of initiation."""

    ORDERS = {
        "failed first": _failed_first,
        "trial": by_number,
        "false tracks": _by_false,
        "duplicates": _by_duplicates,
        "error in ρ": _by_rho_error,
        "error in θ": _by_theta_error,
    }

    def __init__(self, trials: TracksOfTrials) -> None:
        columns = trials.columns
        self.targets = columns.found.shape[1]
        self._found = columns.found.sum(axis=1)
        self.missed = int((self._found < self.targets).sum())
        self.with_false = int((columns.false > 0).sum())
        super().__init__(trials)

    @property
    def words(self) -> str:
        """How many trials there are, and how many failed."""
        unit = self.trials.cell.world.unit.value
        missing = "" if not self.targets else f" · {self.missed:,} miss a target"
        return f"{len(self):,} trials{missing} · {self.with_false:,} have false tracks · lengths in {unit}"

    def told(self) -> list[TrialColumn]:
        """Return what was found, and what else was initiated."""
        columns, found = self.trials.columns, list[TrialColumn]()
        if self.targets:
            found.append(TrialColumn("found", 5, self._found_cell, "failed first"))
        found += [
            TrialColumn("tracks", 6, lambda row: (f"{columns.tracks[row]:,}", PLAIN)),
            TrialColumn("false", 5, self._count(columns.false), "false tracks"),
            TrialColumn("dupl.", 5, self._count(columns.duplicates), "duplicates"),
        ]
        for index, target in enumerate(self.trials.cell.world.targets):
            name = (target.name or f"target {index + 1}")[:12]
            width = max(7, len(name))
            found.append(TrialColumn(f"{name}\nΔθ °", width, self._theta(index), "error in θ"))
            found.append(TrialColumn(f"{name}\nΔρ", width, self._rho(index), "error in ρ"))
        if columns.control_found.size:
            control = columns.control_found.sum(axis=1)
            found.append(TrialColumn("control", 7, lambda row: (f"{control[row]}/{self.targets}", QUIET)))
        if columns.votes_outside.any():
            outside = columns.votes_outside
            found.append(TrialColumn("votes\noutside", 7, lambda row: (f"{outside[row]:,}", QUIET)))
        return found

    def _found_cell(self, row: int) -> tuple[str, str]:
        count = int(self._found[row])
        return f"{count}/{self.targets}", PLAIN if count == self.targets else WRONG

    def _theta(self, target: int) -> Callable[[int], tuple[str, str]]:
        errors = self.trials.columns.theta_error
        return lambda row: self._error(row, target, math.degrees(float(errors[row, target])), 2)

    def _rho(self, target: int) -> Callable[[int], tuple[str, str]]:
        errors = self.trials.columns.rho_error
        return lambda row: self._error(row, target, float(errors[row, target]), 3)

    def _error(self, row: int, target: int, value: float, decimals: int) -> tuple[str, str]:
        if not self.trials.columns.found[row, target]:
            return "missed", WRONG
        return fixed(number(value), decimals), PLAIN

    @staticmethod
    def _count(values: NDArray[np.int32]) -> Callable[[int], tuple[str, str]]:
        return lambda row: (f"{values[row]:,}", PLAIN if values[row] else QUIET)
