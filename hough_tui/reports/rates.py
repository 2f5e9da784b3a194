"""The result rows of Monte Carlo experiments as sheets, one an experiment."""

from __future__ import annotations

from collections.abc import Sequence

from hough_tui.experiments.metrics.kinds import CLUSTERING, INITIATION, kind_of
from hough_tui.reports import clustering_notes, initiation_notes
from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.metric_columns import metric_columns
from hough_tui.reports.row_columns import Row, name_columns, swept_columns

NOTES = {INITIATION: initiation_notes, CLUSTERING: clustering_notes}
"""What tables say beside their figures, by kind of experiment."""


def rate_sheets(rows: Sequence[Row], wanted: Sequence[str] | None = None) -> list[Sheet]:
    """Return one sheet for each experiment of each set, in the order of their first rows.

    Parameters
    ----------
    rows : result rows as `hough-tui batch --json` prints them
    wanted : keys of the metrics and intervals to show, in this order; None for those that say something
    """
    experiments: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        key = (str(row.get("set") or ""), str(row.get("experiment") or ""))
        experiments.setdefault(key, []).append(row)
    return [_sheet(" · ".join(filter(None, key)), part, wanted) for key, part in experiments.items()]


def _sheet(title: str, rows: Sequence[Row], wanted: Sequence[str] | None) -> Sheet:
    """Return the sheet of rows of initiation, of clustering, or, of several experiments, of both."""
    names, notes, warnings = dict[str, Column](), list[str](), list[str]()
    for kind, words in NOTES.items():
        own = [row for row in rows if kind_of(row) is kind]
        if own:
            names |= {column.name: column for column in name_columns(rows, *words.NAMES)}
            notes += words.notes(own)
            warnings += words.warnings(own)
    columns = (*names.values(), *swept_columns(rows), *metric_columns(rows, wanted))
    return Sheet(title, columns, tuple(dict.fromkeys(notes)), tuple(warnings))
