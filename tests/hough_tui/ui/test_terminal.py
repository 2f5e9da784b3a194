"""The command in a real pseudo-terminal: how it begins, works, and leaves the terminal as it was."""

import fcntl
import io
import json
import os
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

from algorithms.errors import RequestError
from hough_tui.ui.terminal import require_terminal

PATIENCE = 60.0
"""Seconds until a wait is given up."""

TO_ALTERNATE, FROM_ALTERNATE = "\x1b[?1049h", "\x1b[?1049l"
HIDE_CURSOR, SHOW_CURSOR = "\x1b[?25l", "\x1b[?25h"
F2, F6, CTRL_Q = "\x1bOQ", "\x1b[17~", "\x11"

COMMAND = "from hough_tui.cli import main; main()"
# The new session takes the terminal that it is given as its own, so that its end is told.
IN_A_TERMINAL = f"import fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); {COMMAND}"
PROJECT = Path(__file__).parents[3]


class Terminal:
    """A pseudo-terminal of 80 × 24 with the command in it, as its controlling terminal."""

    def __init__(self, home: Path, term: str, *arguments: str, **variables: str) -> None:
        self.home = home
        self.master, self.slave = os.openpty()
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        self.before = termios.tcgetattr(self.slave)
        self.output = b""
        self.process = subprocess.Popen(
            [sys.executable, "-c", IN_A_TERMINAL, *arguments],
            stdin=self.slave,
            stdout=self.slave,
            stderr=self.slave,
            cwd=home,
            env=environment(home, term) | variables,
            start_new_session=True,
        )

    def __enter__(self) -> "Terminal":
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        for descriptor in (self.master, self.slave):
            if descriptor >= 0:
                os.close(descriptor)

    def read(self, seconds: float = 0.05) -> None:
        """Take what the command has written, and wait a moment for it."""
        while select.select([self.master], [], [], seconds)[0]:
            self.output += os.read(self.master, 65536)
            seconds = 0.0

    def read_to_the_end(self) -> None:
        """Take what an ended command has left in the terminal, which comes in pieces."""
        before = -1
        while len(self.output) > before:
            before = len(self.output)
            self.read(0.2)

    @property
    def text(self) -> str:
        """What was written, without what moves the cursor and colours it."""
        written = self.output.decode("utf-8", "replace")
        return re.sub(
            r"\x1b(\[[0-9;?<>=$ ]*[A-Za-z~]|\][^\x07\x1b]*(\x07|\x1b\\)|P[^\x1b]*\x1b\\|.)", "", written
        )

    def until(self, words: str, since: int = 0) -> None:
        """Wait until words have been written."""
        limit = time.monotonic() + PATIENCE
        while words not in self.text[since:]:
            self.read()
            assert self.process.poll() is None, f"ended with {self.process.returncode}:\n{self.text[-2000:]}"
            assert time.monotonic() < limit, f"no '{words}' in:\n{self.text[since:][-4000:]}"

    def press(self, keys: str) -> int:
        """Send keys; return how much had been written before."""
        self.read(0.0)
        written = len(self.text)
        os.write(self.master, keys.encode())
        return written

    def status(self) -> int:
        """Wait until the command has ended, and return its exit status."""
        limit = time.monotonic() + PATIENCE
        while self.process.poll() is None:
            self.read()
            assert time.monotonic() < limit, f"it does not end:\n{self.text[-2000:]}"
        self.read(0.0)
        return self.process.returncode

    def fill(self) -> None:
        """Write to it until it takes no more: as nobody reads, whoever writes from now on waits."""
        own = os.open(os.ttyname(self.slave), os.O_WRONLY | os.O_NOCTTY | os.O_NONBLOCK)
        refusals = 0
        while refusals < 20:  # one may be due to the command, which writes at that moment
            try:
                os.write(own, b" ")
                refusals = 0
            except BlockingIOError:
                refusals += 1
                time.sleep(0.002)
        os.close(own)

    def hang_up(self) -> None:
        """Close the terminal, as a dropped connection does."""
        os.close(self.slave)
        os.close(self.master)
        self.master = self.slave = -1


def environment(home: Path, term: str) -> dict[str, str]:
    kept = {
        key: value for key, value in os.environ.items() if not key.startswith(("TEXTUAL", "COLOR", "NO_"))
    }
    kept.pop("COLUMNS", None)
    kept.pop("LINES", None)
    folders = {f"XDG_{name}_HOME": str(home / name.lower()) for name in ("DATA", "CONFIG", "STATE")}
    return {**kept, **folders, "TERM": term, "LANG": "C.UTF-8", "PYTHONPATH": str(PROJECT)}


def assert_restored(terminal: Terminal) -> None:
    written = terminal.output.decode("utf-8", "replace")
    assert written.count(TO_ALTERNATE) == 1
    assert written.rindex(FROM_ALTERNATE) > written.rindex(TO_ALTERNATE)
    assert written.rindex(SHOW_CURSOR) > written.rindex(HIDE_CURSOR)
    # Neither mouse nor pasted text is told any more.
    for mode in ("1000", "1003", "1006", "2004"):
        on, off = f"\x1b[?{mode}h", f"\x1b[?{mode}l"
        assert written.rfind(off) >= written.rfind(on), mode
    assert termios.tcgetattr(terminal.slave) == terminal.before


def edited(terminal: Terminal) -> None:
    """Open a set, type another number of scans, and wait until it is kept aside."""
    terminal.until("Interval")
    # The form has its cursor in the number of scans when the view is asked for.
    since = terminal.press(F2)
    terminal.until("Explain", since)
    since = terminal.press("9")
    terminal.until("changed", since)
    limit = time.monotonic() + PATIENCE
    while not kept_aside(terminal.home):
        terminal.read()
        assert time.monotonic() < limit


