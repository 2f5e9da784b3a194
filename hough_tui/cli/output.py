"""Standard output: how wide it is, whether it has colour, tables on it."""

from __future__ import annotations

import os
import sys
from typing import Any


def print_renderables(*renderables: Any) -> None:
    """Print tables to standard output: as wide as the terminal, or as they need to be where it is none."""
    from rich.console import Console

    console = Console(width=output_width(), highlight=False, markup=False, soft_wrap=False)
    for renderable in renderables:
        console.print(renderable)


def output_width() -> int:
    """Return how many columns standard output has; 160 where it is no terminal and COLUMNS does not say."""
    import shutil

    if sys.stdout.isatty() or os.environ.get("COLUMNS", "").isdecimal():
        return shutil.get_terminal_size().columns
    return 160


def is_coloured() -> bool:
    """Return whether standard output may have colour."""
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR")
