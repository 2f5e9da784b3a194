"""Numbers as people type them: read into the one value that they can mean, or refused with a reason.

The dot is always the decimal sign. A comma is read as one where it can be nothing else; separators of
thousands are never read, and spaces only separate numbers, so that one text means the same in every field.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import pairwise

Value = float | int | str | tuple[float | int, ...] | None
"""What a text can mean: a number, several, a word such as `auto`, or nothing."""

MOST_DIGITS = 40
"""The most digits of a whole number that is read at all; every bound is far below."""

_EXPONENT = r"(?:[eE][+-]?\d{1,9})?"
_NUMBER = re.compile(rf"[+-]?(?:\d+\.?\d*|\.\d+){_EXPONENT}", re.ASCII)
_DECIMAL_COMMA = re.compile(rf"[+-]?\d*,\d+{_EXPONENT}", re.ASCII)
# No more digits than a float holds.
_INTEGER = re.compile(r"[+-]?\d{1,15}", re.ASCII)
# A mark of thousands, the same throughout, and perhaps the other sign for the decimals.
_MARKS = r"[,. '’_\u00a0\u2009\u202f]"
_GROUPED = re.compile(
    rf"(?P<whole>[+-]?(?!0+{_MARKS})\d{{1,3}}(?P<mark>{_MARKS})\d{{3}}(?:(?P=mark)\d{{3}})*)"
    rf"(?:(?!(?P=mark))[.,](?P<rest>\d+))?(?P<exponent>{_EXPONENT})",
    re.ASCII,
)
_WITH_UNIT = re.compile(rf"[+-]?(?:\d+[.,]?\d*|[.,]\d+){_EXPONENT}\s*(?P<unit>[%°]|[^\W\d_].*)", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(?:inf|infinity|nan)", re.IGNORECASE)
_SPACE = re.compile(r"\s")


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a field takes.

    Attributes
    ----------
    whole : whether only whole numbers are taken
    size : 0 for one number, else how many; None for any number of them
    others : how many there may be, too
    single : whether one number may stand for all of several
    words : words that are taken beside numbers
    optional : whether nothing is taken
    """

    whole: bool = False
    size: int | None = 0
    others: tuple[int, ...] = ()
    single: bool = False
    words: tuple[str, ...] = ()
    optional: bool = False

    @property
    def allowed(self) -> str:
        """What is taken, in words."""
        whole = "whole " if self.whole else ""
        choices = [f"a {whole}number"] if self.size == 0 or self.single else []
        if self.size != 0:
            sizes = " or ".join(map(str, sorted((self.size, *self.others)))) if self.size else "a list of"
            choices.append(f"{sizes} {whole}numbers")
        choices += [f"'{word}'" for word in self.words] + (["empty"] if self.optional else [])
        return " or ".join(choices)


ONE_NUMBER = Wanted()


@dataclass(frozen=True, slots=True)
class Unreadable:
    """Why a text is no value: what was given, and what to write instead."""

    message: str


class _RefusedError(Exception):
    """A text that is not read; its argument says why."""


def read(text: str, wanted: Wanted = ONE_NUMBER) -> Value | Unreadable:
    """Return what a text means, or why it means nothing or more than one thing."""
    given = text.strip()
    if not given or (wanted.optional and given.lower() == "none"):
        return None if wanted.optional else Unreadable(f"nothing is given; it must be {wanted.allowed}")
    if given.lower() in wanted.words:
        return given.lower()
    # The minus sign of typesetting is what people paste.
    plain = given.replace("\N{MINUS SIGN}", "-")
    try:
        if wanted.size == 0 or (wanted.single and _is_one(plain)):
            return _number(plain, given, wanted)
        one = Wanted(wanted.whole)
        return tuple(_number(item, item, one) for item in _items(plain, given, wanted))
    except _RefusedError as refused:
        return Unreadable(str(refused))


