"""A picture for the Linux console, whose fonts have neither braille nor most signs."""

from __future__ import annotations

from collections.abc import Iterable

from rich.segment import Segment
from textual.strip import Strip

from hough_tui.reports.look_alikes import BRAILLE

SIGNS = {
    "×": "x", "◇": "♦", "◆": "♦", "●": "•", "□": "■", "▪": "■", "△": "▲", "▽": "▼", "◉": "◘", "╌": "-",
    "▸": "►", "▴": "▲",
}  # fmt: skip
"""What stands for signs that are not among the 256 characters of code page 437."""


TABLE = BRAILLE | str.maketrans(SIGNS)


def for_console(lines: Iterable[Strip]) -> list[Strip]:
    """Return lines with every character that the console lacks replaced by one that it has."""
    return [
        Strip([Segment(text.translate(TABLE), style) for text, style, _ in line], line.cell_length)
        for line in lines
    ]
