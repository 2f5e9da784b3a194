"""What a table of result rows of clustering says beside its figures."""

from __future__ import annotations

from collections.abc import Sequence

from hough_tui.reports.numerals import number, percent
from hough_tui.reports.row_columns import Row, trial_words

NAMES = ("scene", "clustering")
"""Keys of the names of what ran."""


def notes(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the sentences below a table of rows of one experiment."""
    scenes = list(dict.fromkeys(str(row.get("scene") or "") for row in rows))
    words = (
        "Exact: as many clusters as targets. RMSE: of the distance from a target's centre to the nearest "
        "plot, in cells."
    )
    if len(scenes) == 1 and scenes[0]:
        words = f"Scene {scenes[0]}. {words}"
    return words, trial_words(rows)


def warnings(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the sentences that change how a table of rows is to be read."""
    share = max((_share_without_plot(row) for row in rows), default=0.0)
    if share < 0.01:
        return ()
    return (f"In up to {percent(share)} % of a row's trials there is no plot at all; RMSE leaves them out.",)


def _share_without_plot(row: Row) -> float:
    trials, empty = number(row.get("trials")), number(row.get("trials_without_plot"))
    return (empty or 0.0) / trials if trials else 0.0
