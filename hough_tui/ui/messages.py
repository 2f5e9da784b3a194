"""What widgets and views tell the application."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from textual.message import Message

if TYPE_CHECKING:
    from algorithms.parameters import Path
    from hough_tui.experiments.cases import AnyCell


class SetShown(Message):
    """A draw of the set is on the screen, beside its forms."""


class Prepared(Message):
    """All that is prepared in the background is there, or it has failed."""

    def __init__(self, error: Exception | None = None) -> None:
        super().__init__()
        self.error = error


class FieldEdited(Message):
    """A field of the set was given a value that reads as one; the application validates and keeps it."""

    def __init__(self, path: Path, value: Any) -> None:
        super().__init__()
        self.path = path
        self.value = value


class FieldUnreadable(Message):
    """A field holds text that is no value; nothing runs until it is mended."""

    def __init__(self, path: Path, message: str) -> None:
        super().__init__()
        self.path = path
        self.message = message


class ElementAdded(Message):
    """A list of the set is to get a new element at a path that ends with its index."""

    def __init__(self, path: Path, value: Any) -> None:
        super().__init__()
        self.path = path
        self.value = value


class ElementRemoved(Message):
    """An element of a list of the set is to go."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path


class TrialOpened(Message):
    """A trial of a run is to be shown in Look.

    Attributes
    ----------
    cell : what ran: scenario, initiator, parameters and criterion, with every swept value put in
    trial : which draw
    """

    def __init__(self, cell: AnyCell, trial: int) -> None:
        super().__init__()
        self.cell, self.trial = cell, trial
