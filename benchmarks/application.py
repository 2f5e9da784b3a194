"""The application in a pseudo-terminal: how fast it starts, answers, redraws, stops, and what it writes.

Run it with `python benchmarks/application.py`, or with the names of some of its parts after it. It
starts `hough-tui` in a pseudo-terminal, types, and takes the time at which bytes come out; with
settings, unsaved work and results of its own, in a folder that is gone at the end. What only the
inside knows (gaps of a ticker on the event loop, a repaint on demand) is asked of the same
application over a socket.

Times hold for a quiet machine: each is a median of repeats, with the worst beside it.
"""

from __future__ import annotations

import asyncio
import fcntl
import json
import os
import pty
import re
import select
import signal
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import termios
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from measure import verdict

ESCAPES = re.compile(
    rb"\x1b(?:\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(?:\x07|\x1b\\)|P[^\x1b]*\x1b\\|[ -/]*[0-~])"
)
CONTROL = re.compile(rb"[\x00-\x1a\x1c-\x1f]")

F2, F3, F4, F5, F6, F7 = b"\x1bOQ", b"\x1bOR", b"\x1bOS", b"\x1b[15~", b"\x1b[17~", b"\x1b[18~"
CTRL_Q = b"\x11"

LETTERS = "Quick brown jumps over zero lazy vex"
TICK = 0.02
PATIENCE = 60.0


