"""What fields are called, from their names and help lines."""

from __future__ import annotations

import re

GREEK = {"theta": "θ", "rho": "ρ", "sigma": "σ", "lambda": "λ", "delta": "Δ"}
"""The letters that the field writes in Greek."""

_UNIT_WORDS = ("deg",)
"""Endings of names that say a unit, which stands beside the label anyway."""


def label_of(name: str) -> str:
    """Return a field's name as people read it: `rho_step` is "ρ step"."""
    words = name.split("_")
    if len(words) > 1 and words[-1] in _UNIT_WORDS:
        words = words[:-1]
    first, *rest = (GREEK.get(word, word) for word in words)
    # One letter is a symbol, and keeps its case.
    return " ".join([first if len(first) == 1 else first.capitalize(), *rest])


def within(label: str) -> str:
    """Return a label as it stands after another one: only symbols keep their capitals."""
    first, *rest = label.split(" ")
    return " ".join([first if len(first) == 1 else first.lower(), *rest])


def component_names(help: str) -> tuple[str, ...]:
    """Return what a help line that begins with "[vx, vy]" calls the numbers of its vector."""
    found = re.match(r"\[(\w+(?:, \w+)+)\]", help)
    return tuple(found[1].split(", ")) if found else ()
