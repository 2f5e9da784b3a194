"""Floats to whole numbers that become an index, a size or a bound of a loop."""

from __future__ import annotations

import numpy as np

from algorithms.compiled import kernel

FARTHEST = 2.0**53
"""Beyond it not every whole number is a float."""


@kernel
def floored(value):  # type: ignore[no-untyped-def]
    """Return the greatest whole number not above a float, within ±`FARTHEST`.

    The float is bounded before it is converted: beyond the integers a conversion has no defined
    result. What is no number counts as −∞. Every kernel converts by this, or bounds the float
    itself, as `vote` does.
    """
    bounded = value if value > -FARTHEST else -FARTHEST
    return np.int64(np.floor(bounded if bounded < FARTHEST else FARTHEST))
