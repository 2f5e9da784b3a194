"""The result document of a run."""

from __future__ import annotations

from typing import Any

from hough_tui import __version__
from hough_tui.experiments.engine import Job
from hough_tui.experiments.store import Run


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
