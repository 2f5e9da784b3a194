"""The terminal that the application needs, and how it is left when it goes away."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Callable
from io import TextIOWrapper

from algorithms.errors import RequestError
from hough_tui.reports.look_alikes import CELLS

ENDING_SIGNALS = (signal.SIGTERM, signal.SIGHUP)


def require_terminal() -> None:
    """Raise a wrong request where there is no terminal to draw on.

    Raises
    ------
    RequestError
        Where standard input, output or error is no terminal.
    """
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise RequestError(
            "the application needs a terminal, and there is none here; `hough-tui batch` runs without one"
        )
    # Textual draws on it, so that standard output stays free.
    if not sys.stderr.isatty():
        raise RequestError("the application draws on standard error, and that is no terminal here")


def draw_in_any_encoding() -> None:
    """Have characters that the terminal's encoding lacks replaced by such as take the same room."""
    if isinstance(sys.__stderr__, TextIOWrapper):
        sys.__stderr__.reconfigure(errors=CELLS)


def on_ending_signals(act: Callable[[int], None]) -> None:
    """Call a function with the exit status when the process is asked to end or loses its terminal.

    It must be called on the event loop.
    """
    loop = asyncio.get_running_loop()
    for number in ENDING_SIGNALS:
        loop.add_signal_handler(number, act, 128 + number)
