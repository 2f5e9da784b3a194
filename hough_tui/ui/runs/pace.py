"""How far a run is, how fast it goes and what is left of it, in words."""

from __future__ import annotations

from collections import deque

WINDOW = 5.0
"""Seconds over which the speed is taken: long enough to be steady, short enough to follow a change."""


class Pace:
    """The speed of a run, from looks at how much is done.

    Parameters
    ----------
    total : trials asked for
    """

    def __init__(self, total: int) -> None:
        self.total = total
        self.done = 0
        self._looks: deque[tuple[float, int]] = deque()

    def look(self, now: float, done: int) -> None:
        """Note how many trials are done at a time, in seconds."""
        # Before the first trial kernels are loaded, which says nothing of the speed.
        if self.done == 0 and done > 0:
            self._looks.clear()
        self.done = done
        self._looks.append((now, done))
        while len(self._looks) > 2 and self._looks[1][0] <= now - WINDOW:
            self._looks.popleft()

    @property
    def speed(self) -> float | None:
        """Trials a second; None as long as it cannot be told."""
        if len(self._looks) < 2:
            return None
        (before, less), (after, more) = self._looks[0], self._looks[-1]
        return (more - less) / (after - before) if more > less and after > before else None

    @property
    def left(self) -> float | None:
        """Seconds until the end at this speed; None as long as it cannot be told."""
        speed = self.speed
        return None if speed is None else (self.total - self.done) / speed

    def words(self, cells_done: int, cells: int) -> str:
        """Return how far the run is.

        Parameters
        ----------
        cells_done, cells : finished cells and all cells
        """
        parts = [f"{cells_done:,}/{cells:,} cells", f"{self.done:,} of {self.total:,} trials"]
        if self.done == 0:
            parts.append("preparing")
        if self.speed is not None:
            parts.append(f"{self.speed:,.0f}/s")
        if self.left is not None:
            parts.append(f"{duration(self.left)} left")
        return " · ".join(parts)


def duration(seconds: float) -> str:
    """Return a time in words, as coarse as it is of use."""
    if seconds < 9.5:
        return f"{seconds:.1f} s" if seconds < 0.95 else f"{seconds:.0f} s"
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
