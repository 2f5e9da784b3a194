"""Words for names and values of any length: what a message says stays readable."""

from __future__ import annotations

import difflib
from collections.abc import Sequence

LONGEST_TEXT = 60
"""The most characters of a text from outside that a message repeats."""

MOST_NAMES = 40
"""The most names that a message lists."""


def shortened(text: str, longest: int = LONGEST_TEXT) -> str:
    """Return a text, with an ellipsis for what is too long of it."""
    return text if len(text) <= longest else text[: longest - 1] + "…"


def listed(names: Sequence[str], most: int = MOST_NAMES) -> str:
    """Return names as a list in words, and how many more there are where they are many."""
    shown = [shortened(name) for name in names[:most]]
    more = [f"… {len(names) - most:,} more"] if len(names) > most else []
    return ", ".join([*shown, *more]) or "none"


def nearest(name: str, names: Sequence[str]) -> str:
    """Return the hint at the nearest of some names; nothing where none is near."""
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    return f"; did you mean '{shortened(near[0])}'?" if near else ""


def unknown(name: str, known: Sequence[str], what: str) -> str:
    """Return the words for a name that is not known, with the nearest known one."""
    return f"there is no {what} '{shortened(name)}'{nearest(name, known)} (known: {listed(known)})"
