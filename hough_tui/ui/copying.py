"""Copying: to the clipboard of the terminal, and always to a file too, since not every terminal has one."""

from __future__ import annotations

from datetime import datetime

from textual.app import App

from hough_tui.directories import data_directory
from scenarios.files.atomic import replace_file


def copy(app: App[object], text: str, name: str) -> None:
    """Copy text by OSC 52 and to a file in the data directory, and say where that is.

    Parameters
    ----------
    name : of the file, with its ending; the time is put before it
    """
    app.copy_to_clipboard(text)
    path = data_directory() / "exports" / f"{datetime.now():%Y%m%d-%H%M%S-%f}-{name}"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_file(path, text)
    except OSError as error:
        why = f"It is on the clipboard only; {path} cannot be written: {error.strerror or error}"
        app.notify(why, severity="warning", markup=False)
    else:
        app.notify(f"Copied; also in {path}", markup=False)
