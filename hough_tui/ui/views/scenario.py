"""Scenario: the form of a scenario beside a live picture of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from textual import work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.reactive import reactive
from textual.widget import Widget
from textual.worker import get_current_worker

from algorithms.parameters import Problem
from hough_tui.inspection.trial import Picture, picture
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import SetShown
from hough_tui.ui.views.trial_scenes import picture_scene
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.plane import Plane
from scenarios.model import Scenario, ScenarioSet
from scenarios.selection import seed_of

DEBOUNCE = 0.03
"""Seconds without a further change before the picture is drawn anew."""

WIDE = 88
"""Columns from which form and picture stand side by side."""


class ScenarioView(Widget):
    """A scenario's form, and one draw of it."""

    HELP = (
        "The scenario: what is there, what measures it, and one draw of its plots beside the true paths. "
        "Every change is checked at once, and what is wrong stands beside its field; ? explains a field. "
        "Rows of the tables of targets and clutter are added with a, copied with c and removed with d."
    )
    DEFAULT_CSS = """
    ScenarioView { layout: vertical; height: 1fr; }
    ScenarioView #scenario-parts { height: 1fr; }
    ScenarioView #scenario-picture { width: 1fr; height: 1fr; }
    ScenarioView ModelForm { width: 1fr; }
    ScenarioView.narrow.picture ModelForm { display: none; }
    ScenarioView.narrow.form #scenario-picture { display: none; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f9", "next_panel", "Form or picture", id="scenario.panel", show=False),
        Binding("ctrl+n", "another_draw(1)", "Another draw", id="scenario.draw", show=False),
        Binding("ctrl+b", "another_draw(-1)", "The draw before", id="scenario.draw-before", show=False),
        Binding("f10", "next_scenario", "Next scenario", id="scenario.next", show=False),
    ]

    panel: reactive[str] = reactive("form")

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._index, self._trial = 0, 0
        self._timer: Any = None

    def compose(self) -> ComposeResult:
        """Lay out the form beside the picture."""
        yield Caption()
        with Horizontal(id="scenario-parts"):
            yield ModelForm()
            with Vertical(id="scenario-picture"):
                yield Plane()

    def on_mount(self) -> None:
        """Show the form first where there is room for one of the two only."""
        self.watch_panel()

    def on_resize(self) -> None:
        """Put form and picture side by side where there is room."""
        self.set_class(self.size.width < WIDE, "narrow")

    def watch_panel(self) -> None:
        """Show the form or the picture where there is room for one only."""
        for name in ("form", "picture"):
            self.set_class(self.panel == name, name)

    def show_set(self, given: ScenarioSet) -> None:
        """Show the set as it is now."""
        self._given = given
        self._index = max(0, min(self._index, len(given.scenarios) - 1))
        self.query_one("#scenario-parts").display = bool(given.scenarios)
        if not given.scenarios:
            self.query_one(Caption).tell("The set has no scenario")
            return
        self.query_one(ModelForm).load(self._scenario, ("scenarios", self._index), unit=self._scenario.unit)
        # The form comes first: the first draw has kernels loaded, which takes the processor from it.
        self.call_after_refresh(self._ask)

    def choose(self, index: int) -> None:
        """Show another scenario of the set."""
        self._index = index
        if self._given is not None:
            self.show_set(self._given)

    def refuse(self, found: Sequence[Problem]) -> None:
        """Show why the last edit was not taken."""
        self.query_one(ModelForm).problems(found)

    def take_focus(self) -> None:
        """Put the focus where one can go on at once."""
        if self.has_class("narrow") and self.panel == "picture":
            self.query_one(Plane).focus()
        else:
            self.query_one(ModelForm).focus_field(("scenarios", self._index, "scans"))

    def action_next_panel(self) -> None:
        """Go from the form to the picture, or back."""
        self.panel = "picture" if self.panel == "form" else "form"
        if self.panel == "picture":
            self.query_one(Plane).focus()
        else:
            self.take_focus()

    def action_another_draw(self, step: int) -> None:
        """Draw the plots of another trial."""
        self._trial = max(0, self._trial + step)
        self._ask()

    def action_next_scenario(self) -> None:
        """Go to the next scenario of the set."""
        if self._given is not None and self._given.scenarios:
            self.choose((self._index + 1) % len(self._given.scenarios))

    @property
    def _scenario(self) -> Scenario:
        assert self._given is not None
        return self._given.scenarios[self._index]

    def _ask(self) -> None:
        """Draw the picture, once nothing more has changed for a moment."""
        if self._timer is not None:
            self._timer.stop()
        self._timer = self.set_timer(DEBOUNCE, self._begin)

    def _begin(self) -> None:
        if self._given is not None and self._given.scenarios:
            self._draw(self._scenario, seed_of(self._given, self._scenario), self._trial)

    @work(thread=True, exclusive=True, exit_on_error=False, group="picture", name="picture")
    def _draw(self, scenario: Scenario, seed: int, trial: int) -> None:
        """Draw a trial."""
        worker = get_current_worker()
        drawn = picture(scenario, seed, trial)
        if not worker.is_cancelled:
            self.app.call_from_thread(self._show, drawn)

    def _show(self, drawn: Picture) -> None:
        scenario = drawn.scenario
        self.query_one(Caption).tell(
            f"{scenario.name}, trial {drawn.trial} of seed {drawn.seed}: {len(drawn.plots):,} plots",
            Part("Ctrl+N another draw", 1),
            Part("F9 form or picture", 2, "F9 turns"),
        )
        self.query_one(Plane).show(picture_scene(drawn))
        self.post_message(SetShown())
