"""A run from its plan to its place in the store, in one worker thread; it knows nothing of screens."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from algorithms.errors import RequestError, WorkFailedError
from hough_tui import ending
from hough_tui.experiments.cases import Row
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.ui.runs.shown_run import LiveRun
from scenarios.model import ScenarioSet

PERIOD = 0.4
"""Seconds from one snapshot of the rows to the next."""

SHARE = 0.1
"""The most of the time that snapshots may take: those of long runs come more seldom."""

KEPT_ON_LEAVING = 4 * 2**20
"""Bytes of per-trial columns that can be kept while the user waits for the application to end."""


NICENESS = 5
"""How much the engine's threads give way to others."""


@dataclass(frozen=True, slots=True)
class RunRequest:
    """What is to run.

    Attributes
    ----------
    scenario_set : the set
    experiments : names; none: all
    trials, seed : in place of the experiments' own, where given
    """

    scenario_set: ScenarioSet
    experiments: tuple[str, ...] = ()
    trials: int | None = None
    seed: int | None = None


@dataclass(frozen=True, slots=True)
class Started:
    """The trials have begun."""

    live: LiveRun


@dataclass(frozen=True, slots=True)
class Filled:
    """More trials are finished."""

    rows: tuple[Row, ...]


@dataclass(frozen=True, slots=True)
class Ended:
    """Nothing more will come.

    Attributes
    ----------
    rows : over all trials that were finished
    seconds : wall-clock time of the trials
    is_complete : whether every trial was done
    kept_as : the run's name in the store, if it is there
    problem : why the run failed, or could not be kept
    """

    rows: tuple[Row, ...] = ()
    seconds: float = 0.0
    is_complete: bool = False
    kept_as: str | None = None
    problem: str | None = None


Event = Started | Filled | Ended


class Running:
    """One run.

    Parameters
    ----------
    asked : what is to run
    tell : is given what happens, in the worker's thread
    """

    def __init__(self, request: RunRequest, tell: Callable[[Event], None]) -> None:
        self._request, self._tell = request, tell
        self._stopped = threading.Event()
        self._is_leaving = False
        self._job: Job | None = None

    def cancel(self, *, is_leaving: bool = False) -> None:
        """Stop after the stages that are under way; from any thread, at any time.

        Parameters
        ----------
        is_leaving : the application ends: what is finished is kept, if that is quickly done
        """
        self._is_leaving = self._is_leaving or is_leaving
        self._stopped.set()
        if self._job is not None:
            self._job.cancel()

    def work(self) -> None:
        """Do all of it; the body of the worker's thread. What goes wrong is told, not raised."""
        live: LiveRun | None = None
        try:
            request = self._request
            plan = plan_run(
                [request.scenario_set],
                experiments=request.experiments,
                trials=request.trials,
                seed=request.seed,
            )
            if self._stopped.is_set():
                self._tell(Ended())
                return
            self._job = Job(plan)
            if self._stopped.is_set():  # it was set before there was a job to cancel
                self._job.cancel()
            self._job.give_way(NICENESS)
            live = LiveRun(self._job)
            self._tell(Started(live))
            self._fill(live)
            self._tell(self._end(live))
        except Exception as error:
            rows = live.rows if live is not None else ()
            self._tell(Ended(rows, problem=problem_words(error)))

    def _fill(self, live: LiveRun) -> None:
        due = 0.0
        while not live.job.wait(PERIOD):
            if self._is_leaving:
                return  # the trials that are under way may take minutes
            began = time.monotonic()
            if self._stopped.is_set() or began < due:
                continue
            live.rows = live.snapshot()
            self._tell(Filled(live.rows))
            now = time.monotonic()
            due = now + (now - began) / SHARE

    def _end(self, live: LiveRun) -> Ended:
        job = live.job
        live.rows = live.snapshot()
        live.is_over = True
        kept_as = problem = None
        if job.is_complete:
            self._tell(Filled(live.rows))  # keeping a million trials takes seconds
            kept_as, problem = keep(live)
        elif self._is_leaving and job.progress.done.any() and _is_small(live):
            kept_as, problem = keep(live)
        return Ended(live.rows, job.seconds, job.is_complete, kept_as, problem)


def keep(live: LiveRun) -> tuple[str | None, str | None]:
    """Keep a run; return its name, or why it could not be kept."""
    store = FolderStore()
    try:
        with ending.finishing():
            return store.add(live.whole()), None
    except OSError as error:
        return None, (
            f"The run could not be kept in {store.folder}: {error.strerror or error}. "
            "Its results stay on the screen: e exports them, w tries to keep them again."
        )


def problem_words(error: Exception) -> str:
    """Return what went wrong, in words that help."""
    if isinstance(error, RequestError | WorkFailedError):
        return str(error)
    if isinstance(error, MemoryError):
        return "There is not enough memory for so many trials; ask for fewer trials or fewer experiments."
    return f"{type(error).__name__}: {error}"


def _is_small(live: LiveRun) -> bool:
    trials = zip(live.job.plan.cells, live.job.progress.done, strict=True)
    return sum(cell.bytes_a_trial * int(done) for cell, done in trials) <= KEPT_ON_LEAVING
