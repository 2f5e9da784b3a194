"""The one exception that stands for a wrong request."""

from __future__ import annotations


class RequestError(ValueError):
    """What was asked for cannot be done as it was asked; the message is for people.

    The message says what was given, where (file, line, field), what is allowed and what
    to do. Commands print it alone, without a traceback, and exit with status 2.
    """
