"""All key bindings of the application, as its classes declare them."""

from __future__ import annotations

import difflib
import importlib
import inspect
import pkgutil
from collections.abc import Mapping

from textual.binding import Binding
from textual.dom import DOMNode

import hough_tui.ui
from algorithms.errors import RequestError


def declared_bindings() -> dict[str, list[Binding]]:
    """Return the bindings that each class of the application declares itself, by its name.

    Every module of the application is imported for that.
    """
    found: dict[str, list[Binding]] = {}
    for module in pkgutil.walk_packages(hough_tui.ui.__path__, "hough_tui.ui."):
        for name, kind in vars(importlib.import_module(module.name)).items():
            own = inspect.isclass(kind) and issubclass(kind, DOMNode) and kind.__module__ == module.name
            if own and kind.__dict__.get("BINDINGS"):
                found[name] = list(kind.__dict__["BINDINGS"])
    return found


def require_known(places: Mapping[str, str]) -> None:
    """Raise a wrong request where an id is that of no binding.

    Parameters
    ----------
    places : by id, where in a file it stands

    Raises
    ------
    RequestError
        For the first one that is not known, with its place and the nearest id that is.
    """
    known = {binding.id or "" for bindings in declared_bindings().values() for binding in bindings}
    for name, where in places.items():
        if name not in known:
            near = difflib.get_close_matches(name, sorted(known), n=1, cutoff=0.5)
            hint = f"did you mean '{near[0]}'? " if near else ""
            raise RequestError(
                f"{where}: there is no binding '{name}'; {hint}F1 in the application lists the ids of a view"
            )
