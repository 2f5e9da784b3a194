"""The main screen: the set's tree, the views in tabs, the status line."""

from __future__ import annotations

import asyncio
import importlib
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Horizontal
from textual.widget import Widget
from textual.widgets import TabbedContent, TabPane

from hough_tui.ui.screens.relayout_workaround import AttentiveScreen
from hough_tui.ui.widgets.key_line import KeyLine
from hough_tui.ui.widgets.status_line import StatusLine

if TYPE_CHECKING:
    from algorithms.parameters import Problem
    from hough_tui.ui.messages import TrialOpened
    from hough_tui.ui.workspace import Workspace

TABS = {
    "scenario": "Scenario",
    "initiator": "Initiator",
    "look": "Look",
    "clustering": "Clustering",
    "monte-carlo": "Monte Carlo",
    "results": "Results",
}

VIEWS_OF = {
    "scenarios": "scenario",
    "initiators": "initiator",
    "scenes": "clustering",
    "clusterings": "clustering",
    "experiments": "monte-carlo",
}
"""The view that shows an element of each list of the set."""

WIDE = 120
"""Columns from which the tree stands beside the views."""


LONGEST_MOUNTING = 0.3
"""Seconds that whoever leaves waits at most for widgets that are being mounted."""


class ViewPane(TabPane):
    """The place of a view, empty until it is first shown."""

    def render(self) -> str:
        """Return nothing: an empty pane would show its own name."""
        return ""


