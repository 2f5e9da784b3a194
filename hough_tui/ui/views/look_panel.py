"""One initiator's view of a trial: plane, accumulator and tracks, linked with one another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import Static

from algorithms.hough.inspection import columns_of, voters
from hough_tui.reports.documents import track_csv
from hough_tui.reports.metrics import field_name
from hough_tui.reports.numerals import as_given
from hough_tui.ui.copying import copy
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.screens.why_peak import WhyPeak
from hough_tui.ui.views.trial_scenes import MOST_DRAWN, STATES, heatmap_scene, layers, plane_scene
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.plane import Plane
from hough_tui.ui.widgets.track_grid import TrackGrid

if TYPE_CHECKING:
    from hough_tui.experiments.look import TrialLook

PANELS = ("plane", "accumulator", "tracks")


class LookPanel(Widget):
    """Plane, accumulator and tracks of one initiator on one draw."""

    DEFAULT_CSS = """
    LookPanel { layout: vertical; height: 1fr; width: 1fr; }
    LookPanel.second { border-left: solid $panel; }
    LookPanel #panels { height: 1fr; }
    LookPanel #plane-side { width: 1fr; height: 1fr; }
    LookPanel #vote-side { width: 1fr; height: 1fr; }
    LookPanel #no-accumulator { height: 3fr; content-align: center middle; color: $text-muted; }
    LookPanel #no-accumulator { display: none; }
    LookPanel Heatmap { height: 3fr; }
    LookPanel TrackGrid { height: 2fr; }
    LookPanel.without-accumulator Heatmap { display: none; }
    LookPanel.without-accumulator #no-accumulator { display: block; }
    LookPanel.stacked #panels { layout: vertical; }
    LookPanel.one-plane #vote-side { display: none; }
    LookPanel.one-accumulator #plane-side { display: none; }
    LookPanel.one-accumulator TrackGrid { display: none; }
    LookPanel.one-tracks #plane-side { display: none; }
    LookPanel.one-tracks Heatmap { display: none; }
    LookPanel.one-tracks #no-accumulator { display: none; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "copy", "Copy the tracks", id="look.copy", show=False),
        Binding("v", "next_panel", "Plane, accumulator or tracks", id="look.panel", show=False),
        Binding("w", "next_layer", "Votes, deviation or weighted votes", id="look.layer", show=False),
    ]

    layout_kind: reactive[str] = reactive("wide")
    panel: reactive[str] = reactive("plane")
    layer: reactive[str] = reactive("votes")

    def __init__(self, classes: str | None = None) -> None:
        super().__init__(classes=classes)
        self._seen: TrialLook | None = None
        self._marked: tuple[int, int] | None = None

    def compose(self) -> ComposeResult:
        """Lay out the three panels."""
        yield Caption()
        with Horizontal(id="panels"):
            with Vertical(id="plane-side"):
                yield Plane()
            with Vertical(id="vote-side"):
                yield Heatmap()
                yield Static("This initiator has no accumulator.", id="no-accumulator", markup=False)
                yield TrackGrid()

    def refuse(self, why: str) -> None:
        """Say why there is nothing to show."""
        self.query_one(Caption).tell(why)

    def show(self, seen: TrialLook, swept: Mapping[str, int | float] | None = None) -> None:
        """Show what an initiator made of a draw; `swept` is said of one of a run."""
        is_other_draw = self._seen is None or self._seen.picture is not seen.picture
        self._seen = seen
        self.query_one(Caption).tell(*caption(seen, swept))
        plane = self.query_one(Plane)
        plane.show(plane_scene(seen))
        if is_other_draw:
            plane.highlight(np.zeros(0, np.int64))
        self.set_class(seen.accumulator is None, "without-accumulator")
        if seen.accumulator is not None:
            self.query_one(Heatmap).show(heatmap_scene(seen, self.layer))
        self.query_one(TrackGrid).show(seen)

    # Which of the panels are seen

    def watch_layout_kind(self) -> None:
        """Lay the panels out side by side, one above the other, or one at a time."""
        self._arrange()

    def watch_panel(self) -> None:
        """Show another panel where they are shown one at a time."""
        self._arrange()

    def _arrange(self) -> None:
        self.set_class(self.layout_kind == "stacked", "stacked")
        for name in PANELS:
            self.set_class(self.layout_kind == "single" and self.panel == name, f"one-{name}")

    def action_next_panel(self) -> None:
        """Go to the next panel."""
        self.panel = PANELS[(PANELS.index(self.panel) + 1) % len(PANELS)]
        self.take_focus()

    def action_next_layer(self) -> None:
        """Show votes, their standard deviation, or weighted votes in the accumulator."""
        if self._seen is None or self._seen.accumulator is None:
            return
        known = list(layers(self._seen.accumulator))
        if len(known) == 1:
            self.notify(f"{self._seen.entry.name} counts votes as they are", timeout=3, markup=False)
            return
        self.layer = known[(known.index(self.layer) + 1) % len(known)] if self.layer in known else known[0]
        self.query_one(Heatmap).show(heatmap_scene(self._seen, self.layer))

    def action_copy(self) -> None:
        """Copy the tracks as CSV, to the clipboard and to a file."""
        if self._seen is not None:
            copy(self.app, track_csv(self._seen.tracks), f"{self._seen.entry.name}-tracks.csv")

    def take_focus(self) -> None:
        """Put the focus on the panel that is seen first."""
        target: Widget = self.query_one(
            {"plane": Plane, "accumulator": Heatmap, "tracks": TrackGrid}[self.panel]
        )
        target.focus()

    # Links between the panels

    @on(Heatmap.CellHighlighted)
    def _light_up_voters(self, event: Heatmap.CellHighlighted) -> None:
        event.stop()
        # The cell of a chosen track is told, too; the track's own plots stay lit then.
        is_marked, self._marked = (event.row, event.column) == self._marked, None
        if not is_marked and self._seen is not None and self._seen.accumulator is not None:
            position, grid = self._seen.picture.plots.position, self._seen.accumulator.grid
            self.query_one(Plane).highlight(voters(position, grid, event.row, event.column))

    @on(Heatmap.CellChosen)
    def _explain(self, event: Heatmap.CellChosen) -> None:
        event.stop()
        if self._seen is not None and self._seen.accumulator is not None:
            self.app.push_screen(WhyPeak(self._seen, event.row, event.column))

    @on(Plane.PlotChosen)
    def _trace_plot(self, event: Plane.PlotChosen) -> None:
        event.stop()
        if self._seen is None or self._seen.accumulator is None:
            return
        grid = self._seen.accumulator.grid
        position = self._seen.picture.plots.position[[event.index]]
        columns = columns_of(position, grid, np.arange(grid.theta_bins))[:, 0]
        self.query_one(Heatmap).trace(np.where(columns < grid.rho_bins, columns, -1))

    @on(Plane.TrackChosen)
    def _mark_chosen_track(self, event: Plane.TrackChosen) -> None:
        event.stop()
        self._mark_track(event.index)

    @on(TrackGrid.TrackHighlighted)
    def _mark_listed_track(self, event: TrackGrid.TrackHighlighted) -> None:
        event.stop()
        self._mark_track(event.index)

    def _mark_track(self, index: int) -> None:
        seen = self._seen
        if seen is None or index >= len(seen.tracks):
            return
        plane = self.query_one(Plane)
        plane.choose_track(index if index < MOST_DRAWN else None)
        if seen.accumulator is not None:
            cell = seen.accumulator.grid.cell(float(seen.tracks.theta[index]), float(seen.tracks.rho[index]))
            heatmap = self.query_one(Heatmap)
            if cell is not None and cell != heatmap.cursor:
                self._marked = cell
                heatmap.move_cursor(*cell)
        plane.highlight(seen.tracks.plots[index])


