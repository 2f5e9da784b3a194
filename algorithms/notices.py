"""Notices: what people should hear of although the work goes on, such as code that cannot be kept.

Whoever has a screen listens; each notice is passed on once a process.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

Listener = Callable[[str], None]

_lock = threading.Lock()
_notices: list[str] = []
_listeners: list[Listener] = []


def notice(message: str) -> None:
    """Pass a message to the listener, unless it has been said before; without a listener it waits for one."""
    with _lock:
        if message in _notices:
            return
        _notices.append(message)
        listeners = list(_listeners)
    for listener in listeners:
        listener(message)


def listen(listener: Listener) -> None:
    """Have a listener hear every notice, the earlier ones at once; it takes the place of the one before."""
    with _lock:
        _listeners[:] = [listener]
        earlier = list(_notices)
    for message in earlier:
        listener(message)
