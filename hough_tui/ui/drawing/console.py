"""A picture for the Linux console, whose fonts have neither braille nor most signs."""

from __future__ import annotations

from collections.abc import Iterable

from rich.segment import Segment
from textual.strip import Strip

UPPER_DOTS, LOWER_DOTS = 0b00011011, 0b11100100
"""Bits of a braille character's dots in its upper and in its lower half."""

SIGNS = {
    "×": "x", "◇": "♦", "◆": "♦", "●": "•", "□": "■", "▪": "■", "△": "▲", "▽": "▼", "◉": "◘", "╌": "-",
    "▸": "►", "▴": "▲",
}  # fmt: skip
"""What stands for signs that are not among the 256 characters of code page 437."""


def _table() -> dict[int, str]:
    dots = {
        0x2800 + bits: " '.:"[bool(bits & UPPER_DOTS) + 2 * bool(bits & LOWER_DOTS)] for bits in range(256)
    }
    return dots | str.maketrans(SIGNS)


TABLE = _table()


def for_console(lines: Iterable[Strip]) -> list[Strip]:
    """Return lines with every character that the console lacks replaced by one that it has."""
    return [
        Strip([Segment(text.translate(TABLE), style) for text, style, _ in line], line.cell_length)
        for line in lines
    ]
