"""The result document of a run, what its rows are told apart by, and the trials behind them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from algorithms.errors import RequestError
from hough_tui import __version__
from hough_tui.experiments.cases import AnyCell
from hough_tui.experiments.columns.schema import Columns
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.formats import FORMAT
from hough_tui.experiments.metrics.kinds import kind_of
from hough_tui.experiments.metrics.metric import AnySample, Sample
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.rows import row_of
from hough_tui.experiments.stores.folder import Run
from scenarios.sweeps import SINGULAR

Identity = tuple[str, str, tuple[str | None, ...], tuple[tuple[str, float], ...]]
"""Set, experiment, what of the set runs, and the swept values."""


def identity(row: Mapping[str, Any]) -> Identity:
    """Return what makes two rows of different runs the same one."""
    swept = tuple(sorted((row.get("swept") or {}).items()))
    return row["set"], row["experiment"], tuple(row.get(part) for part in SINGULAR.values()), swept


def result(job: Job) -> Run:
    """Return the finished trials of a job, as they are printed and kept.

    The document's `seed` is None where the experiments have several; each row has its own.
    `complete` tells whether every trial was done.
    """
    finished = list(job.finished())
    seeds = {cell.experiment.seed for cell in job.plan.cells}
    document: dict[str, Any] = {
        "format": FORMAT,
        "sets": [scenario_set.name for scenario_set in job.plan.sets],
        "seed": seeds.pop() if len(seeds) == 1 else None,
        "version": __version__,
        "complete": job.is_complete,
        "rows": [row_of(cell, columns, seconds) for cell, columns, seconds in finished],
    }
    return Run(job.plan.sets, document, tuple(columns.arrays() for _, columns, _ in finished))


def cells_of_run(run: Run) -> list[AnyCell | None]:
    """Return the cell of each row of a run, None where its sets do not hold it.

    The rows are those cells, in their order, that had finished trials.
    """
    rows = run.document["rows"]
    try:
        cells = iter(plan_run(run.sets).cells)
    except RequestError:
        return [None] * len(rows)
    matching: list[AnyCell | None] = []
    for row in rows:
        wanted = identity(row)
        matching.append(next((cell for cell in cells if identity(cell.blank()) == wanted), None))
    return matching


def columns_of_row(run: Run, index: int) -> Columns:
    """Return the per-trial columns of a row of a run.

    Raises
    ------
    RequestError
        Where a column is missing or damaged.
    """
    row = run.document["rows"][index]
    return kind_of(row).columns.read(run.columns[index], row["trials"])


def sample_of_row(run: Run, index: int, cell: AnyCell) -> AnySample:
    """Return the trials of a row of a run, from which metrics are computed; `cell` is the row's."""
    row = run.document["rows"][index]
    return Sample(cell, columns_of_row(run, index), row["seconds_per_trial"] * row["trials"])
