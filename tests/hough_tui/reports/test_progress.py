from __future__ import annotations

import io
import re
import sys

import pytest

from hough_tui.reports.progress import ProgressBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def run(bar: ProgressBar) -> None:
    with bar:
        bar.update(0, 12, 0, 24_000)
        bar.update(3, 12, 6_000, 24_000)
        bar.update(12, 12, 24_000, 24_000)


def plain(text: str) -> str:
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)


@pytest.mark.parametrize("variable", ["NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE"])
def test_silent_where_there_is_no_terminal(monkeypatch, capfd, variable):
    monkeypatch.setenv(variable, "1")
    stream = io.StringIO()
    run(ProgressBar("tables", stream))
    assert stream.getvalue() == ""
    run(ProgressBar("tables"))
    assert capfd.readouterr() == ("", "")


def test_silent_on_a_dumb_terminal(monkeypatch):
    monkeypatch.setenv("TERM", "dumb")
    stream = Terminal()
    run(ProgressBar("tables", stream))
    assert stream.getvalue() == ""


@pytest.mark.parametrize("width", [60, 80, 120])
def test_shows_how_far_the_job_is(monkeypatch, width):
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLUMNS", str(width))
    stream = Terminal()
    run(ProgressBar("course-report [tables]", stream))
    text = plain(stream.getvalue())
    assert "24,000/24,000 trials" in text
    assert "left" in text
    assert ("12/12 cells" in text) == (width >= 80)
    assert all(len(line) <= width for line in re.split(r"[\r\n]+", text))


def test_leaves_standard_output_alone(monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    before = sys.stdout
    with ProgressBar("tables", Terminal()):
        assert sys.stdout is before


def test_ends_when_the_job_fails(monkeypatch):
    monkeypatch.setenv("TERM", "xterm-256color")
    stream = Terminal()
    bar = ProgressBar("tables", stream)
    with pytest.raises(ZeroDivisionError), bar:
        raise ZeroDivisionError
    shown = stream.getvalue()
    bar.update(1, 1, 1, 1)
    assert stream.getvalue() == shown
    assert shown.rstrip().endswith("\x1b[2K") or "\x1b[?25h" in shown
