"""Where the product keeps its files, by the XDG base directory specification."""

from __future__ import annotations

import os
from pathlib import Path

NAME = "hough-tui"


def data_directory() -> Path:
    """Return where results are kept."""
    return _base("XDG_DATA_HOME", ".local/share") / NAME


def config_directory() -> Path:
    """Return where the user's settings are."""
    return _base("XDG_CONFIG_HOME", ".config") / NAME


def state_directory() -> Path:
    """Return where unsaved work is kept aside."""
    return _base("XDG_STATE_HOME", ".local/state") / NAME


def _base(variable: str, default: str) -> Path:
    given = os.environ.get(variable, "")
    # The specification has relative paths ignored.
    return Path(given) if os.path.isabs(given) else Path.home() / default
