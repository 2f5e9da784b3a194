"""What a new scene and a new clustering begin with."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from algorithms.clustering.parameters import MODES

EXTENTS = {"range_extent": 16.0, "doppler_extent": 12.0}
"""Of a target whose points spread as a scene's do by default, with room to spare; in cells."""

NEW_SCENE: dict[str, Any] = {
    "name": "scene",
    "region": {"range": [0.0, 120.0], "doppler": [0.0, 90.0]},
    "targets": [{"range": 35.0, "doppler": 45.0}, {"range": 80.0, "doppler": 45.0}],
}
"""Two targets, well apart."""


def clustering_data(mode: str, like: BaseModel | None) -> dict[str, Any]:
    """Return the data of a new clustering.

    Parameters
    ----------
    mode : its mode, and its name
    like : a clustering whose extents it takes, where it has them
    """
    declared = MODES[mode].model_fields
    extents = {
        name: getattr(like, name, None) or value for name, value in EXTENTS.items() if name in declared
    }
    number = {"number": "auto"} if "number" in declared else {}
    return {"name": mode, "mode": mode, **extents, **number}