class Terminal:
    """A program in a pseudo-terminal, and all that it wrote with the times at which it came."""

    def __init__(
        self,
        command: Sequence[str],
        environment: dict[str, str],
        columns: int = 120,
        lines: int = 40,
        pass_fds: Iterable[int] = (),
    ) -> None:
        self.written = bytearray()
        self._master, slave = pty.openpty()
        self.resize(columns, lines)
        self.before = termios.tcgetattr(self._master)
        self.started = time.perf_counter()
        self.process = subprocess.Popen(
            command,
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env=environment,
            start_new_session=True,
            pass_fds=tuple(pass_fds),
            cwd=environment["XDG_STATE_HOME"],
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
        )
        os.close(slave)

    def resize(self, columns: int, lines: int) -> None:
        """Give the terminal another size."""
        fcntl.ioctl(self._master, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))

    def send(self, keys: bytes) -> tuple[float, int]:
        """Type; return the time, and how much had been written by then."""
        self.drain(0.0)
        self.check()
        at = time.perf_counter(), len(self.written)
        os.write(self._master, keys)
        return at

    def text(self, since: int = 0) -> str:
        """Return what was written after a place, without escape sequences."""
        return CONTROL.sub(b"", ESCAPES.sub(b"", bytes(self.written[since:]))).decode(errors="replace")

    def check(self) -> None:
        """Make sure that the program has not failed: an idle failure would look fast and silent."""
        if b"Traceback" in self.written:
            raise RuntimeError(f"the application failed: {self.text()[-400:].strip()!r}")

    def drain(self, seconds: float) -> int:
        """Read for some time; return the number of bytes that came."""
        before, end = len(self.written), time.perf_counter() + seconds
        while self._read(max(0.0, end - time.perf_counter())) and time.perf_counter() < end:
            pass
        return len(self.written) - before

    def wait(self, wanted: str, since: int = 0, patience: float = PATIENCE) -> float:
        """Wait until a pattern is written; return the time at which it was."""
        pattern, end = re.compile(wanted), time.perf_counter() + patience
        while True:
            if pattern.search(self.text(since)):
                return self.latest
            if time.perf_counter() > end or not self._read(0.5, is_patient=True):
                raise TimeoutError(f"'{wanted}' did not come; at the end: {self.text(since)[-400:]!r}")

    def settle(self, seconds: float = 0.6, patience: float = 10.0) -> int:
        """Read until nothing comes for some time; return the number of bytes that came."""
        before, end = len(self.written), time.perf_counter() + patience
        while self.drain(seconds) and time.perf_counter() < end:
            pass
        return len(self.written) - before

    def ended(self, patience: float = PATIENCE) -> float:
        """Read until the program has ended; return the time at which it had."""
        end = time.perf_counter() + patience
        while self.process.poll() is None:
            if time.perf_counter() > end:
                raise TimeoutError("the program did not end")
            self._read(0.002, is_patient=True)
        return time.perf_counter()

    def processor_seconds(self) -> float:
        """Return the processor time that the program has used; what else the machine does is not in it."""
        tasks = Path(f"/proc/{self.process.pid}/task").glob("*/schedstat")
        return sum(int(task.read_text().split()[0]) for task in tasks) * 1e-9

    def close(self) -> None:
        """End the program, if it has not ended yet."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            try:
                self.ended(5.0)
            except TimeoutError:
                self.process.kill()
                self.process.wait()
        os.close(self._master)

    latest = 0.0

    def _read(self, seconds: float, *, is_patient: bool = False) -> bool:
        """Read once; return whether something came, or more can come."""
        ready, _, _ = select.select([self._master], [], [], seconds)
        if not ready:
            return is_patient and self.process.poll() is None
        try:
            found = os.read(self._master, 1 << 16)
        except OSError:  # Linux says so where nobody has the terminal open any more
            return False
        self.latest = time.perf_counter()
        self.written += found
        return bool(found)


class Inside(Terminal):
    """The application in a pseudo-terminal, which can also be asked from within."""

    def __init__(self, name: str, environment: dict[str, str]) -> None:
        self._ours, theirs = socket.socketpair()
        command = [sys.executable, __file__, "--inside", str(theirs.fileno()), name]
        super().__init__(command, environment, pass_fds=[theirs.fileno()])
        theirs.close()
        self.wait("Detection probability")
        self.settle(1.5)  # the kernels are loaded meanwhile

    def ask(self, **what: Any) -> Any:
        """Have something done in the application; return its answer."""
        self.check()
        self._ours.sendall(json.dumps(what).encode() + b"\n")
        answer = b""
        while not answer.endswith(b"\n"):
            ready, _, _ = select.select([self._ours], [], [], 0.0)
            if ready:
                answer += self._ours.recv(1 << 20)
            else:
                self._read(0.001)
        return json.loads(answer)

    def close(self) -> None:
        super().close()
        self._ours.close()


# What runs inside


async def inside(name: str, descriptor: int) -> None:
    """Run the application, and answer what is asked over a socket."""
    from hough_tui.ui import interpreter
    from hough_tui.ui.app import HoughApp
    from hough_tui.ui.config import Config
    from hough_tui.ui.forms.model_form import ModelForm
    from hough_tui.ui.messages import FieldEdited

    interpreter.prepare()
    app = HoughApp(name, Config())
    gaps: list[float] = []

    async def tick() -> None:
        last = time.perf_counter()
        while True:
            await asyncio.sleep(TICK)
            now = time.perf_counter()
            gaps.append(now - last)
            last = now

    async def serve() -> None:
        reader, writer = await asyncio.open_connection(sock=socket.socket(fileno=descriptor))
        ticker: asyncio.Task[None] | None = None
        while line := await reader.readline():
            what, answer = json.loads(line), None
            match what["do"]:
                case "focus":
                    for form in app.screen.query(ModelForm):
                        app.call_later(form.focus_field, tuple(what["path"]))
                case "edit":
                    app.post_message(FieldEdited(tuple(what["path"]), what["value"]))
                case "repaint":
                    app.call_later(app.screen.refresh)
                case "tick":
                    gaps.clear()
                    ticker = asyncio.create_task(tick())
                case "gaps":
                    assert ticker is not None
                    ticker.cancel()
                    answer = gaps
            writer.write(json.dumps(answer).encode() + b"\n")

    serving = asyncio.create_task(serve())
    await app.run_async()
    serving.cancel()


# What is measured


@contextmanager
def place() -> Iterator[tuple[dict[str, str], Callable[[int], str]]]:
    """Yield an environment with folders of its own, and what writes a set of so many trials a cell."""
    from scenarios.files.set_files import locate

    with tempfile.TemporaryDirectory() as folder:
        environment = {
            name: value
            for name, value in os.environ.items()
            if name not in ("COLORTERM", "NO_COLOR", "COLUMNS", "LINES") and not name.startswith("TEXTUAL")
        }
        environment |= {"TERM": "xterm-256color", "LANG": "C.UTF-8"}
        for name in ("CONFIG", "STATE", "DATA"):
            environment[f"XDG_{name}_HOME"] = folder

        def written(trials: int) -> str:
            path = Path(folder) / f"course-report-{trials}.yaml"
            text = locate("course-report").read_text(encoding="utf-8")
            path.write_text(text.replace("trials: 1000", f"trials: {trials}"), encoding="utf-8")
            return str(path)

        yield environment, written


@contextmanager
def closing(terminal: Any) -> Iterator[Any]:
    try:
        yield terminal
    finally:
        terminal.close()


def told(what: str, seconds: Sequence[float], bound: float) -> None:
    """Print the median, the worst and the bound of times."""
    middle = statistics.median(seconds)
    print(
        f"  {what:56} {middle * 1e3:6.0f} ms, worst {max(seconds) * 1e3:5.0f} of {len(seconds)} "
        f"(bound {bound * 1e3:.0f}: {verdict(middle, bound)})",
        flush=True,
    )


def counted(what: str, count: int, bound: int) -> None:
    """Print a number of bytes and its bound."""
    print(f"  {what:56} {count:7,} bytes (bound {bound:,}: {verdict(count, bound)})", flush=True)


def start() -> None:
    """From the command to the first frame and to the form, with a warm cache."""
    command = [str(Path(sys.executable).with_name("hough-tui")), "course-report"]
    marks = {
        "the first frame": ("Monte Carlo", 0.7),
        "the form": ("Detection probability", 1.2),
        "the draw beside it being told": ("767 plots", 1.5),
    }
    seconds: dict[str, list[float]] = {name: [] for name in marks}
    worked: dict[str, list[float]] = {name: [] for name in marks}
    with place() as (environment, _):
        for attempt in range(10):
            with closing(Terminal(command, environment)) as terminal:
                for name, (text, _) in marks.items():
                    at = terminal.wait(text) - terminal.started
                    if attempt:  # the first one warms the cache
                        seconds[name].append(at)
                        worked[name].append(terminal.processor_seconds())
                terminal.send(CTRL_Q)
                terminal.ended()
    for name, (_, bound) in marks.items():
        told(f"command to {name}", seconds[name], bound)
        print(f"    of processor time: {statistics.median(worked[name]) * 1e3:.0f} ms", flush=True)


def typing(terminal: Inside, letters: str, pause: float) -> list[float]:
    """Type letters into the focused field; return the time of each until it is painted."""
    seconds, typed = [], ""
    for letter in letters:
        typed += letter
        at, since = terminal.send(letter.encode())
        # The end of the text is always in view, but a long text is not.
        seconds.append(terminal.wait(re.escape(typed[-6:].strip()), since) - at)
        terminal.drain(pause)
    return seconds


def run() -> None:
    """During a run on all processors: gaps of the event loop, keys to their paint."""
    worst, keys, idle = [], [], []
    with place() as (environment, written):
        for _ in range(5):
            with closing(Inside(written(4_000), environment)) as terminal:
                terminal.send(F6)
                terminal.wait("r runs it")
                terminal.settle()
                terminal.ask(do="tick")
                _, since = terminal.send(F5)
                terminal.wait("trials in", since)
                worst.append(max(terminal.ask(do="gaps")))
        told("worst gap of a 20 ms ticker, start to end of a run", worst, 0.1)
        print("    each run: " + ", ".join(f"{value * 1e3:.0f}" for value in worst), flush=True)
        with closing(Inside(written(300_000), environment)) as terminal:
            terminal.ask(do="focus", path=["scenarios", 0, "description"])
            terminal.settle(1.2, 2.0)
            idle = typing(terminal, LETTERS[:12], 0.25)
            _, since = terminal.send(F5)
            terminal.wait(r"\d/s", since)
            terminal.send(F2)
            terminal.drain(0.5)
            terminal.ask(do="focus", path=["scenarios", 0, "description"])
            terminal.drain(0.7)
            terminal.send(b"\x01\x0b")  # an empty line
            terminal.drain(0.7)
            keys = typing(terminal, LETTERS, 0.25)
    told("key to paint in a form, nothing running", idle, 0.05)
    told("key to paint in a form, during a run", keys, 0.05)


def accumulator() -> None:
    """From the last key in a quantisation field to the redrawn accumulator."""
    readout = r"ρ (-?[\d.]+) km"
    path = ["initiators", 0, "grid", "rho_step"]
    keyed, edited = [], []
    with place() as (environment, _), closing(Inside("course-report", environment)) as terminal:
        terminal.send(F4)
        terminal.settle(1.0)
        shown = re.findall(readout, terminal.text())[-1]
        for turn in range(12):
            terminal.send(F3)
            terminal.settle(0.6, 1.5)
            terminal.ask(do="focus", path=path)
            terminal.drain(0.5)
            # The place of the cursor's cell depends on the step, so the read-out tells old from new.
            terminal.send(b"0.")
            terminal.drain(0.3)
            at, since = terminal.send((b"5", b"8")[turn % 2] + F4)
            new = rf"ρ (?!{re.escape(shown)} )(-?[\d.]+) km"
            keyed.append(terminal.wait(new, since) - at)
            shown = re.findall(readout, terminal.text(since))[-1]
            terminal.settle(0.6, 2.0)
        for turn in range(12):
            terminal.drain(0.4)
            _, since = terminal.send(b"")
            at = time.perf_counter()
            terminal.ask(do="edit", path=path, value=(0.6, 0.9)[turn % 2])
            new = rf"ρ (?!{re.escape(shown)} )(-?[\d.]+) km"
            edited.append(terminal.wait(new, since) - at)
            shown = re.findall(readout, terminal.text(since))[-1]
    told("last key, then F4, to the redrawn accumulator", keyed, 0.15)
    told("an edit to the accumulator in view, redrawn", edited, 0.15)


def written_bytes() -> None:
    """What a repaint of Look writes in 256 colours, and what an idle application writes."""
    with place() as (environment, _), closing(Inside("course-report", environment)) as terminal:
        terminal.send(F4)
        terminal.settle(1.0)
        for columns, lines in ((80, 24), (160, 48), (120, 40)):
            terminal.resize(columns, lines)
            terminal.settle(1.0)
            terminal.ask(do="repaint")
            counted(f"full repaint of Look, {columns} × {lines}", terminal.settle(), 70_000)
        for name, key in (("Look", F4), ("Initiator", F3), ("Monte Carlo", F6), ("Results", F7)):
            terminal.send(key)
            terminal.settle(1.5)
            counted(f"idle for 2 s in {name}", terminal.drain(2.0), 0)
        terminal.send(F2)
        terminal.settle(1.2, 3.0)
        terminal.ask(do="focus", path=["scenarios", 0, "scans"])
        terminal.drain(1.5)
        counted("idle for 2 s in a field of Scenario", terminal.drain(2.0), 0)


def ending() -> None:
    """Cancel a run, and quit during one."""
    cancelled, quitted, small = [], [], []
    with place() as (environment, written):
        many, few = written(300_000), written(15_000)
        with closing(Inside(many, environment)) as terminal:
            for turn in range(8):
                _, since = terminal.send(F5)
                terminal.wait(r"\d/s", since)
                terminal.drain(0.5 + 0.13 * turn)
                at, since = terminal.send(b"x")
                cancelled.append(terminal.wait("cancelled after", since) - at)
                terminal.settle(0.6, 2.0)
        for path, found in ((many, quitted), (few, small)):
            for turn in range(4):
                with closing(Inside(path, environment)) as terminal:
                    _, since = terminal.send(F5)
                    terminal.wait(r"\d/s", since)
                    terminal.drain(0.4 + 0.13 * turn)
                    at, _ = terminal.send(CTRL_Q)
                    found.append(terminal.ended() - at)
                    if termios.tcgetattr(terminal._master) != terminal.before:
                        print("  THE TERMINAL IS NOT AS IT WAS")
    told("cancel, to it being said", cancelled, 0.1)
    told("quit during a run, to the end of the process", quitted, 0.5)
    told("quit during a run small enough to be kept", small, 0.5)


PARTS = {
    "start": start,
    "run": run,
    "accumulator": accumulator,
    "bytes": written_bytes,
    "ending": ending,
}


def main() -> None:
    if sys.argv[1:2] == ["--inside"]:
        from hough_tui.ui.interpreter import leave

        asyncio.run(inside(sys.argv[3], int(sys.argv[2])))
        leave(0)
    for name in sys.argv[1:] or PARTS:
        print(f"{name}: {PARTS[name].__doc__}")
        PARTS[name]()


if __name__ == "__main__":
    main()
