"""One initiator's view of a trial: plane, accumulator and tracks, linked with one another."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.events import DescendantFocus
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import Static

from algorithms.hough.inspection import columns_of, voters
from hough_tui.reports.documents import track_csv
from hough_tui.reports.field_names import field_name
from hough_tui.reports.numerals import as_given
from hough_tui.ui.copying import copy
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.screens.why_peak import WhyPeak
from hough_tui.ui.views.trial_scenes import (
    GROUND,
    MOST_DRAWN,
    PLANES,
    STATES,
    heatmap_scene,
    layers,
    picture_scene,
    plane_scene,
    votes_scene,
)
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.pair_votes import PairVotes
from hough_tui.ui.widgets.plane import Plane
from hough_tui.ui.widgets.scatter import NOTHING
from hough_tui.ui.widgets.track_grid import TrackGrid
from scenarios.selection import ignores_z

if TYPE_CHECKING:
    from hough_tui.inspection.trial import Picture, TrialLook
    from hough_tui.ui.widgets.plane_scene import PlaneScene
    from scenarios.model import Scenario

PANELS = ("plane", "accumulator", "tracks")
NAMES = tuple("".join("xyz"[axis] for axis in axes) for axes in PLANES)

THREE_ACROSS, THREE_DOWN = 108, 30
"""Columns and rows from which the planes of a trial in space stand side by side, their votes below."""


class LookPanel(Widget):
    """Plane, accumulator and tracks of one initiator on one draw; in space three planes and their votes."""

    DEFAULT_CSS = """
    LookPanel { layout: vertical; height: 1fr; width: 1fr; }
    LookPanel.second { border-left: solid $panel; }
    LookPanel #panels { height: 1fr; }
    LookPanel #plane-side { width: 1fr; height: 1fr; }
    LookPanel #vote-side { width: 1fr; height: 1fr; }
    LookPanel #no-accumulator {
        height: 3fr; padding: 0 2; content-align: center middle; text-align: center; color: $text-muted;
    }
    LookPanel #no-accumulator { display: none; }
    LookPanel #pair-votes { height: 3fr; display: none; }
    LookPanel Heatmap { height: 3fr; }
    LookPanel TrackGrid { height: 2fr; }
    LookPanel.without-accumulator Heatmap { display: none; }
    LookPanel.without-accumulator #no-accumulator { display: block; }
    LookPanel.with-pairs #no-accumulator { display: none; }
    LookPanel.with-pairs #pair-votes { display: block; }
    LookPanel.stacked #panels { layout: vertical; }
    LookPanel.one-plane #vote-side { display: none; }
    LookPanel.one-accumulator #plane-side { display: none; }
    LookPanel.one-accumulator TrackGrid { display: none; }
    LookPanel.one-tracks #plane-side { display: none; }
    LookPanel.one-tracks Heatmap { display: none; }
    LookPanel.one-tracks #no-accumulator { display: none; }
    LookPanel.one-tracks #pair-votes { display: none; }
    LookPanel.three #panels { layout: vertical; }
    LookPanel.three Plane, LookPanel.three PairVotes { margin-right: 1; }
    LookPanel.three.without-votes #vote-side { height: 12; }
    LookPanel.three.without-votes #no-accumulator { height: 2; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "copy", "Copy the tracks", id="look.copy", show=False),
        Binding("v", "next_panel", "Plane, accumulator or tracks", id="look.panel", show=False),
        Binding("z", "next_plane(1)", "Plane xy, xz or yz", id="look.plane", show=False),
        Binding("Z", "next_plane(-1)", "The plane before", id="look.plane-before", show=False),
        Binding("w", "next_layer", "Votes, deviation or weighted votes", id="look.layer", show=False),
    ]

    layout_kind: reactive[str] = reactive("wide")
    panel: reactive[str] = reactive("plane")
    plane: reactive[int] = reactive(0)
    layer: reactive[str] = reactive("votes")

    def __init__(self, classes: str | None = None) -> None:
        super().__init__(classes=classes)
        self._seen: TrialLook | None = None
        self._is_in_space = False
        self._marked: tuple[int, int] | None = None

    def compose(self) -> ComposeResult:
        """Lay out the three panels."""
        caption = Caption()
        caption.tell("Drawing the trial …")
        yield caption
        with Horizontal(id="panels"):
            with Horizontal(id="plane-side"):
                for name in NAMES:
                    yield Plane(classes=name)
            with Vertical(id="vote-side"):
                yield Heatmap()
                with Horizontal(id="pair-votes"):
                    for name in NAMES:
                        yield PairVotes(classes=name)
                yield Static("", id="no-accumulator", markup=False)
                yield TrackGrid()

    def refuse(self, why: str, drawn: Picture | None = None) -> None:
        """Say why there is nothing to show but the draw itself, where there is one."""
        self._seen = None
        self.query_one(Caption).tell(why)
        self.query_one("#no-accumulator", Static).update(why)
        self.add_class("without-accumulator")
        self.remove_class("with-pairs", "without-votes")
        self.query_one(TrackGrid).clear()
        if drawn is not None:
            self._show_planes(drawn.scenario, lambda axes: picture_scene(drawn, (), axes))
            self._light_up(NOTHING)

    def show(self, seen: TrialLook, swept: Mapping[str, int | float] | None = None) -> None:
        """Show what an initiator made of a draw; `swept` is said of one of a run."""
        is_other_draw = self._seen is None or self._seen.picture is not seen.picture
        self._seen = seen
        self.query_one(Caption).tell(*caption(seen, swept))
        self._show_planes(seen.picture.scenario, lambda axes: plane_scene(seen, axes))
        if is_other_draw:
            self._light_up(NOTHING)
        self.set_class(seen.accumulator is None, "without-accumulator")
        self.set_class(seen.plane_votes is not None, "with-pairs")
        self.set_class(seen.accumulator is None and seen.plane_votes is None, "without-votes")
        self.query_one("#no-accumulator", Static).update("This initiator has no accumulator.")
        if seen.accumulator is not None:
            self.query_one(Heatmap).show(heatmap_scene(seen, self.layer))
        if seen.plane_votes is not None:
            for index, votes in enumerate(self.query(PairVotes)):
                votes.show(votes_scene(seen, index))
        # A table takes longer to draw than plane and accumulator together, so these come first. They
        # draw themselves a moment later, and what waits for a refresh must not wait for the one before.
        self.call_later(self.call_after_refresh, self._list_tracks, seen)

    def _list_tracks(self, seen: TrialLook) -> None:
        if seen is self._seen:
            self.query_one(TrackGrid).show(seen)

    def _show_planes(self, scenario: Scenario, scene: Callable[[tuple[int, int]], PlaneScene]) -> None:
        self._is_in_space = scenario.dimensions == 3
        planes = list(self.query(Plane))
        for plane, axes in zip(planes, PLANES, strict=True) if self._is_in_space else [(planes[0], GROUND)]:
            plane.show(scene(axes))
        if not self._is_in_space:
            self.plane = 0
        self._arrange()

    # Which of the panels are seen

    def watch_layout_kind(self) -> None:
        """Lay the panels out side by side, one above the other, or one at a time."""
        self._arrange()

    def watch_panel(self) -> None:
        """Show another panel where they are shown one at a time."""
        self._arrange()

    def watch_plane(self) -> None:
        """Show another plane where they are shown one at a time."""
        self._arrange()

    def on_resize(self) -> None:
        """Show the planes side by side where there is room."""
        self._arrange()

    def _arrange(self) -> None:
        self.set_class(self.layout_kind == "stacked", "stacked")
        for name in PANELS:
            self.set_class(self.layout_kind == "single" and self.panel == name, f"one-{name}")
        has_room = self.size.width >= THREE_ACROSS and self.size.height >= THREE_DOWN
        are_three = self._is_in_space and has_room and self.layout_kind == "wide"
        self.set_class(are_three, "three")
        for kind in (Plane, PairVotes):
            for index, chart in enumerate(self.query(kind)):
                chart.display = are_three or index == self.plane

    def action_next_panel(self) -> None:
        """Go to the next panel."""
        self.panel = PANELS[(PANELS.index(self.panel) + 1) % len(PANELS)]
        self.take_focus()

    def action_next_plane(self, step: int) -> None:
        """Go to the next plane of a trial in space."""
        if not self._is_in_space:
            self.notify("This trial lies in the plane", timeout=3, markup=False)
            return
        focused = self.screen.focused
        self.plane = (self.plane + step) % len(PLANES)
        if isinstance(focused, Plane | PairVotes):
            list(self.query(type(focused)))[self.plane].focus()

    def on_descendant_focus(self, event: DescendantFocus) -> None:
        """Let the plane that has the focus be the one that is seen where there is room for one."""
        if isinstance(event.widget, Plane | PairVotes):
            self.plane = list(self.query(type(event.widget))).index(event.widget)

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
        target: Widget = self.query_one(TrackGrid)
        if self.panel == "plane":
            target = list(self.query(Plane))[self.plane]
        elif self.panel == "accumulator" and self.has_class("with-pairs"):
            target = list(self.query(PairVotes))[self.plane]
        elif self.panel == "accumulator" and not self.has_class("without-accumulator"):
            target = self.query_one(Heatmap)
        target.focus()

    # Links between the panels

    @on(Heatmap.CellHighlighted)
    def _light_up_voters(self, event: Heatmap.CellHighlighted) -> None:
        event.stop()
        # The cell of a chosen track is told, too; the track's own plots stay lit then.
        is_marked, self._marked = (event.row, event.column) == self._marked, None
        if not is_marked and self._seen is not None and self._seen.accumulator is not None:
            position, grid = self._seen.picture.plots.position, self._seen.accumulator.grid
            self._light_up(voters(position, grid, event.row, event.column))

    @on(Heatmap.CellChosen)
    def _explain(self, event: Heatmap.CellChosen) -> None:
        event.stop()
        if self._seen is not None and self._seen.accumulator is not None:
            self.app.push_screen(WhyPeak(self._seen, event.row, event.column))

    @on(PairVotes.VoteChosen)
    def _light_up_pair(self, event: PairVotes.VoteChosen) -> None:
        event.stop()
        for votes in self.query(PairVotes):
            votes.put_cursor(event.index)
        if self._seen is not None and self._seen.plane_votes is not None:
            self._light_up(self._seen.plane_votes.pairs[event.index])

    @on(Plane.ViewMoved)
    def _share_view(self, event: Plane.ViewMoved) -> None:
        event.stop()
        if self._is_in_space:
            for plane in self.query(Plane):
                if plane is not event.plane:
                    plane.follow(event.plane)

    @on(Plane.PlotHighlighted)
    def _share_cursor(self, event: Plane.PlotHighlighted) -> None:
        event.stop()
        if self._is_in_space:
            for plane in self.query(Plane):
                plane.put_cursor(event.index)

    @on(Plane.PlotChosen)
    def _trace_plot(self, event: Plane.PlotChosen) -> None:
        event.stop()
        if self._seen is None:
            return
        if self._seen.plane_votes is not None:
            self._mark_votes((self._seen.plane_votes.pairs == event.index).any(axis=1))
        if self._seen.accumulator is None:
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
        for plane in self.query(Plane):
            plane.choose_track(index if index < MOST_DRAWN else None)
        if seen.accumulator is not None:
            cell = seen.accumulator.grid.cell(float(seen.tracks.theta[index]), float(seen.tracks.rho[index]))
            heatmap = self.query_one(Heatmap)
            if cell is not None and cell != heatmap.cursor:
                self._marked = cell
                heatmap.move_cursor(*cell)
        if seen.plane_votes is not None:
            is_inside = np.isin(seen.plane_votes.pairs, seen.tracks.plots[index])
            self._mark_votes(np.asarray(is_inside.all(axis=1)))
        self._light_up(seen.tracks.plots[index])

    def _light_up(self, plots: NDArray[np.integer]) -> None:
        for plane in self.query(Plane):
            plane.highlight(plots)

    def _mark_votes(self, which: NDArray[np.bool_]) -> None:
        """Light up the votes of some pairs in every plane, and take the cursor away from others."""
        rows = np.flatnonzero(which)
        for votes in self.query(PairVotes):
            votes.put_cursor(None)
            votes.highlight(rows)


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
    if seen.picture.scenario.is_resolved:
        stage = seen.picture.stage
        words = "every point a plot" if stage is None else f"plots by {stage.name}"
        parts.append(Part(words, 1))
    if seen.total > len(seen.tracks):
        shown = f"the {len(seen.tracks)} strongest"
        parts.append(Part(f"{shown} are shown", 3, shown))
    if seen.state is not None and len(seen.tracks):
        counts = [(STATES[state], int((seen.state == state).sum())) for state in STATES]
        words = ", ".join(f"{count} {name}" for name, count in counts if count)
        parts.append(Part(words, 2, words.replace("duplicate", "dup.")))
    if ignores_z(seen.entry, seen.picture.scenario):
        parts.append(Part("z is ignored", 1))
    parts.append(Part(f"{len(seen.picture.plots):,} plots", 4))
    if seen.plane_votes is not None:
        gated = f"{len(seen.plane_votes):,} of {seen.plane_votes.tried:,} pairs"
        parts.append(Part(f"{gated} vote", 3, gated))
    parts.append(Part(f"{seen.seconds * 1e3:.2f} ms", 5))
    return tuple(parts)
