"""The registry: which extractions there are, each a module beside this one."""

from __future__ import annotations

import importlib
import pkgutil

from algorithms.hough import peaks as package
from algorithms.hough.peaks.extraction import Extraction


def _extractions() -> dict[str, type[Extraction]]:
    """Return what the modules of the package declare as `EXTRACTION`."""
    modules = pkgutil.iter_modules(package.__path__, f"{package.__name__}.")
    declared = (getattr(importlib.import_module(module.name), "EXTRACTION", None) for module in modules)
    return {extraction.name: extraction for extraction in declared if extraction is not None}


EXTRACTIONS = _extractions()
"""Every extraction by its name."""
