"""The watcher of a worker: deadlines, limits of memory, interrupts, and a fresh worker where one is lost."""

from __future__ import annotations

import json
import os
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

LONGEST = 5.0
"""Seconds that a command may take unless it has said that it takes long."""

MOST_MEMORY = 2**30
"""Bytes that a command may have in memory."""

LONGEST_ENDING = 1.0
"""Seconds within which an interrupt must have ended a command."""

DEAD = 20.0
"""Seconds after which a command that an interrupt has not ended is killed."""

COMMANDS_A_WORKER = 1_500
"""After so many commands a worker is replaced, since what libraries keep would count as the next one's."""

ROOT = Path(__file__).parents[2]
TICK = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a command went.

    Attributes
    ----------
    arguments : of hough-tui
    status : its exit status; that of a signal is negative, and None is one that had to be killed
    out, err : its output
    seconds : how long it took: the lesser of wall-clock time and processor time, since the machine may be
        busy with something else
    peak : of memory, in bytes
    ending : seconds that it went on after an interrupt, counted as `seconds` are; None where there was none
    """

    arguments: tuple[str, ...]
    status: int | None
    out: bytes
    err: bytes
    seconds: float
    peak: int
    ending: float | None = None


class Watch:
    """A worker process that is watched: `run` gives the outcome of a command, whatever happens to the worker.

    Parameters
    ----------
    folder : where its files lie, and modules that the entry needs; a new temporary one without
    entry : what runs a command, as `module:function`
    deadly : bytes of memory at which a command is killed, to spare the machine
    """

    def __init__(
        self, folder: Path | None = None, entry: str = "hough_tui.cli:main", deadly: int = 2 * MOST_MEMORY
    ) -> None:
        self.entry = entry
        self.deadly = deadly
        self.is_own = folder is None
        self.folder = Path(tempfile.mkdtemp(prefix="fuzzing-")) if folder is None else folder
        self.commands = 0
        self.process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        self.end()
        if self.is_own:
            shutil.rmtree(self.folder, ignore_errors=True)

    def end(self) -> None:
        """End the worker."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            self.process = None

    def write(self, name: str, content: bytes) -> None:
        """Write a file where the commands run."""
        (self.folder / name).write_bytes(content)

    def run(self, arguments: tuple[str, ...], longest: float = LONGEST) -> Outcome:
        """Run a command in the worker; after the `longest` seconds it is interrupted."""
        if self.process is None or self.process.poll() is not None or self.commands >= COMMANDS_A_WORKER:
            self.end()
            self._begin()
        assert self.process is not None
        assert self.process.stdin is not None
        self.commands += 1
        self.process.stdin.write(json.dumps(arguments).encode() + b"\n")
        self.process.stdin.flush()
        outcome = self._watched(arguments, longest)
        if outcome.ending is not None:
            # What an interrupt left behind is not the next command's.
            self.end()
        return outcome

    def _begin(self) -> None:
        environment = {
            **os.environ,
            "XDG_DATA_HOME": str(self.folder / "data"),
            "COLUMNS": "120",
            "PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]),
        }
        command = [sys.executable, "-m", "benchmarks.fuzzing.worker", self.entry]
        self.process = subprocess.Popen(
            command,
            cwd=self.folder,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
        )
        self.commands = 0
        assert self.process.stdout is not None
        self.process.stdout.readline()

    def _watched(self, arguments: tuple[str, ...], longest: float) -> Outcome:
        assert self.process is not None
        assert self.process.stdout is not None
        began, used = time.monotonic(), self._processor()
        interrupted: tuple[float, float] | None = None
        seconds, highest = 0.0, 0
        with selectors.DefaultSelector() as ready:
            ready.register(self.process.stdout, selectors.EVENT_READ)
            while not ready.select(0.02):
                now = time.monotonic()
                wall, memory = now - began, self._memory()
                highest = max(highest, memory)
                if interrupted is None:
                    seconds = min(wall, self._processor() - used)
                    # One that waits for something uses no processor time.
                    if seconds > longest or wall > 12 * longest:
                        interrupted = now, self._processor()
                        self.process.send_signal(signal.SIGINT)
                if (interrupted and now - interrupted[0] > DEAD) or memory > self.deadly:
                    ending = self._since(interrupted)
                    self.end()
                    return self._outcome(arguments, None, seconds, highest, ending)
        ending = self._since(interrupted)
        line = self.process.stdout.readline()
        if not line:
            # The worker is gone: it crashed, or the command ended the process by itself.
            status = self.process.wait()
            wall = time.monotonic() - began
            return self._outcome(arguments, status, seconds or wall, highest, ending)
        answer: dict[str, Any] = json.loads(line)
        seconds = min(answer["seconds"], answer["processor"])
        return self._outcome(arguments, answer["status"], seconds, max(highest, answer["peak"]), ending)

    def _outcome(
        self, arguments: tuple[str, ...], status: int | None, seconds: float, peak: int, ending: float | None
    ) -> Outcome:
        out, err = (
            (self.folder / name).read_bytes() if (self.folder / name).exists() else b""
            for name in ("out", "err")
        )
        return Outcome(arguments, status, out, err, seconds, peak, ending)

    def _since(self, moment: tuple[float, float] | None) -> float | None:
        """Return the seconds since a moment, of wall-clock time and of processor time."""
        if moment is None:
            return None
        wall, processor = time.monotonic() - moment[0], self._processor() - moment[1]
        # What waits for something that never comes uses no processor time.
        return wall if wall > DEAD or processor <= 0 else min(wall, processor)

    def _processor(self) -> float:
        """Return the seconds of processor time that the worker has used, all its threads together."""
        fields = self._proc("stat").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / TICK if fields else time.monotonic()

    def _memory(self) -> int:
        fields = self._proc("statm").split()
        return int(fields[1]) * page_size() if fields else 0

    def _proc(self, name: str) -> str:
        assert self.process is not None
        try:
            return Path(f"/proc/{self.process.pid}/{name}").read_text()
        except OSError:
            return ""


def page_size() -> int:
    """Return the size of a page of memory, in bytes."""
    return os.sysconf("SC_PAGE_SIZE")
