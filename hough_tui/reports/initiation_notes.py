"""What a table of result rows of initiation says beside its figures: criterion, work, warnings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hough_tui.reports.numerals import as_given, number, percent, significant
from hough_tui.reports.row_columns import Row, trial_words

HIGH_CONTROL = 0.05
"""From here on clutter alone is no small part of a success."""

NAMES = ("scenario", "clustering", "initiator")
"""Keys of the names of what ran."""


def criterion_words(criterion: Mapping[str, Any] | None, unit: str) -> str:
    """Return a match criterion as a sentence.

    Parameters
    ----------
    criterion : `rho`, `theta_deg`, `plots`, each a number or null; `at`, `nearest` where they matter
    unit : of length; empty where the rows have several
    """
    bounds = {key: as_given(value) for key, value in (criterion or {}).items() if value is not None}
    length = unit or "of the scenario's unit"
    clauses = []
    if "plots" in bounds:
        clauses.append(f"at least {bounds['plots']} of its plots are the target's own")
    if "rho" in bounds:
        clauses.append(f"|Δρ| ≤ {bounds['rho']} {length}")
    if "theta_deg" in bounds:
        clauses.append(f"|Δθ| ≤ {bounds['theta_deg']}°")
    if not clauses:
        return ""
    words = " and ".join(clauses)
    if "at" in bounds:
        words += ", ρ compared about the middle of its path"
    if "rho" in bounds and "theta_deg" not in bounds:
        words += ", θ not compared"
    if "nearest" in bounds:
        words += "; of several such targets, the nearest alone"
    return f"A track matches a target when {words}."


def notes(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the sentences below a table of rows of one experiment."""
    units = list(dict.fromkeys(str(row.get("unit") or "") for row in rows))
    scenarios = list(dict.fromkeys(str(row.get("scenario") or "") for row in rows))
    words = criterion_words(rows[0].get("criterion"), units[0] if len(units) == 1 else "")
    if len(scenarios) == 1 and scenarios[0]:
        words = f"Scenario {scenarios[0]}. {words}".rstrip()
    return tuple(filter(None, (words, trial_words(rows), *_flat(rows), *_efforts(rows))))


def _efforts(rows: Sequence[Row]) -> Iterator[str]:
    """Yield what initiators counted of their work, one sentence for those that counted the same."""
    efforts: dict[str, dict[str, list[float]]] = {}
    for row in rows:
        for name, count in (row.get("effort_per_trial") or {}).items():
            counts = efforts.setdefault(str(row.get("initiator") or ""), {}).setdefault(name, [])
            counts.append(float(count))
    alike: dict[str, list[str]] = {}
    for initiator, counted in efforts.items():
        parts = []
        for name, counts in counted.items():
            least, most = significant(min(counts)), significant(max(counts))
            parts.append(f"{name.replace('_', ' ')} {least}" + (f" to {most}" if least != most else ""))
        alike.setdefault(", ".join(parts), []).append(initiator)
    for words, initiators in alike.items():
        yield f"{', '.join(initiators)}, on the mean of a trial: {words}."


def _flat(rows: Sequence[Row]) -> Iterator[str]:
    """Yield which initiators look at x and y alone, of plots in space."""
    names = dict.fromkeys(str(row.get("initiator") or "") for row in rows if row.get("ignores_z"))
    if names:
        yield f"{', '.join(names)} work{'s' if len(names) == 1 else ''} in the plane: z is ignored."


def warnings(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the sentences that change how a table of rows is to be read."""
    sentences = []
    control = max((number(row.get("success_control")) or 0.0 for row in rows), default=0.0)
    if control >= HIGH_CONTROL:
        sentences.append(
            "With every target taken out, clutter alone still reaches a success of up to "
            f"{percent(control)} % (control). Read success against control in the same row: where the two "
            "are close, success does not show that targets were found."
        )
    empty = max((number(row.get("no_track_rate")) or 0.0 for row in rows), default=0.0)
    if empty >= 0.01:
        sentences.append(
            f"In up to {percent(empty)} % of a row's trials there is no track at all; false % counts "
            "them as 0."
        )
    outside = max((number(row.get("votes_outside_per_trial")) or 0.0 for row in rows), default=0.0)
    if outside > 0.0:
        sentences.append(
            f"Up to {significant(outside)} votes a trial fall outside the grid: its range of ρ does not "
            "cover all plots."
        )
    return tuple(sentences)
