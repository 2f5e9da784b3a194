"""What the quantisation of an initiator leads to, and what is recommended: density, figures, words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from textual import on, work
from textual.app import ComposeResult
from textual.containers import Horizontal, VerticalScroll
from textual.message import Message
from textual.widgets import Input, Static
from textual.worker import get_current_worker

from hough_tui.reports.numerals import percent, significant
from hough_tui.ui.drawing.shortening import Part
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.false_cell_field import DEFAULT_BOUND, FalseCellField
from hough_tui.ui.widgets.prediction_density import PredictionDensity
from hough_tui.ui.widgets.prediction_table import Compared, PredictionTable

if TYPE_CHECKING:
    from algorithms.quantisation.advisor import Advice
    from hough_tui.quantisation.forecast import Forecast, VotePicture
    from hough_tui.quantisation.vote_cost import VoteCost
    from scenarios.entries import InitiatorEntry
    from scenarios.model import Scenario

DEBOUNCE = 0.03
"""Seconds without a further change before all is predicted anew."""

NO_ADVICE = "none"


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """What is to be predicted."""

    entry: InitiatorEntry
    scenario: Scenario
    false_cells: float


class PredictionPanel(VerticalScroll, can_focus=False, inherit_bindings=False):
    """The prediction for one entry on one scenario, as it is now; it is worked out in the background."""

    DEFAULT_CSS = """
    PredictionPanel { height: 1fr; scrollbar-size-vertical: 1; }
    PredictionPanel PredictionDensity { height: 1fr; min-height: 6; margin: 0 1; }
    PredictionPanel #bound { height: 1; padding: 0 1; }
    PredictionPanel #bound Static { width: auto; color: $text-muted; padding-right: 1; }
    PredictionPanel FalseCellField { width: 6; margin-right: 1; background: $boost; }
    PredictionPanel FalseCellField:focus { background: $primary 20%; }
    PredictionPanel .words { height: auto; padding: 0 1; color: $text-muted; }
    PredictionPanel.without-figures PredictionDensity { display: none; }
    PredictionPanel.without-figures PredictionTable { display: none; }
    """

    class Predicted(Message):
        """A prediction is ready, or there is none for a reason."""

        def __init__(self, asked: Asked, found: Forecast | str, cost: VoteCost | None) -> None:
            super().__init__()
            self.asked, self.found, self.cost = asked, found, cost

    class Advised(Message):
        """A recommendation is ready, or there is none for a reason."""

        def __init__(self, asked: Asked, found: Advice | str) -> None:
            super().__init__()
            self.asked, self.found = asked, found

    def __init__(self) -> None:
        super().__init__()
        self._asked: Asked | None = None
        self._bound = DEFAULT_BOUND
        self._bound_problem: str | None = None
        self._forecast: Forecast | str | None = None
        self._cost: VoteCost | None = None
        self._advised: PredictionPanel.Advised | None = None
        self._wanted_advice: Asked | None = None
        self._timer: Any = None
        self._is_paused = self._is_owed = False

    def compose(self) -> ComposeResult:
        """Lay out the picture above the figures and the words."""
        yield Caption()
        yield PredictionDensity()
        yield PredictionTable()
        with Horizontal(id="bound"):
            yield Static("False cells ≤", markup=False)
            yield FalseCellField()
            yield Static("Ctrl+T takes it", markup=False)
        yield Static("", classes="words", markup=False)

    # What is asked

    def ask(self, entry: InitiatorEntry, scenario: Scenario, others: int = 0) -> None:
        """Predict for an entry on a scenario, once nothing more has changed for a moment.

        Parameters
        ----------
        others : how many further scenarios there are to look at
        """
        more = (Part(f"F10: {others} other{'s' * (others != 1)}", 1),) if others else ()
        self.query_one(Caption).tell(f"{entry.name} on {scenario.name}", *more, Part("predicted", 2))
        self._asked = Asked(entry, scenario, self._bound)
        if self._timer is not None:
            self._timer.stop()
        self._timer = self.set_timer(DEBOUNCE, self._begin)

    def pause(self) -> None:
        """Predict nothing more until somebody looks again: it would only delay what is looked at."""
        self._is_paused = True

    def resume(self) -> None:
        """Predict again, and first what was asked meanwhile."""
        self._is_paused = False
        if self._is_owed:
            self._begin()

    @property
    def is_up_to_date(self) -> bool:
        """Whether prediction and recommendation are those for what was asked last."""
        asked, advised = self._asked, self._advised
        return (
            asked is not None
            and advised is not None
            and advised.asked.false_cells == asked.false_cells
            and advised.asked.scenario == asked.scenario
        )

    @property
    def advice(self) -> Advice | str | None:
        """What is recommended for what was asked last, or why nothing is; None while it is not known yet."""
        return self._advised.found if self._advised is not None and self.is_up_to_date else None

    @on(Input.Changed)
    def _read_bound(self, event: Input.Changed) -> None:
        event.stop()
        found = self.query_one(FalseCellField).read()
        self._bound_problem = found if isinstance(found, str) else None
        self.query_one(FalseCellField).set_class(isinstance(found, str), "-wrong")
        if isinstance(found, str):
            self._show()
        elif self._asked is not None:
            self._bound = found
            self._asked = Asked(self._asked.entry, self._asked.scenario, found)
            self._begin()
            self._show()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()

    # Working it out

    def _begin(self) -> None:
        asked = self._asked
        self._is_owed = self._is_paused
        if asked is None or self._is_paused:
            return
        self._predict(asked)
        if not self.is_up_to_date and not self._is_wanted(asked):
            self._wanted_advice = asked
            self._advise(asked)

    def _is_wanted(self, asked: Asked) -> bool:
        """Return whether the recommendation for what is asked is being worked out already."""
        wanted = self._wanted_advice
        return (
            wanted is not None
            and wanted.false_cells == asked.false_cells
            and wanted.scenario == asked.scenario
        )

    @work(thread=True, exclusive=True, exit_on_error=False, group="prediction", name="prediction")
    def _predict(self, asked: Asked) -> None:
        """Predict, and learn what votes cost on this machine."""
        from algorithms.errors import RequestError
        from hough_tui.quantisation.forecast import forecast
        from hough_tui.quantisation.vote_cost import known_cost, vote_cost

        worker = get_current_worker()
        try:
            found = forecast(asked.entry, asked.scenario)
        except RequestError as error:
            self.post_message(self.Predicted(asked, str(error), None))
            return
        cost = known_cost(found.is_weighted)
        if not worker.is_cancelled:
            self.post_message(self.Predicted(asked, found, cost))
        if cost is None and not worker.is_cancelled:
            self.post_message(self.Predicted(asked, found, vote_cost(found.is_weighted)))

    @work(thread=True, exclusive=True, exit_on_error=False, group="advice", name="advice")
    def _advise(self, asked: Asked) -> None:
        """Work the recommendation out."""
        from algorithms.errors import RequestError
        from hough_tui.quantisation.forecast import recommendation

        found: Advice | str
        try:
            found = recommendation(asked.scenario, asked.false_cells)
        except RequestError as error:
            found = str(error)
        if not get_current_worker().is_cancelled:
            self.post_message(self.Advised(asked, found))

    def on_prediction_panel_predicted(self, event: Predicted) -> None:
        """Show a prediction, unless something else was asked meanwhile."""
        event.stop()
        if event.asked is self._asked:
            self._forecast, self._cost = event.found, event.cost
            self._show()

    def on_prediction_panel_advised(self, event: Advised) -> None:
        """Show a recommendation."""
        event.stop()
        self._advised, self._wanted_advice = event, None
        self._show()

    # Showing it

    @on(PredictionDensity.TargetChosen)
    def _tell_target(self, event: PredictionDensity.TargetChosen) -> None:
        event.stop()
        self._show()

    def _show(self) -> None:
        found, advice = self._forecast, self.advice
        words: list[str] = [f"False cells: {self._bound_problem}."] if self._bound_problem else []
        self.set_class(isinstance(found, str), "without-figures")
        if isinstance(found, str):
            words.append(f"Nothing is predicted: {found}.")
        elif found is not None:
            words += self._show_figures(found, advice)
        if isinstance(advice, str) and advice != found:
            words.append(f"Nothing is recommended: {advice}.")
        self.query_one(".words", Static).update("\n".join(words))

    def _show_figures(self, found: Forecast, advice: Advice | str | None) -> list[str]:
        """Show density and figures; return what is to be said in words."""
        from hough_tui.quantisation.forecast import recommended

        unit = found.scenario.unit.value
        density = self.query_one(PredictionDensity)
        density.show(found.pictures, unit)
        told = None if advice is None or isinstance(advice, str) else recommended(advice, found.is_weighted)
        missing = {"missing": NO_ADVICE} if isinstance(advice, str) else {}
        self.query_one(PredictionTable).compared = Compared(found.outlook, told, self._cost, unit, **missing)
        shown = density.shown
        return [*([spread_words(shown, unit)] if shown is not None else []), *found.notes]


def spread_words(shown: VotePicture, unit: str) -> str:
    """Return what the angle between line and row does to the share of votes in the home cell."""
    return (
        f"Share in the home cell over all θ: mean {percent(shown.mean)} %, best {percent(shown.most)} % "
        f"(line in a row), worst {percent(shown.least)} % (midway between two, the extent adds "
        f"±{significant(shown.most_spread)} {unit})."
    )
