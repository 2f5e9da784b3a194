"""Characters that stand for those that an encoding lacks.

Standard output may be ASCII, Latin-1, a code page of Windows or GBK. Two error handlers replace what
it lacks, so that nothing that is printed is an error: `WORDS` reads best in running text, `CELLS`
gives each character as many cells as it had, so that a screen keeps its columns.
"""

from __future__ import annotations

import codecs
import unicodedata

WORDS, CELLS = "hough_tui.words", "hough_tui.cells"
"""Names of the error handlers, for `str.encode` and for streams."""

UPPER_DOTS, LOWER_DOTS = 0b00011011, 0b11100100
"""Bits of a braille character's dots in its upper and in its lower half."""

BRAILLE = {
    0x2800 + bits: " '.:"[bool(bits & UPPER_DOTS) + 2 * bool(bits & LOWER_DOTS)] for bits in range(256)
}
"""What stands for braille."""

SPELLED = {
    "±": "+/-", "≤": "<=", "≥": ">=", "≠": "!=", "…": "...", "→": "->", "←": "<-", "∞": "inf", "°": "deg",
    "√": "sqrt", "∫": "integral", "⁻": "-",
    "Δ": "d", "Φ": "Phi", "Σ": "Sigma", "δ": "delta", "ε": "epsilon", "η": "eta", "θ": "theta",
    "κ": "kappa", "λ": "lambda", "μ": "mu", "µ": "mu", "π": "pi", "ρ": "rho", "σ": "sigma", "φ": "phi",
    "χ": "chi",
}  # fmt: skip
"""What reads best, of any length."""

SIGNS = {
    "−": "-", "–": "-", "—": "-", "·": ".", "×": "x", "≈": "~", "′": "'", "‘": "'", "’": "'", "“": '"',
    "”": '"', "•": "*", "✚": "+", "✗": "x", "✓": "v", "●": "o", "◉": "o", "○": "o", "◘": "o", "◆": "*",
    "◇": "*", "♦": "*", "■": "#", "□": "#", "▪": "#", "▲": "^", "△": "^", "▴": "^", "↑": "^", "▼": "v",
    "▽": "v", "↓": "v", "▸": ">", "►": ">", "◄": "<", "⌈": "[", "⌉": "]", "▀": '"', "▄": "_",
}  # fmt: skip
"""What looks alike, one character each."""

ONE_LETTER = {
    "±": "~", "≤": "<", "≥": ">", "≠": "#", "…": "~", "→": ">", "←": "<", "∞": "8", "°": "'", "√": "V",
    "∫": "S", "⁻": "-",
    "Δ": "D", "Φ": "F", "Σ": "S", "δ": "d", "ε": "e", "η": "h", "θ": "t", "κ": "k", "λ": "l", "μ": "u",
    "µ": "u", "π": "p", "ρ": "r", "σ": "s", "φ": "f", "χ": "x",
}  # fmt: skip
"""In place of `SPELLED` where a character has one cell."""


def spelled(text: str, encoding: str) -> str:
    """Return text with what an encoding lacks replaced, so that it can be measured as it will be shown."""
    return text.encode(encoding, WORDS).decode(encoding)


def look_alike(character: str) -> str:
    """Return a character, or several, of ASCII that take as many cells as one that an encoding lacks."""
    code = ord(character)
    same = SIGNS.get(character) or ONE_LETTER.get(character) or BRAILLE.get(code)
    if same:
        return same
    if 0x2500 <= code < 0x2580:
        return _frame(unicodedata.name(character))
    if 0x2580 <= code < 0x25A0:
        return "#"
    cells = 2 if unicodedata.east_asian_width(character) in "WF" else 1
    plain = unicodedata.normalize("NFKD", character)[:1]
    # A letter without its accents; else nothing is known of it but its width.
    return plain if cells == 1 and plain.isascii() and plain.isprintable() else "?" * cells


def _frame(name: str) -> str:
    """Return what stands for a line of a frame, by its name in Unicode."""
    if "DIAGONAL" in name:
        return "/" if "LOWER LEFT" in name else "\\"
    directions = set(name.split())
    across, along = directions & {"HORIZONTAL", "LEFT", "RIGHT"}, directions & {"VERTICAL", "UP", "DOWN"}
    if across and along:
        return "+"
    return "-" if across else "|"


def _replace(error: UnicodeError, table: dict[str, str]) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(table.get(character) or look_alike(character) for character in lacking), error.end


codecs.register_error(WORDS, lambda error: _replace(error, SPELLED))
codecs.register_error(CELLS, lambda error: _replace(error, {}))
