"""One clustering's view of a draw: the plane, the steps that led to the clusters, and what both say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Vertical
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import Static

from algorithms.clustering.clusters import NONE
from hough_tui.recorded.clustering import document, plot_rows
from hough_tui.reports.clusters import Document, step_sheet, verdict_words
from hough_tui.reports.documents import csv_text
from hough_tui.reports.field_names import field_name
from hough_tui.reports.numerals import as_given
from hough_tui.ui.copying import copy
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.views.cluster_scenes import cluster_scene, step_scene
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.cluster_plane import ClusterPlane
from hough_tui.ui.widgets.step_list import StepList

if TYPE_CHECKING:
    from hough_tui.inspection.scene import ClusterLook
    from hough_tui.ui.widgets.cluster_scene import StepScene


class ClusterPanel(Widget):
    """What a clustering made of a draw, as a whole or step by step."""

    DEFAULT_CSS = """
    ClusterPanel { layout: vertical; height: 1fr; width: 1fr; }
    ClusterPanel.second { border-left: solid $panel; }
    ClusterPanel #plane-side { height: 1fr; width: 1fr; }
    ClusterPanel #step-side { height: 1fr; width: 1fr; }
    ClusterPanel #no-steps { height: 1fr; padding: 1 2; color: $text-muted; display: none; }
    ClusterPanel.without-steps #no-steps { display: block; }
    ClusterPanel.without-steps StepList { display: none; }
    ClusterPanel.stacked #plane-side { height: 2fr; }
    ClusterPanel.stacked #step-side { height: 1fr; border-top: solid $panel; }
    ClusterPanel.stacked.without-steps #step-side { height: 4; }
    ClusterPanel.one-plane #step-side { display: none; }
    ClusterPanel.one-steps #plane-side { display: none; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("full_stop", "step(1)", "Next step", key_display=".", id="clustering.next-step"),
        Binding("comma", "step(-1)", "Step before", key_display=",", id="clustering.previous-step"),
        Binding("escape", "clusters", "The clusters", id="clustering.clusters", show=False),
        Binding("y", "copy", "Copy the plots", id="clustering.copy", show=False),
    ]

    layout_kind: reactive[str] = reactive("stacked")
    panel: reactive[str] = reactive("plane")
    step: reactive[int | None] = reactive(None)

    def __init__(self, classes: str | None = None) -> None:
        super().__init__(classes=classes)
        self._seen: ClusterLook | None = None
        self._swept: Mapping[str, int | float] | None = None
        self._steps: Sequence[Document] = ()

    def compose(self) -> ComposeResult:
        """Lay out the plane and the steps below what they say."""
        caption = Caption()
        # The first draw waits until the kernels are compiled.
        caption.tell("Drawing the scene …")
        yield caption
        yield Caption(id="verdict")
        with Container():
            with Vertical(id="plane-side"):
                yield ClusterPlane()
            with Vertical(id="step-side"):
                yield StepList()
                yield Static(id="no-steps", markup=False)

    def refuse(self, why: str) -> None:
        """Say why there is nothing to show; what is shown is of before."""
        self.query_one(Caption).tell(why)
        self.query_one("#verdict", Caption).tell()

    def show(self, seen: ClusterLook, swept: Mapping[str, int | float] | None = None) -> None:
        """Show what a clustering made of a draw; `swept` is said of one of a run.

        The step stays where it was while only parameters change, as far as there are so many.
        """
        before, self._seen, self._swept = self._seen, seen, swept
        is_same = before is not None and before.name == seen.name and is_same_draw(before, seen)
        self.set_class(not seen.steps, "without-steps")
        self.query_one("#no-steps", Static).update(seen.why_no_steps)
        told = document(seen.found, with_steps=bool(seen.steps))
        self._steps = told.get("steps", ())
        if seen.steps:
            sheet = step_sheet(told, 0)
            self.query_one(StepList).show(sheet.columns, len(seen.found.clusters.points), count_words(seen))
        step = self.step if is_same else None
        self.set_reactive(ClusterPanel.step, step if step is not None and step < len(seen.steps) else None)
        self.query_one(ClusterPlane).show(cluster_scene(seen), self._step_scene)
        self._tell()

    # Step by step

    @property
    def _step_scene(self) -> StepScene | None:
        if self._seen is None or self.step is None:
            return None
        return step_scene(self._seen, self._seen.steps[self.step])

    def watch_step(self) -> None:
        """Show another step."""
        if self._seen is not None:
            plane = self.query_one(ClusterPlane)
            plane.show(plane.scene, self._step_scene)
            self._tell()

    def action_step(self, change: int) -> None:
        """Go one step on, or back; after the last and before the first are the clusters."""
        if self._seen is None:
            return
        if not self._seen.steps:
            self.notify(self._seen.why_no_steps, timeout=3, markup=False)
            return
        # The clusters have place 0 in the round.
        here = 0 if self.step is None else self.step + 1
        place = (here + change) % (len(self._seen.steps) + 1)
        self.step = None if place == 0 else place - 1

    def action_clusters(self) -> None:
        """Show the clusters, in place of a step."""
        self.step = None

    @on(StepList.Chosen)
    def _choose(self, event: StepList.Chosen) -> None:
        event.stop()
        self.step = event.index

    def _tell(self) -> None:
        """Say what is seen, and what becomes of the set under consideration."""
        seen = self._seen
        assert seen is not None
        self.query_one(Caption).tell(*caption(seen, self._swept))
        self.query_one("#verdict", Caption).tell(*verdict(self._steps, self.step) or (seen.why_no_steps,))
        if seen.steps:
            self.query_one(StepList).turn_to(self.step)

    # Which of the parts are seen

    def watch_layout_kind(self) -> None:
        """Put plane and steps one above the other, or show one at a time."""
        self._arrange()

    def watch_panel(self) -> None:
        """Show the other part where one is shown at a time."""
        self._arrange()

    def _arrange(self) -> None:
        self.set_class(self.layout_kind == "stacked", "stacked")
        for name in ("plane", "steps"):
            self.set_class(self.layout_kind == "single" and self.panel == name, f"one-{name}")

    def take_focus(self) -> None:
        """Put the focus on the plane or the list of steps."""
        listed = self.query_one(StepList)
        (listed if self.panel == "steps" and listed.display else self.query_one(ClusterPlane)).focus()

    def action_copy(self) -> None:
        """Copy the plots as CSV, to the clipboard and to a file."""
        if self._seen is not None:
            rows = plot_rows(document(self._seen.found))
            copy(self.app, csv_text(rows), f"{self._seen.name}-clusters.csv")


