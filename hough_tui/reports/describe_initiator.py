"""What an initiator declares of itself, as a document."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from algorithms.initiators.base import Initiator
from algorithms.initiators.registry import FailedPlugIn
from algorithms.parameters import LARGEST, LARGEST_WHOLE, LEAST

TYPES = {
    "number": "number",
    "integer": "whole number",
    "null": "none",
    "string": "text",
    "boolean": "true, false",
}
BOUNDS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


def declaration(algorithm: Initiator) -> dict[str, Any]:
    """Return name, summary, source and parameters of an initiator.

    Each parameter has `name` (dotted), `default`, `allowed`, `dimension` and `help`; `error` is None.
    """
    return {
        "name": algorithm.name,
        "summary": algorithm.summary,
        "source": algorithm.source,
        "parameters": list(_parameters(algorithm.parameters, "")),
        "error": None,
    }


def failed_declaration(failed: FailedPlugIn) -> dict[str, Any]:
    """Return a plug-in that cannot be used in the same form, with `error` saying why."""
    return {"name": failed.name, "summary": "", "source": "", "parameters": [], "error": failed.words}


def _parameters(model: type[BaseModel], prefix: str) -> list[dict[str, Any]]:
    schema = model.model_json_schema()
    declared: list[dict[str, Any]] = []
    for name, field in model.model_fields.items():
        if isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel):
            declared += _parameters(field.annotation, f"{prefix}{name}.")
            continue
        described = schema["properties"][name]
        declared.append(
            {
                "name": f"{prefix}{name}",
                "default": described.get("default"),
                "allowed": _allowed(described),
                "dimension": described.get("dimension"),
                "auto": described.get("auto"),
                "help": field.description,
            }
        )
    return declared


def _allowed(schema: dict[str, Any]) -> str:
    if "anyOf" in schema:
        return " or ".join(_allowed(alternative) for alternative in schema["anyOf"])
    if "enum" in schema:
        return ", ".join(map(str, schema["enum"]))
    if "const" in schema:
        return str(schema["const"])
    if schema.get("type") == "array":
        return "[" + ", ".join(_allowed(item) for item in schema.get("prefixItems", ())) + "]"
    limits = [_limit(key, sign, schema[key]) for key, sign in BOUNDS.items() if _tells(schema, key)]
    return " ".join([TYPES.get(schema.get("type", ""), "value"), *([", ".join(limits)] if limits else [])])


def _limit(key: str, sign: str, bound: float) -> str:
    return "> 0" if key == "minimum" and bound == LEAST else f"{sign} {bound:g}"


def _tells(schema: dict[str, Any], key: str) -> bool:
    """Return whether a bound says something: not what those of all numbers or a stricter bound say."""
    if key not in schema or abs(schema[key]) in (LARGEST, LARGEST_WHOLE):
        return False
    stricter = {"maximum": "exclusiveMaximum", "minimum": "exclusiveMinimum"}.get(key, "")
    return bool(schema.get(stricter) != schema[key])
