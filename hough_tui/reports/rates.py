"""The result rows of Monte Carlo experiments as sheets, one an experiment."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hough_tui.reports.counts import count_sheet
from hough_tui.reports.layout import Column, Sheet, broken
from hough_tui.reports.numerals import (
    aligned,
    as_given,
    number,
    percent,
    significant,
)
from hough_tui.reports.row_columns import (
    SHORT_KEY,
    Row,
    interval,
    measured,
    name_columns,
    percents,
    swept_columns,
    time_column,
    trial_words,
)

HIGH_CONTROL = 0.05
"""From here on clutter alone is no small part of a success."""

MANY_TARGETS, UNLIKE = 3, 0.1
"""Where so many targets differ by more than this, their mean says little: success by target goes first."""

SUCCESS, BY_TARGET = "success %", "success by target"
"""The name of the column of success, and what those of each target are called."""


def rate_sheets(rows: Sequence[Row]) -> list[Sheet]:
    """Return one sheet for each experiment of each set, in the order of their first rows.

    Parameters
    ----------
    rows : result rows as `hough-tui batch --json` prints them
    """
    experiments: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        key = (str(row.get("set") or ""), str(row.get("experiment") or ""))
        experiments.setdefault(key, []).append(row)
    return [_fitting_sheet(" · ".join(filter(None, key)), part) for key, part in experiments.items()]


def _fitting_sheet(title: str, rows: Sequence[Row]) -> Sheet:
    """Return the sheet of rows of initiation, of clustering, or, of several experiments, of both."""
    of_scenes = [row for row in rows if "scene" in row]
    if not of_scenes:
        return _sheet(title, rows)
    if len(of_scenes) == len(rows):
        return count_sheet(title, rows)
    first, second = _sheet(title, rows), count_sheet(title, rows)
    known = {(column.name, column.called) for column in first.columns}
    further = tuple(column for column in second.columns if (column.name, column.called) not in known)
    return Sheet(title, first.columns + further, first.notes + second.notes, first.warnings + second.warnings)


def criterion_words(criterion: Mapping[str, Any] | None, unit: str) -> str:
    """Return a match criterion as a sentence.

    Parameters
    ----------
    criterion : `rho`, `theta_deg`, `plots`, each a number or null; `at`, `nearest` where they matter
    unit : of length; empty where the rows have several
    """
    given = {key: as_given(value) for key, value in (criterion or {}).items() if value is not None}
    length = unit or "of the scenario's unit"
    clauses = []
    if "plots" in given:
        clauses.append(f"at least {given['plots']} of its plots are the target's own")
    if "rho" in given:
        clauses.append(f"|Δρ| ≤ {given['rho']} {length}")
    if "theta_deg" in given:
        clauses.append(f"|Δθ| ≤ {given['theta_deg']}°")
    if not clauses:
        return ""
    words = " and ".join(clauses)
    if "at" in given:
        words += ", ρ compared about the middle of its path"
    if "rho" in given and "theta_deg" not in given:
        words += ", θ not compared"
    if "nearest" in given:
        words += "; of several such targets, the nearest alone"
    return f"A track matches a target when {words}."


def _sheet(title: str, rows: Sequence[Row]) -> Sheet:
    units = list(dict.fromkeys(str(row.get("unit") or "") for row in rows))
    unit = units[0] if len(units) == 1 else ""
    columns = [
        *name_columns(rows, "scenario", "clustering", "initiator"),
        *swept_columns(rows),
        *_success(rows),
        *_false(rows),
        *_further(rows, units),
    ]
    return Sheet(title, tuple(columns), _notes(rows, unit), _warnings(rows))


def _success(rows: Sequence[Row]) -> list[Column]:
    columns = [Column("success\n%", percents(rows, "success_rate"))]
    columns += interval(rows, "success_ci95", rank=20, called="the interval of success")
    columns += measured(rows, "control\n%", "success_control", percents, rank=10, called="control")
    return columns


def _false(rows: Sequence[Row]) -> list[Column]:
    columns = [Column("false\n%", percents(rows, "false_track_ratio"))]
    columns += interval(rows, "false_track_ratio_ci95", rank=75, called="the interval of false %")
    columns += measured(
        rows, "false\n/trial", "false_tracks_per_trial", rank=30, called="false tracks a trial"
    )
    columns += measured(rows, "duplic.\n/trial", "duplicates_per_trial", rank=40, called="duplicates")
    columns += measured(rows, "tracks\n/trial", "tracks_per_trial", rank=70, called="tracks a trial")
    columns += measured(rows, "pure\n%", "pure_track_ratio", percents, rank=60, called="pure tracks")
    return columns


def _further(rows: Sequence[Row], units: Sequence[str]) -> list[Column]:
    columns = measured(rows, "θ RMSE\n°", "theta_rmse_deg", rank=50, called="θ RMSE")
    if len(units) == 1:
        heading = f"ρ RMSE\n{units[0]}" if units[0] else "ρ RMSE"
        columns += measured(rows, heading, "rho_rmse", rank=60, called="ρ RMSE")
    elif any(number(row.get("rho_rmse")) is not None for row in rows):
        errors = aligned([significant(number(row.get("rho_rmse"))) for row in rows])
        room = max(len(str(row.get("unit") or "")) for row in rows)
        cells = tuple(
            f"{error} {row.get('unit') or '':<{room}}" for error, row in zip(errors, rows, strict=True)
        )
        columns.append(Column("ρ RMSE", cells, rank=60))
    columns += time_column(rows)
    empty = [_share_without_track(row) for row in rows]
    if any(empty):
        cells = aligned([percent(value) for value in empty])
        columns.append(Column("no track\n%", cells, rank=80, called="trials without a track"))
    columns += _by_target(rows)
    return columns


def _by_target(rows: Sequence[Row]) -> list[Column]:
    shares = [[number(value) for value in row.get("success_by_target") or []] for row in rows]
    most = max(map(len, shares), default=0)
    if most < 2:
        return []
    known = [[share for share in values if share is not None] for values in shares]
    spread = max((max(values) - min(values) for values in known if values), default=0.0)
    # Of two targets the mean tells nearly as much; of more it hides which of them is missed.
    rank = 90 if most < MANY_TARGETS else 35 if spread > UNLIKE else 55
    columns = []
    for target in range(most):
        cells = [percent(values[target] if target < len(values) else None) for values in shares]
        heading = f"{broken(_target_name(rows, target), SHORT_KEY)}\n%"
        columns.append(Column(heading, aligned(cells), rank=rank, quiet=True, called=BY_TARGET))
    return columns


def _target_name(rows: Sequence[Row], target: int) -> str:
    """Return what all rows call a target, else its number."""
    names = {(list(row.get("target_names") or []) + [None] * (target + 1))[target] for row in rows}
    name = names.pop() if len(names) == 1 else None
    return str(name or f"target {target + 1}")


def _notes(rows: Sequence[Row], unit: str) -> tuple[str, ...]:
    scenarios = list(dict.fromkeys(str(row.get("scenario") or "") for row in rows))
    words = criterion_words(rows[0].get("criterion"), unit)
    if len(scenarios) == 1 and scenarios[0]:
        words = f"Scenario {scenarios[0]}. {words}".rstrip()
    return tuple(filter(None, (words, trial_words(rows), *_flat(rows), *_efforts(rows))))


def _efforts(rows: Sequence[Row]) -> Iterator[str]:
    """Yield what initiators counted of their work, one sentence for those that counted the same."""
    told: dict[str, dict[str, list[float]]] = {}
    for row in rows:
        for name, count in (row.get("effort_per_trial") or {}).items():
            counts = told.setdefault(str(row.get("initiator") or ""), {}).setdefault(name, [])
            counts.append(float(count))
    alike: dict[str, list[str]] = {}
    for initiator, counted in told.items():
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


def _share_without_track(row: Row) -> float:
    trials, empty = number(row.get("trials")), number(row.get("trials_without_track"))
    return (empty or 0.0) / trials if trials else 0.0


def _warnings(rows: Sequence[Row]) -> tuple[str, ...]:
    warnings = []
    control = max((number(row.get("success_control")) or 0.0 for row in rows), default=0.0)
    if control >= HIGH_CONTROL:
        warnings.append(
            "With every target taken out, clutter alone still reaches a success of up to "
            f"{percent(control)} % (control). Read success against control in the same row: where the two "
            "are close, success does not show that targets were found."
        )
    empty = max(map(_share_without_track, rows), default=0.0)
    if empty >= 0.01:
        warnings.append(
            f"In up to {percent(empty)} % of a row's trials there is no track at all; false % counts "
            "them as 0."
        )
    outside = max((number(row.get("votes_outside_per_trial")) or 0.0 for row in rows), default=0.0)
    if outside > 0.0:
        warnings.append(
            f"Up to {significant(outside)} votes a trial fall outside the grid: its range of ρ does not "
            "cover all plots."
        )
    return tuple(warnings)
