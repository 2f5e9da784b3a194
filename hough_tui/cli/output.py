"""Standard output: how wide it is, whether it has colour; tables, lines, pictures and documents on it."""

from __future__ import annotations

import os
import sys
from typing import Any

from hough_tui.reports.visible import visible
from hough_tui.streams import naming_output


def print_renderables(*renderables: Any) -> None:
    """Print tables to standard output: as wide as the terminal, or as they need to be where it is none."""
    from rich.console import Console

    console = Console(width=output_width(), highlight=False, markup=False, soft_wrap=False)
    with naming_output():
        for renderable in renderables:
            console.print(renderable)


def print_line(text: str) -> None:
    """Print a line that may hold text from outside."""
    with naming_output():
        print(visible(text))


def print_picture(text: str) -> None:
    """Print a picture with its own codes of colour, in which text from outside is safe already."""
    with naming_output():
        print(text)


def write_document(text: str) -> None:
    """Write what scripts read: to a file or a pipe as it is, in UTF-8; to a terminal so that it is safe."""
    with naming_output():
        buffer = None if sys.stdout.isatty() else getattr(sys.stdout, "buffer", None)
        if buffer is None:
            sys.stdout.write(visible(text))
        else:
            sys.stdout.flush()
            buffer.write(text.encode("utf-8", "backslashreplace"))


def output_width() -> int:
    """Return how many columns standard output has; 160 where it is no terminal and COLUMNS does not say."""
    import shutil

    if sys.stdout.isatty() or os.environ.get("COLUMNS", "").isdecimal():
        return shutil.get_terminal_size().columns
    return 160


def is_coloured() -> bool:
    """Return whether standard output may have colour."""
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR")
