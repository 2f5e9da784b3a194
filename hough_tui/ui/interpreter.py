"""How the interpreter is set while the application runs, so that the screen answers at once."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import suppress
from multiprocessing import resource_tracker

from hough_tui import ending

SWITCH_INTERVAL = 0.001
"""Seconds after which a thread that computes hands the interpreter over, if another one asks for it."""


def prepare() -> None:
    """Set the interpreter before the application starts."""
    sys.setswitchinterval(SWITCH_INTERVAL)
    # A pool of processes cannot be begun once the screen is up, unless what looks after it runs already.
    resource_tracker.ensure_running()
    # Nothing that is imported at the start becomes garbage: to look through it all would only hold up.
    gc.disable()


def settle() -> None:
    """Leave all that is loaded by now out of the collector's sight, and let it work."""
    # A full collection over modules, kernels and the style sheet stops the screen for a tenth of a second.
    gc.freeze()
    gc.enable()


def leave(status: int) -> None:
    """End the process without taking the interpreter apart, which takes longer than anybody waits.

    Only to be called when no thread writes any more.
    """
    with suppress(OSError):  # the terminal may have gone
        sys.stdout.flush()
        sys.stderr.flush()
    ending.claim()
    os._exit(status)