def is_same_draw(one: ClusterLook, other: ClusterLook) -> bool:
    """Return whether two looks are at the same draw, whatever its scene is like now."""
    return (one.picture.scene.name, one.picture.seed, one.picture.trial) == (
        other.picture.scene.name,
        other.picture.seed,
        other.picture.trial,
    )


def count_words(seen: ClusterLook) -> str:
    """Return how many clusters were found, and of how many targets."""
    count, targets = len(seen.found.clusters), len(seen.picture.scene.targets)
    return f"{count:,} cluster{'s' * (count != 1)} of {targets:,} target{'s' * (targets != 1)}"


def caption(seen: ClusterLook, swept: Mapping[str, int | float] | None = None) -> tuple[Part, ...]:
    """Return what is seen, for one line.

    Parameters
    ----------
    seen : what a clustering made of a draw
    swept : the swept values of the run that it is of; None for a draw of the set as it is
    """
    picture, clusters = seen.picture, seen.found.clusters
    words = f"trial {picture.trial}: {count_words(seen)}"
    parts = [Part(f"{seen.name} on {picture.scene.name}, {words}", short=f"{seen.name}, {words}")]
    if swept is not None:
        values = ", ".join(f"{field_name(key)} {as_given(value)}" for key, value in swept.items())
        parts.append(Part(f"of a run: {values}", short=values) if values else Part("of a run", 1))
    idle = int(((clusters.label == NONE) | ~clusters.kept).sum())
    parts.append(Part(f"{len(clusters.points):,} points, {idle:,} in no plot", 2, f"{idle:,} in no plot"))
    parts.append(Part(f"seed {picture.seed}", 3))
    return tuple(parts)


def verdict(steps: Sequence[Document], index: int | None) -> tuple[Part, ...]:
    """Return what becomes of a set of points and why, for one line; without a set, how to go on.

    Parameters
    ----------
    steps : as `document` tells them; none of a clustering that does not split
    index : which one is looked at
    """
    if not steps:
        return ()
    if index is None:
        return Part(f"{len(steps)} step{'s' * (len(steps) != 1)} led here"), Part(". goes through them", 1)
    step = steps[index]
    count = len(step["points"])
    return (
        Part(f"step {index}"),
        Part(f"{count:,} point{'s' * (count != 1)}", 2),
        Part(verdict_words(step)),
        Part(step["why"], 1),
    )
