"""The footer: the keys of what has the focus, then those that work everywhere, six at most."""

from __future__ import annotations

from textual.app import ComposeResult
from textual.widgets import Footer
from textual.widgets._footer import FooterKey

MOST_KEYS = 6

PALETTE = "app.palette"
"""The id of the binding of the command palette, whose key stands at the right end."""


class KeyLine(Footer):
    """A footer of at most six keys; F1 tells the others, and the command palette lists every action."""

    def compose(self) -> ComposeResult:
        """Lay out the first keys, and the one of the command palette, whichever that is."""
        yield from list(super().compose())[: MOST_KEYS - 1]
        if not self._bindings_ready:
            return
        for active in self.screen.active_bindings.values():
            if (binding := active.binding).id == PALETTE:
                key = self.app.get_key_display(binding)
                yield FooterKey(
                    binding.key, key, binding.description, binding.action, classes="-command-palette"
                )
                return
