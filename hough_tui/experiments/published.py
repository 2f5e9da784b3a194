"""Published tables, and how they compare with what is measured here."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.intervals import Z95, effective_count, mean_interval
from algorithms.parameters import unknown
from hough_tui.experiments.columns import TrialColumns
from hough_tui.experiments.engine import Job
from hough_tui.experiments.plan import Cell, Plan, plan_run
from hough_tui.experiments.tallies import false_ratio
from scenarios.files import load_set

PerTrial = Callable[[TrialColumns], NDArray[np.float64]]

METRICS: dict[str, PerTrial] = {
    "success_rate": lambda columns: columns.found.mean(axis=1),
    "false_track_ratio": false_ratio,
    "success_control": lambda columns: columns.control_found.mean(axis=1),
}
"""Rates that are means of per-trial values in [0, 1]."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One figure of a published table.

    Attributes
    ----------
    case : how the row is called
    experiment, swept : which cell of the bundled set measures it
    metric : a name of `METRICS`
    published : the printed figure; None where the source has none
    note : what a reader must know
    """

    case: str
    experiment: str
    swept: dict[str, int | float]
    metric: str
    published: float | None = None
    note: str | None = None


@dataclass(frozen=True, slots=True)
class PublishedTable:
    """A published table and the bundled set that measures it.

    Attributes
    ----------
    name, title, source : what it is
    set_name, initiator : which initiator entry of which bundled set
    trials : number of trials behind each published figure
    rounding : half the last printed digit
    entries : its figures
    """

    name: str
    title: str
    source: str
    set_name: str
    initiator: str
    trials: int
    rounding: float
    entries: tuple[Entry, ...]


def _course_table(
    number: str, initiator: str, published: dict[int, tuple[float, float]], note: str | None = None
) -> PublishedTable:
    entries: list[Entry] = []
    for scans, (success, false) in published.items():
        case, swept = f"{initiator}, {scans} scans", {"scans": scans}
        sound = f"{case}, θ within 6°"
        entries += [
            Entry(case, "tables", swept, "success_rate", success, note),
            Entry(case, "tables", swept, "false_track_ratio", false, note),
            Entry(case, "tables", swept, "success_control", note="the same draws without targets"),
            Entry(sound, "tables-sound", swept, "success_rate", note="sound criterion"),
            Entry(sound, "tables-sound", swept, "false_track_ratio", note="sound criterion"),
            Entry(sound, "tables-sound", swept, "success_control", note="sound criterion, without targets"),
        ]
    return PublishedTable(
        name=f"course-{number}",
        title=f"Table {number}: {initiator} Hough transform, by number of scans",
        source="course report, Northwestern Polytechnical University, 2018",
        set_name="course-report",
        initiator=initiator,
        trials=100,
        rounding=0.0005,
        entries=tuple(entries),
    )


TABLES: dict[str, PublishedTable] = {
    table.name: table
    for table in (
        _course_table("2-1", "standard", {5: (1.0, 0.883), 10: (0.995, 0.709), 15: (1.0, 0.329)}),
        _course_table("2-2", "sequential", {5: (0.285, 0.71), 10: (0.695, 0.29), 15: (0.92, 0.07)}),
    )
}


def published_table(name: str) -> PublishedTable:
    """Return a published table.

    Raises
    ------
    RequestError
        Where there is none of that name.
    """
    if name not in TABLES:
        raise RequestError(unknown(name, list(TABLES), "table"))
    return TABLES[name]


def plan_table(table: PublishedTable, trials: int, seed: int | None = None) -> Plan:
    """Return the plan of the cells that a table's figures need."""
    given = load_set(table.set_name)
    names = {entry.experiment for entry in table.entries}
    experiments = [
        experiment.model_copy(update={"initiators": [table.initiator]})
        for experiment in given.experiments
        if experiment.name in names
    ]
    return plan_run([given.model_copy(update={"experiments": experiments})], trials=trials, seed=seed)


def compare(table: PublishedTable, job: Job) -> dict[str, Any]:
    """Return a table's published figures beside those that a finished job measured."""
    found = [(cell, columns) for cell, columns, _ in job.finished()]
    return {
        "table": table.name,
        "title": table.title,
        "source": table.source,
        "trials": int(job.progress.total[0]),
        "published_trials": table.trials,
        "rows": [_compared(table, entry, _columns_of(entry, found)) for entry in table.entries],
    }


def _columns_of(entry: Entry, found: Sequence[tuple[Cell, TrialColumns]]) -> TrialColumns:
    return next(
        columns
        for cell, columns in found
        if cell.experiment.name == entry.experiment and cell.swept == entry.swept
    )


def _compared(table: PublishedTable, entry: Entry, columns: TrialColumns) -> dict[str, Any]:
    values = METRICS[entry.metric](columns)
    return {
        "case": entry.case,
        "metric": entry.metric,
        "published": entry.published,
        "measured": float(values.mean()),
        "ci95": list(mean_interval(values)),
        "consistent": is_consistent(entry.published, table.trials, table.rounding, values),
        "note": entry.note,
    }


def is_consistent(
    published: float | None, trials: int, rounding: float, values: NDArray[np.float64]
) -> bool | None:
    """Return whether a published mean may be of the same kind as measured per-trial values.

    Parameters
    ----------
    published : the printed mean; None gives None
    trials : number of trials behind it; they are taken to scatter as the measured ones do
    rounding : half the last printed digit
    values : measured per-trial values in [0, 1]

    Notes
    -----
    Two-sided test of two proportions at 5 %, with the pooled rate and, for both, the number of
    yes-or-no observations that the trials are worth.
    """
    if published is None:
        return None
    measured, count = float(values.mean()), effective_count(values)
    published_count = count * trials / len(values)
    pooled = (measured * count + published * published_count) / (count + published_count)
    error = math.sqrt(pooled * (1.0 - pooled) * (1.0 / count + 1.0 / published_count))
    return abs(measured - published) <= Z95 * error + rounding + 1e-12
