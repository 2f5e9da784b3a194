"""A recommended quantisation on the screen of a terminal, from the document that scripts read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table

from hough_tui.reports.layout import Column, Sheet, sheet_table
from hough_tui.reports.numerals import (
    NONE,
    aligned,
    as_given,
    intervals,
    number,
    pair,
    percent,
    significant,
)

Document = Mapping[str, Any]

MOST_WIDTHS = 10
"""Columns of a map in a terminal; of more, every other one is shown."""


def advice_tables(document: Document, width: int, with_map: bool = False) -> list[Table]:
    """Return the tables of a recommendation.

    Parameters
    ----------
    document : as `hough-tui advise --json` prints it
    width : of the terminal, in cells
    with_map : whether P_D over Δθ and Δρ is among them
    """
    sheets = [advice_sheet(document), trade_off_sheet(document)]
    if with_map:
        sheets.append(map_sheet(document))
    if document.get("check"):
        sheets.append(check_sheet(document))
    return [sheet_table(sheet, width) for sheet in sheets]


def advice_sheet(document: Document) -> Sheet:
    """Return the recommendation and its reasons."""
    unit = str(document.get("unit") or "")
    size = number(document.get("bytes"))
    rows = [
        ("θ bins", as_given(document.get("theta_bins"))),
        ("Δθ", f"{significant(number(document.get('theta_step_deg')))}°"),
        ("Δρ", f"{as_given(document.get('rho_step'))} {unit}".rstrip()),
        ("votes", as_given(document.get("votes"))),
        ("P_D", f"{percent(number(document.get('p_detection')))} %"),
        ("false cells", significant(number(document.get("expected_false_cells")))),
        ("suppression", f"±{document.get('suppress_theta')} rows, ±{document.get('suppress_rho')} columns"),
        (
            "accumulator",
            NONE if size is None else f"{document.get('rho_bins'):,} columns, {size / 2**20:.3g} MiB",
        ),
    ]
    assumed = document.get("assumed") or {}
    notes = [str(reason) for reason in document.get("reasons") or ()]
    notes += [f"Assumed {name}: {value}." for name, value in assumed.items()]
    columns = (
        Column("quantity", tuple(name for name, _ in rows), prose=True),
        Column("value", tuple(value for _, value in rows), prose=True, styles=("bold",) * len(rows)),
    )
    return Sheet("recommended quantisation", columns, warnings=tuple(notes))


def trade_off_sheet(document: Document) -> Sheet:
    """Return the greatest P_D within bounds on the false cells."""
    rows = list(document.get("trade_off") or ())
    bound = number(document.get("false_cells_bound"))
    bounds = [number(row.get("false_cells")) for row in rows]
    columns = (
        Column("false cells\nat most", aligned([as_given(value) for value in bounds])),
        Column(
            "best P_D\n%",
            aligned([percent(number(row.get("p_detection"))) for row in rows]),
            styles=tuple("bold" if value == bound else "" for value in bounds),
        ),
    )
    return Sheet("what false cells buy", columns)


def map_sheet(document: Document) -> Sheet:
    """Return P_D over Δθ and Δρ, each with its best threshold within the bound."""
    found = document.get("map") or {}
    widths, bins = list(found.get("rho_step", ())), list(found.get("theta_bins", ()))
    every = max(1, -(-len(widths) // MOST_WIDTHS))
    row, width = bins.index(document["theta_bins"]), widths.index(document["rho_step"])
    unit = str(document.get("unit") or "")
    columns = [Column("θ\nbins", tuple(str(int(count)) for count in bins))]
    for at in range(width % every, len(widths), every):
        cells = [
            percent(number(rates[at])) if allowed[at] else f"({percent(number(rates[at]))})"
            for rates, allowed in zip(found["p_detection"], found["allowed"], strict=True)
        ]
        styles = tuple("bold" if (index, at) == (row, width) else "" for index in range(len(cells)))
        columns.append(Column(f"Δρ\n{significant(number(widths[at]))}", _bracketed(cells), styles=styles))
    bound = as_given(document.get("false_cells_bound"))
    notes = [f"P_D in %, each at the best threshold with at most {bound} false cells; Δρ in {unit}."]
    if any("(" in cell for column in columns for cell in column.cells):
        notes.append("In brackets: outside the demands on Δθ and Δρ.")
    return Sheet("P_D over Δθ and Δρ", tuple(columns), tuple(notes))


def _bracketed(cells: Sequence[str]) -> tuple[str, ...]:
    """Return cells with room for a bracket behind each, where one has it."""
    if not any(cell.endswith(")") for cell in cells):
        return tuple(cells)
    return tuple(cell if cell.endswith(")") else f"{cell} " for cell in cells)


def check_sheet(document: Document) -> Sheet:
    """Return predicted beside measured rates."""
    check = document["check"]
    targets = list(document.get("targets") or ())
    measured = list(check["targets"])
    names = [str(target.get("name")) for target in targets]
    predicted = [number(target.get("p_detection")) for target in targets]
    if len(targets) > 1:
        names.append("all")
        predicted.append(number(document.get("p_detection")))
        measured.append(check)
    columns = (
        Column("target", tuple(names), prose=True),
        Column("predicted\n%", aligned([percent(value) for value in predicted])),
        Column("home cell\n%", aligned([percent(number(row["home_cell_rate"])) for row in measured])),
        Column("95 %\ninterval", _ends(measured, "home_cell_ci95"), quiet=True, rank=10),
        Column("3 × 3\n%", aligned([percent(number(row["success_rate"])) for row in measured])),
        Column("95 %\ninterval", _ends(measured, "success_rate_ci95"), quiet=True, rank=10),
    )
    low, high = (significant(end) for end in pair(check.get("false_cells_ci95")))
    told = significant(number(document.get("expected_false_cells")))
    cells = significant(number(check["false_cells"]))
    return Sheet(
        "predicted and measured",
        columns,
        (
            f"{check['trials']:,} trials, seed {check['seed']}; each on a grid that is moved by chance.",
            f"False cells: {told} predicted, {cells} measured ({low} to {high}).",
            "The prediction is that of the home cell; success means that some cell of the 3 × 3 about it "
            "reaches the threshold.",
        ),
    )


def _ends(rows: Sequence[Document], key: str) -> tuple[str, ...]:
    pairs = [pair(row.get(key)) for row in rows]
    return intervals([(percent(low), percent(high)) for low, high in pairs])
