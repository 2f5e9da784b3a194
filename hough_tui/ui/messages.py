"""What widgets and views tell the application."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from textual.message import Message

if TYPE_CHECKING:
    from algorithms.parameters import Path


class SetShown(Message):
    """The set that was opened is on the screen."""


class Preparing(Message):
    """Something is prepared in the background, which takes a while."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text


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
    """A trial is to be shown in Look.

    Attributes
    ----------
    scenario : the scenario with every swept value put in
    entry, parameters : the initiator to look at, its parameters resolved
    seed, trial : which draw
    """

    def __init__(self, scenario: Any, entry: Any, parameters: Any, seed: int, trial: int) -> None:
        super().__init__()
        self.scenario = scenario
        self.entry = entry
        self.parameters = parameters
        self.seed = seed
        self.trial = trial
