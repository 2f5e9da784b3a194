"""Look: one trial, as the initiators see it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, ClassVar

from textual import work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.widget import Widget
from textual.worker import get_current_worker

from algorithms.errors import RequestError, WorkFailedError
from algorithms.parameters import Parameters
from hough_tui.experiments.chunks.initiation import InitiationCell
from hough_tui.inspection.trial import Picture, TrialLook, look, picture
from hough_tui.ui.views.look_panel import LookPanel
from scenarios.entries import ClusteringEntry, InitiatorEntry
from scenarios.experiments import InitiationExperiment, MatchCriterion
from scenarios.model import Scenario, ScenarioSet
from scenarios.selection import known_stages, seed_of
from scenarios.sweeps import Stage

if TYPE_CHECKING:
    from hough_tui.ui.messages import TrialOpened

DEBOUNCE = 0.03
"""Seconds from one change to the next within which they count as one, and the last of them is shown."""

WIDE = 88
"""Columns from which the parts of a panel stand side by side."""

DOUBLE = 120
"""Columns from which two panels stand side by side."""


class LookView(Widget):
    """One trial: plane, accumulator and tracks of one initiator, or of two side by side."""

    HELP = (
        "One trial, as an initiator sees it. The plane shows the plots (older scans dimmer), the true "
        "paths, and the tracks as lines through their plots, false ones apart. The accumulator shows the "
        "votes of θ and ρ: the plots that voted for the cell under its cursor light up in the plane, and "
        "Enter tells why the cell is a peak. Choosing a plot in the plane draws its sinusoid over the "
        "accumulator; choosing a track in the table marks its cell and its plots. w shows, of "
        "initiators that weight votes, their standard deviation or the weighted votes. Tab goes from panel "
        "to panel; y copies the tracks, to the clipboard and to a file.\n\n"
        "A trial in space is projected on the planes xy, xz and yz, which share their axes, the cursor and "
        "the chosen track; z goes from one to the next. Of an initiator whose pairs of plots vote, the votes "
        "of each plane stand in place of the accumulator: d across, the direction θ down, larger where a "
        "window confirms them. n goes from vote to vote and lights up its two plots; choosing a track lights "
        "up its votes, choosing a plot those that it has a part in.\n\n"
        "Sensors of high resolution give points. o goes through the ways in which they become plots: the "
        "clusterings of the set, every point a plot, and each target seen as one point."
    )
    DEFAULT_CSS = """
    LookView { layout: vertical; height: 1fr; }
    LookView #looks { height: 1fr; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("right_square_bracket", "trial(1)", "Next trial", id="look.next-trial", show=False),
        Binding("left_square_bracket", "trial(-1)", "Previous trial", id="look.previous-trial", show=False),
        Binding("i", "initiator(1)", "Next initiator", id="look.next-initiator", show=False),
        Binding("I", "initiator(-1)", "Previous initiator", id="look.previous-initiator", show=False),
        Binding("s", "scenario", "Next scenario", id="look.next-scenario", show=False),
        Binding("o", "stage(1)", "Cluster points otherwise", id="look.next-clustering", show=False),
        Binding("O", "stage(-1)", "As clustered before", id="look.previous-clustering", show=False),
        Binding("b", "side_by_side", "Two initiators side by side", id="look.side-by-side", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._given: ScenarioSet | None = None
        self._scenario, self._entry, self._trial = 0, 0, 0
        self._stage_name: str | None = None
        self._cell: InitiationCell | None = None
        self._is_double = False
        self._timer: Any = None
        self._asked_at = -DEBOUNCE

    def compose(self) -> ComposeResult:
        """Lay out one panel; a second one joins it where two initiators are compared."""
        with Horizontal(id="looks"):
            yield LookPanel()

    def on_resize(self) -> None:
        """Arrange the panels for the room that there is."""
        self._arrange()

    def _arrange(self) -> None:
        panels = list(self.query(LookPanel))
        room = self.size.width // max(1, len(panels))
        for found in panels:
            found.layout_kind = "wide" if room >= WIDE else "stacked" if len(panels) > 1 else "single"
            if len(panels) > 1 and self.size.height < 30:
                found.layout_kind = "single"

    # What is looked at

    def show_set(self, given: ScenarioSet) -> None:
        """Show the set as it is now, the same trial where it is still there."""
        self._given = given
        self._cell = None
        self._scenario = max(0, min(self._scenario, len(given.scenarios) - 1))
        self._entry = min(self._entry, max(0, len(given.initiators) - 1))
        self._ask()

    def open_trial(self, opened: TrialOpened) -> None:
        """Show a trial of a run, with the values that were swept there."""
        assert isinstance(opened.cell, InitiationCell)
        self._cell = opened.cell
        self._trial = opened.trial
        if self._given is not None:
            names = [found.name for found in self._given.scenarios]
            entries = [found.name for found in self._given.initiators]
            scenario, entry = self._cell.scenario.name, self._cell.entry.name
            self._scenario = names.index(scenario) if scenario in names else 0
            self._entry = entries.index(entry) if entry in entries else 0
        self._ask()

    def choose(self, index: int) -> None:
        """Look at another scenario of the set."""
        self._scenario, self._cell = index, None
        self._ask()

    def action_trial(self, step: int) -> None:
        """Look at the next or the previous trial."""
        self._trial = max(0, self._trial + step)
        self._ask()

    def action_initiator(self, step: int) -> None:
        """Look through the eyes of another initiator."""
        if self._given is not None and self._given.initiators:
            self._entry = (self._entry + step) % len(self._given.initiators)
            self._cell = None
            self._ask()

    def action_stage(self, step: int) -> None:
        """Make plots of the points in the next way; a trial of a run is then one of the set again."""
        if self._given is None or not self._given.scenarios:
            return
        if not self._given.scenarios[self._scenario].is_resolved:
            self.notify("No sensor of the scenario gives points that could be clustered", markup=False)
            return
        names = list(stages(self._given))
        if self._cell is not None:
            stage = self._cell.clustering
            here = "none" if stage is None else stage.name
        else:
            here = self._stage_name or names[0]
        place = names.index(here) if here in names else 0
        self._stage_name, self._cell = names[(place + step) % len(names)], None
        self._ask()

    def action_scenario(self) -> None:
        """Look at the next scenario."""
        if self._given is not None and self._given.scenarios:
            self.choose((self._scenario + 1) % len(self._given.scenarios))

    async def action_side_by_side(self) -> None:
        """Put the next initiator beside this one, or take it away again."""
        if not self._is_double and (self._given is None or len(self._given.initiators) < 2):
            self.notify("The set has one initiator only", markup=False)
            return
        if not self._is_double and self.size.width < DOUBLE:
            self.notify(
                f"Two initiators side by side need {DOUBLE} columns, and the view has {self.size.width}"
                + (": F8 hides the tree" if self.app.size.width >= DOUBLE else ""),
                markup=False,
            )
            return
        self._is_double = not self._is_double
        if self._is_double:
            await self.query_one("#looks").mount(LookPanel("second"))
        else:
            await self.query(LookPanel).last().remove()
        self._arrange()
        self._ask()

    def take_focus(self) -> None:
        """Put the focus on the plane."""
        self.query(LookPanel).first().take_focus()

    # Working it out

    def _ask(self) -> None:
        """Work the trial out at once; while changes follow each other, when the last of them has come."""
        before, self._asked_at = self._asked_at, time.monotonic()
        if self._timer is not None:
            self._timer.stop()
        if self._asked_at - before >= DEBOUNCE:
            self._begin()
        else:
            self._timer = self.set_timer(DEBOUNCE, self._begin)

    def _begin(self) -> None:
        if self._given is None:
            return
        for part in ("scenarios", "initiators"):
            if not getattr(self._given, part):
                self.query(LookPanel).first().refuse(f"The set has no {part}.")
                return
        chosen: list[tuple[InitiatorEntry, Parameters | None]]
        criterion: MatchCriterion | None
        if self._cell is not None:
            cell, swept = self._cell, self._cell.swept
            scenario, seed, criterion = cell.scenario, cell.experiment.seed, cell.criterion
            chosen, stage = [(cell.entry, cell.parameters)], cell.clustering
        else:
            scenario, swept = self._given.scenarios[self._scenario], None
            seed, criterion = seed_of(self._given, scenario), criterion_of(self._given, scenario)
            chosen, stage = [(self._given.initiators[self._entry], None)], None
            if scenario.is_resolved:
                ways = stages(self._given)
                stage = ways.get(self._stage_name or "", next(iter(ways.values())))
        if self._is_double:
            chosen.append((self._given.initiators[(self._entry + 1) % len(self._given.initiators)], None))
        self._work(scenario, seed, self._trial, chosen, criterion, swept, stage)

    @work(thread=True, exclusive=True, exit_on_error=False, group="look", name="look")
    def _work(
        self,
        scenario: Scenario,
        seed: int,
        trial: int,
        chosen: list[tuple[InitiatorEntry, Parameters | None]],
        criterion: MatchCriterion | None,
        swept: dict[str, int | float] | None,
        stage: Stage,
    ) -> None:
        """Draw the trial and let the initiators work on it."""
        worker = get_current_worker()
        try:
            drawn = picture(scenario, seed, trial, stage)
        except RequestError as error:
            # A way to cluster may need what is not installed.
            if not worker.is_cancelled:
                self.app.call_from_thread(self.query(LookPanel).first().refuse, str(error))
            return
        found: list[TrialLook | str] = []
        for entry, parameters in chosen:
            if worker.is_cancelled:
                return
            try:
                resolved = parameters or entry.parameters.resolved(scenario.context)
                found.append(look(drawn, entry, resolved, criterion))
            except (RequestError, WorkFailedError) as error:
                found.append(f"{entry.name}: {error}")
        if not worker.is_cancelled:
            self.app.call_from_thread(self._show, drawn, found, swept)

    def _show(
        self, drawn: Picture, found: list[TrialLook | str], swept: dict[str, int | float] | None
    ) -> None:
        # One that is just coming is shown what there is to see once it is there.
        panels = [panel for panel in self.query(LookPanel) if panel.is_mounted]
        for panel, seen in zip(panels, found, strict=False):
            if isinstance(seen, str):
                panel.refuse(seen, drawn)
            else:
                panel.show(seen, swept)


def stages(given: ScenarioSet) -> dict[str, Stage]:
    """Return by name how the points of a scenario can become plots, the clusterings of the set first."""
    known = known_stages(given)
    clusterings = {name: stage for name, stage in known.items() if isinstance(stage, ClusteringEntry)}
    return {**clusterings, "none": None, "ideal": known["ideal"]}


def criterion_of(given: ScenarioSet, scenario: Scenario) -> MatchCriterion | None:
    """Return the criterion of the first experiment on a scenario; None where there is none."""
    for experiment in given.experiments:
        if isinstance(experiment, InitiationExperiment):
            if scenario.name in (one.name for one in given.chosen_scenarios(experiment)):
                return experiment.criterion
    return None
