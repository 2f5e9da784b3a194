"""Folder of the compiled kernels of one state of the sources: checked files, written atomically."""

from __future__ import annotations

import contextlib
import hashlib
import importlib.util
import os
import re
import shutil
import stat
import sys
import time
import uuid
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path

from algorithms.base_directories import base_directory
from algorithms.errors import RequestError
from algorithms.kernel_cache.trust import is_writable_by_others, objection
from algorithms.notices import notice

SETTINGS = (
    "BOUNDSCHECK",
    "DEBUGINFO_DEFAULT",
    "DISABLE_INTEL_SVML",
    "LOOP_VECTORIZE",
    "NRT_STATS",
    "OPT",
    "SLP_VECTORIZE",
)
"""Settings of numba that decide what code it makes; in the environment their names begin with `NUMBA_`."""

MAGIC = b"hough-tui kernel 1\n"
SUFFIX, UNFINISHED = ".nbc", ".tmp"
DAY, MONTH = 86_400.0, 30 * 86_400.0
NAMING = re.compile(r"kernels-(?:([A-Za-z_]\w*)-)?[0-9a-f]{16}")
"""Names of these folders, with the package that the kernels are of; earlier versions left it out."""

CONSEQUENCE = "every start compiles them again, up to a minute"


class DamagedError(Exception):
    """A file that is not as it was written."""