def caption(seen: TrialLook, swept: Mapping[str, int | float] | None = None) -> tuple[Part, ...]:
    """Return what is seen, for one line.

    Parameters
    ----------
    seen : a trial
    swept : the swept values of the run that it is of; None for a trial of the set as it is
    """
    words = f"trial {seen.picture.trial}: {seen.total:,} track{'s' * (seen.total != 1)}"
    parts = [
        Part(
            f"{seen.entry.name} on {seen.picture.scenario.name}, {words}",
            short=f"{seen.entry.name}, {words}",
        )
    ]
    if swept is not None:
        values = ", ".join(f"{field_name(key)} {as_given(value)}" for key, value in swept.items())
        parts.append(Part(f"of a run: {values}" if values else "of a run", 1))
    if seen.total > len(seen.tracks):
        shown = f"the {len(seen.tracks)} strongest"
        parts.append(Part(f"{shown} are shown", 3, shown))
    if seen.state is not None and len(seen.tracks):
        counts = [(STATES[state], int((seen.state == state).sum())) for state in STATES]
        words = ", ".join(f"{count} {name}" for name, count in counts if count)
        parts.append(Part(words, 2, words.replace("duplicate", "dup.")))
    parts.append(Part(f"{len(seen.picture.plots):,} plots", 4))
    parts.append(Part(f"{seen.seconds * 1e3:.2f} ms", 5))
    return tuple(parts)
