"""Guard of plug-ins: whatever they raise or return wrongly becomes a message that names plug-in and line."""

from __future__ import annotations

import contextlib
import functools
import re
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from algorithms.context import Context
from algorithms.errors import RequestError, WorkFailedError
from algorithms.initiators.base import Initiator
from algorithms.initiators.returned_tracks import ReturnedTracksError, checked_chunk, checked_tracks

LONGEST = 600
"""Characters of an exception's own words that are passed on; compilers write pages."""


class PlugInError(WorkFailedError):
    """A plug-in failed, or returned what it must not; the message names it, what happened and the line."""


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a plug-in comes from.

    Attributes
    ----------
    name, value : of its entry point
    distribution : name and version of the package that declares it; empty where unknown
    """

    name: str
    value: str
    distribution: str = ""

    @classmethod
    def of(cls, point: Any) -> Origin:
        """Return the origin of what an entry point names."""
        distribution = getattr(point, "dist", None)
        named = f"{distribution.name} {distribution.version}" if distribution is not None else ""
        return cls(point.name, point.value, named)

    def __str__(self) -> str:
        return f"plug-in '{self.name}' ({', '.join(filter(None, (self.value, self.distribution)))})"

    def words(self, error: BaseException) -> str:
        """Return an exception in one line, with the last line of the plug-in that led to it."""
        said = " ".join(str(error).split())
        said = said if len(said) <= LONGEST else f"{said[:LONGEST]}…"
        lines = [
            f" ({frame.f_code.co_filename}:{line})"
            for frame, line in traceback.walk_tb(error.__traceback__)
            if _package(frame.f_globals.get("__name__")) == _package(self.value)
        ]
        return f"{type(error).__name__}{': ' if said else ''}{said}{lines[-1] if lines else ''}"


def _package(module: object) -> str:
    """Return the outermost package of a module, or of what an entry point names in one."""
    return re.split("[.:]", str(module))[0]


def guard(declared: Initiator, origin: Origin) -> None:
    """Have everything that is asked of a plug-in's initiator raise `PlugInError` where the plug-in fails.

    `RequestError`, for a wrong request, passes. Tracks are checked before anyone uses them.
    """

    def tracks(returned: Any, plots: Any, context: Context, *_: Any) -> Any:
        return checked_tracks(returned, plots, context, declared.dimensions)

    def chunk(returned: Any, plots: Any, *arguments: Any) -> Any:
        context = next(argument for argument in arguments if isinstance(argument, Context))
        return checked_chunk(returned, plots, context, declared.dimensions)

    def strongest(returned: Any, *arguments: Any) -> Any:
        return tracks(returned[0], *arguments), returned[1]

    checks = {
        "initiate": tracks,
        "strongest": strongest,
        "initiate_chunk": chunk,
        "associate_chunk": chunk,
        "tracks_of_chunk": chunk,
        "accumulator": None,
        "plane_votes": None,
    }
    for name, check in checks.items():
        if hasattr(declared, name):
            # On the object, since its class may be shared, and frozen.
            object.__setattr__(declared, name, _guarded(getattr(declared, name), origin, check))
    kinds: tuple[Any, ...] = declared.parameters.__mro__
    for kind in kinds:
        if "resolved" in vars(kind) and _package(kind.__module__) == _package(type(declared).__module__):
            kind.resolved = _guarded(kind.resolved, origin, None)


def _guarded(
    function: Callable[..., Any], origin: Origin, check: Callable[..., Any] | None
) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        try:
            # What numpy would warn of belongs to the author of the plug-in, not to its user.
            with np.errstate(all="ignore"):
                returned = function(*arguments, **named)
                return returned if check is None else check(returned, *arguments)
        except RequestError as error:
            # A class of the plug-in's own may not come back from a worker process.
            raise RequestError(str(error)) from error
        except (WorkFailedError, MemoryError):
            raise
        except ReturnedTracksError as error:
            code = function.__code__
            said = f"{function.__name__}: {error} ({code.co_filename}:{code.co_firstlineno})"
            raise PlugInError(f"{origin}: {said}; mend the plug-in") from error
        except (Exception, SystemExit) as error:
            raise PlugInError(f"{origin}: {origin.words(error)}; mend the plug-in") from error

    return call


@contextlib.contextmanager
def located(where: str) -> Iterator[None]:
    """Say of a plug-in's failure on what it worked: set, scenario and trial, or a file."""
    try:
        yield
    except PlugInError as error:
        raise PlugInError(f"{where}: {error}") from error
