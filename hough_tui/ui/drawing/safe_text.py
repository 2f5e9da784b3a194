"""Text from outside on the screen: nothing of it acts on the terminal.

rich and Textual make text of whatever they are handed and drop five control characters of it; the
sixty others, escapes among them, go to the terminal. Here none does: where text is made they become
escapes, so that lines are laid out with what they show, and a last gate before the terminal takes out
what came another way.
"""

from __future__ import annotations

import re

import rich.text
import textual.content
from rich.cells import cell_len
from rich.segment import Segment
from textual.color import Color
from textual.filter import LineFilter

from hough_tui.reports.visible import ACTING, visible

NO_CELL = re.compile(f"\n|{ACTING.pattern}")
"""What must not be in a line that is drawn."""


def show_what_acts() -> None:
    """Have both libraries show the characters that they would drop or let through."""
    for module, name in ((rich.text, "strip_control_codes"), (textual.content, "_strip_control_codes")):
        setattr(module, name, visible)


class Gate(LineFilter):
    """The last gate before the terminal: what acts is taken out, and the line keeps its length."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """Return segments without any character that acts."""
        if not NO_CELL.search("".join([segment.text for segment in segments])):
            return segments
        return [
            segment if segment.control else Segment(NO_CELL.sub(_room, segment.text), segment.style)
            for segment in segments
        ]


def _room(match: re.Match[str]) -> str:
    return "?" * cell_len(match[0])
