"""Compiled kernels: how they are declared and called."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from functools import cache, cached_property, update_wrapper
from operator import attrgetter
from typing import Any

from algorithms.kernel_cache.folder import kernel_folder


class Kernel:
    """Function compiled by numba on its first call.

    numba is imported only then, so commands that run no kernel start fast. Kernels call each
    other as if they were numba's own dispatchers.

    Parameters
    ----------
    function : in the part of Python that numba compiles
    """

    function: Callable[..., Any]

    def __init__(self, function: Callable[..., Any]) -> None:
        # A function that is made around different kernels is as many functions: numba names machine
        # code after the function, and code of one name that two processes kept would be taken for one.
        around = [inner for inner in _closure(function) if isinstance(inner, Kernel)]
        if around:
            names = ", ".join(
                f"{inner.function.__module__}.{inner.function.__qualname__}" for inner in around
            )
            function.__qualname__ += f"[{names}]"
        self.function = function
        update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Return what the function returns."""
        return self.compiled(*arguments)

    @property
    def name(self) -> str:
        """Name of the function with that of its module."""
        return f"{self.function.__module__}.{self.function.__qualname__}"

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[str, str]]:
        """Return where the kernel is: code is kept under the kernels that its function is made around."""
        return _named, (self.function.__module__, self.function.__qualname__)

    @cached_property
    def compiled(self) -> Any:
        """The dispatcher that numba makes of the function; with `NUMBA_DISABLE_JIT` the function itself."""
        import numba

        from algorithms.kernel_cache.overloads import OverloadCache

        _register_kernels()
        dispatcher = numba.njit(nogil=True, error_model="numpy")(self.function)
        if dispatcher is self.function:
            return dispatcher
        _compile_once_for_literals(dispatcher)
        # The folder's name covers the sources of the kernels that this one calls: numba would
        # compare a cached kernel with its own file alone.
        folder = kernel_folder(self.function.__module__.partition(".")[0])
        if folder is not None:
            dispatcher._cache = OverloadCache(folder, self.function)
        return dispatcher


def _closure(function: Callable[..., Any]) -> list[Any]:
    return [cell.cell_contents for cell in function.__closure__ or ()]


def _named(module: str, name: str) -> Any:
    return attrgetter(name)(importlib.import_module(module))


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile a function to machine code that runs without the interpreter's lock, when it is first called.

    The code is kept in `kernel_folder`, so that a second process need not compile it again.
    Division by zero follows IEEE 754, as in numpy; the order of floating-point operations
    is the one written (no `fastmath`), so results do not depend on the vector width.
    """
    return Kernel(function)


def _compile_once_for_literals(dispatcher: Any) -> None:
    """Have kernels that call this one take a literal number for a number of its type.

    Numba would compile it for the 0 that a counter begins with, and again for the counter.
    """
    from numba import types

    template = dispatcher.get_call_template
    dispatcher.get_call_template = lambda given, named: template(tuple(map(types.unliteral, given)), named)


@cache
def _register_kernels() -> None:
    """Have numba take a kernel that another one calls for its dispatcher."""
    from numba import types
    from numba.extending import typeof_impl

    @typeof_impl.register(Kernel)
    def _(value: Kernel, _: Any) -> types.Dispatcher:
        return types.Dispatcher(value.compiled)
