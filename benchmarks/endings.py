"""Endings of the application at random moments: how long they last, and what they leave behind.

Run it with `python benchmarks/endings.py [--moments N] [--seed N]`. In a pseudo-terminal the application
is ended by TERM, by HUP and by closing the terminal, at random moments of the first five seconds after
its start, after the start of a run and after kernels begin to compile; once with a terminal that is read,
once with one that nobody reads from then on, so that whoever writes to it waits. Half of the endings get
a second signal, and a third meet an open dialog.

An ending is good if it takes at most two seconds, with the status of its signal; if the work that was
changed before lies aside, whole; and if a terminal that is still there is as it was before.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import sys
import termios
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from application import F2, F6, Terminal, place
from measure import verdict

from algorithms.errors import RequestError
from scenarios.files.set_files import parse_set

LONGEST = 2.0
"""Seconds that an ending may take."""

SPAN = 5.0
"""Seconds in which the moments lie."""

GIVEN_UP = 20.0
"""Seconds after which a process that does not end is killed."""

PHASES = ("start", "run", "compile")
WAYS = {"TERM": 143, "HUP": 129, "closed": 129}

F1 = b"\x1bOP"
COMMAND = [sys.executable, "-m", "hough_tui"]
TO_OTHER_SCREEN, FROM_OTHER_SCREEN = b"\x1b[?1049h", b"\x1b[?1049l"


class Line(Terminal):
    """A pseudo-terminal that can stall, and that can be closed."""

    is_read = True

    def stall(self) -> None:
        """Read nothing any more; what the program writes from now on waits for room."""
        self.is_read = False
        own = os.open(f"/proc/{self.process.pid}/fd/0", os.O_WRONLY | os.O_NOCTTY | os.O_NONBLOCK)
        refusals = 0
        while refusals < 20:  # one may be due to the program, which writes at that moment
            try:
                os.write(own, b" ")
                refusals = 0
            except BlockingIOError:
                refusals += 1
                time.sleep(0.002)
        os.close(own)

    def hang_up(self) -> None:
        """Close the terminal."""
        os.close(self._master)
        self._master = -1

    def pass_time(self, seconds: float) -> None:
        """Let some seconds pass, or less if the program ends meanwhile."""
        end = time.perf_counter() + seconds
        while time.perf_counter() < end and self.process.poll() is None:
            self._look(min(0.02, max(0.0, end - time.perf_counter())))

    def seconds_to_end(self) -> float:
        """Return how long the program takes to end; infinity where it had to be killed."""
        began = time.perf_counter()
        while self.process.poll() is None:
            if time.perf_counter() - began > GIVEN_UP:
                self.process.kill()
                self.process.wait()
                return float("inf")
            self._look(0.005)
        return time.perf_counter() - began

    def is_restored(self) -> bool:
        """Whether the terminal is as it was before: its attributes, and the screen that it shows."""
        self.is_read = True
        while self._read(0.2):  # it comes in pieces
            continue
        was_left = self.written.rfind(FROM_OTHER_SCREEN) >= self.written.rfind(TO_OTHER_SCREEN)
        return was_left and termios.tcgetattr(self._master) == self.before

    def close(self) -> None:
        if self._master >= 0:
            super().close()

    def _look(self, seconds: float) -> None:
        if self.is_read and self._master >= 0:
            self._read(seconds)
        else:
            time.sleep(seconds)


@dataclass(frozen=True, slots=True)
class Ending:
    """What became of one application.

    Attributes
    ----------
    seconds : from the first signal on
    status : 128 + the signal where it ended by the signal itself
    is_expected : whether the status is that of the way
    is_aside : whether what was changed lies aside, whole; None where nothing was changed
    is_restored : whether the terminal is as it was; None where it has gone
    """

    seconds: float
    status: int
    is_expected: bool
    is_aside: bool | None
    is_restored: bool | None


def one_ending(phase: str, way: str, is_read: bool, moment: float, chance: random.Random) -> Ending:
    """Start an application, bring it to a phase, and end it in a way."""
    with place() as (environment, write_set):
        if phase == "compile":
            environment["XDG_CACHE_HOME"] = environment["XDG_STATE_HOME"] + "/cold"
        environment["PYTHONPATH"] = os.pathsep.join(sys.path[1:])
        line = Line([*COMMAND, write_set(10_000_000)], environment)
        try:
            is_changed = reach(line, phase, is_read, moment)
            if line.is_read and chance.random() < 1 / 3:
                line.send(F1)
                line.pass_time(0.1)
            second = chance.uniform(0.0, 0.5) if chance.random() < 0.5 else None
            return ended(line, way, second, Path(environment["XDG_STATE_HOME"]) if is_changed else None)
        finally:
            line.close()
            if line.process.poll() is None:
                line.process.kill()
                line.process.wait()


def reach(line: Line, phase: str, is_read: bool, moment: float) -> bool:
    """Bring an application to a moment of a phase; return whether its set is changed by then."""
    began = time.perf_counter()
    is_changed = False
    if phase == "start":
        if not is_read:
            line.stall()
        line.pass_time(moment)
        return False
    line.wait("two-crossing")
    line.wait("Interval")
    if phase == "compile":
        began = time.perf_counter()
    _, since = line.send(F2)
    line.wait("Explain", since)
    _, since = line.send(b"9")
    line.wait("changed", since)
    is_changed = True
    if phase == "run":
        _, since = line.send(F6)
        line.wait("trials", since)
        _, since = line.send(b"r")
        line.wait("Cancel", since)
        began = time.perf_counter()
    if not is_read:
        line.stall()
    line.pass_time(moment - (time.perf_counter() - began))
    return is_changed


def ended(line: Line, way: str, second: float | None, state: Path | None) -> Ending:
    """End an application, and look at what it leaves behind."""
    number = signal.SIGTERM if way == "TERM" else signal.SIGHUP
    if way == "closed":
        line.hang_up()
    else:
        line.process.send_signal(number)
    if second is not None:
        began = time.perf_counter()
        line.pass_time(second)
        spent = time.perf_counter() - began
        line.process.send_signal(number)
        seconds = spent + line.seconds_to_end()
    else:
        seconds = line.seconds_to_end()
    status = line.process.returncode
    status = 128 - status if status < 0 else status
    return Ending(
        seconds,
        status,
        status == WAYS[way],
        None if state is None else is_aside(state),
        None if way == "closed" else line.is_restored(),
    )


def is_aside(state: Path) -> bool:
    """Whether the changed set lies aside: one file that can be read, with the value that was typed."""
    files = list((state / "hough-tui" / "unsaved").glob("*.json"))
    try:
        (content,) = (json.loads(file.read_text(encoding="utf-8")) for file in files)
        return parse_set(content["set"], "aside").scenarios[0].scans == 9
    except (ValueError, KeyError, RequestError):
        return False


def cases(moments: int, chance: random.Random) -> Iterator[tuple[str, bool, str, float]]:
    """Yield phase, whether the terminal is read, way and moment of every ending."""
    for phase in PHASES:
        for is_read in (True, False):
            for index in range(moments):
                yield phase, is_read, list(WAYS)[index % len(WAYS)], chance.uniform(0.0, SPAN)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moments", type=int, default=27, help="of each phase and terminal (27)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--phases", nargs="+", choices=PHASES, default=PHASES)
    chosen = parser.parse_args()
    chance = random.Random(chosen.seed)
    # Under nohup, or from a shell in the background, what is started would ignore them.
    for number in (signal.SIGHUP, signal.SIGINT):
        signal.signal(number, signal.SIG_DFL)
    endings: dict[tuple[str, bool], list[Ending]] = {}
    for phase, is_read, way, moment in cases(chosen.moments, chance):
        if phase not in chosen.phases:
            continue
        ending = one_ending(phase, way, is_read, moment, chance)
        endings.setdefault((phase, is_read), []).append(ending)
        if not is_good(ending):
            print(f"{title(phase, is_read)} {way} at {moment:.2f} s: {ending}", flush=True)
    print(f"seed {chosen.seed}")
    print(
        f"{'phase, terminal':19}{'endings':>8}{'worst':>9}{'good':>6}{'aside':>8}{'restored':>10}  statuses"
    )
    for kind, of_kind in endings.items():
        statuses = Counter(ending.status for ending in of_kind)
        print(
            f"{title(*kind):19}{len(of_kind):8}"
            f"{max(ending.seconds for ending in of_kind):7.2f} s{sum(map(is_good, of_kind)):6}"
            f"{share([ending.is_aside for ending in of_kind]):>8}"
            f"{share([ending.is_restored for ending in of_kind]):>10}"
            f"  {dict(sorted(statuses.items()))}"
        )
    every = [ending for of_kind in endings.values() for ending in of_kind]
    worst = max(ending.seconds for ending in every)
    good = sum(map(is_good, every))
    print(f"{len(every)} endings, {good} good; worst {worst:.2f} s: {verdict(worst, LONGEST)}")


def title(phase: str, is_read: bool) -> str:
    return f"{phase}, {'read' if is_read else 'not read'}"


def share(answers: list[bool | None]) -> str:
    """Return how many of those that can be asked are right."""
    asked = [answer for answer in answers if answer is not None]
    return f"{sum(asked)}/{len(asked)}"


def is_good(ending: Ending) -> bool:
    return (
        ending.seconds <= LONGEST
        and ending.is_expected
        and ending.is_aside is not False
        and ending.is_restored is not False
    )


if __name__ == "__main__":
    main()
