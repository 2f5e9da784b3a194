"""Base directories of a user by the XDG specification: cache, data, settings, state."""

from __future__ import annotations

import os
from pathlib import Path

from algorithms.errors import RequestError

DEFAULTS = {
    "XDG_CACHE_HOME": ".cache",
    "XDG_CONFIG_HOME": ".config",
    "XDG_DATA_HOME": ".local/share",
    "XDG_STATE_HOME": ".local/state",
}
"""Folders below the home folder that stand for a variable which is not set."""


def base_directory(variable: str) -> Path:
    """Return the folder that a variable names, or its default below the home folder.

    A relative path is ignored, as the specification demands: it would lead into whatever folder
    the program is started in.

    Raises
    ------
    RequestError
        Where neither the variable nor the user's home folder is an absolute path.
    """
    value = os.environ.get(variable, "")
    if os.path.isabs(value):
        return Path(value)
    home = _home()
    if not os.path.isabs(home):
        raise RequestError(
            f"this user has no home folder; set HOME or {variable} to the absolute path of a folder of yours"
        )
    return Path(home) / DEFAULTS[variable]


def _home() -> str:
    """Return the home folder by HOME or, where that is none, by the list of users; empty without one."""
    home = os.environ.get("HOME", "")
    if os.path.isabs(home):
        return home
    try:
        import pwd
    except ImportError:
        return os.path.expanduser("~")
    try:
        return pwd.getpwuid(os.getuid()).pw_dir
    except KeyError:
        return ""