def kept_aside(home: Path) -> list[Path]:
    return list((home / "state" / "hough-tui" / "unsaved").glob("*.json"))


@pytest.mark.parametrize("term", ["xterm-256color", "linux"])
def test_start_open_run_and_quit_leave_the_terminal_as_it_was(tmp_path, term):
    with Terminal(tmp_path, term) as terminal:
        terminal.until("Choose a bundled set")
        assert terminal.output.decode("utf-8", "replace").startswith(TO_ALTERNATE)
        terminal.press("\r")
        terminal.until("two-crossing")
        since = terminal.press(F6)
        terminal.until("6,000 trials", since)
        since = terminal.press("r")
        terminal.until("kept as", since)
        terminal.press(CTRL_Q)
        assert terminal.status() == 0
        assert_restored(terminal)
    (run,) = (tmp_path / "data" / "hough-tui" / "runs").iterdir()
    document = json.loads((run / "result.json").read_text(encoding="utf-8"))
    assert document["complete"]
    assert [row["trials"] for row in document["rows"]] == [1000] * 6


ENDINGS = {"TERM": 143, "HUP": 129, "closed": 129}


@pytest.mark.parametrize(
    ("state", "way", "is_read"),
    [
        ("at rest", "TERM", True),
        ("compiling", "TERM", False),
        ("running", "HUP", False),
        ("running", "closed", True),
    ],
)
def test_an_ending_keeps_the_work_aside(state, way, is_read, long_set, tmp_path):
    cache = {"XDG_CACHE_HOME": str(tmp_path / "cold")} if state == "compiling" else {}
    with Terminal(tmp_path, "xterm-256color", str(long_set), **cache) as terminal:
        edited(terminal)
        (kept,) = kept_aside(tmp_path)
        kept.unlink()
        if state == "running":
            since = terminal.press(F6)
            terminal.until("40 trials", since)
            since = terminal.press("r")
            terminal.until("Cancel", since)
        if not is_read:
            terminal.fill()
        if way == "closed":
            terminal.hang_up()
            assert terminal.process.wait(PATIENCE) == ENDINGS[way]
        else:
            terminal.process.send_signal(getattr(signal, f"SIG{way}"))
            assert terminal.process.wait(PATIENCE) == ENDINGS[way]
            terminal.read_to_the_end()
            assert_restored(terminal)
        # It is written at the end too, not only a while after the last key.
        (kept,) = kept_aside(tmp_path)
        assert "scans: 9" in json.loads(kept.read_text(encoding="utf-8"))["set"]


def test_a_terminal_that_is_closed_at_the_start_ends_it(tmp_path):
    with Terminal(tmp_path, "xterm-256color", "course-report") as terminal:
        while TO_ALTERNATE.encode() not in terminal.output:
            terminal.read()
        terminal.hang_up()
        assert terminal.process.wait(PATIENCE) == 129


def test_a_quit_does_not_wait_for_a_kernel(long_set, tmp_path):
    with Terminal(tmp_path, "xterm-256color", str(long_set)) as terminal:
        terminal.until("crowd")
        since = terminal.press(F6)
        terminal.until("40 trials", since)
        since = terminal.press("r")
        terminal.until("1 of 40 trials", since)
        terminal.press(CTRL_Q)
        assert terminal.status() == 0
        assert_restored(terminal)
    (run,) = (tmp_path / "data" / "hough-tui" / "runs").iterdir()
    document = json.loads((run / "result.json").read_text(encoding="utf-8"))
    assert [row["trials"] for row in document["rows"]] == [1]


@pytest.mark.parametrize("arguments", [[], ["course-report"]], ids=["bare", "with a set"])
def test_without_a_terminal_it_refuses_and_points_to_batch(tmp_path, arguments):
    done = subprocess.run(
        [sys.executable, "-c", COMMAND, *arguments],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=environment(tmp_path, "xterm-256color"),
        timeout=PATIENCE,
    )
    assert done.returncode == 2
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert "batch" in line
    assert "terminal" in line


def test_settings_that_are_wrong_end_it_before_the_screen_is_touched(tmp_path):
    folder = tmp_path / "config" / "hough-tui"
    folder.mkdir(parents=True)
    (folder / "config.yaml").write_text("theme: nord\nkeyz: {}\n", encoding="utf-8")
    with Terminal(tmp_path, "xterm-256color", "course-report") as terminal:
        assert terminal.status() == 2
        assert TO_ALTERNATE not in terminal.output.decode()
        assert "config.yaml:2:1" in terminal.text
        assert termios.tcgetattr(terminal.slave) == terminal.before


def test_a_terminal_of_ascii_is_drawn_on_in_ascii(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")
    path = tmp_path / "\x1b]0;owned\x07.yaml"
    path.write_bytes((PROJECT / "scenarios/sets/course-report.yaml").read_bytes())
    with Terminal(tmp_path, "xterm-256color", path.name) as terminal:
        terminal.until("two-crossing")
        terminal.until(r"\x1b]0;owned\x07.yaml")
        terminal.until("Interval")
        terminal.press(CTRL_Q)
        assert terminal.status() == 0
        assert_restored(terminal)
    assert terminal.output.isascii()
    assert b"\x1b]0;" not in terminal.output
    assert rb"\u25" not in terminal.output


def test_without_a_terminal_to_draw_on_it_refuses(monkeypatch):
    streams = {name: io.StringIO() for name in ("stdin", "stdout", "stderr")}
    for name, stream in streams.items():
        monkeypatch.setattr(stream, "isatty", lambda name=name: name != "stderr", raising=False)
        monkeypatch.setattr(sys, name, stream)
    with pytest.raises(RequestError, match="draws on standard error"):
        require_terminal()
