"""The set that is being edited: validated edits, undo and redo, unsaved changes."""

from __future__ import annotations

import copy
import itertools
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

from pydantic import ValidationError

from algorithms.parameters import FieldError, Path, Problem, dotted, problems
from scenarios.checks import inconsistencies
from scenarios.files.set_files import save_set, set_data
from scenarios.model import ScenarioSet

MOST_UNDO = 200
"""How many edits can be undone."""


@dataclass(frozen=True, slots=True)
class Edit:
    """The state before an edit, and what the edit was.

    Attributes
    ----------
    before : the set before it
    what : in words
    path : of the field that was given a value; None where elements were added or removed
    """

    before: ScenarioSet
    what: str
    path: Path | None


class Workspace:
    """A scenario set under edit; every state that it takes is valid.

    Attributes
    ----------
    given : the set as it is now
    path : the file that it belongs to; None for one that was never saved (a bundled set)
    """

    def __init__(self, given: ScenarioSet, path: FilePath | None) -> None:
        self.given = given
        self.path = path
        self._saved: ScenarioSet | None = given
        self._undo: list[Edit] = []
        self._redo: list[Edit] = []

    @property
    def is_changed(self) -> bool:
        """Whether there are changes that are not in the file."""
        return self.given != self._saved

    @property
    def undoable(self) -> str | None:
        """What would be undone, in words."""
        return self._undo[-1].what if self._undo else None

    @property
    def redoable(self) -> str | None:
        """What would be done again, in words."""
        return self._redo[-1].what if self._redo else None

    def value(self, path: Path) -> Any:
        """Return what stands at a path of the set, with defaults; None where there is nothing."""
        here: Any = self.given
        for part in path:
            if here is None:
                return None
            here = (
                getattr(here, part, None)
                if isinstance(part, str)
                else here[part]
                if part < len(here)
                else None
            )
        return here

    def set(self, path: Path, value: Any) -> None:
        """Put a value at a path; a new name is put wherever the old one is referred to.

        Further values at the same path belong to the same edit: one step takes them all back.

        Raises
        ------
        FieldError
            Where the set would not be valid; it stays as it was.
        """
        data = set_data(self.given)
        here: Any = data
        for depth, (part, following) in enumerate(itertools.pairwise(path), start=1):
            if isinstance(here, dict) and part not in here:
                # A field at its default is not among the data: it is written out to be changed.
                stands = self.value(path[:depth])
                here[part] = (
                    _plain(stands) if stands is not None else ([] if isinstance(following, int) else {})
                )
            here = here[part]
        if isinstance(here, dict) and value is None and _optional_is_absent(self, path):
            here.pop(path[-1], None)
        else:
            here[path[-1]] = value
        if len(path) == 3 and path[2] == "name":
            self._rename(data, str(path[0]), int(path[1]), value)
        self._take(data, dotted(path), path)

    def insert(self, path: Path, value: Any) -> None:
        """Put a new element into a list at a path that ends with its index.

        Raises
        ------
        FieldError
            Where the set would not be valid; it stays as it was.
        """
        data = set_data(self.given)
        self._list(data, path).insert(int(path[-1]), value)
        self._take(data, f"add to {dotted(path[:-1])}", path, is_value=False)

    def remove(self, path: Path) -> None:
        """Take an element out of a list.

        Raises
        ------
        FieldError
            Where the set would not be valid; it stays as it was.
        """
        data = set_data(self.given)
        del self._list(data, path)[int(path[-1])]
        self._take(data, f"remove from {dotted(path[:-1])}", path, is_value=False)

    def undo(self) -> str | None:
        """Take back the last edit; return what it was."""
        return self._step(self._undo, self._redo)

    def redo(self) -> str | None:
        """Do the last undone edit again; return what it was."""
        return self._step(self._redo, self._undo)

    def save(self, path: FilePath | None = None) -> FilePath:
        """Write the set to its file, or to another that becomes its file.

        Raises
        ------
        RequestError
            Where it cannot be written.
        """
        target = path or self.path
        assert target is not None
        save_set(self.given, target)
        self.path, self._saved = target, self.given
        return target

    def recovered(self, given: ScenarioSet) -> Workspace:
        """Return the workspace with recovered, unsaved content in place of the file's."""
        found = Workspace(given, self.path)
        found._saved = self._saved
        return found

    def forget_saved(self) -> None:
        """Take the set as changed: what it holds is in no file."""
        self._saved = None

    def _list(self, data: dict[str, Any], path: Path) -> list[Any]:
        here: Any = data
        for part in path[:-1]:
            if isinstance(here, dict) and part not in here:
                here[part] = []
            here = here[part]
        found: list[Any] = here
        return found

    def _rename(self, data: dict[str, Any], part: str, index: int, name: Any) -> None:
        """Put a new name where experiments refer to the old one, and keep what the old one said."""
        old = self.value((part, index)).name
        which = {"initiators": "initiator", "clusterings": "mode"}.get(part)
        if which is not None:
            data[part][index].setdefault(which, getattr(self.value((part, index)), which))
        for experiment in data.get("experiments", ()):
            if part in experiment and experiment[part] is not None:
                experiment[part] = [name if found == old else found for found in experiment[part]]

    def _take(self, data: dict[str, Any], what: str, path: Path, *, is_value: bool = True) -> None:
        try:
            changed = ScenarioSet.model_validate(data)
        except ValidationError as error:
            raise FieldError(_nearest(problems(error, ScenarioSet, data), path)) from None
        found = list(inconsistencies(changed))
        if found:
            raise FieldError(_nearest(found, path))
        if changed == self.given:
            return
        goes_on = is_value and self._undo and self._undo[-1].path == path and not self._redo
        if not goes_on:
            edit = Edit(self.given, what, path if is_value else None)
            self._undo = [*self._undo[1 - MOST_UNDO :], edit]
        self._redo.clear()
        self.given = changed

    def _step(self, source: list[Edit], target: list[Edit]) -> str | None:
        if not source:
            return None
        edit = source.pop()
        target.append(replace(edit, before=self.given))
        self.given = edit.before
        return edit.what


def _plain(value: Any) -> Any:
    dump = getattr(value, "model_dump", None)
    if dump is not None:
        return dump(mode="json", exclude_unset=True)
    if isinstance(value, list | tuple):
        return [_plain(element) for element in value]
    return copy.deepcopy(value)


def _optional_is_absent(workspace: Workspace, path: Path) -> bool:
    """Return whether a field left empty is best left out, being empty by default."""
    holder = workspace.value(path[:-1])
    field = type(holder).model_fields.get(str(path[-1])) if hasattr(type(holder), "model_fields") else None
    return field is not None and field.default is None


def _nearest(found: list[Problem], path: Path) -> Problem:
    """Return the problem at the edited field, if there is one there."""
    for problem in found:
        if problem.path[: len(path)] == path or path[: len(problem.path)] == problem.path:
            return problem
    return found[0]
