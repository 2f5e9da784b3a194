"""The terminal that the application needs, and how it is left when it goes away."""

from __future__ import annotations

import os
import signal
import sys
import termios
import threading
import time
from contextlib import suppress
from io import TextIOWrapper

from algorithms.errors import RequestError
from hough_tui.reports.look_alikes import CELLS

LEFT = (
    b"\x1b\\\x1b[0m"  # the end of a sequence that was cut off, and of colours
    b"\x1b[?2026l\x1b[?2004l\x1b[?7h\x1b[?2048l\x1b[?1000l\x1b[?1003l\x1b[?1015l\x1b[?1006l\x1b[?1016l"
    b"\x1b[<u\x1b[?1049l\x1b[?25h\x1b[?1004l"
)
"""What takes back all that Textual asks of a terminal: the other screen, mouse, paste, focus, keys."""

WRITER = "textual-output"
"""The thread that writes what is drawn; it has ended once the screen is left, or the terminal has gone."""

DRAWN_ON = 2
"""The file descriptor that it writes to: standard error, for which `sys.stderr` does not stand meanwhile."""

RESTORING_SECONDS = 0.3
"""The longest that a terminal which takes no byte is tried."""


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


class Terminal:
    """Terminal as it was before the application drew on it.

    Attributes
    ----------
    descriptor : its file descriptor

    Raises
    ------
    RequestError
        Where it has gone.
    """

    def __init__(self) -> None:
        self.descriptor = sys.stdin.fileno()
        try:
            self._attributes = termios.tcgetattr(self.descriptor)
        except termios.error as error:
            raise RequestError(f"the terminal cannot be used: {error.args[-1]}") from None

    def restore(self, _: int) -> None:
        """Restore it from any thread, whether or not somebody reads it, where Textual has not done so."""
        with suppress(OSError, termios.error):  # it has gone
            termios.tcsetattr(self.descriptor, termios.TCSANOW, self._attributes)
            writers = [thread for thread in threading.enumerate() if thread.name == WRITER]
            if writers:
                self._leave_screen(writers[0])

    def _leave_screen(self, writer: threading.Thread) -> None:
        # Nothing of what is still drawn shall come through.
        own = os.open(os.ttyname(self.descriptor), os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY)
        os.dup2(os.open(os.devnull, os.O_WRONLY), DRAWN_ON)
        rest, limit = LEFT, time.monotonic() + RESTORING_SECONDS
        while rest and time.monotonic() < limit:
            if writer.ident is not None and writer.is_alive():
                # Where nobody reads it has the terminal to itself, until a signal interrupts its call.
                with suppress(ProcessLookupError):
                    signal.pthread_kill(writer.ident, signal.SIGTERM)
            termios.tcflush(own, termios.TCOFLUSH)
            try:
                rest = rest[os.write(own, rest) :]
            except BlockingIOError:
                time.sleep(0.01)
