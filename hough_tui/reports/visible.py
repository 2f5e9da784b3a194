"""Text from outside, made safe to show: no character of it acts on the terminal.

Names, descriptions, headers of tables and paths come from files and command lines of anybody. An
escape sequence among them would drive the reader's terminal, and a mark of direction would reorder
what stands around it. Where text is shown, such characters are shown as escapes; files keep them.
"""

from __future__ import annotations

import re

ACTING = re.compile(
    "["
    "\x00-\x09\x0b-\x1f\x7f-\x9f"  # control characters: C0 but the line feed, DEL, C1
    "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # marks, embeddings, overrides and isolates of direction
    "\u2028\u2029"  # separators of lines and paragraphs
    "\ud800-\udfff"  # lone surrogates, which no encoding has; bytes of file names among them
    "]"
)
"""A character that acts, and is not the line feed that sentences are broken with."""

SHORT = {"\t": r"\t", "\r": r"\r"}

PICTURES = {code: 0x2400 + code for code in range(0x20)} | {0x7F: 0x2421}
"""Unicode has a picture of each control character of ASCII."""


def visible(text: str) -> str:
    """Return lines of text with every other character that acts on a terminal as an escape."""
    return ACTING.sub(_escape, text)


def visible_line(text: str) -> str:
    """Return text in one line: its line feeds are escapes, too."""
    return visible(text).replace("\n", r"\n")


def visible_in_place(text: str) -> str:
    """Return text of the same length with pictures in place of what acts, for a line that is edited."""
    return ACTING.sub("\N{REPLACEMENT CHARACTER}", text.translate(PICTURES))


def _escape(match: re.Match[str]) -> str:
    character = match[0]
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:
        # A byte of a file's name that is no character.
        code -= 0xDC00
    return SHORT.get(character) or (f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}")
