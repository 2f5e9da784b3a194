"""Mutations of values and of text that sets and tables share."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence

EXTREMES = (
    *(0, -0.0, 1, -1, 2, 0.5, 1e-12, 1e9, 1e12, 1e13, -1e12, 1e100, 1e160, -1e160, 1e308, -1e308),
    *(1e-320, 5e-324, -1e-320, math.nan, math.inf, -math.inf),
    *(2**31 - 1, 2**31, -(2**31), 2**53 + 1, 2**63 - 1, 2**63, -(2**63), 2**64, 10**400),
)
"""Numbers at the bounds of their types, and beyond what a radar has."""

USUAL = (
    0,
    1,
    2,
    3,
    4,
    5,
    8,
    10,
    16,
    45,
    89,
    90,
    180,
    360,
    1000,
    4096,
    0.1,
    0.25,
    0.9,
    0.95,
    1e-3,
    1e-6,
    30.5,
)
"""Numbers that many fields take."""

HOSTILE = (
    *(
        "\x1b]0;title\a",
        "\x1b[31mred\x1b[0m",
        "\x00",
        "\x9b31m",
        "\u202eright to left",
        "[red]markup[/]",
        "[/]",
    ),
    *(
        "%s{0}{name}",
        "../../name",
        "a" * 5_000,
        "\ud7ff\ufffd",
        "名前",
        "e\u0301",
        " ",
        "",
        "\t",
        "\r\n",
        "\u2028",
    ),
    *("=1+1", "<<", "*alias", "&anchor", "!tag", "- ", "? ", ": ", "#", "---", "NaN", "null", "~", "auto"),
)
"""Text that drives a terminal, a formatter or a parser, where it is not taken as text."""

DAMAGES: dict[str, Callable[[random.Random, bytes], bytes]]
"""Mutations of the bytes of a file, by name."""


def number(dice: random.Random, value: float) -> float:
    """Return a number in place of another: extreme, usual, or the same one scaled, negated, retyped."""
    kind = dice.randrange(8)
    if kind < 2:
        return dice.choice(EXTREMES)
    if kind < 4:
        return dice.choice(USUAL)
    if kind < 6 and abs(value) < 1e300:
        scaled = value * 10.0 ** dice.randint(-8, 8)
        return int(scaled) if isinstance(value, int) and math.isfinite(scaled) else scaled
    if kind == 6:
        return -value
    if isinstance(value, int) and abs(value) < 2**53:
        return float(value)
    return int(value) if math.isfinite(value) else 0


def hostile(dice: random.Random, text: str = "") -> str:
    """Return a text with something hostile in it, or in its place."""
    part = dice.choice(HOSTILE)
    at = dice.randint(0, len(text))
    return dice.choice((part, text[:at] + part + text[at:]))


def damaged(dice: random.Random, data: bytes) -> bytes:
    """Return the bytes of a file with one damage."""
    return DAMAGES[dice.choice(tuple(DAMAGES))](dice, data)


def _truncated(dice: random.Random, data: bytes) -> bytes:
    return data[: dice.randint(0, len(data))]


def _raw_bytes(dice: random.Random, data: bytes) -> bytes:
    at = dice.randint(0, len(data))
    return data[:at] + dice.randbytes(dice.randint(1, 20)) + data[at:]


def _flipped(dice: random.Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(min(len(changed), dice.randint(1, 10))):
        changed[dice.randrange(len(changed))] ^= 1 << dice.randrange(8)
    return bytes(changed)


def _inserted(parts: Sequence[bytes]) -> Callable[[random.Random, bytes], bytes]:
    def insert(dice: random.Random, data: bytes) -> bytes:
        at, part = dice.randint(0, len(data)), dice.choice(parts)
        return data[:at] + part + data[at:]

    return insert


def _marked(dice: random.Random, data: bytes) -> bytes:
    """Return the bytes with a byte order mark, or in another encoding."""
    kind = dice.choice(("utf-8-sig", "utf-16", "utf-16-le", "utf-32", "latin-1", "two marks"))
    if kind == "two marks":
        return b"\xef\xbb\xbf" * 2 + data
    return data.decode("utf-8", "replace").encode(kind, "replace")


def _line_ends(dice: random.Random, data: bytes) -> bytes:
    return data.replace(b"\n", dice.choice((b"\r\n", b"\r", b"\n\n", b"\xe2\x80\xa8", b"\x00\n")))


def _lines(dice: random.Random, data: bytes) -> bytes:
    """Return the lines with one lost, repeated, moved, indented, shifted or made empty."""
    lines = data.split(b"\n")
    at, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    kind = dice.randrange(6)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(other, lines[at])
    elif kind == 2:
        lines[at], lines[other] = lines[other], lines[at]
    elif kind == 3:
        lines[at] = dice.choice((b" ", b"\t", b"    ", b"\xc2\xa0")) + lines[at]
    elif kind == 4:
        lines[at] = lines[at].lstrip()
    else:
        lines[at] = b""
    return b"\n".join(lines)


def _replaced(dice: random.Random, data: bytes) -> bytes:
    """Return the bytes with every one of a delimiter replaced by another."""
    one, other = dice.sample((b",", b";", b"\t", b" ", b"|", b":", b"."), 2)
    return data.replace(one, other, dice.choice((1, -1)))


def _huge(dice: random.Random, data: bytes) -> bytes:
    """Return the bytes with a very long run of a character, or of a line."""
    at = dice.randint(0, len(data))
    part = dice.choice(
        (b"a", b"9", b" ", b"\n", b"[", b"{", b"- ", b'"', b",", b"\xc3\xa4", b"a: 1\n", b"1,2,3\n")
    )
    return data[:at] + part * dice.choice((200, 5_000, 400_000)) + data[at:]


DAMAGES = {
    "truncated": _truncated,
    "raw bytes": _raw_bytes,
    "flipped": _flipped,
    "control": _inserted(
        (b"\x00", b"\x1b[2J", b"\x07", b"\x7f", b"\xc2\x9b", b"\xe2\x80\xae", b"\x08", b"\x0c")
    ),
    "quotes": _inserted((b'"', b"'", b'""', b"\\", b"#", b"`", b"@", b"%")),
    "marked": _marked,
    "line ends": _line_ends,
    "lines": _lines,
    "replaced": _replaced,
    "huge": _huge,
}
