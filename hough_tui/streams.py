"""The standard streams, be they closed, full, left by their reader or of a poor encoding."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterator
from io import TextIOWrapper
from typing import TextIO

STANDARD_OUTPUT = "standard output"


def reserve_descriptors() -> None:
    """Take descriptors 0 to 2 where they are closed: else the next file or pipe would become one of them."""
    # None can be written to, as if it were closed.
    while (descriptor := os.open(os.devnull, os.O_RDONLY)) <= 2:
        pass
    os.close(descriptor)


def prepare() -> None:
    """Make all three streams objects that can be used, and their encoding no reason to fail."""
    from hough_tui.reports.look_alikes import WORDS

    reserve_descriptors()
    sys.stdin = sys.stdin or os.fdopen(0, closefd=False, encoding="utf-8")
    sys.stdout = sys.stdout or os.fdopen(1, "w", closefd=False, encoding="utf-8")
    sys.stderr = sys.stderr or os.fdopen(2, "w", closefd=False, encoding="utf-8")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors=WORDS)


@contextlib.contextmanager
def naming_output() -> Iterator[None]:
    """Have an error of standard output say that it is one."""
    try:
        yield
    except OSError as error:
        raise named(error) from error


def named(error: OSError) -> OSError:
    """Return an error of standard output with its name and in plain words."""
    words = "it is closed" if error.errno == errno.EBADF else error.strerror
    return OSError(error.errno, words, STANDARD_OUTPUT)


def settle() -> OSError | None:
    """Write out what the streams still hold, and let go of what cannot be written.

    The interpreter writes them out once more at its end; what fails there is a traceback that nobody can
    catch, and another exit status.

    Returns
    -------
    error : that of standard output; None where it took everything
    """
    error = _settle(sys.stdout)
    _settle(sys.stderr)
    return error and named(error)


def _settle(stream: TextIO) -> OSError | None:
    try:
        stream.flush()
    except OSError as error:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        return error
    return None
