"""The command line in this process."""

from collections.abc import Callable
from pathlib import Path

import pytest

from hough_tui.cli import run as run_command

Cli = Callable[..., tuple[int, str, str]]

GRID = "{theta_bins: 1800, rho_min: -150, rho_step: 0.1, rho_bins: 4000}"
SEARCH = f"maxima: 100000000, suppress_theta: 0, suppress_rho: 0, grid: {GRID}"
ENDLESS = f"{{name: endless, initiator: sequential, {SEARCH}}}"

LONG_SET = f"""\
schema: 1
name: long
scenarios:
  - name: crowd
    scans: 3
    interval: 4
    region: {{x: [0, 100], y: [0, 100]}}
    sensor: {{sigma: 0.1}}
    clutter: [{{rate: 500}}]
    targets: [{{position: [40, 20], velocity: [0.3, 0.18]}}]
initiators:
  - {{name: standard, votes: 30, grid: {{theta_bins: 90, rho_min: -150, rho_step: 0.6, rho_bins: 1000}}}}
  - {ENDLESS}
experiments:
  - {{name: long, trials: 20, seed: 3, criterion: {{plots: 2}}}}
"""


@pytest.fixture
def long_set(tmp_path: Path) -> Path:
    """A set of two cells: each trial of the first is soon done, and none of the second ever."""
    path = tmp_path / "long.yaml"
    path.write_text(LONG_SET)
    return path


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
