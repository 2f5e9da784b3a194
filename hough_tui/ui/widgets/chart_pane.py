"""The chart of a run, below the choice of what it shows."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from textual import on
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.widgets import Select

from algorithms.errors import RequestError
from hough_tui.experiments.cases import Row
from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.experiments.metrics.metric import Sample
from hough_tui.experiments.metrics.registry import leading_metric, metric
from hough_tui.reports.charts import rate_chart
from hough_tui.reports.metric_columns import measured
from hough_tui.ui.runs.shown_run import ShownRun, cell_words
from hough_tui.ui.widgets.rate_plot import RatePlot
from hough_tui.ui.widgets.trial_chart import trial_chart

BY_TRIAL = "by-trial"
"""The second kind of chart, in the list of metrics."""


class ChartPane(Vertical):
    """A metric against the swept field, or the ratio of false tracks by trial, around one row."""

    DEFAULT_CSS = """
    ChartPane { padding: 0 1; }
    ChartPane #metric { width: 44; max-width: 100%; }
    ChartPane RatePlot { height: 1fr; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.metric = leading_metric(()).key
        self._metric_before = self.metric
        self._run: ShownRun | None = None
        self._rows: tuple[Row, ...] = ()
        self._index: int | None = None
        self._drawn: object = None
        self._offered: list[tuple[str, str]] = []

    def compose(self) -> ComposeResult:
        """Lay out the choice and the chart."""
        yield Select[str]([], id="metric", compact=True, prompt="metric")
        yield RatePlot()

    def fill(self, run: ShownRun | None, rows: Sequence[Row], index: int | None) -> None:
        """Show a run around the row of an index."""
        self._run, self._rows, self._index = run, tuple(rows), index
        metrics = self._metrics()
        if metrics and self.metric not in (*metrics, BY_TRIAL):
            self.metric = metrics[0]
        options = [(metric(key).label(), key) for key in metrics]
        if any("initiator" in row for row in self._rows) and options:
            options.append(("false % by trial, of the row chosen", BY_TRIAL))
        if options != self._offered:
            self._offered = options
            with self.prevent(Select.Changed):
                self.query_one(Select).set_options(options)
        self._show_choice()
        self.draw()

    def turn_to(self, index: int | None) -> None:
        """Show another row of the same run."""
        self._index = index
        if self._wanted() != self._drawn:
            self.draw()

    def next_metric(self, step: int) -> None:
        """Show the next metric of those that have values."""
        metrics = self._metrics()
        if metrics:
            here = metrics.index(self.metric) if self.metric in metrics else -min(step, 0) - 1
            self._choose(metrics[(here + step) % len(metrics)])

    def turn_by_trial(self) -> None:
        """Show the ratio of false tracks by trial, or the metric again."""
        if BY_TRIAL not in (value for _, value in self._offered):
            self.notify("Trials of clustering have no tracks, and so none that are false", markup=False)
        elif self.metric == BY_TRIAL:
            self._choose(self._metric_before)
        else:
            self._metric_before = self.metric
            self._choose(BY_TRIAL)

    def draw(self) -> None:
        """Draw; the plot waits with it until somebody sees it."""
        plot, index = self.query_one(RatePlot), self._index
        self._drawn = self._wanted()
        if self._run is None or index is None or index >= len(self._rows):
            plot.show(None)
        elif self.metric == BY_TRIAL:
            plot.show(partial(_trials_drawn, self._run, index))
        else:
            chosen = self._rows[index]
            key = chosen["set"], chosen["experiment"]
            rows = [row for row in self._rows if (row["set"], row["experiment"]) == key and row["trials"]]
            plot.show(partial(_rates_drawn, rows, self.metric))

    @on(Select.Changed)
    def _selected(self, event: Select.Changed) -> None:
        event.stop()
        if isinstance(event.value, str) and event.value != self.metric:
            self._choose(event.value)

    def _choose(self, name: str) -> None:
        self.metric = name
        self._show_choice()
        self.draw()

    def _show_choice(self) -> None:
        if self.metric in (value for _, value in self._offered):
            with self.prevent(Select.Changed):
                self.query_one(Select).value = self.metric

    def _metrics(self) -> list[str]:
        return [metric.key for metric in measured(self._rows)]

    def _wanted(self) -> object:
        """Return what tells the chart from another one of the same rows."""
        if self._index is None or self._index >= len(self._rows):
            return None
        if self.metric == BY_TRIAL:
            return self.metric, self._index
        return self.metric, self._rows[self._index]["set"], self._rows[self._index]["experiment"]


def _rates_drawn(rows: Sequence[Row], key: str, width: int, height: int) -> str:
    return rate_chart(rows, key, width, height, True)


def _trials_drawn(run: ShownRun, index: int, width: int, height: int) -> str:
    trials = run.trials(index)
    if not isinstance(trials.columns, TrialColumns):
        raise RequestError("this row is of clustering: its trials have clusters, and no tracks")
    ratio = metric("false_track_ratio").per_trial(Sample(trials.cell, trials.columns, 0.0))
    return trial_chart(cell_words(trials.cell), trials.numbers, ratio, width, height)
