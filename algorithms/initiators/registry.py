"""The registry: which initiators there are.

An initiator of the product is a module beside this one with a name `INITIATOR`; one of a
plug-in package is an entry point of the group `hough_tui.initiators`.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from functools import cache
from importlib.metadata import entry_points

from algorithms import initiators as package
from algorithms.errors import RequestError
from algorithms.initiators.base import Initiator
from algorithms.parameters import NAME, unknown

ENTRY_POINTS = "hough_tui.initiators"

RESERVED = frozenset({"name", "initiator", "parameters", "algorithm"})
"""Names that an entry of a set has beside the initiator's parameters."""


@cache
def initiators() -> dict[str, Initiator]:
    """Return every initiator by its name, those of the product first.

    Raises
    ------
    RequestError
        Where a plug-in cannot be loaded, or takes a name that is already in use.
    """
    found: dict[str, Initiator] = {}
    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        declared = getattr(importlib.import_module(module.name), "INITIATOR", None)
        if declared is not None:
            _add(found, declared, module.name)
    for point in entry_points(group=ENTRY_POINTS):
        origin = f"plug-in '{point.name}' ({point.value})"
        try:
            declared = point.load()
            if isinstance(declared, type):
                declared = declared()
        except Exception as error:
            raise RequestError(
                f"{origin} cannot be loaded: {type(error).__name__}: {error}; mend or remove it"
            ) from error
        _add(found, declared, origin)
    return found


def initiator(name: str) -> Initiator:
    """Return the initiator of a name.

    Raises
    ------
    RequestError
        Where there is none of that name.
    """
    known = initiators()
    if name not in known:
        raise RequestError(unknown(name, list(known), "initiator"))
    return known[name]


def _add(found: dict[str, Initiator], declared: object, origin: str) -> None:
    if not isinstance(declared, Initiator):
        raise RequestError(f"{origin} gives {type(declared).__name__}, not an Initiator; mend or remove it")
    for attribute, kind in (("name", str), ("summary", str), ("parameters", type)):
        if not isinstance(getattr(declared, attribute, None), kind):
            raise RequestError(f"{origin} does not say its `{attribute}`; mend or remove it")
    if not re.fullmatch(NAME, declared.name):
        raise RequestError(f"{origin} is named '{declared.name}'; the form of a name is {NAME}; rename it")
    if declared.name in found:
        raise RequestError(f"{origin} is named '{declared.name}', as another initiator is; rename it")
    taken = sorted(RESERVED & set(declared.parameters.model_fields))
    if taken:
        raise RequestError(f"{origin} declares a parameter '{taken[0]}', a reserved name; rename it")
    found[declared.name] = declared
