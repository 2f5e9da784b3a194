"""How far a running job is, on standard error."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import IO

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn, TimeRemainingColumn
from rich.table import Column
from rich.text import Text

from hough_tui.reports.visible import visible_line

ROOM_FOR_CELLS = 80
ROOM_FOR_SPEED = 100


class ProgressBar:
    """A bar that shows how much of a job is done; a context manager.

    Where the stream is no terminal nothing at all is written. The bar vanishes when the job is
    over, so that it does not stand between the results.

    Parameters
    ----------
    description : what is running
    stream : where to draw; None for standard error
    """

    def __init__(self, description: str, stream: IO[str] | None = None) -> None:
        self._description = description
        self._stream = stream
        self._progress: Progress | None = None

    def __enter__(self) -> ProgressBar:
        stream = sys.stderr if self._stream is None else self._stream
        # rich's own answer follows FORCE_COLOR too, which asks for colour and not for a moving bar.
        if not stream.isatty():
            return self
        console = Console(file=stream)
        if console.is_dumb_terminal:
            return self
        self._progress = Progress(
            *_columns(console.width),
            console=console,
            transient=True,
            # What is printed while the bar runs is a result and belongs on standard output.
            redirect_stdout=False,
            expand=True,
        )
        self._progress.add_task(visible_line(self._description), total=None, cells="")
        self._progress.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._progress is not None:
            self._progress.stop()
            self._progress = None

    def update(self, cells_done: int, cells: int, trials_done: int, trials: int) -> None:
        """Say how far the job is.

        Parameters
        ----------
        cells_done, cells : finished cells and all cells
        trials_done, trials : finished trials and all trials
        """
        if self._progress is not None:
            (task,) = self._progress.task_ids
            counted = f"{cells_done:,}/{cells:,} cells"
            self._progress.update(task, completed=trials_done, total=trials, cells=counted)


class _TrialsColumn(ProgressColumn):
    """Trials done of all."""

    def render(self, task: Task) -> Text:
        if task.total is None:
            return Text("")
        total = f"{int(task.total):,}"
        # Room for the total from the start, so that the bar keeps its length.
        return Text(f"{int(task.completed):>{len(total)},}/{total} trials")


class _SpeedColumn(ProgressColumn):
    """Trials a second over the last seconds."""

    def render(self, task: Task) -> Text:
        speed = task.finished_speed or task.speed
        return Text("" if speed is None else f"{speed:,.0f} trials/s", style="dim")


class _LeftColumn(TimeRemainingColumn):
    """Time left."""

    def render(self, task: Task) -> Text:
        return super().render(task).append(" left")


def _columns(width: int) -> list[ProgressColumn]:
    """Return what a terminal of a width has room for."""
    columns: list[ProgressColumn] = [
        TextColumn(
            "{task.description}", markup=False, table_column=Column(no_wrap=True, max_width=width // 3)
        ),
        BarColumn(bar_width=None, table_column=Column(ratio=1, min_width=6)),
    ]
    if width >= ROOM_FOR_CELLS:
        columns.append(TextColumn("{task.fields[cells]}", markup=False))
    columns.append(_TrialsColumn())
    if width >= ROOM_FOR_SPEED:
        columns.append(_SpeedColumn())
    columns.append(_LeftColumn(compact=True))
    return columns
