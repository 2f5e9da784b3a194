"""Unsaved work, kept aside so that a dropped connection loses nothing."""

from __future__ import annotations

import hashlib
import json
import os
import threading
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from algorithms.errors import RequestError
from hough_tui.directories import state_directory
from hough_tui.ui.workspace import Workspace
from scenarios.files.atomic import replace_file
from scenarios.files.marked_yaml import write
from scenarios.files.set_files import parse_set, set_data
from scenarios.model import ScenarioSet


@dataclass(frozen=True, slots=True)
class Unsaved:
    """Work that was kept aside.

    Attributes
    ----------
    given : the set as it was
    path : the file that it belongs to; None for one that was never saved
    when : the time of its last change
    file : where it is kept
    """

    given: ScenarioSet
    path: Path | None
    when: str
    file: Path


class Autosave:
    """Keeper of the unsaved work of a workspace; any thread may call it, at any time.

    Attributes
    ----------
    workspace : the set under edit
    undecided : work kept aside before, about which nobody has decided yet
    """

    def __init__(self, workspace: Workspace, undecided: Unsaved | None) -> None:
        self.workspace = workspace
        self.undecided = undecided
        self._lock = threading.Lock()

    def keep(self) -> None:
        """Keep unsaved work aside; forget what was kept where all is saved.

        Raises
        ------
        OSError
            Where the folder cannot be written.
        """
        with self._lock:
            workspace = self.workspace
            if workspace.is_changed:
                self._set_undecided_apart()
                keep_aside(workspace.given, workspace.path)
            elif self.undecided is None:
                # Work that is not decided about is not forgotten, whatever ends the application.
                forget(workspace.given.name, workspace.path)

    def forget(self, name: str, path: Path | None) -> None:
        """Remove what is kept aside of a set, but not what was not decided about.

        Raises
        ------
        OSError
            Where the folder cannot be written.
        """
        with self._lock:
            self._set_undecided_apart()
            forget(name, path)

    def _set_undecided_apart(self) -> None:
        if self.undecided is not None:
            with suppress(FileNotFoundError):  # another process may have decided
                set_apart(self.undecided)
            self.undecided = None


def keep_aside(given: ScenarioSet, path: Path | None) -> Path:
    """Write a set aside, in place of what was kept of it before.

    Raises
    ------
    OSError
        Where the folder cannot be written.
    """
    file = aside_file(given.name, path)
    file.parent.mkdir(parents=True, exist_ok=True)
    content: dict[str, Any] = {
        "path": None if path is None else str(path.resolve()),
        "when": f"{datetime.now():%Y-%m-%d %H:%M:%S}",
        "set": write(set_data(given)),
    }
    replace_file(file, json.dumps(content, ensure_ascii=False, indent=1))
    return file


def forget(name: str, path: Path | None) -> None:
    """Remove what was kept aside of a set: it was saved, or is not wanted."""
    aside_file(name, path).unlink(missing_ok=True)


def set_apart(kept: Unsaved) -> None:
    """Give work that was not decided about a place of its own, where no later edit takes its place.

    Raises
    ------
    OSError
        Where the folder cannot be written.
    """
    when = "".join(filter(str.isdigit, kept.when))
    kept.file.replace(kept.file.with_stem(f"{kept.file.stem}-{when}"))


def put_back(kept: Unsaved) -> None:
    """Give work that is taken up again the place of its set; what is kept there is set apart.

    Raises
    ------
    OSError
        Where the folder cannot be written.
    """
    own = aside_file(kept.given.name, kept.path)
    if kept.file == own:
        return
    other = read_aside(own)
    if other is not None:
        set_apart(other)
    kept.file.replace(own)


def aside_file(name: str, path: Path | None) -> Path:
    """Return where a set is kept aside; each file has its own place."""
    key = hashlib.sha256(os.fsencode(path.resolve() if path else "")).hexdigest()[:10]
    return state_directory() / "unsaved" / f"{name}-{key}.json"


def unsaved_work() -> list[Unsaved]:
    """Return all work that was kept aside, the newest first; what cannot be read is left out."""
    folder = state_directory() / "unsaved"
    found = [kept for file in folder.glob("*.json") if (kept := read_aside(file)) is not None]
    return sorted(found, key=lambda kept: kept.when, reverse=True)


def read_aside(file: Path) -> Unsaved | None:
    """Return work that was kept aside in a file; None where there is none, or it cannot be read."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        given = parse_set(str(content["set"]), str(file))
        return Unsaved(given, Path(content["path"]) if content["path"] else None, str(content["when"]), file)
    except (OSError, ValueError, KeyError, TypeError, RequestError):
        return None
