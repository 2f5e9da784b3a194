"""How the benchmarks measure: contenders in turn, the median of several rounds, ratios within a round."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable


def rounds(
    contenders: dict[str, Callable[[], object]], *, count: int = 15, at_least: float = 0.02
) -> dict[str, list[float]]:
    """Return seconds a call of each contender in each round.

    In every round each contender is called, one after the other, for at least so many seconds,
    so that a drift of the machine's speed meets all of them alike. One call before is not counted.
    """
    calls: dict[str, int] = {}
    for name, call in contenders.items():
        call()
        began = time.perf_counter()
        call()
        calls[name] = max(1, int(at_least / max(time.perf_counter() - began, 1e-9)))
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    for _ in range(count):
        for name, call in contenders.items():
            began = time.perf_counter()
            for _ in range(calls[name]):
                call()
            seconds[name].append((time.perf_counter() - began) / calls[name])
    return seconds


def ratio(seconds: dict[str, list[float]], ours: str, other: str) -> float:
    """Return the median over the rounds of our time by the other's."""
    return statistics.median(a / b for a, b in zip(seconds[ours], seconds[other], strict=True))


def verdict(value: float, bound: float, *, at_most: bool = True) -> str:
    """Return whether a value keeps its bound, in words."""
    return "kept" if (value <= bound if at_most else value >= bound) else "NOT KEPT"
