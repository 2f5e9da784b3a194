"""Where the bundled sets are; light, so that a name can be looked up before anything heavy is loaded."""

from __future__ import annotations

from importlib.resources import files as resources
from pathlib import Path


def bundled_paths() -> dict[str, Path]:
    """Return where the bundled sets are, by name."""
    folder = Path(str(resources("scenarios") / "sets"))
    return {path.stem: path for path in sorted(folder.glob("*.yaml"))}
