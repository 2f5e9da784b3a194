"""The command line in this process."""

from collections.abc import Callable
from pathlib import Path

import pytest

from hough_tui.cli import run as run_command

Cli = Callable[..., tuple[int, str, str]]


@pytest.fixture
def cli(data_home: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Cli:
    """Run a command; return its exit status, what it printed and what it said, but of compilations."""

    def run(*arguments: object) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            run_command([*map(str, arguments)])
        out, err = capsys.readouterr()
        said = [line for line in err.splitlines(True) if not line.startswith("hough-tui: compiling")]
        return ended.value.code or 0, out, "".join(said)

    return run
