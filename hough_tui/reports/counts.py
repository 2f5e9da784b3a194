"""The result rows of an experiment of clustering as a sheet: how well targets are counted and placed."""

from __future__ import annotations

from collections.abc import Sequence

from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.numerals import intervals, number, pair, percent, significant
from hough_tui.reports.row_columns import (
    Row,
    interval,
    measured,
    name_columns,
    percents,
    swept_columns,
    time_column,
    trial_words,
)


def count_sheet(title: str, rows: Sequence[Row]) -> Sheet:
    """Return the rows of an experiment of clustering as a sheet.

    Parameters
    ----------
    title : a line above it
    rows : result rows as `hough-tui batch --json` prints them
    """
    columns = [
        *name_columns(rows, "scene", "clustering"),
        *swept_columns(rows),
        Column("exact\n%", percents(rows, "count_exact_rate")),
        *interval(rows, "count_exact_ci95", rank=20, called="the interval of exact counts"),
        *measured(rows, "too few\n%", "too_few_rate", percents, rank=40, called="too few clusters"),
        *measured(rows, "too many\n%", "too_many_rate", percents, rank=40, called="too many clusters"),
        *measured(rows, "excess\n/trial", "excess_per_trial", rank=50, called="excess clusters"),
        *measured(rows, "RMSE\ncells", "centroid_rmse", rank=10, called="the centroid's error"),
        *_error_interval(rows),
        *time_column(rows),
    ]
    return Sheet(title, tuple(columns), _notes(rows), _warnings(rows))


def _error_interval(rows: Sequence[Row]) -> list[Column]:
    pairs = [pair(row.get("centroid_rmse_ci95")) for row in rows]
    if all(ends == (None, None) for ends in pairs):
        return []
    cells = intervals([(significant(low), significant(high)) for low, high in pairs])
    return [Column("95 %\ninterval", cells, rank=30, quiet=True, called="the interval of that error")]


def _notes(rows: Sequence[Row]) -> tuple[str, ...]:
    scenes = list(dict.fromkeys(str(row.get("scene") or "") for row in rows))
    words = (
        "Exact: as many clusters as targets. RMSE: of the distance from a target's centre to the nearest "
        "plot, in cells."
    )
    if len(scenes) == 1 and scenes[0]:
        words = f"Scene {scenes[0]}. {words}"
    return words, trial_words(rows)


def _warnings(rows: Sequence[Row]) -> tuple[str, ...]:
    share = max((_share_without_plot(row) for row in rows), default=0.0)
    if share < 0.01:
        return ()
    return (f"In up to {percent(share)} % of a row's trials there is no plot at all; RMSE leaves them out.",)


def _share_without_plot(row: Row) -> float:
    trials, empty = number(row.get("trials")), number(row.get("trials_without_plot"))
    return (empty or 0.0) / trials if trials else 0.0
