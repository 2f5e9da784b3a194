"""The user's settings: theme and keys."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from algorithms.errors import RequestError
from hough_tui.directories import config_directory

KNOWN = ("theme", "keys")


@dataclass(frozen=True, slots=True)
class Config:
    """Settings.

    Attributes
    ----------
    theme : a theme of Textual; None: the default one
    keys : the keys of bindings, by the binding's id
    places : where in the file each of these ids stands
    """

    theme: str | None = None
    keys: dict[str, str] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict, compare=False)


def config_file() -> Path:
    """Return where the settings are."""
    return config_directory() / "config.yaml"


def read_config() -> Config:
    """Return the settings; the defaults where there is no file.

    Whether there are bindings of these ids is not looked at: all modules would have to be imported.

    Raises
    ------
    RequestError
        Where the file is wrong, with file, line and column.
    """
    path = config_file()
    if not path.exists():
        return Config()
    from algorithms.parameters import unknown
    from scenarios.files.marked_yaml import read
    from scenarios.files.set_files import read_text

    document = read(read_text(path), str(path))
    data = document.data if document.data is not None else {}
    if not isinstance(data, dict):
        raise RequestError(f"{document.where(())}: a mapping with {' and '.join(KNOWN)} is expected")
    for key in data:
        if key not in KNOWN:
            raise RequestError(f"{document.where((key,), key=True)}: {unknown(key, KNOWN, 'setting')}")
    theme, keys = data.get("theme"), data.get("keys") or {}
    if theme is not None and not isinstance(theme, str):
        raise RequestError(f"{document.where(('theme',))}: theme must be the name of a theme")
    if not isinstance(keys, dict) or not all(isinstance(value, str) for value in keys.values()):
        raise RequestError(f"{document.where(('keys',))}: keys must be a mapping of binding ids to keys")
    places = {name: document.where(("keys", name), key=True) for name in keys}
    return Config(theme, keys, places)
