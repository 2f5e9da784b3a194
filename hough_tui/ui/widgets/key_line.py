"""The footer: the keys of what has the focus, then those that work everywhere, six at most."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.widgets import Footer

MOST_KEYS = 6


class KeyLine(Footer):
    """A footer of at most six keys; F1 tells the others, and Ctrl+P lists every action."""

    def compose(self) -> ComposeResult:
        """Lay out the first keys, and the one of the command palette."""
        keys = list(super().compose())
        palette = [key for key in keys if key.has_class("-command-palette")]
        others = [key for key in keys if not key.has_class("-command-palette")]
        yield from others[: MOST_KEYS - len(palette)]
        yield from palette
