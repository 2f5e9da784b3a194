"""What a quantisation leads to, beside what the recommended one leads to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.text import Text
from textual.reactive import reactive
from textual.widget import Widget

from hough_tui.reports.numerals import as_given, durations, percent, significant

if TYPE_CHECKING:
    from hough_tui.quantisation.forecast import Outlook
    from hough_tui.quantisation.vote_cost import VoteCost

COLUMN = 13
"""Cells of a column of figures."""

UNKNOWN = "…"


@dataclass(frozen=True, slots=True)
class Compared:
    """What the table shows.

    Attributes
    ----------
    own : of the entry as it is
    recommended : None where it is not known yet, or not at all
    cost : what votes cost on this machine; None before it was measured
    unit : of length
    missing : what stands for a recommendation that there is not
    """

    own: Outlook
    recommended: Outlook | None
    cost: VoteCost | None
    unit: str
    missing: str = UNKNOWN


class PredictionTable(Widget):
    """Eight figures of two quantisations; what the recommendation would change is in bold."""

    DEFAULT_CSS = """
    PredictionTable { height: 9; width: 1fr; padding: 0 1; }
    """

    compared: reactive[Compared | None] = reactive(None)

    def render(self) -> Text:
        """Return a row for each figure."""
        if self.compared is None:
            return Text("")
        return table(self.compared, self.size.width)


def table(compared: Compared, width: int) -> Text:
    """Return the table in so many columns."""
    room = max(1, width - 2 * COLUMN)
    every = rows(compared)
    # All long names or none: a mixture would read as if it meant something.
    which = 0 if all(len(names[0]) < room for names, *_ in every) else 1
    lines = [Text(f"{'':{room}}{'now':>{COLUMN}}{'recommended':>{COLUMN}}", style="dim")]
    for names, figure, is_choice in every:
        own = figure(compared.own)
        other = compared.missing if compared.recommended is None else figure(compared.recommended)
        line = Text(f"{names[which]:{room}}")
        line.append(f"{own:>{COLUMN}}", "" if is_choice else "bold")
        is_new = compared.recommended is not None and other != own
        line.append(f"{other:>{COLUMN}}", "bold" if is_new else "dim")
        lines.append(line)
    return Text("\n", no_wrap=True).join(lines)


def rows(compared: Compared) -> list[tuple[tuple[str, str], Callable[[Outlook], str], bool]]:
    """Return long and short name of each row, how its figure is told, and whether it is one to choose."""
    unit, cost = compared.unit, compared.cost
    return [
        (("Δθ in ° (θ bins)", "Δθ, °"), _rows, True),
        ((f"Δρ in {unit} (columns)", f"Δρ, {unit}"), _columns, True),
        (("least votes", "votes ≥"), lambda told: f"{told.votes:,}", True),
        (("votes in the home cell", "home cell"), lambda told: f"{percent(told.share)} %", False),
        (("P_D of the home cell", "P_D"), lambda told: f"{percent(told.p_detection)} %", False),
        (("false cells a batch", "false cells"), lambda told: significant(told.false_cells), False),
        (("memory of the accumulator", "memory"), lambda told: _size(told.size), False),
        (("time a trial, estimated", "time, est."), lambda told: _duration(told, cost), False),
    ]


def _rows(told: Outlook) -> str:
    return _counted(math.degrees(told.grid.theta_step), told.grid.theta_bins)


def _columns(told: Outlook) -> str:
    return _counted(told.grid.rho_step, told.grid.rho_bins)


def _counted(step: float, bins: int) -> str:
    """Return a step and how many bins that makes, as exactly as there is room for."""
    steps = [as_given(float(f"{step:.{digits}g}")) for digits in (4, 3, 2)]
    return next((text for shown in steps if len(text := f"{shown} ({bins})") < COLUMN - 1), steps[1])


def _size(size: int) -> str:
    for unit, factor in (("GiB", 2**30), ("MiB", 2**20)):
        if size >= 0.1 * factor:
            return f"{significant(size / factor)} {unit}"
    return f"{significant(size / 2**10)} KiB"


def _duration(told: Outlook, cost: VoteCost | None) -> str:
    if cost is None:
        return UNKNOWN
    # To two digits: more would promise too much.
    seconds = float(f"{cost.seconds(told.votes_cast, math.prod(told.grid.shape)):.1e}")
    unit, (text,) = durations([seconds])
    return f"{float(text.replace(',', '')):,.4g} {unit}"
