"""What of YAML's syntax reading and writing share: line breaks, comments, plain scalars, limits.

Scalars follow the core schema of YAML 1.2 (`1e-3` and `0o17` are numbers, `no` and `12:30` are text).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

Path = tuple[str | int, ...]

# Deeper than a person writes, and shallow enough for any recursive function that meets the data later.
DEEPEST = 100
# Values, keys among them, that a document may have: some seconds of reading, 25 MiB of memory.
MOST_VALUES = 50_000
# Values that aliases may add to a document; without a bound a few lines can stand for billions of values.
MOST_COPIES = 100_000
# PyYAML takes up to 1024 characters for a key on one line; longer keys need the form `? key`.
LONGEST_KEY = 1000
SHORT = 72

BREAKS = "\r\n\x85\u2028\u2029"
BREAK = rf"(?:\r\n|[{BREAKS}])"
COMMENT = rf"#[^{BREAKS}]*"
LINE_END = re.compile(rf"[^{BREAKS}]*(?:{BREAK}|\Z)")
# What stands above an item, cut in two: things further up; its own comment lines, and its indentation.
LEAD = re.compile(rf"(?s)\A(.*?)(?<![^{BREAKS}])((?:[ \t]*{COMMENT}{BREAK})*[ ]*)\Z")
BLANK_END = re.compile(rf"(?<=[{BREAKS}])(?<!\r(?=\n))(?:[ \t]*{BREAK})+\Z")
COMMA = re.compile(rf"\A((?:\s|{COMMENT})*),")
# What follows an item in brackets and belongs to it: its comma, and a comment on its line.
TAIL = re.compile(rf"(?:(?:\s|{COMMENT})*,)?(?:[ \t]*{COMMENT})?")

# The first pattern that fits a plain scalar makes its value; str() refuses as many digits as int() does.
_SCALARS: tuple[tuple[re.Pattern[str], Callable[[str], Any]], ...] = (
    (re.compile("(null|Null|NULL|~)?"), lambda _: None),
    (re.compile("true|True|TRUE|false|False|FALSE"), lambda text: text[0] in "tT"),
    (re.compile(r"[-+]?[0-9]+"), int),
    (re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+"), lambda text: int(str(int(text, 0)))),
    (re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"), float),
    (re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"), lambda text: float(text.replace(".", ""))),
)
CORE = "tag:yaml.org,2002:"
MERGE = "<<"
"""A key that YAML 1.1 has replaced by the fields of its value; without quotes it is refused."""


def match_end(pattern: re.Pattern[str], text: str, position: int) -> int:
    """Return where a pattern that begins at a position ends; the position where it does not fit."""
    match = pattern.match(text, position)
    return match.end() if match else position


def scalar_maker(text: str) -> Callable[[str], Any] | None:
    """Return what makes the value of a plain scalar; None where it is text."""
    return next((make for pattern, make in _SCALARS if pattern.fullmatch(text)), None)
