"""Names for what is added to a set."""

from __future__ import annotations

from collections.abc import Collection
from itertools import count


def free_name(wanted: str, taken: Collection[str]) -> str:
    """Return a name, numbered where it is taken."""
    if wanted not in taken:
        return wanted
    return next(name for number in count(2) if (name := f"{wanted}-{number}") not in taken)
