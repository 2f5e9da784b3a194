"""Lines that are made to fit by leaving out what matters least, and never amid a word or a number."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from rich.cells import cell_len

BETWEEN = " · "


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a line.

    Attributes
    ----------
    text : what it says
    rank : the part of the highest rank is shortened first, then left out; that of rank 0 stays
    short : a shorter way to say it; empty where there is none
    """

    text: str
    rank: int = 0
    short: str = ""


def ranked(text: str) -> tuple[Part, ...]:
    """Return the parts of a line, of which the first matters most and the last least."""
    return tuple(Part(part, rank) for rank, part in enumerate(text.split(BETWEEN)))


def fitted(parts: Sequence[Part], width: int) -> str:
    """Return the parts in one line of so many cells at most."""
    left = list(parts)
    while cell_len(line := BETWEEN.join(part.text for part in left)) > width:
        index = max(range(len(left)), key=lambda index: (left[index].rank, index), default=None)
        if index is None:
            return ""
        part = left[index]
        if part.short:
            left[index] = replace(part, text=part.short, short="")
        elif part.rank:
            del left[index]
        else:
            return cut(line, width)
    return line


def cut(text: str, width: int) -> str:
    """Return as many whole words as there is room for, with an ellipsis where some are missing."""
    if cell_len(text) <= width:
        return text
    words = text.split(" ")
    while words and cell_len(" ".join(words)) + 2 > width:
        words.pop()
    begun = " ".join(words).rstrip(" ,:;·")
    return f"{begun} …" if begun else "…"[: max(0, width)]