class MainScreen(AttentiveScreen):
    """The frame of the application; a view is mounted when its tab is first shown."""

    AUTO_FOCUS = "ContentTabs"
    """Not the first widget that could have the focus, which would be a tree that is not seen."""
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f2", "tab('scenario')", "Scenario", id="tab.scenario", show=False),
        Binding("f3", "tab('initiator')", "Initiator", id="tab.initiator", show=False),
        Binding("f4", "tab('look')", "Look", id="tab.look", show=False),
        Binding("f11,ctrl+g", "tab('clustering')", "Clustering", id="tab.clustering", show=False),
        Binding("f6", "tab('monte-carlo')", "Monte Carlo", id="tab.monte-carlo", show=False),
        Binding("f7", "tab('results')", "Results", id="tab.results", show=False),
        Binding("f8", "tree", "Tree of the set", id="main.tree", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._workspace: Workspace | None = None
        self._views: dict[str, Any] = {}
        self._stale: set[str] = set()
        self._showing = asyncio.Lock()
        self._is_leaving = False

    def compose(self) -> ComposeResult:
        """Lay out the frame."""
        with Horizontal(id="main"):
            yield Container(id="tree-place")
            with TabbedContent(id="tabs"):
                for name, title in TABS.items():
                    yield ViewPane(title, id=name)
        yield StatusLine()
        yield KeyLine(show_command_palette=False)

    def on_resize(self) -> None:
        """Take the tree out of a narrow screen."""
        self.set_class(self.size.width < WIDE, "narrow")

    # What the application says

    def tell_state(self, text: str | None) -> None:
        """Say on the status line what is being prepared."""
        self.query_one(StatusLine).state = text or ""

    def show_workspace(self, workspace: Workspace) -> None:
        """Show another set; views of the one before are built anew."""
        self._workspace = workspace
        self.run_worker(self._rebuild())

    async def _rebuild(self) -> None:
        from hough_tui.ui.widgets.set_tree import SetTree

        assert self._workspace is not None
        async with self._showing:
            # They are told of nothing more while they are taken down: what they consist of goes bit by bit.
            former, self._views = list(self._views.values()), {}
            self._stale.clear()
            for view in former:
                _stop_work_of(view)
                await view.remove()
            self.query_one(StatusLine).job = ""
            place = self.query_one("#tree-place")
            await place.remove_children()
            await place.mount(SetTree())
            self.show_set(self._workspace)
        if not self._workspace.given.scenarios:
            self.query_one(TabbedContent).active = "clustering"
        await self._show_tab(self.query_one(TabbedContent).active)

    def show_set(self, workspace: Workspace, part: str | None = None) -> None:
        """Show the set as it is now: at once in the view that is seen, in the others when they are.

        Parameters
        ----------
        part : the list of the set that an edit was of; the form that asked for it is answered even where
            another view is seen by now
        """
        from hough_tui.ui.widgets.set_tree import SetTree

        for tree in self.query(SetTree):
            tree.show(workspace.given)
        status = self.query_one(StatusLine)
        status.file = (
            str(workspace.path) if workspace.path else f"{workspace.given.name} (bundled, not saved)"
        )
        status.is_changed = workspace.is_changed
        active = self.query_one(TabbedContent).active
        shown = {name for name in self._views if name in (active, VIEWS_OF.get(part or ""))}
        self._stale = set(self._views) - shown
        for name in shown:
            self._views[name].show_set(workspace.given)
        self.show_soundness()

    def refuse(self, problem: Problem, part: str) -> None:
        """Put beside its field why the last edit was not taken.

        Parameters
        ----------
        part : the list of the set that the edit was of: another view may be seen by now
        """
        view = self._views.get(VIEWS_OF[part])
        if view is not None and hasattr(view, "refuse"):
            view.refuse([problem])
        self.show_soundness()

    def show_soundness(self) -> None:
        """Say whether a form holds something wrong; nothing runs meanwhile."""
        reason = self.why_not_runnable()
        self.query_one(StatusLine).is_wrong = reason is not None
        for view in self._views.values():
            if hasattr(view, "set_runnable"):
                view.set_runnable(reason)

    def take_back_unsound(self) -> bool:
        """Put back what is in effect where something is typed that is not; return whether there was such."""
        unsound = [
            form for view in self._views.values() for form in view.query("ModelForm") if not form.is_sound
        ]
        for form in unsound:
            form.revert()
        self.show_soundness()
        return bool(unsound)

    def why_not_runnable(self) -> str | None:
        """Return why nothing may run or be saved, in words; None where all is well."""
        for name, view in self._views.items():
            if any(not form.is_sound for form in view.query("ModelForm")):
                return f"a field in the form of {TABS[name]} is wrong; mend it, or take it back with Ctrl+Z"
        return None

    # Views

    # None of these waits inside a handler of a message: mounting waits for messages that it would hold up.

    @on(TabbedContent.TabActivated)
    def _activate(self, event: TabbedContent.TabActivated) -> None:
        if event.pane.id in TABS:
            self.run_worker(self._show_tab(event.pane.id or ""))

    async def _show_tab(self, name: str, chosen: tuple[str, int] | None = None) -> None:
        """Show a view, mounted now if this is the first time, and the part of the set that it is to show."""
        # One after the other, and each to its end: a view that is half mounted would stay blank.
        async with self._showing:
            await self._show(name, chosen)

    async def _show(self, name: str, chosen: tuple[str, int] | None) -> None:
        if self._workspace is None or not name or self._is_leaving:
            return
        if name not in self._views:
            view = _view(name)
            await self.query_one(f"#{name}", TabPane).mount(view)
            # Only now: an edit or a signal that comes meanwhile would meet a view without its parts.
            self._views[name] = view
            view.show_set(self._workspace.given)
            self.show_soundness()
        elif name in self._stale:
            self._stale.discard(name)
            self._views[name].show_set(self._workspace.given)
        if chosen is not None:
            part, index = chosen
            view = self._views[name]
            if hasattr(view, "choose_part"):
                view.choose_part(part, index)
            else:
                view.choose(index)

    def action_tab(self, name: str) -> None:
        """Show a view."""
        self.run_worker(self._go(name))

    async def _go(self, name: str) -> None:
        self.query_one(TabbedContent).active = name
        await self._show_tab(name)
        if name in self._views:
            self._views[name].take_focus()

    def action_tree(self) -> None:
        """Show or hide the tree of the set."""
        self.toggle_class("with-tree" if self.size.width < WIDE else "without-tree")

    def run_experiment(self) -> None:
        """Run the experiment of the Monte Carlo view."""
        self.run_worker(self._run_experiment())

    async def _run_experiment(self) -> None:
        await self._go("monte-carlo")
        if "monte-carlo" in self._views:
            self.show_soundness()
            self._views["monte-carlo"].action_run()

    def open_trial(self, opened: TrialOpened) -> None:
        """Look at a trial."""
        self.run_worker(self._open_trial(opened))

    async def _open_trial(self, opened: TrialOpened) -> None:
        # What is drawn of a scene are points to be clustered; of a scenario, plots for initiators.
        name = "clustering" if "scene" in opened.cell.names else "look"
        await self._go(name)
        if name in self._views:
            self._views[name].open_trial(opened)

    async def _choose(self, part: str, index: int) -> None:
        """Show an element of a list of the set."""
        name = VIEWS_OF[part]
        await self._go(name)
        await self._show_tab(name, (part, index))

    def on_monte_carlo_view_progress(self, event: Any) -> None:
        """Say on the status line how far the run is."""
        self.query_one(StatusLine).job = event.text or ""

    def on_set_tree_chosen(self, event: Any) -> None:
        """Show what was chosen in the tree."""
        self.run_worker(self._choose(event.part, event.index))

    def help_text(self) -> str:
        """Return what the view that is seen is for, and in one line what the focused field is."""
        active = self.query_one(TabbedContent).active
        view = self._views.get(active)
        parts = [TABS.get(active, ""), getattr(view, "HELP", "")]
        if self.focused is not None:
            parts += [node.in_short for node in self.focused.ancestors if hasattr(node, "in_short")][:1]
        return "\n\n".join(part for part in parts if part)

    def stop_work(self) -> None:
        """Stop what runs in the background."""
        for view in self._views.values():
            _stop_work_of(view)

    async def leave(self) -> None:
        """Stop all work, and let what is being mounted get there: half a widget cannot be taken down."""
        self._is_leaving = True
        self.stop_work()
        async with self._showing:
            self.stop_work()
            with suppress(TimeoutError):
                async with asyncio.timeout(LONGEST_MOUNTING):
                    while not all(widget.is_mounted for widget in self.walk_children(Widget)):
                        await asyncio.sleep(0.005)


def _stop_work_of(view: Widget) -> None:
    """Stop what runs in the background for a view, and what would be shown of it."""
    if hasattr(view, "stop_work"):
        view.stop_work()
    for widget in view.walk_children(Widget, with_self=True):
        widget.workers.cancel_node(widget)


VIEWS = {
    "scenario": ("hough_tui.ui.views.scenario", "ScenarioView"),
    "initiator": ("hough_tui.ui.views.initiator", "InitiatorView"),
    "look": ("hough_tui.ui.views.look", "LookView"),
    "clustering": ("hough_tui.ui.views.clustering", "ClusteringView"),
    "monte-carlo": ("hough_tui.ui.views.monte_carlo", "MonteCarloView"),
    "results": ("hough_tui.ui.views.results", "ResultsView"),
}
"""Module and class of each view."""


def _view(name: str) -> Any:
    """Return a new view; its module, with all that is heavy, is imported here for the first time."""
    module, view = VIEWS[name]
    return getattr(importlib.import_module(module), view)()
