"""What the list of kept runs says of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from algorithms.errors import RequestError
from hough_tui.experiments.stores.folder import RunStore
from hough_tui.reports.layout import Column
from hough_tui.reports.numerals import NONE, as_given

STAMP = "%Y%m%d-%H%M%S"
"""How a run's name begins."""


@dataclass(frozen=True, slots=True)
class KeptSummary:
    """One run of the list.

    Attributes
    ----------
    name : in the store
    when, sets, experiments, rows, trials, seed : as they are shown
    state : empty where the run is complete and can be read
    """

    name: str
    when: str
    sets: str = NONE
    experiments: str = NONE
    rows: str = NONE
    trials: str = NONE
    seed: str = NONE
    state: str = ""


def summaries(store: RunStore, known: Mapping[str, KeptSummary]) -> list[KeptSummary]:
    """Return what there is to say of the runs, the newest first.

    Parameters
    ----------
    store : where they are
    known : by name, what was read before: a run never changes
    """
    return [known.get(name) or _summary(store, name) for name in store.names()]


def summary_columns(found: list[KeptSummary], marked: set[str]) -> list[Column]:
    """Return the list as columns."""
    return [
        Column("", tuple("●" if summary.name in marked else " " for summary in found), prose=True),
        Column("when", tuple(summary.when for summary in found), prose=True),
        Column("sets", tuple(summary.sets for summary in found), prose=True),
        Column("rows", tuple(summary.rows for summary in found)),
        Column("trials", tuple(summary.trials for summary in found)),
        Column("seed", tuple(summary.seed for summary in found)),
        Column("experiments", tuple(_experiments(summary) for summary in found), prose=True),
    ]


def _experiments(summary: KeptSummary) -> str:
    return f"{summary.experiments} ({summary.state})" if summary.state else summary.experiments


def _summary(store: RunStore, name: str) -> KeptSummary:
    try:
        document = store.document(name)
        return _of(name, document)
    except (RequestError, KeyError, TypeError, ValueError):
        return KeptSummary(name, _when(name), state="damaged")


def _of(name: str, document: Mapping[str, Any]) -> KeptSummary:
    rows = document["rows"]
    counts = {int(row["trials"]) for row in rows}
    seeds = list(dict.fromkeys(row["seed"] for row in rows))
    few, many = min(counts, default=0), max(counts, default=0)
    return KeptSummary(
        name,
        _when(name),
        ", ".join(document["sets"]),
        ", ".join(dict.fromkeys(row["experiment"] for row in rows)) or NONE,
        f"{len(rows):,}",
        f"{many:,}" if few == many else f"{few:,}–{many:,}",
        as_given(seeds[0]) if len(seeds) == 1 else "several" if seeds else NONE,
        "" if document.get("complete", True) else "part",
    )


def _when(name: str) -> str:
    stamp = "-".join(name.split("-")[:2])
    try:
        return f"{datetime.strptime(stamp, STAMP):%Y-%m-%d %H:%M:%S}"
    except ValueError:
        return name
