"""Rows: the per-trial columns of a cell into one row of the result document."""

from __future__ import annotations

from hough_tui.experiments.cases import AnyCell, Row
from hough_tui.experiments.columns.schema import Columns
from hough_tui.experiments.metrics.metric import Sample
from hough_tui.experiments.metrics.registry import metrics_of_columns


def row_of(cell: AnyCell, columns: Columns, seconds: float) -> Row:
    """Return the row that tables, charts and files are made of: what ran, every metric, the settings.

    Parameters
    ----------
    cell : what ran
    columns : what each trial gave, at least one trial
    seconds : worker time from draw to score, the control left out
    """
    sample = Sample(cell, columns, seconds)
    row = cell.heading(len(columns))
    for metric in metrics_of_columns(columns):
        row |= metric.entries(sample)
    return row | cell.settings()