def number_text(value: float | int) -> str:
    """Return the shortest text that reads as a number."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        # Only the sign of a negative zero is lost, and the two zeros are equal.
        return str(int(value))
    return repr(value)


def numbers_text(values: Sequence[float | int]) -> str:
    """Return several numbers as one text."""
    return ", ".join(map(number_text, values))


def _number(text: str, given: str, wanted: Wanted) -> float | int:
    """Return the one number that a text means; `given` is the text as it was typed."""
    if _NUMBER.fullmatch(text):
        return _converted(text, given, wanted)
    grouped = _GROUPED.fullmatch(text)
    if _DECIMAL_COMMA.fullmatch(text):
        if not grouped:
            return _converted(text.replace(",", "."), given, wanted)
        raise _RefusedError(
            f"'{given}' may mean {text.replace(',', '.')} or {text.replace(',', '')}; write one of them"
        )
    if grouped:
        rest = f".{grouped['rest']}" if grouped["rest"] else ""
        whole = grouped["whole"].replace(grouped["mark"], "")
        raise _RefusedError(
            f"'{given}' is given; write it without separators: {whole}{rest}{grouped['exponent']}"
        )
    if _NOT_FINITE.fullmatch(text):
        raise _RefusedError(f"'{given}' is given; it must be a finite number")
    with_unit = _WITH_UNIT.fullmatch(text)
    if with_unit and with_unit["unit"] == "%":
        raise _RefusedError(f"'{given}' is given; write per cents as a fraction, 95% as 0.95")
    if with_unit:
        raise _RefusedError(f"'{given}' is given; write the number alone, without '{with_unit['unit']}'")
    raise _RefusedError(f"'{given}' is given; it must be {wanted.allowed}")


def _converted(text: str, given: str, wanted: Wanted) -> float | int:
    if wanted.whole:
        # Exactly: seeds have more digits than a float holds.
        exact = Decimal(text)
        if exact and exact.adjusted() > MOST_DIGITS:
            raise _RefusedError(f"'{given}' is too large")
        if exact != exact.to_integral_value():
            raise _RefusedError(f"'{given}' is given; it must be {wanted.allowed}")
        return int(exact)
    if _INTEGER.fullmatch(text):
        # What is said of the value shows it as it was typed, and swept whole numbers stay whole.
        return int(text)
    value = float(text)
    if math.isinf(value):
        raise _RefusedError(f"'{given}' is too large")
    if value == 0.0 and re.search(r"[1-9]", re.split("[eE]", text)[0]):
        raise _RefusedError(f"'{given}' is too small to be told from 0")
    return value


def _is_one(text: str) -> bool:
    """Return whether a text where one number or several are wanted is one."""
    # A comma with nothing before it separates nothing.
    return not re.search(r"[\s;\[\](),]", text.removeprefix(","))


def _items(text: str, given: str, wanted: Wanted) -> list[str]:
    """Return the texts of several numbers, split where only one splitting is possible."""
    bare, is_list = _opened(text, given)
    if ";" in bare:
        items = bare.split(";")
    elif is_list:
        # As in YAML: within brackets a comma separates, whatever stands about it.
        items = bare.split(",") if "," in bare else bare.split()
    elif _SPACE.search(bare):
        items = re.split(r"\s+,\s+|,\s+|\s+", bare)
        # With so many numbers as are wanted, a comma inside one can only be its decimal sign.
        if any(item.startswith(",") for item in items) or (
            wanted.size != len(items) and any("," in item for item in items)
        ):
            raise _RefusedError(f"'{given}' can be read in several ways; {_ADVICE}")
    else:
        items = bare.split(",")
        if any(_joins(left, right) for left, right in pairwise(items)):
            raise _RefusedError(f"the comma of '{given}' may separate numbers or decimals; {_ADVICE}")
    items = [item.strip() for item in items]
    if "" in items[:-1] or (bare and not items[-1]):
        raise _RefusedError(f"'{given}' is given; a number is missing beside a separator")
    if any(re.match(r"[+-]?0\d", item) for item in items) or (wanted.single and _GROUPED.fullmatch(bare)):
        # What begins with a needless zero was cut off a larger number: 1 000.
        raise _RefusedError(f"'{given}' may be one number with a separator; {_ADVICE}")
    items = items if bare else []
    if wanted.size is not None and len(items) not in (wanted.size, *wanted.others):
        count = f"{len(items)} number{'s' * (len(items) != 1)}"
        raise _RefusedError(f"'{given}' is {count}; it must be {wanted.allowed}, as in {_EXAMPLE}")
    return items


_EXAMPLE = "'40, 20'"
_ADVICE = f"write numbers as in {_EXAMPLE}, and decimals with a dot"


def _opened(text: str, given: str) -> tuple[str, bool]:
    """Return a text without the brackets around it, and whether there were any."""
    for opening, closing in ("[]", "()"):
        if text.startswith(opening) or text.endswith(closing):
            if not (text.startswith(opening) and text.endswith(closing) and len(text) > 1):
                raise _RefusedError(f"'{given}': a bracket is missing")
            return text[1:-1].strip(), True
    return text, False


def _joins(left: str, right: str) -> bool:
    """Return whether two texts with a comma between them could be one number."""
    joined = f"{left},{right}"
    return bool(_DECIMAL_COMMA.fullmatch(joined) or _GROUPED.fullmatch(joined))
