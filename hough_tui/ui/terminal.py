"""The terminal that the application needs, and how it is left when it goes away."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Callable

from algorithms.errors import RequestError

ENDING_SIGNALS = (signal.SIGTERM, signal.SIGHUP)


def require_terminal() -> None:
    """Raise a wrong request where there is no terminal to draw on.

    Raises
    ------
    RequestError
        Where standard input or output is no terminal.
    """
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise RequestError(
            "the application needs a terminal, and there is none here; `hough-tui batch` runs without one"
        )


def on_ending_signals(act: Callable[[int], None]) -> None:
    """Call a function with the exit status when the process is asked to end or loses its terminal.

    It must be called on the event loop.
    """
    loop = asyncio.get_running_loop()
    for number in ENDING_SIGNALS:
        loop.add_signal_handler(number, act, 128 + number)
