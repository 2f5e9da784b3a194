"""Where the product keeps its files, by the XDG base directory specification."""

from __future__ import annotations

from pathlib import Path

from algorithms.base_directories import base_directory

NAME = "hough-tui"


def data_directory() -> Path:
    """Return where results are kept."""
    return base_directory("XDG_DATA_HOME") / NAME


def config_directory() -> Path:
    """Return where the user's settings are."""
    return base_directory("XDG_CONFIG_HOME") / NAME


def state_directory() -> Path:
    """Return where unsaved work is kept aside."""
    return base_directory("XDG_STATE_HOME") / NAME
