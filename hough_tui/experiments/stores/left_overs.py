"""Hidden folders that a store works in, and their removal once the process that made them is gone."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import socket
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

UNFINISHED, REMOVED = "unfinished", "removed"
"""What such a folder is for: a run that is being written; one that is being removed."""

OLD = 86_400.0
"""Seconds after which a folder counts as left over, where its process cannot be asked for."""

_NAMING = re.compile(rf"\.(?:{UNFINISHED}|{REMOVED})-(?:(\d+)@(.+)-)?\w+")

_lock = threading.Lock()
_in_use: set[str] = set()
"""Names of the folders that this process works in: an earlier process may have had its number."""


@contextlib.contextmanager
def working_folder(parent: Path, purpose: str) -> Iterator[Path]:
    """Make a hidden folder that names process and host; what is left of it in the end is removed."""
    with _lock:
        folder = Path(tempfile.mkdtemp(dir=parent, prefix=f".{purpose}-{os.getpid()}@{_host()}-"))
        _in_use.add(folder.name)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        _in_use.discard(folder.name)


def remove_left_overs(parent: Path) -> None:
    """Remove the folders of killed processes; those of other hosts once they are old.

    What cannot be removed stays, since nothing depends on it.
    """
    with contextlib.suppress(OSError):
        with _lock:
            left = [folder for folder in parent.iterdir() if _is_left_over(folder)]
        for folder in left:
            shutil.rmtree(folder, ignore_errors=True)


def _is_left_over(folder: Path) -> bool:
    named = _NAMING.fullmatch(folder.name)
    if named is None:
        return False
    process, host = named.groups()
    if process is None or host != _host():
        return time.time() - folder.lstat().st_mtime > OLD
    if int(process) == os.getpid():
        return folder.name not in _in_use
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return True
    except (OSError, OverflowError):
        return False
    return False


def _host() -> str:
    return re.sub(r"[^\w.-]", "_", socket.gethostname())[:60]
