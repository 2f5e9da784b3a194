"""Names of swept fields, and what rows are told apart by."""

from __future__ import annotations

PARTS = ("scenario", "initiator", "scene", "clustering")
"""What rows are told apart by, and swept fields begin with."""


def field_name(key: str) -> str:
    """Return a swept key without the part that says where its field belongs."""
    part, _, rest = key.partition(".")
    return rest if rest and part in PARTS else key