class KernelFolder:
    """Files of compiled kernels, each with a checksum, in a folder that only its user can write.

    Nothing here raises for the state of the disk: what cannot be read is missing, what cannot be
    written is not kept, and a notice says so once. Any number of threads and processes may call:
    a file is written beside its place and moved there whole.

    Parameters
    ----------
    path : the folder; made when something is first kept
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._is_writable = True
        self._is_damaged = self._is_renewed = False

    @cached_property
    def is_trusted(self) -> bool:
        """Whether code may be loaded from here."""
        against = objection(self.path)
        if against is not None:
            notice(
                f"the compiled kernels in {self.path.parent} are not used: {against}, "
                f"or set XDG_CACHE_HOME to a folder of your own; until then {CONSEQUENCE}"
            )
        return against is None

    @property
    def can_keep(self) -> bool:
        """Whether a file can be written here; tried out, so that it can be said before the work begins."""
        if self.is_trusted and self._is_writable:
            try:
                self._make()
                _write_new(self._temporary("probe"), b"").unlink()
            except OSError as error:
                self._report_failure(error)
        return self.is_trusted and self._is_writable

    @property
    def is_empty(self) -> bool:
        """Whether nothing is kept here that could be used."""
        if not self.is_trusted:
            return True
        try:
            with os.scandir(self.path) as entries:
                return not any(entry.name.endswith(SUFFIX) for entry in entries)
        except OSError:
            return True

    def read(self, name: str) -> bytes | None:
        """Return what was written under a name; None where there is nothing that could be used."""
        if not self.is_trusted:
            return None
        self._renew()
        try:
            return _checked(self.path / (name + SUFFIX))
        except (FileNotFoundError, NotADirectoryError):
            return None
        except (OSError, DamagedError) as error:
            self.report_damage(name, getattr(error, "strerror", None) or str(error))
            return None

    def write(self, name: str, body: bytes) -> None:
        """Keep some bytes under a name, whatever lies there."""
        if not self.is_trusted or not self._is_writable:
            return
        try:
            self._make()
            whole = _write_new(self._temporary(name), MAGIC + hashlib.sha256(body).digest() + body)
            _move(whole, self.path / (name + SUFFIX))
        except OSError as error:
            self._report_failure(error)

    def report_damage(self, name: str, reason: str) -> None:
        """Say of the first file that is of no use that such files are made anew; they are written over."""
        if self._is_damaged:
            return
        self._is_damaged = True
        notice(f"compiled kernels in {self.path} are damaged ({name}{SUFFIX}: {reason}); they are made anew")

    def _report_failure(self, error: OSError) -> None:
        self._is_writable = False
        notice(
            f"the compiled kernels cannot be kept in {self.path.parent}: {error.strerror or error}; "
            f"{CONSEQUENCE}; set XDG_CACHE_HOME to a folder that can be written"
        )

    def _make(self) -> None:
        """Make the folder, and those above it that are missing, for the user alone."""
        missing = []
        folder = self.path
        while not folder.exists():
            missing.append(folder)
            folder = folder.parent
        for folder in reversed(missing):
            with contextlib.suppress(FileExistsError):
                folder.mkdir(mode=0o700)

    def _temporary(self, name: str) -> Path:
        return self.path / f"{name}.{uuid.uuid4().hex[:16]}{UNFINISHED}"

    def _renew(self) -> None:
        """Mark the folder as used, once a process, and remove what has not been used for long."""
        if self._is_renewed:
            return
        self._is_renewed = True
        # A folder that cannot be changed is read all the same.
        with contextlib.suppress(OSError):
            if time.time() - self.path.stat().st_mtime > DAY:
                os.utime(self.path)
            remove_left_overs(self.path)


def remove_left_overs(used: Path) -> None:
    """Remove folders of other versions that were not used for a month, and files of killed processes.

    Other processes may do so at the same time, or come back to such a folder: they compile anew.
    """
    now = time.time()
    for folder in used.parent.iterdir():
        named = NAMING.fullmatch(folder.name)
        if named is None or folder.is_symlink() or not folder.is_dir() or folder == used:
            continue
        if now - folder.stat().st_mtime > MONTH and not _is_current(folder, named[1]):
            shutil.rmtree(folder, ignore_errors=True)
    for file in used.glob(f"*{UNFINISHED}"):
        if now - file.lstat().st_mtime > DAY:
            file.unlink(missing_ok=True)


def _is_current(folder: Path, package: str | None) -> bool:
    current = kernel_folder(package) if package else None
    return current is not None and current.path == folder


def _checked(path: Path) -> bytes:
    """Return what was written to a file.

    Raises
    ------
    OSError, DamagedError
        Where it cannot be read, is somebody else's, or is not as it was written.
    """
    # Neither a link is followed nor a pipe waited for.
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    with open(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise DamagedError("no file")
        if hasattr(os, "geteuid") and (
            status.st_uid not in (0, os.geteuid()) or is_writable_by_others(status)
        ):
            raise DamagedError("others can write it")
        if file.read(len(MAGIC)) != MAGIC:
            raise DamagedError("no kernel")
        checksum = file.read(hashlib.sha256().digest_size)
        body = file.read()
    if hashlib.sha256(body).digest() != checksum:
        raise DamagedError("its checksum is wrong")
    return body


def _write_new(path: Path, content: bytes) -> Path:
    """Write a file that does not exist yet, for the user alone, or leave nothing."""
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with open(handle, "wb") as file:
            file.write(content)
    except BaseException:
        path.unlink(missing_ok=True)
        raise
    return path


def _move(source: Path, target: Path) -> None:
    """Move a file into its place, even where a folder lies there."""
    try:
        if target.is_dir() and not target.is_symlink():
            shutil.rmtree(target)
        os.replace(source, target)
    except BaseException:
        source.unlink(missing_ok=True)
        raise


@cache
def kernel_folder(package: str = "algorithms") -> KernelFolder | None:
    """Return the folder of the kernels of a package; None, with a notice, where the user has no folders.

    It lies below `$XDG_CACHE_HOME/hough-tui` (by default `~/.cache/hough-tui`); its name is a hash
    of all that makes the code what it is: Python, numba and its settings, the sources of this
    package and of the one that asks.
    """
    try:
        base = base_directory("XDG_CACHE_HOME") / "hough-tui"
    except RequestError as error:
        notice(f"the compiled kernels cannot be kept: {error}; {CONSEQUENCE}")
        return None
    # numba itself is not asked for anything: loading it takes longer than all of this.
    versions = [f"{name} {version(name)}" for name in ("numba", "llvmlite", "numpy")]
    settings = [f"{name}={os.environ.get('NUMBA_' + name, '')}" for name in SETTINGS]
    digest = hashlib.sha256("\n".join([sys.version, *versions, *settings]).encode())
    for name in sorted({__name__.partition(".")[0], package}):
        for relative, source in _sources(name):
            digest.update(relative.encode())
            digest.update(source.read_bytes())
    return KernelFolder(base / f"kernels-{package}-{digest.hexdigest()[:16]}")


def _sources(package: str) -> list[tuple[str, Path]]:
    """Return the source files of a package, or the one of a module, by their relative paths."""
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):  # a program that was typed in or piped
        return []
    if spec is None:
        return []
    if spec.submodule_search_locations is None:
        return [(package, Path(spec.origin))] if spec.origin and Path(spec.origin).is_file() else []
    return [
        (source.relative_to(location).as_posix(), source)
        for location in spec.submodule_search_locations
        for source in sorted(Path(location).rglob("*.py"))
    ]


def is_cold() -> bool:
    """Return whether nothing of this state of the kernels is kept, or none of it may be used."""
    folder = kernel_folder()
    return folder is None or folder.is_empty


def can_keep() -> bool:
    """Return whether what is compiled can be kept for the next process; where not, a notice says why."""
    folder = kernel_folder()
    return folder is not None and folder.can_keep
