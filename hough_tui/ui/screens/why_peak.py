"""Why a cell of the accumulator is a peak: its plots, its surroundings, its scatter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from algorithms.hough.inspection import neighbourhood, voters, votes_spread

if TYPE_CHECKING:
    from hough_tui.inspection.trial import TrialLook

RADIUS = 4
"""The neighbourhood that is printed has 2·4 + 1 cells a side, as the thesis prints it."""


class WhyPeak(ModalScreen[None]):
    """Tell why a cell has its votes."""

    DEFAULT_CSS = """
    WhyPeak { align: center middle; }
    WhyPeak > VerticalScroll { width: auto; max-width: 96%; height: auto; max-height: 94%; padding: 1 2;
        background: $surface; border: round $primary; }
    WhyPeak Static { width: auto; height: auto; margin-bottom: 1; }
    WhyPeak .title { text-style: bold; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,enter", "leave", "Back", id="why.leave"),
        Binding("j", "scroll(1)", "Down", id="why.down", show=False),
        Binding("k", "scroll(-1)", "Up", id="why.up", show=False),
    ]

    def __init__(self, seen: TrialLook, row: int, column: int) -> None:
        super().__init__()
        self._seen, self._row, self._column = seen, row, column

    def compose(self) -> ComposeResult:
        """Lay out the cell, its plots by scan, and the votes around it."""
        accumulator = self._seen.accumulator
        assert accumulator is not None
        grid, unit = accumulator.grid, self._seen.picture.scenario.unit.value
        position = self._seen.picture.plots.position
        theta = math.degrees(grid.theta[self._row])
        spread = votes_spread(position, grid, self._row, self._column)
        votes = int(accumulator.votes[self._row, self._column])
        with VerticalScroll():
            yield Static(
                f"Cell ({self._row}, {self._column}): θ {theta:.2f}°, ρ {grid.rho[self._column]:.3f} {unit}, "
                f"{votes} votes",
                classes="title",
                markup=False,
            )
            if accumulator.weighted is not None:
                weighted = f"{float(accumulator.weighted[self._row, self._column]):.4g} votes"
                if accumulator.std is not None and np.isnan(accumulator.std[self._row, self._column]):
                    weighted += ", as there are too few for their deviation to count"
                yield Static(f"Weighted by their standard deviation: {weighted}", markup=False)
            scatter = "not defined for fewer than two votes" if spread is None else f"{spread:.4g} {unit}"
            yield Static(f"Standard deviation of the ρ that voted for it: {scatter}", markup=False)
            yield Static(self._surroundings())
            yield Static(self._plots())

    def _surroundings(self) -> Table:
        accumulator = self._seen.accumulator
        assert accumulator is not None
        grid = accumulator.grid
        block = neighbourhood(accumulator.votes, grid, self._row, self._column, RADIUS)
        table = Table(box=None, padding=(0, 1), title=Text("votes around it: θ down, ρ across", style="dim"))
        table.add_column("θ °", justify="right", style="dim")
        for offset in range(-RADIUS, RADIUS + 1):
            table.add_column(f"{offset:+d}" if offset else "ρ", justify="right", header_style="dim")
        greatest = int(block.max())
        for offset, line in zip(range(-RADIUS, RADIUS + 1), block, strict=True):
            theta = math.degrees(grid.theta[(self._row + offset) % grid.theta_bins])
            cells = [
                Text(
                    "·" if votes < 0 else str(votes),
                    style=_style(int(votes), greatest, offset == 0 and j == RADIUS),
                )
                for j, votes in enumerate(line)
            ]
            table.add_row(f"{theta:.1f}", *cells)
        return table

    def _plots(self) -> Table:
        picture, accumulator = self._seen.picture, self._seen.accumulator
        assert accumulator is not None
        rows = voters(picture.plots.position, accumulator.grid, self._row, self._column)
        unit = picture.scenario.unit.value
        table = Table(box=None, padding=(0, 1), title=Text(f"the {len(rows)} plots that voted", style="dim"))
        for heading in ("scan", f"x {unit}", f"y {unit}", "of"):
            table.add_column(heading, justify="right", header_style="dim")
        names = [target.name or f"target {index}" for index, target in enumerate(picture.scenario.targets)]
        for row in rows:
            x, y = picture.plots.position[row, :2]
            origin = int(picture.origin[row])
            table.add_row(
                str(int(picture.plots.scan[row])),
                f"{x:.3f}",
                f"{y:.3f}",
                Text("clutter", style="dim") if origin < 0 else Text(names[origin], style="green"),
            )
        return table

    def action_scroll(self, lines: int) -> None:
        """Scroll by lines."""
        self.query_one(VerticalScroll).scroll_relative(y=lines, animate=False)

    def action_leave(self) -> None:
        """Go back."""
        self.dismiss(None)


def _style(votes: int, greatest: int, is_centre: bool) -> str:
    if is_centre:
        return "bold reverse"
    if votes <= 0:
        return "dim"
    return "bold" if votes >= np.ceil(0.5 * greatest) else ""
