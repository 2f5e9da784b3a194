"""Cache of one kernel's machine code, in the place of numba's own.

numba's cache writes beside the sources where its folder cannot be written, unpickles whatever lies
in its files, and keeps an index that two processes can set at odds with the code. Here each
combination of a kernel, the types of its arguments and the processor has a file of its own.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable
from typing import Any

from algorithms.kernel_cache.folder import SETTINGS, KernelFolder


class OverloadCache:
    """Compiled overloads of one kernel; what numba's dispatcher asks of a cache.

    Parameters
    ----------
    folder : where they are kept
    function : the kernel's function
    """

    def __init__(self, folder: KernelFolder, function: Callable[..., Any]) -> None:
        from numba.core.serialize import dumps

        self._folder = folder
        code = function.__code__
        name = f"{function.__module__}.{function.__qualname__}".replace("<", "").replace(">", "")
        self._name = f"{name[:100]}-{code.co_firstlineno}"
        closure = tuple(cell.cell_contents for cell in function.__closure__ or ())
        self._function = (name, code.co_firstlineno, code.co_code, dumps(closure) if closure else b"")

    @property
    def cache_path(self) -> str:
        """The folder."""
        return str(self._folder.path)

    def load_overload(self, signature: Any, target: Any) -> Any:
        """Return the compiled code for a signature; None where none is kept that could be used."""
        from numba.core.compiler import CompileResult

        target.refresh()
        key = self._key(signature, target.codegen())
        name = self._file_name(key)
        body = self._folder.read(name)
        if body is None:
            return None
        try:
            kept, payload = pickle.loads(body)
            return CompileResult._rebuild(target, *payload) if kept == key else None
        except Exception as error:  # whatever a pickle of another installation may end in
            self._folder.report_damage(name, f"{type(error).__name__}: {error}")
            return None

    def save_overload(self, signature: Any, compiled: Any) -> None:
        """Keep the compiled code for a signature, where it holds no address of this process."""
        from numba.core.serialize import dumps
        from numba.core.types import Dispatcher

        arguments = getattr(signature, "args", signature)
        if any(isinstance(argument, Dispatcher) for argument in arguments):
            return
        if compiled.library.has_dynamic_globals or any(not part.can_cache for part in compiled.lifted):
            return
        key = self._key(signature, compiled.codegen)
        self._folder.write(self._file_name(key), dumps((key, compiled._reduce())))

    def flush(self) -> None:
        """Forget nothing: what is compiled again is written over."""

    def _key(self, signature: Any, codegen: Any) -> tuple[Any, ...]:
        from numba import config

        settings = tuple((name, getattr(config, name, None)) for name in SETTINGS)
        return (signature, codegen.magic_tuple(), self._function, settings)

    def _file_name(self, key: tuple[Any, ...]) -> str:
        return f"{self._name}-{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}"
