"""The store of runs: each kept as its sets, its result document and its per-trial columns."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.parameters import unknown
from hough_tui.directories import data_directory
from hough_tui.experiments.formats import upgraded
from hough_tui.experiments.stores.left_overs import REMOVED, UNFINISHED, remove_left_overs, working_folder
from scenarios.files.marked_yaml import write
from scenarios.files.set_files import parse_set, read_text, set_data
from scenarios.model import ScenarioSet

Columns = Mapping[str, NDArray[np.generic]]


@dataclass(frozen=True, slots=True)
class Run:
    """One run as it is kept.

    Attributes
    ----------
    sets : the sets as they ran, every override put in
    document : the result document, as `batch --json` prints it
    columns : the per-trial columns of each row of the document
    """

    sets: tuple[ScenarioSet, ...]
    document: dict[str, Any]
    columns: tuple[Columns, ...]


class RunStore(ABC):
    """Where runs are kept."""

    @abstractmethod
    def add(self, run: Run) -> str:
        """Keep a run, wholly or not at all, and return its name."""

    @abstractmethod
    def names(self) -> list[str]:
        """Return the names of the runs, the newest first."""

    @abstractmethod
    def document(self, name: str) -> dict[str, Any]:
        """Return the result document of a run."""

    @abstractmethod
    def load(self, name: str) -> Run:
        """Return a run."""

    @abstractmethod
    def remove(self, name: str) -> None:
        """Remove a run; here a part of its name is not enough."""


class FolderStore(RunStore):
    """Runs as folders below the data directory, each moved into place when it is whole.

    A run's folder holds `sets/NAME.yaml`, `result.json` and `trials.npz`, whose arrays are
    named `ROW.COLUMN`. What processes that were killed left here is removed when the store is opened.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or data_directory() / "runs"
        remove_left_overs(self.folder)

    def add(self, run: Run) -> str:
        """Keep a run, wholly or not at all, and return its name.

        Raises
        ------
        OSError
            Where the folder cannot be written; nothing is left behind.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        names = "+".join(given.name for given in run.sets)[:60]
        name = f"{datetime.now():%Y%m%d-%H%M%S}-{names}-{secrets.token_hex(2)}"
        with working_folder(self.folder, UNFINISHED) as temporary:
            (temporary / "sets").mkdir()
            for given in run.sets:
                (temporary / "sets" / f"{given.name}.yaml").write_text(
                    write(set_data(given)), encoding="utf-8"
                )
            (temporary / "result.json").write_text(
                json.dumps(run.document, ensure_ascii=False, indent=1), encoding="utf-8"
            )
            np.savez_compressed(
                temporary / "trials.npz",
                allow_pickle=False,
                **{
                    f"{row}.{key}": values
                    for row, columns in enumerate(run.columns)
                    for key, values in columns.items()
                },
            )
            temporary.chmod(0o755)
            os.replace(temporary, self.folder / name)
        return name

    def names(self) -> list[str]:
        """Return the names of the runs, the newest first."""
        if not self.folder.is_dir():
            return []
        found = [path.name for path in self.folder.iterdir() if (path / "result.json").is_file()]
        whole = [name for name in found if not name.startswith(".")]
        return sorted(whole, key=lambda name: (self.folder / name).stat().st_mtime_ns, reverse=True)

    def document(self, name: str) -> dict[str, Any]:
        """Return the result document of a run.

        Raises
        ------
        RequestError
            Where there is no run of that name, or its document cannot be read.
        """
        path = self.folder / self.full_name(name) / "result.json"
        try:
            document: dict[str, Any] = json.loads(read_text(path))
        except json.JSONDecodeError as error:
            raise RequestError(
                f"{path}: this is no JSON: {error}; the run is damaged, remove its folder"
            ) from None
        try:
            return upgraded(document)
        except (AttributeError, KeyError, TypeError):
            raise RequestError(f"{path}: this is no document of a run; remove its folder") from None

    def load(self, name: str) -> Run:
        """Return a run.

        Raises
        ------
        RequestError
            Where there is no run of that name, or it cannot be read.
        """
        folder = self.folder / self.full_name(name)
        document = self.document(name)
        paths = {path.stem: path for path in (folder / "sets").glob("*.yaml")}
        try:
            sets = tuple(parse_set(read_text(paths[given]), str(paths[given])) for given in document["sets"])
            with np.load(folder / "trials.npz", allow_pickle=False) as archive:
                columns = _columns(archive, len(document["rows"]))
        except (KeyError, OSError, ValueError) as error:
            if isinstance(error, RequestError):
                raise
            raise RequestError(f"{folder}: the run is damaged ({error}); remove its folder") from None
        return Run(sets, document, columns)

    def remove(self, name: str) -> None:
        """Remove a run; here a part of its name is not enough.

        Raises
        ------
        RequestError
            Where there is no run of that name.
        OSError
            Where the folder cannot be written.
        """
        known = self.names()
        if name not in known:
            raise RequestError(unknown(name, known[:10], "run"))
        # Renamed first: a run that is removed in part only must not be listed.
        with working_folder(self.folder, REMOVED) as doomed:
            os.replace(self.folder / name, doomed / name)
            shutil.rmtree(doomed / name)

    def full_name(self, name: str) -> str:
        """Return the name of a run from a part of it that fits no other.

        Raises
        ------
        RequestError
            Where there is no such run, or more than one.
        """
        known = self.names()
        matches = [found for found in known if found == name] or [found for found in known if name in found]
        if len(matches) != 1:
            if matches:
                raise RequestError(
                    f"'{name}' fits {len(matches)} runs ({', '.join(matches[:3])}, …); give more of the name"
                )
            raise RequestError(unknown(name, known[:10], "run"))
        return matches[0]


def _columns(archive: Mapping[str, NDArray[np.generic]], rows: int) -> tuple[Columns, ...]:
    found: list[dict[str, NDArray[np.generic]]] = [{} for _ in range(rows)]
    for key in archive:
        row, _, column = key.partition(".")
        found[int(row)][column] = archive[key]
    return tuple(found)
