"""What stands for a wrong request, and for work that failed."""

from __future__ import annotations


class RequestError(ValueError):
    """What was asked for cannot be done as it was asked; the message is for people.

    The message says what was given, where (file, line, field), what is allowed and what
    to do. Commands print it alone, without a traceback, and exit with status 2.
    """


class WorkFailedError(RuntimeError):
    """The request was right, and the work failed; the message is for people.

    Commands print it alone and exit with status 1.
    """
