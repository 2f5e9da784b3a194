"""Plain data to a fresh YAML 1.2 document."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from algorithms.errors import RequestError
from scenarios.files.marked_yaml.syntax import DEEPEST, LONGEST_KEY, MERGE, SHORT, Path, scalar_maker


def write(data: Any) -> str:
    """Print data as a fresh document in block style, which `read` reads as the same data.

    Keys keep their order; short lists and mappings of scalars come in flow style, text of several lines as
    a literal block where that can be. Tuples become lists.

    Raises `TypeError` for data that YAML's core schema has no form for, `RequestError` for data that is
    nested too deeply or within itself, or holds text or numbers that could not be read back.
    """
    return "\n".join((*Layout().lines(plain_data(data), 0), ""))


def plain_data(data: Any, path: Path = ()) -> Any:
    """Return the data in the exact types that `read` gives, or raise for what has no form in YAML."""
    place = ".".join(map(str, path)) or "the data"
    if len(path) > DEEPEST:
        raise RequestError(f"data more than {DEEPEST} levels deep, or within itself; make it flatter")
    if data is None or isinstance(data, bool):
        return data
    try:
        if isinstance(data, str):
            return data.encode().decode()
        if isinstance(data, int | float):
            return int(str(int(data))) if isinstance(data, int) else float(data)
    except ValueError:
        raise RequestError(f"{place}: no file can hold this text or number; correct it") from None
    if isinstance(data, list | tuple):
        return [plain_data(value, (*path, index)) for index, value in enumerate(data)]
    if isinstance(data, Mapping) and all(isinstance(key, str) for key in data):
        return {plain_data(key, path): plain_data(value, (*path, key)) for key, value in data.items()}
    raise TypeError(f"{place}: YAML has no form for this {type(data).__name__}: {data!r}")


def canonical(value: Any) -> str:
    """Return a text that two values share if they differ in nothing but the order of their keys."""
    return json.dumps(value, sort_keys=True)


def is_same(one: Any, other: Any) -> bool:
    """Return whether two values differ in nothing but the order of their keys."""
    return canonical(one) == canonical(other)


def _text(value: str, flow: bool, quote: str = "") -> str:
    """Return text as a scalar on one line: as it is if it then reads as this text, else in quotes."""
    if quote == "'" and value.isprintable():
        return "'" + value.replace("'", "''") + "'"
    taken = (": ", " #", *(",?[]{}" if flow else ""))
    plain = value.isprintable() and scalar_maker(value) is None and not value.startswith("...")
    plain = plain and value[0] not in "-?:,[]{}#&*!|>'\"%@` " and value[-1] not in ": "
    if plain and quote != '"' and not any(sign in value for sign in taken):
        return value
    # JSON's escapes are YAML's too, but JSON leaves some characters as they are that YAML forbids.
    signs = json.dumps(value, ensure_ascii=False)
    return "".join(sign if sign.isprintable() else f"\\U{ord(sign):08x}" for sign in signs)


def key_text(key: str | None, flow: bool, between: str) -> str:
    """Return a key with its colon, or the dash of a list item where there is none."""
    text = "-" if key is None else _text(key, flow, '"' if key == MERGE else "")
    return text if key is None else f"{text}:" if len(text) <= LONGEST_KEY else f"? {text}{between}:"


def flow_text(value: Any, *, outer: bool = False, quote: str = "") -> str:
    """Return a value on one line; `outer` where it stands inside no brackets."""
    if isinstance(value, dict):
        return (
            "{"
            + ", ".join(f"{key_text(key, True, ' ')} {flow_text(child)}" for key, child in value.items())
            + "}"
        )
    if isinstance(value, list):
        return "[" + ", ".join(map(flow_text, value)) + "]"
    if isinstance(value, str):
        return _text(value, not outer, quote)
    if isinstance(value, float):
        return re.sub("(?=inf|nan)", ".", repr(value))
    return "null" if value is None else str(value).lower()


def literal_text(value: Any) -> list[str] | None:
    """Return the lines of a text that can be a literal block with every line looking as it is."""
    lines = value.removesuffix("\n").split("\n") if isinstance(value, str) and "\n" in value else [""]
    clean = all(map(str.isprintable, lines))
    return lines if clean and lines[0] and lines[-1] and lines[0][0] != " " else None


def inline_text(value: Any) -> str | None:
    """Return a value as it stands on the line of its key, or None if it wants lines of its own."""
    if isinstance(value, dict | list) and value:
        children = list(value.values()) if isinstance(value, dict) else value
        nested = any(isinstance(child, dict | list) or literal_text(child) for child in children)
        return None if nested or len(text := flow_text(value)) > SHORT else text
    return None if literal_text(value) else flow_text(value, outer=True)


class Layout(NamedTuple):
    """How a document indents: mappings by `step`, lists by `offset` from the key above them."""

    step: int = 2
    offset: int = 2
    newline: str = "\n"

    def lines(self, value: Any, column: int) -> list[str]:
        """Return a value in block style, indented by so many columns."""
        if not isinstance(value, dict | list) or not value:
            return [flow_text(value, outer=True)]
        lines: list[str] = []
        for key, child in value.items() if isinstance(value, dict) else zip(itertools.repeat(None), value):
            head = key_text(key, False, self.newline + " " * column)
            first, *rest = self.entry(head, child, column, inline_text(child))
            lines += [" " * column + first, *rest]
        return lines

    def entry(self, head: str, value: Any, column: int, inline: str | None) -> list[str]:
        """Return the lines of a key or dash with its value, the first one without its indentation."""
        if inline is not None:
            return [f"{head} {inline}"]
        if literal := literal_text(value):
            padding = " " * (column + (2 if head == "-" else self.step))
            header = f"{head} |" if value.endswith("\n") else f"{head} |-"
            return [header, *(line and padding + line for line in literal)]
        if head == "-":
            first, *rest = self.lines(value, column + 2)
            return [f"- {first.lstrip(' ')}", *rest]
        return [head, *self.lines(value, column + (self.offset if isinstance(value, list) else self.step))]
