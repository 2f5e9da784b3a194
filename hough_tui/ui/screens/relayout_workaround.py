"""A screen that tells every widget when it is shown, hidden or resized."""

from __future__ import annotations

from typing import Any

from textual._compositor import Compositor, ReflowResult
from textual.geometry import Size
from textual.screen import Screen
from textual.widget import Widget


class AttentiveScreen(Screen[None]):
    """A screen that tells every widget when it is shown, hidden or resized.

    Notes
    -----
    Textual tells it to those that differ from its map of the screen. Whatever asks for a place
    between a change and the layout that follows it, as a refresh of something hidden may, has the map
    made anew, and what is new is taken for old: it learns no size, and keeps what it drew before it was
    hidden. Here the map of the layout before is what the next one is compared with.
    """

    def __init__(self) -> None:
        super().__init__()
        self._compositor = _Remembering()


class _Remembering(Compositor):
    def __init__(self) -> None:
        super().__init__()
        self._laid_out: dict[Widget, Any] = {}

    def reflow(self, parent: Widget, size: Size) -> ReflowResult:
        self._full_map = self._laid_out
        result = super().reflow(parent, size)
        self._laid_out = self._full_map
        return result
