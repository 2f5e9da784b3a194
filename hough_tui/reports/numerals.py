"""Numbers as people read them: cells of one column, lined up at the decimal point."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

NONE = "–"
"""What stands where there is no value."""

Pair = tuple[float | None, float | None]


def number(value: object) -> float | None:
    """Return a value as a finite number; None where it is none (null, NaN, infinite, no number)."""
    if value is None or isinstance(value, (bool, str)):
        return None
    try:
        found = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return found if math.isfinite(found) else None


def pair(value: object) -> Pair:
    """Return an interval as its two ends, None for an end that is none."""
    if isinstance(value, (list, tuple)) and len(value) == 2:
        return number(value[0]), number(value[1])
    return None, None


def fixed(value: float | None, decimals: int) -> str:
    """Return a number with so many decimals, never a negative zero."""
    if value is None:
        return NONE
    return f"{round(value, decimals) + 0.0:,.{decimals}f}"


def percent(value: float | None) -> str:
    """Return a share as per cent, one decimal."""
    return fixed(None if value is None else 100.0 * value, 1)


def significant(value: float | None, digits: int = 3) -> str:
    """Return a number with so many significant digits, whole parts in full, at most four decimals.

    Notes
    -----
    Below a thousandth it is written with an exponent: a row of zeros would say that it is 0.
    """
    if value is None:
        return NONE
    if value == 0.0:
        return "0"
    if abs(value) < 1e-3:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    # Rounding first, so that 9.996 counts as 10.0 and not as 10.00.
    rounded = float(f"{value:.{digits - 1}e}")
    return fixed(value, min(4, max(0, digits - 1 - math.floor(math.log10(abs(rounded))))))


def as_given(value: object) -> str:
    """Return a value that someone wrote, as short as it can be written."""
    found = number(value)
    if found is None:
        return NONE if value is None or isinstance(value, float) else str(value)
    return str(int(found)) if found.is_integer() and abs(found) < 1e15 else f"{found:.10g}"


def decimals_of_lengths(values: Iterable[float | None]) -> int:
    """Return the decimals for lengths: two, three where all are short, none where some are long."""
    greatest = max((abs(value) for value in values if value is not None), default=0.0)
    return 0 if greatest >= 1e4 else 2 if greatest >= 10.0 else 3


def aligned(texts: Sequence[str]) -> tuple[str, ...]:
    """Return the texts of one column filled up on the right so that their decimal points line up."""
    tails = [len(text) - text.index(".") if "." in text else 0 for text in texts]
    room = max(tails, default=0)
    return tuple(text + " " * (room - tail) for text, tail in zip(texts, tails, strict=True))


def intervals(pairs: Sequence[tuple[str, str]]) -> tuple[str, ...]:
    """Return intervals, the ends already text, their halves lined up below each other.

    Parameters
    ----------
    pairs : low and high end of each; `NONE` for an end that is open
    """
    # A dash between negative numbers would read as one more sign.
    between = " to " if any("-" in text.lstrip("0123456789.,e") for ends in pairs for text in ends) else "–"
    lows, highs = aligned([low for low, _ in pairs]), aligned([high for _, high in pairs])
    left, right = max(map(len, lows), default=0), max(map(len, highs), default=0)
    return tuple(
        NONE if given == (NONE, NONE) else f"{low:>{left}}{between}{high:>{right}}"
        for given, low, high in zip(pairs, lows, highs, strict=True)
    )


def durations(seconds: Sequence[float | None]) -> tuple[str, tuple[str, ...]]:
    """Return the unit that suits a column of short durations, and the durations in it."""
    greatest = max((value for value in seconds if value is not None), default=0.0)
    unit, factor = ("µs", 1e6) if greatest < 1e-2 else ("ms", 1e3) if greatest < 10.0 else ("s", 1.0)
    texts = [significant(None if value is None else factor * value) for value in seconds]
    return unit, aligned(texts)
