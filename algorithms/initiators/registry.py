"""The registry: which initiators there are.

An initiator of the product is a module beside this one with a name `INITIATOR`; one of a
plug-in package is an entry point of the group `hough_tui.initiators`. A plug-in that cannot be
used is a notice, and everything else works.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from typing import Any

from algorithms import initiators as package
from algorithms.errors import RequestError
from algorithms.initiators.base import Initiator
from algorithms.initiators.guard import Origin, guard
from algorithms.notices import notice
from algorithms.parameters import NAME, Parameters, unknown

ENTRY_POINTS = "hough_tui.initiators"

RESERVED = frozenset({"name", "initiator", "parameters", "algorithm"})
"""Names that an entry of a set has beside the initiator's parameters."""


@dataclass(frozen=True, slots=True)
class FailedPlugIn:
    """A plug-in that cannot be used.

    Attributes
    ----------
    name : of the initiator, as far as it could be read, else of the entry point
    origin : where it comes from
    reason : why it cannot be used, and what to do
    """

    name: str
    origin: Origin
    reason: str

    @property
    def words(self) -> str:
        """Origin and reason as one sentence."""
        return f"{self.origin} {self.reason}"


_failed: list[FailedPlugIn] = []
_origins: dict[str, Origin] = {}


@cache
def initiators() -> dict[str, Initiator]:
    """Return every initiator by its name, those of the product first."""
    _failed.clear()
    _origins.clear()
    usable: dict[str, Initiator] = {}
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        declared = getattr(importlib.import_module(module.name), "INITIATOR", None)
        if declared is not None:
            usable[declared.name] = declared
    for point in entry_points(group=ENTRY_POINTS):
        origin = Origin.of(point)
        name = point.name
        try:
            declared = point.load()
            if isinstance(declared, type):
                declared = declared()
            name = _name(declared, name)
            _require_declared(declared, usable)
            guard(declared, origin)
        except _DeclarationError as error:
            _fail(FailedPlugIn(name, origin, str(error)))
        except (Exception, SystemExit) as error:
            _fail(FailedPlugIn(name, origin, f"cannot be loaded: {origin.words(error)}; mend or remove it"))
        else:
            usable[name] = declared
            _origins[name] = origin
    return usable


def failed_plug_ins() -> tuple[FailedPlugIn, ...]:
    """Return the plug-ins that cannot be used."""
    initiators()
    return tuple(_failed)


def initiator(name: str) -> Initiator:
    """Return the initiator of a name.

    Raises
    ------
    RequestError
        Where there is none of that name, or its plug-in cannot be used.
    """
    usable = initiators()
    if name not in usable:
        raise RequestError(why_missing(name))
    return usable[name]


def why_missing(name: str) -> str:
    """Return why there is no initiator of a name."""
    for failed in failed_plug_ins():
        if failed.name == name:
            return f"the initiator '{name}' could not be loaded: {failed.words}"
    message = unknown(name, list(initiators()), "initiator")
    if _failed:
        message += f"; could not be loaded: {', '.join(failed.name for failed in _failed)}"
    return message


def exclude(name: str, error: Exception) -> None:
    """Take a plug-in's initiator out, since something that its declaration is needed for fails.

    Raises
    ------
    Exception
        The error, where the initiator is the product's own.
    """
    origin = _origins.get(name)
    if origin is None:
        raise error
    del initiators()[name]
    reason = f"declares parameters of no use: {origin.words(error)}; mend or remove it"
    _fail(FailedPlugIn(name, origin, reason))


class _DeclarationError(Exception):
    """What a plug-in declares is wrong; the message says how."""


def _fail(failed: FailedPlugIn) -> None:
    _failed.append(failed)
    notice(f"{failed.words}; everything else works without it")


def _name(declared: object, otherwise: str) -> str:
    name = getattr(declared, "name", None)
    return name if isinstance(declared, Initiator) and isinstance(name, str) else otherwise


def _require_declared(declared: Any, usable: dict[str, Initiator]) -> None:
    """Refuse what is no initiator that could stand beside the others."""
    if not isinstance(declared, Initiator):
        raise _DeclarationError(f"gives {type(declared).__name__}, not an Initiator; mend or remove it")
    for attribute, kind in (("name", str), ("summary", str), ("source", str), ("parameters", type)):
        if not isinstance(getattr(declared, attribute, None), kind):
            raise _DeclarationError(f"does not say its `{attribute}`; mend or remove it")
    if not re.fullmatch(NAME, declared.name):
        raise _DeclarationError(f"is named '{declared.name}'; the form of a name is {NAME}; rename it")
    if declared.name in usable:
        raise _DeclarationError(f"is named '{declared.name}', as another initiator is; rename it")
    if not issubclass(declared.parameters, Parameters):
        raise _DeclarationError("declares `parameters` that are no class of Parameters; mend or remove it")
    if declared.dimensions not in (2, 3):
        said = f"declares {declared.dimensions!r} dimensions, and there are 2 or 3"
        raise _DeclarationError(f"{said}; mend or remove it")
    taken = sorted(RESERVED & set(declared.parameters.model_fields))
    if taken:
        raise _DeclarationError(f"declares a parameter '{taken[0]}', a reserved name; rename it")
    # Forms, tables and the schema of sets are made of it.
    declared.parameters.model_json_schema()
