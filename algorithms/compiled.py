"""Compiled kernels: how they are declared, and where their machine code is kept."""

from __future__ import annotations

import hashlib
import importlib.util
import os
from collections.abc import Callable
from functools import cache, cached_property, update_wrapper
from importlib.metadata import version
from pathlib import Path
from typing import Any


class Kernel:
    """A function that is machine code from its first call on.

    Until then numba is not even imported: whoever only reads sets and shows forms does not wait
    for it. Kernels call each other as if they were what numba makes of them.

    Parameters
    ----------
    function : in the part of Python that numba compiles
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Return what the function returns."""
        return self.compiled(*arguments)

    @cached_property
    def compiled(self) -> Any:
        """What numba makes of the function."""
        import numba

        _have_kernels_understood()
        # numba compares a cached kernel with its own file only, not with the files of the kernels
        # it calls, so an edited callee would be missed: the folder's name covers all of them.
        numba.config.CACHE_DIR = str(cache_folder(self.function.__module__.partition(".")[0]))
        return numba.njit(nogil=True, cache=True, error_model="numpy")(self.function)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function to machine code that runs without the interpreter's lock, when it is first called.

    The code is kept on disk in `cache_folder`, so that a second process finds it ready.
    Division by zero follows IEEE 754, as in numpy; the order of floating-point operations
    is the one written (no `fastmath`), so results do not depend on the vector width.
    """
    return Kernel(function)


@cache
def _have_kernels_understood() -> None:
    """Teach numba that a kernel which another one calls is its own dispatcher."""
    from numba import types
    from numba.extending import typeof_impl

    @typeof_impl.register(Kernel)
    def _(value: Kernel, _: Any) -> types.Dispatcher:
        return types.Dispatcher(value.compiled)


@cache
def cache_folder(package: str = "algorithms") -> Path:
    """Return where the kernels of a package are kept: one folder for each state of their sources.

    The folder lies below `$XDG_CACHE_HOME/hough-tui` (by default `~/.cache/hough-tui`); its
    name is a hash of the sources of this package and of the given one.
    """
    # Not asked of numba itself, which would have to be loaded for it.
    digest = hashlib.sha256(version("numba").encode())
    for name in sorted({__name__.partition(".")[0], package}):
        spec = importlib.util.find_spec(name)
        locations = (spec.submodule_search_locations if spec else None) or ()
        for location in locations:
            for source in sorted(Path(location).rglob("*.py")):
                digest.update(source.relative_to(location).as_posix().encode())
                digest.update(source.read_bytes())
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "hough-tui" / f"kernels-{digest.hexdigest()[:16]}"


def is_cold() -> bool:
    """Return whether nothing of this state of the kernels has been compiled yet."""
    folder = cache_folder()
    return not folder.exists() or next(folder.rglob("*.nbc"), None) is None
