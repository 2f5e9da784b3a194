"""Published figures beside measured ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.intervals import Z95, effective_count
from algorithms.parameters import unknown
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.metrics.metric import AnySample, Sample
from hough_tui.experiments.metrics.registry import metric
from hough_tui.experiments.plan import Plan, plan_run
from hough_tui.published import clustering, course, par, thesis
from hough_tui.published.tables import Entry, PublishedTable
from scenarios.files.set_files import load_set

TABLES: dict[str, PublishedTable] = {
    table.name: table for table in (*course.TABLES, *thesis.TABLES, *par.TABLES, *clustering.TABLES)
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
    """Return the plan of the cells that a table's figures need, and of no others."""
    given = load_set(table.set_name)
    experiments = []
    for experiment in given.experiments:
        wanted = [entry for entry in table.entries if entry.experiment == experiment.name]
        if wanted:
            names = list(dict.fromkeys(entry.method for entry in wanted))
            sweep = {
                key: list(dict.fromkeys(entry.swept[key] for entry in wanted)) for key in experiment.sweep
            }
            update = {experiment.parts[-1]: names, "sweep": sweep}
            experiments.append(experiment.model_copy(update=update))
    return plan_run([given.model_copy(update={"experiments": experiments})], trials=trials, seed=seed)


def compare(table: PublishedTable, job: Job) -> dict[str, Any]:
    """Return a table's published figures beside those that a finished job measured."""
    samples = [Sample(cell, columns, seconds) for cell, columns, seconds in job.finished()]
    return {
        "table": table.name,
        "title": table.title,
        "source": table.source,
        "trials": int(job.progress.total[0]),
        "published_trials": table.trials,
        "rows": [_compared(table, entry, _sample_of(entry, samples)) for entry in table.entries],
    }


def _sample_of(entry: Entry, samples: Sequence[AnySample]) -> AnySample:
    return next(
        sample
        for sample in samples
        if sample.cell.experiment.name == entry.experiment
        and sample.cell.entry.name == entry.method
        and sample.cell.swept == entry.swept
        and entry.world in (None, sample.cell.world.name)
    )


def _compared(table: PublishedTable, entry: Entry, sample: AnySample) -> dict[str, Any]:
    measure = metric(entry.metric)
    estimate = measure.estimate(sample)
    row: dict[str, Any] = {
        "case": entry.case,
        "metric": entry.metric,
        "published": entry.published,
        "measured": estimate.value,
        "ci95": None if estimate.interval is None else list(estimate.interval),
        "consistent": None,
        "note": entry.note,
        "trials_counted": estimate.trials,
    }
    if estimate.value is not None and entry.published is not None and entry.is_judged:
        values = measure.per_trial(sample)
        test = is_consistent_rate if measure.is_share else is_consistent_mean
        row["consistent"] = test(entry.published, table.trials, table.rounding, values[np.isfinite(values)])
    return row


def is_consistent_rate(published: float, trials: int, rounding: float, values: NDArray[np.float64]) -> bool:
    """Return whether a published rate may be of the same kind as measured per-trial values.

    Parameters
    ----------
    published : the printed mean
    trials : number of trials behind it; they are taken to scatter as the measured ones do
    rounding : half the last printed digit
    values : measured per-trial values in [0, 1]

    Notes
    -----
    Two-sided test of two proportions at 5 %, with the pooled rate and, for both, the number of
    yes-or-no observations that the trials are worth.
    """
    measured, count = float(values.mean()), effective_count(values)
    published_count = count * trials / len(values)
    pooled = (measured * count + published * published_count) / (count + published_count)
    error = math.sqrt(pooled * (1.0 - pooled) * (1.0 / count + 1.0 / published_count))
    return abs(measured - published) <= Z95 * error + rounding + 1e-12


def is_consistent_mean(published: float, trials: int, rounding: float, values: NDArray[np.float64]) -> bool:
    """Return whether a published mean may be of the same kind as measured per-trial values.

    Parameters
    ----------
    published, trials, rounding : as in `is_consistent_rate`
    values : measured per-trial values

    Notes
    -----
    Two-sided test of the difference of two means at 5 %, by the normal distribution; for values that
    are seldom large, as square errors are, it asks too little of few published trials, not too much.
    """
    error = float(values.std()) * math.sqrt(1.0 / len(values) + 1.0 / trials)
    return abs(float(values.mean()) - published) <= Z95 * error + rounding
