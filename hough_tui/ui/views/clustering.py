"""Clustering: draws of a scene, what clusterings make of them step by step, and the forms of both."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on, work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Horizontal, Vertical
from textual.reactive import reactive
from textual.widget import Widget
from textual.widgets import Static
from textual.worker import get_current_worker

from algorithms.clustering.parameters import MODES, Clustering
from algorithms.errors import RequestError
from algorithms.parameters import Problem
from hough_tui.inspection.scene import ClusterLook, cluster_look, scene_picture, scene_seed
from hough_tui.ui.messages import ElementAdded, FieldEdited, SetShown
from hough_tui.ui.naming import free_name
from hough_tui.ui.screens.choose_one import Choice
from hough_tui.ui.views.cluster_panel import ClusterPanel
from hough_tui.ui.views.new_entries import NEW_SCENE, clustering_data
from hough_tui.ui.widgets.entry_form import EntryForm
from scenarios.entries import ClusteringEntry
from scenarios.model import ScenarioSet
from scenarios.scenes import Scene

if TYPE_CHECKING:
    from hough_tui.ui.messages import TrialOpened

DEBOUNCE = 0.03
"""Seconds without a further change before a draw is clustered anew."""

WIDE, TALL = 112, 30
"""Columns from which forms stand beside the plane; rows from which the steps stand below it."""

DOUBLE = 120
"""Columns from which two panels stand side by side."""

SCENE = "scene"
"""What is added beside the modes of clustering, none of which is called so."""

PANELS = ("plane", "steps", "clusterings", "scenes")
"""What takes turns where there is no room: plane, steps, and the forms of clustering and scene."""


class Hint(Static, can_focus=True):
    """What stands in place of all where there is nothing to show; it has the focus, so that keys work."""


class ClusteringView(Widget):
    """A scene, a draw of it, and what one clustering makes of it, or two side by side."""

    HELP = (
        "A draw of a scene of the range-Doppler plane, in which a high-resolution radar sees a target as "
        "many points, and what a clustering makes of it. Points show their clusters by glyph and colour, "
        "hollow where they lie beyond the radius of the ellipse and are left out of the plot; points in no "
        "cluster are dots. + are the plots, × the true centres, * both in one cell.\n\n"
        ". and , go through the steps by which the points were split, and so does the list of steps: the "
        "set under consideration is bright, with its standard-deviation ellipse, the chord along range, the "
        "box of its extents where these are judged, and a dashed line where it is split. Escape shows the "
        "clusters again. ] and [ take other draws, also Ctrl+N and Ctrl+B; i goes to the next clustering, "
        "s or F10 to the next scene, b puts two clusterings side by side. In the plane n goes from point to "
        "point, t from cluster to cluster; + - 0 zoom, z to the set or the cluster.\n\n"
        "F9 or v goes on to the forms of the clustering and of the scene; every edit is seen at once. a "
        "adds a scene or a clustering. y copies the plots, to the clipboard and to a file. How often a "
        "clustering counts right is the matter of an experiment of kind `clustering`, which Monte Carlo "
        "runs; its trials open here."
    )
    DEFAULT_CSS = """
    ClusteringView { layout: vertical; height: 1fr; }
    ClusteringView Hint { height: 1fr; content-align: center middle; text-align: center; padding: 0 4; }
    ClusteringView Hint { color: $text-muted; display: none; }
    ClusteringView.empty Hint { display: block; }
    ClusteringView.empty #clustering-parts { display: none; }
    ClusteringView #clustering-parts { height: 1fr; }
    ClusteringView #clustering-forms { width: 50; height: 1fr; border-right: solid $panel; }
    ClusteringView #form-clusterings { height: 2fr; }
    ClusteringView #form-scenes { height: 3fr; border-top: solid $panel; }
    ClusteringView #cluster-looks { width: 1fr; height: 1fr; }
    ClusteringView.narrow #clustering-forms { width: 1fr; border-right: none; }
    ClusteringView.narrow #form-scenes { border-top: none; }
    ClusteringView.narrow.look #clustering-forms { display: none; }
    ClusteringView.narrow.clusterings #cluster-looks, ClusteringView.narrow.scenes #cluster-looks {
        display: none;
    }
    ClusteringView.narrow.clusterings #form-scenes { display: none; }
    ClusteringView.narrow.scenes #form-clusterings { display: none; }
    ClusteringView.double #clustering-forms { display: none; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("i", "clustering(1)", "Next clustering", id="clustering.next-clustering"),
        Binding("I", "clustering(-1)", "Clustering before", id="clustering.previous-clustering", show=False),
        Binding("right_square_bracket,ctrl+n", "draw(1)", "Next draw", id="clustering.next-draw", show=False),
        Binding(
            "left_square_bracket,ctrl+b", "draw(-1)", "Draw before", id="clustering.previous-draw", show=False
        ),
        Binding("s,f10", "scene", "Next scene", id="clustering.next-scene", show=False),
        Binding(
            "b", "side_by_side", "Two clusterings side by side", id="clustering.side-by-side", show=False
        ),
        Binding("f9,v", "next_panel", "Plane, steps or forms", id="clustering.panel", show=False),
        Binding("a", "add", "Add a scene or a clustering", id="clustering.add", show=False),
    ]

    panel: reactive[str] = reactive("plane")

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._scene, self._entry, self._trial = 0, 0, 0
        self._opened: TrialOpened | None = None
        self._asked_by = "clusterings"
        self._added: dict[str, int] = {}
        self._is_double = False
        self._timer: Any = None

    def compose(self) -> ComposeResult:
        """Lay out the forms beside the panel; a second panel joins it where two clusterings are compared."""
        yield Hint(markup=False)
        with Horizontal(id="clustering-parts"):
            with Vertical(id="clustering-forms"):
                yield EntryForm("clusterings", "clustering")
                yield EntryForm("scenes", "scene")
            with Container(id="cluster-looks"):
                yield ClusterPanel()

    def form(self, part: str) -> EntryForm:
        """Return the form of an element of a list of the set."""
        return self.query_one(f"#form-{part}", EntryForm)

    # Which of the parts are seen

    def on_mount(self) -> None:
        """Show the plane first where there is room for one part only."""
        self._arrange()

    def on_resize(self) -> None:
        """Arrange the parts for the room that there is."""
        self._arrange()

    def watch_panel(self) -> None:
        """Show another part where they take turns."""
        self._arrange()

    def _arrange(self) -> None:
        width, height = self.size
        panels = list(self.query(ClusterPanel))
        is_double = len(panels) > 1
        self.query_one("#cluster-looks").styles.layout = "horizontal" if is_double else "vertical"
        self.set_class(width < WIDE, "narrow")
        self.set_class(is_double, "double")
        shown = self.panel if self.panel in ("clusterings", "scenes") else "look"
        for name in ("look", "clusterings", "scenes"):
            self.set_class(shown == name, name)
        for panel in panels:
            panel.layout_kind = "stacked" if height >= TALL else "single"
            panel.panel = "steps" if self.panel == "steps" else "plane"

    @property
    def _turns(self) -> tuple[str, ...]:
        """The parts in the order of their turns; those that are seen together anyway have one."""
        return PANELS[:2] if self._is_double else PANELS

    def action_next_panel(self) -> None:
        """Go to the next part."""
        if self.has_class("empty"):
            return
        here = self._turns.index(self.panel) if self.panel in self._turns else -1
        self.panel = self._turns[(here + 1) % len(self._turns)]
        self.take_focus()

    def take_focus(self) -> None:
        """Put the focus on the part whose turn it is."""
        if self.has_class("empty"):
            self.query_one(Hint).focus()
        elif self.panel in ("clusterings", "scenes"):
            self.form(self.panel).take_focus()
        else:
            self.query(ClusterPanel).first().take_focus()

    # What is shown

    def show_set(self, given: ScenarioSet) -> None:
        """Show the set as it is now, the same draw where its scene is still there."""
        self._given, self._opened = given, None
        scene, entry = self._added.get("scenes", self._scene), self._added.get("clusterings", self._entry)
        self._added.clear()
        self._scene = max(0, min(scene, len(given.scenes) - 1))
        self._entry = max(0, min(entry, len(given.clusterings) - 1))
        is_empty, had_focus = not (given.scenes and given.clusterings), bool(self.query("Hint:focus"))
        self.set_class(is_empty, "empty")
        if is_empty:
            lacking = "scene of the range-Doppler plane" if not given.scenes else "clustering"
            self.query_one(Hint).update(f"The set has no {lacking}.\n\na adds one, whose form is then here.")
        if not is_empty:
            self._show_forms()
            self._ask()
        if had_focus and not is_empty:
            self.call_after_refresh(self.take_focus)

    def _show_forms(self) -> None:
        assert self._given is not None
        scene, entry = self._given.scenes[self._scene], self._given.clusterings[self._entry]
        resolved: Clustering | None = None
        try:
            resolved = entry.resolved_on(scene)
        except RequestError:
            # The panel says what is wrong, and the form what was given.
            resolved = None
        self.form("scenes").show(self._given.scenes, self._scene)
        self.form("clusterings").show(self._given.clusterings, self._entry, resolved)

    def open_trial(self, opened: TrialOpened) -> None:
        """Show a trial of a run, with the values that were swept there."""
        if self._given is None:
            return
        self._opened, self._trial = opened, opened.trial
        for attribute, part, name in (
            ("_scene", "scenes", opened.cell.world.name),
            ("_entry", "clusterings", opened.cell.entry.name),
        ):
            names = [found.name for found in getattr(self._given, part)]
            setattr(self, attribute, names.index(name) if name in names else 0)
        self.panel = "plane"
        self.remove_class("empty")
        if self._given.scenes and self._given.clusterings:
            self._show_forms()
        self._ask()

    def choose_part(self, part: str, index: int) -> None:
        """Show another scene or clustering of the set."""
        if part == "scenes":
            self._scene = index
        else:
            self._entry = index
        if self._given is not None:
            self.show_set(self._given)

    def action_clustering(self, step: int) -> None:
        """Show what the next clustering makes of the draw."""
        if self._given is not None and self._given.clusterings:
            self.choose_part("clusterings", (self._entry + step) % len(self._given.clusterings))

    def action_scene(self) -> None:
        """Show the next scene."""
        if self._given is not None and self._given.scenes:
            self.choose_part("scenes", (self._scene + 1) % len(self._given.scenes))

    def action_draw(self, step: int) -> None:
        """Show the next draw, or the one before."""
        self._trial = max(0, self._trial + step)
        self._ask()

    async def action_side_by_side(self) -> None:
        """Put the next clustering beside this one, or take it away again."""
        if self._given is None or self.has_class("empty"):
            return
        if not self._is_double and len(self._given.clusterings) < 2:
            self.notify("The set has one clustering only", markup=False)
            return
        if not self._is_double and self.size.width < DOUBLE:
            self.notify(
                f"Two clusterings side by side need {DOUBLE} columns, and the view has {self.size.width}"
                + (": F8 hides the tree" if self.app.size.width >= DOUBLE else ""),
                markup=False,
            )
            return
        self._is_double = not self._is_double
        if self._is_double:
            await self.query_one("#cluster-looks").mount(ClusterPanel("second"))
        else:
            await self.query(ClusterPanel).last().remove()
        if self.panel not in self._turns:
            self.panel = "plane"
        self._arrange()
        self.take_focus()
        self._ask()

    # Editing

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken, in the form that asked for it."""
        self.form(self._asked_by).refuse(found)

    @on(FieldEdited)
    def _note_form(self, event: FieldEdited) -> None:
        self._asked_by = str(event.path[0])

    @on(EntryForm.Wanted)
    def _make(self, event: EntryForm.Wanted) -> None:
        event.stop()
        if event.like is not None:
            data = event.like.model_dump(mode="json", exclude_unset=True)
            if isinstance(event.like, ClusteringEntry):
                # Its name alone may say which mode it is of, and the copy has another name.
                data["mode"] = event.like.mode
            self._insert(event.part, data)
        elif event.part == "scenes":
            self._insert("scenes", NEW_SCENE)
        else:
            self._choose_mode({})

    def action_add(self) -> None:
        """Add a scene, or a clustering of a mode."""
        if self._given is None:
            return
        if self._given.scenes:
            self._choose_mode({SCENE: "scene: a piece of the range-Doppler plane with two targets"})
            return
        self._insert("scenes", NEW_SCENE)
        if not self._given.clusterings:
            self._insert("clusterings", clustering_data("recommended", None))

    def _choose_mode(self, others: dict[str, str]) -> None:
        modes = {name: f"{name}: {(model.__doc__ or '').strip()}" for name, model in MODES.items()}
        self.app.push_screen(Choice("Add", others | modes), self._add)

    def _add(self, chosen: str | None) -> None:
        if chosen is None or self._given is None:
            return
        if chosen == SCENE:
            self._insert("scenes", NEW_SCENE)
            return
        known = self._given.clusterings
        self._insert("clusterings", clustering_data(chosen, known[self._entry] if known else None))

    def _insert(self, part: str, data: dict[str, Any]) -> None:
        """Add an element at the end of a list of the set, and choose it; it gets a name of its own."""
        elements: list[Any] = getattr(self._given, part)
        at = len(elements)
        name = free_name(data["name"], [element.name for element in elements])
        self._added[part] = at  # the set that has it is yet to come
        self.post_message(ElementAdded((part, at), {**data, "name": name}))

    # Working it out

    def _ask(self) -> None:
        """Cluster the draw, once nothing more has changed for a moment."""
        if self._timer is not None:
            self._timer.stop()
        self._timer = self.set_timer(DEBOUNCE, self._begin)

    def _begin(self) -> None:
        given = self._given
        if given is None or self.has_class("empty"):
            return
        chosen: list[tuple[str, Clustering]]
        if self._opened is not None:
            cell = self._opened.cell
            scene, seed, swept = cell.world, cell.experiment.seed, dict(cell.swept)
            chosen = [(cell.entry.name, cell.parameters)]
        else:
            scene, swept = given.scenes[self._scene], None
            seed = scene_seed(given, scene)
            entry = given.clusterings[self._entry]
            chosen = [(entry.name, entry.parameters)]
        if self._is_double and given.clusterings:
            other = given.clusterings[(self._entry + 1) % len(given.clusterings)]
            chosen.append((other.name, other.parameters))
        self._work(scene, seed, self._trial, chosen, swept)

    @work(thread=True, exclusive=True, exit_on_error=False, group="clustering", name="clustering")
    def _work(
        self,
        scene: Scene,
        seed: int,
        trial: int,
        chosen: list[tuple[str, Clustering]],
        swept: dict[str, int | float] | None,
    ) -> None:
        """Draw the trial and let the clusterings work on it."""
        worker = get_current_worker()
        picture = scene_picture(scene, seed, trial)
        found: list[ClusterLook | str] = []
        for name, parameters in chosen:
            if worker.is_cancelled:
                return
            try:
                found.append(cluster_look(picture, name, parameters))
            except RequestError as error:
                found.append(f"{name} on {scene.name}, trial {trial}: {error}")
        if not worker.is_cancelled:
            self.app.call_from_thread(self._show, found, swept)

    def _show(self, found: list[ClusterLook | str], swept: dict[str, int | float] | None) -> None:
        for panel, seen in zip(self.query(ClusterPanel), found, strict=False):
            if isinstance(seen, str):
                panel.refuse(seen)
            else:
                panel.show(seen, swept)
        self.post_message(SetShown())
