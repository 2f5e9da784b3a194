"""How a command meets the process it runs in: messages, exit statuses, signals."""

from __future__ import annotations

import contextlib
import functools
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import typer

from hough_tui.ending import INTERRUPTED, WORDS, requested_status
from hough_tui.reports.visible import visible
from hough_tui.streams import naming_output

if TYPE_CHECKING:
    from hough_tui.experiments.engines.threads import Job

WRONG_REQUEST, FAILED = 2, 1

STAGE_SECONDS = 0.4
"""The longest that the end of a run waits for the trials that are under way."""


def reported(command: Callable[..., None]) -> Callable[..., None]:
    """Make a command report what goes wrong as one message and an exit status."""

    @functools.wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        from algorithms.errors import RequestError, WorkFailedError
        from algorithms.notices import listen

        listen(tell)
        try:
            command(*args, **kwargs)
            with naming_output():
                sys.stdout.flush()
        except RequestError as error:
            stop(str(error), WRONG_REQUEST)
        except WorkFailedError as error:
            stop(str(error), FAILED)
        except KeyboardInterrupt:
            stop(WORDS[INTERRUPTED], INTERRUPTED)
        except OSError as error:
            raise typer.Exit(failed(error)) from None
        except MemoryError:
            stop("there is not enough memory for this; give a smaller grid, or fewer scans or trials", FAILED)

    return run


def stop(message: str, status: int) -> None:
    """Say on standard error why the command ends, and end it; what was asked to end says so itself."""
    if requested_status() is None:
        tell(message)
    raise typer.Exit(status)


def failed(error: OSError) -> int:
    """Say what the system refused, and return the exit status."""
    # A reader that leaves has enough of the output: that is no news.
    if not isinstance(error, BrokenPipeError):
        tell(f"{error.filename or 'the system'}: {error.strerror or error}")
    return FAILED


def counted(number: int, what: str) -> str:
    """Return a number of things, in words."""
    return f"{number:,} {what}" + ("" if number == 1 else "s")


def tell(message: str) -> None:
    """Say something on standard error."""
    # A terminal that has gone away must not keep the work from being ended in order.
    with contextlib.suppress(OSError):
        print(f"hough-tui: {visible(message)}", file=sys.stderr, flush=True)


def refuse(condition: bool, message: str) -> None:
    """Raise a wrong request where a condition holds."""
    from algorithms.errors import RequestError

    if condition:
        raise RequestError(message)


def announce_compilation() -> None:
    """Say that kernels must be compiled, where they must."""
    from algorithms.kernel_cache.folder import can_keep, is_cold

    if is_cold():
        tell("compiling the kernels" + (", once for this version" if can_keep() else "") + ": up to a minute")


def finish(job: Job, description: str) -> None:
    """Wait for a job with a progress bar on standard error; end it in order where the process must end."""
    progress = job.progress
    try:
        # The job is at work already: whatever interrupts from here on must end it.
        from hough_tui.reports.progress import ProgressBar

        with ProgressBar(description) as bar:
            while not job.wait(0.1):
                bar.update(
                    progress.cells_done,
                    len(progress.total),
                    int(progress.done.sum()),
                    int(progress.total.sum()),
                )
    except KeyboardInterrupt:
        job.cancel()
        # What a worker fails with while everything is being ended is no news; one in a long kernel goes on.
        with contextlib.suppress(Exception):
            job.wait(STAGE_SECONDS)
        raise
