"""The result document of a run, and what its rows are told apart by."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hough_tui import __version__
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.stores.folder import Run
from scenarios.sweeps import SINGULAR

Identity = tuple[str, str, tuple[str | None, ...], tuple[tuple[str, float], ...]]
"""Set, experiment, what of the set runs, and the swept values."""


def identity(row: Mapping[str, Any]) -> Identity:
    """Return what makes two rows of different runs the same one."""
    swept = tuple(sorted((row.get("swept") or {}).items()))
    return row["set"], row["experiment"], tuple(row.get(part) for part in SINGULAR.values()), swept


def result(job: Job) -> Run:
    """Return what a job has found so far, as it is printed and kept.

    The document's `seed` is None where the experiments have several; each row has its own.
    `complete` tells whether every trial was done.
    """
    found = list(job.finished())
    seeds = {cell.experiment.seed for cell in job.plan.cells}
    document: dict[str, Any] = {
        "sets": [given.name for given in job.plan.sets],
        "seed": seeds.pop() if len(seeds) == 1 else None,
        "version": __version__,
        "complete": job.is_complete,
        "rows": [cell.tally(columns, seconds) for cell, columns, seconds in found],
    }
    return Run(job.plan.sets, document, tuple(columns.arrays() for _, columns, _ in found))
