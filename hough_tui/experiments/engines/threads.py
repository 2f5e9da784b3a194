"""The local engine: chunks of trials on threads, into per-trial columns.

A chunk is a fixed range of trials, its kernels run without the interpreter's lock, and it
writes its own rows of the columns: neither the number of workers nor their order, nor the parts in
which a chunk that takes long is done, can change a figure. An initiator in plain Python would hold
the lock, so its trials go to processes.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import WorkFailedError
from hough_tui.experiments.cases import AnyCell, Row
from hough_tui.experiments.columns.schema import Columns
from hough_tui.experiments.engines.process_worker import begin_worker
from hough_tui.experiments.plan import Plan
from hough_tui.experiments.rows import row_of

PART_SECONDS = 0.05
"""About how long a worker goes on before it looks whether the run is cancelled; one trial may last longer."""

THREADS = "chunks"
"""Prefix of the names of the workers' threads."""

LEAST_SECONDS = 1e-6
"""The least time that a part is taken to last, where the clock is coarse."""


@dataclass(slots=True)
class Progress:
    """How far a run is; the engine writes it, anyone may read it at any time.

    Attributes
    ----------
    done, total : int64 (cells,), trials finished and asked for
    started : `time.monotonic()` of the start
    """

    done: NDArray[np.int64]
    total: NDArray[np.int64]
    started: float = field(default_factory=time.monotonic)

    @property
    def cells_done(self) -> int:
        """Number of finished cells."""
        return int((self.done == self.total).sum())


class Job:
    """A run that is under way.

    Start it with `Job(plan, workers)`; look at `progress`, `cancel` it, and take `rows` at any
    time or after `wait`.
    """

    def __init__(self, plan: Plan, workers: int | None = None) -> None:
        self.plan = plan
        self.workers = workers or available_workers()
        self.columns = tuple(cell.empty_columns() for cell in plan.cells)
        totals = np.array([cell.experiment.trials for cell in plan.cells], dtype=np.int64)
        self.progress = Progress(np.zeros_like(totals), totals)
        self._finished = tuple(np.zeros(cell.experiment.trials, np.bool_) for cell in plan.cells)
        self._seconds = np.zeros(len(plan.cells))
        self._prepared: dict[int, Any] = {}
        self._ended: float | None = None
        self._cancelled = threading.Event()
        self._lock = threading.Lock()
        self._chunks = _chunks(plan)
        self._pace: dict[int, float] = {}
        self._cold = list(plan.draws)
        # Processes come first: starting them once threads are busy is slow, and unsafe by fork.
        self._processes = _processes(plan, self.workers)
        self._threads = ThreadPoolExecutor(self.workers, thread_name_prefix=THREADS)
        self._futures: list[Future[None]] = [self._threads.submit(self._work) for _ in range(self.workers)]

    def cancel(self) -> None:
        """Ask the workers to stop after the stage that they are in."""
        self._cancelled.set()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for the end of the run; return whether it has ended.

        Raises
        ------
        Exception
            What a worker failed with.
        """
        pending = wait_for(self._futures, timeout).not_done
        if pending:
            return False
        self._threads.shutdown()
        if self._processes is not None:
            self._processes.shutdown(cancel_futures=True)
        self._ended = self._ended or time.monotonic()
        for future in self._futures:
            future.result()
        return True

    @property
    def seconds(self) -> float:
        """Wall-clock time since the start; once the run has ended, of the run."""
        return (self._ended or time.monotonic()) - self.progress.started

    @property
    def is_complete(self) -> bool:
        """Whether every trial of every cell is done."""
        return bool((self.progress.done == self.progress.total).all())

    def finished_trials(self, index: int) -> tuple[Columns, float] | None:
        """Return the columns of a cell's finished trials and their seconds; None before the first.

        Any thread may ask, at any time.
        """
        # The workers go on meanwhile: the mask must be the same for every column.
        done, seconds = self._finished[index].copy(), float(self._seconds[index])
        if not done.any():
            return None
        columns = self.columns[index]
        return (columns if done.all() else columns.select(done)), seconds

    def finished(self) -> Iterator[tuple[AnyCell, Columns, float]]:
        """Yield the cells that have finished trials, with the columns of these and their seconds."""
        for index, cell in enumerate(self.plan.cells):
            trials = self.finished_trials(index)
            if trials is not None:
                yield cell, *trials

    def give_way(self, niceness: int) -> None:
        """Put the workers behind the threads that a user waits for, where threads have priorities."""
        if sys.platform != "linux":
            return
        for thread in threading.enumerate():
            if thread.name.startswith(THREADS) and thread.native_id is not None:
                with suppress(OSError):  # it may have come to its end
                    os.setpriority(os.PRIO_PROCESS, thread.native_id, niceness)

    def rows(self) -> list[Row]:
        """Return the rows of the cells that have finished trials, over these trials."""
        return [row_of(cell, columns, seconds) for cell, columns, seconds in self.finished()]

    def _work(self) -> None:
        try:
            with self._lock:
                self._warm()
            while not self._cancelled.is_set():
                with self._lock:
                    chunk = next(self._chunks, None)
                if chunk is None:
                    return
                self._run(*chunk)
        except BaseException:
            self.cancel()
            raise

    def _warm(self) -> None:
        """Load, or compile, the kernels that the plan needs, so that no trial is charged for it.

        No trial at all is done: of some plans a single one takes minutes.
        """
        while self._cold and not self._cancelled.is_set():
            shared = self._cold.pop()
            for _ in shared.run(shared.prepared(), 0, 0, self._run_in_process):
                continue

    def _run(self, index: int, first: int, trials: int) -> None:
        """Do a chunk, in parts that are soon done: where most cells are tracks, a trial takes long."""
        end = first + trials
        while first < end and not self._cancelled.is_set():
            with self._lock:
                pace = self._pace.get(index, PART_SECONDS)
            part = min(end - first, max(1, int(PART_SECONDS / pace)))
            began = time.monotonic()
            self._run_part(index, first, part)
            with self._lock:
                self._pace[index] = max(time.monotonic() - began, LEAST_SECONDS) / part
            first += part

    def _run_part(self, index: int, first: int, trials: int) -> None:
        shared = self.plan.draws[index]
        with self._lock:
            prepared = self._prepared.get(index)
            if prepared is None:
                prepared = self._prepared[index] = shared.prepared()
        for part in shared.run(prepared, first, trials, self._run_in_process):
            self.columns[part.cell].put(part.columns)
            with self._lock:
                self._seconds[part.cell] += part.seconds
                self._finished[part.cell][first : first + trials] = True
                self.progress.done[part.cell] += trials
            if self._cancelled.is_set():
                return

    def _run_in_process(self, what: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return what a function in plain Python gives in a worker process."""
        assert self._processes is not None
        try:
            return self._processes.submit(function, *arguments).result()
        except BrokenExecutor:
            raise WorkFailedError(f"{what}: its worker process died; mend the plug-in") from None


def available_workers() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _chunks(plan: Plan) -> Iterator[tuple[int, int, int]]:
    """Yield the work: index of the draws, first trial, number of trials."""
    for index, shared in enumerate(plan.draws):
        for first in range(0, shared.trials, shared.chunk):
            yield index, first, min(shared.chunk, shared.trials - first)


def _processes(plan: Plan, workers: int) -> ProcessPoolExecutor | None:
    if not any(shared.needs_processes for shared in plan.draws):
        return None
    # A forked child would inherit the state of threads that it does not have.
    spawned = multiprocessing.get_context("spawn")
    return ProcessPoolExecutor(workers, mp_context=spawned, initializer=begin_worker)
