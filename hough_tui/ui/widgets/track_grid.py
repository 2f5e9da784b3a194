"""The table of the tracks that an initiator found."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from rich.text import Text
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets import DataTable

from algorithms.scoring.matching import DUPLICATE, FALSE, FINDER

if TYPE_CHECKING:
    from hough_tui.inspection.trial import TrialLook

MOST_ROWS = 500
"""Weaker tracks than these are counted, not listed."""

HEADINGS = {
    "#": 3,
    "is": 9,
    "score": 5,
    "plots": 5,
    "θ °": 6,
    "ρ {unit}": 8,
    "{unit}/s": 7,
    "hdg °": 6,
}
"""Columns and how many characters their values need."""

IN_SPACE = {"climb {unit}/s": 7}
"""Columns of tracks in space in place of those of the line in the plane."""

STATES = {FALSE: ("false", "red"), FINDER: ("found", "green"), DUPLICATE: ("duplicate", "yellow")}


class TrackGrid(DataTable[Text]):
    """Tracks, the strongest first; the one under the cursor is told."""

    DEFAULT_CSS = "TrackGrid { height: 1fr; }"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("j", "cursor_down", "Next track", id="tracks.down", show=False),
        Binding("k", "cursor_up", "Previous track", id="tracks.up", show=False),
        Binding("g", "scroll_top", "First track", id="tracks.top", show=False),
        Binding("G", "scroll_bottom", "Last track", id="tracks.bottom", show=False),
    ]

    class TrackHighlighted(Message):
        """The cursor is on a track."""

        def __init__(self, grid: TrackGrid, index: int) -> None:
            super().__init__()
            self.grid, self.index = grid, index

        @property
        def control(self) -> TrackGrid:
            """The table."""
            return self.grid

    def __init__(self) -> None:
        super().__init__(cursor_type="row", zebra_stripes=False)
        self._is_filling = False

    def show(self, seen: TrialLook) -> None:
        """List the tracks of a trial."""
        unit = seen.picture.scenario.unit.value
        tracks = seen.tracks
        self._is_filling = True
        self.clear(columns=True)
        is_in_space = tracks.states.velocity.shape[1] == 3
        headings = HEADINGS
        if is_in_space:
            lines = ("θ °", "ρ {unit}")
            headings = {name: width for name, width in HEADINGS.items() if name not in lines} | IN_SPACE
        for heading, width in headings.items():
            label = Text(heading.format(unit=unit), justify="left" if heading == "is" else "right")
            self.add_column(label, width=max(width, label.cell_len))
        for index in range(min(len(tracks), MOST_ROWS)):
            state = ("–", "dim") if seen.state is None else STATES[int(seen.state[index])]
            speed, heading = _course(tracks.states.velocity[index])
            cells = [f"{index}", f"{tracks.score[index]:g}", f"{len(tracks.plots[index])}"]
            if not is_in_space:
                cells += [f"{math.degrees(tracks.theta[index]):.2f}", f"{tracks.rho[index]:.2f}"]
            cells += [speed, heading]
            if is_in_space:
                cells.append(_climb(tracks.states.velocity[index]))
            first, *rest = (Text(cell, justify="right") for cell in cells)
            self.add_row(first, Text(state[0], style=state[1]), *rest)
        self._is_filling = False

    def on_data_table_row_highlighted(self, event: DataTable.RowHighlighted) -> None:
        """Tell which track the cursor is on."""
        event.stop()
        # Filling the table moves its cursor, which is nobody's choice.
        if not self._is_filling and self.has_focus and self.row_count:
            self.post_message(self.TrackHighlighted(self, event.cursor_row))


def _course(velocity: np.ndarray) -> tuple[str, str]:
    if not np.isfinite(velocity).all():
        return "–", "–"
    heading = math.degrees(math.atan2(velocity[0], velocity[1])) % 360.0
    return f"{math.hypot(*velocity):.3g}", f"{heading:.1f}"


def _climb(velocity: np.ndarray) -> str:
    return f"{velocity[-1]:.3g}" if np.isfinite(velocity).all() else "–"
