"""Whether code may be loaded from a folder: kept kernels run with the rights of their user."""

from __future__ import annotations

import os
import stat
from pathlib import Path

LEVELS = 3
"""Folders whose owner and mode count: that of the kernels, that of the product, the user's cache."""


def objection(folder: Path) -> str | None:
    """Return why a folder must not be used, with what to do; None where only its user can have filled it.

    A folder that does not exist is none to object to: it is made for its user alone.
    """
    if not hasattr(os, "geteuid"):  # a system without modes
        return None
    resolved = Path(os.path.realpath(folder))
    levels = [resolved, *resolved.parents][:LEVELS]
    for level in levels:
        try:
            status = level.stat()
        except OSError:
            continue
        if status.st_uid not in (0, os.geteuid()):
            return f"{level} belongs to {_user_name(status.st_uid)}; give it to {_user_name(os.geteuid())}"
        # In a folder like /tmp nobody else can rename or remove what the user makes there.
        is_shared_safely = level is levels[-1] and status.st_mode & stat.S_ISVTX
        if is_writable_by_others(status) and not is_shared_safely:
            return f"others can write {level} ({stat.filemode(status.st_mode)}); chmod go-w it"
    return None


def is_writable_by_others(status: os.stat_result) -> bool:
    """Return whether anybody else may write, apart from the system's administrator."""
    if status.st_mode & stat.S_IWOTH:
        return True
    return bool(status.st_mode & stat.S_IWGRP) and not _is_private_group(status.st_gid)


def _is_private_group(group: int) -> bool:
    """Return whether a group is the user's own, as systems make one for each user, with nobody else in it."""
    import grp
    import pwd

    try:
        user, members = pwd.getpwuid(os.geteuid()), grp.getgrgid(group)
    except KeyError:
        return False
    is_own = members.gr_gid == user.pw_gid and members.gr_name == user.pw_name
    return is_own and set(members.gr_mem) <= {user.pw_name}


def _user_name(user: int) -> str:
    import pwd

    try:
        return f"user {pwd.getpwuid(user).pw_name}"
    except KeyError:
        return f"user {user}"
