"""What a form has asked of the set, and what was refused: that is asked again when it may be allowed."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from algorithms.parameters import Path
from hough_tui.ui.forms.edits import edit_of, together, value_in


@dataclass(frozen=True, slots=True)
class Asked:
    """An edit that was asked for.

    Attributes
    ----------
    path, value : what is to stand where
    typed : the values of the form's fields that it is for; none for what a table asks
    is_count : whether an element was to be added or removed
    """

    path: Path
    value: Any = None
    typed: Mapping[Path, Any] = field(default_factory=dict)
    is_count: bool = False

    def is_in(self, model: BaseModel, base: Path) -> bool:
        """Return whether a model has it; what cannot be told counts as had."""
        values = self.typed or {self.path: self.value}
        if self.is_count or (not self.typed and isinstance(self.value, Mapping)):
            return True
        return all(value_in(model, path[len(base) :]) == value for path, value in values.items())


class Negotiation:
    """The edits of one form that are not answered yet, and those that were refused.

    Attributes
    ----------
    refused : the values of fields that are typed but not in effect
    """

    def __init__(self) -> None:
        self.refused: dict[Path, Any] = {}
        self._waiting: deque[Asked] = deque()
        self._tried: set[frozenset[tuple[Path, str]]] = set()

    def edit(self, model: BaseModel, base: Path, path: Path, value: Any) -> Asked:
        """Return what to ask for the edit of a field."""
        self.forget(path)
        return self._wait(Asked(*edit_of(model, base, path, value), {path: value}))

    def note(self, path: Path, value: Any = None, *, is_count: bool = False) -> None:
        """Note what a table has asked for."""
        self._wait(Asked(path, value, is_count=is_count))

    def forget(self, path: Path) -> None:
        """Forget that the value of a field was refused: it is no longer typed."""
        self.refused.pop(path, None)

    def taken(self, model: BaseModel, base: Path, *, is_changed: bool) -> list[Asked]:
        """Return what to ask again, now that there is a model.

        Parameters
        ----------
        is_changed : whether it is another one than before
        """
        self.refused = {
            path: value for path, value in self.refused.items() if value_in(model, path[len(base) :]) != value
        }
        had = [index for index, asked in enumerate(self._waiting) if asked.is_in(model, base)]
        certain = [index for index in had if index == 0 or not self._waiting[index].is_count]
        for _ in range(max(certain, default=-1) + 1):
            # Answers come in order, so what was asked before is answered too.
            self._waiting.popleft()
        if not is_changed:
            return []
        self._tried.clear()
        again = [(path, value) for path, value in self.refused.items() if not self._is_waiting(path)]
        return [self._wait(Asked(*edit_of(model, base, path, value), {path: value})) for path, value in again]

    def turned_down(self, model: BaseModel, base: Path) -> tuple[Asked | None, Asked | None]:
        """Return what was refused, the edit that was asked for first, and what to ask in its stead.

        Edits that are refused one by one may be allowed together: a match by plots instead of by ρ.
        They are tried together once.
        """
        asked = self._waiting.popleft() if self._waiting else None
        if asked is not None and len(asked.typed) == 1:
            self.refused.update(asked.typed)
        attempt = frozenset((path, repr(value)) for path, value in self.refused.items())
        if len(attempt) < 2 or attempt in self._tried:
            return asked, None
        self._tried.add(attempt)
        typed = dict(self.refused)
        return asked, self._wait(Asked(*together(model, base, typed), typed))

    def _is_waiting(self, path: Path) -> bool:
        return any(path in asked.typed for asked in self._waiting)

    def _wait(self, asked: Asked) -> Asked:
        self._waiting.append(asked)
        return asked
