"""What answers at once loads no heavy module."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]

HEAVY = {
    "numba",
    "llvmlite",
    "numpy",
    "scipy",
    "textual",
    "plotext",
    "yaml",
    "algorithms",
    "scenarios",
}

# Run a command line in this process and tell which top-level modules it has loaded in the end.
LOADED = """
import sys
from hough_tui.cli import main
if len(sys.argv) > 1:
    try:
        main()
    except SystemExit as ended:
        assert not ended.code, ended.code
print(*sorted({name.partition(".")[0] for name in sys.modules}), file=sys.stderr)
"""


def loaded(*arguments: str) -> tuple[set[str], str]:
    """Return the top-level modules that a command loads, and what it prints."""
    done = subprocess.run(
        [sys.executable, "-c", LOADED, *arguments],
        capture_output=True,
        text=True,
        cwd=PROJECT,
        env={**os.environ, "COLUMNS": "100"},
        check=True,
    )
    return set(done.stderr.splitlines()[-1].split()), done.stdout


def test_the_command_line_itself_imports_nothing_heavy():
    modules, out = loaded()
    assert out == ""
    assert "typer" in modules
    assert not modules & (HEAVY | {"pydantic", "rich"})


def test_help_imports_nothing_heavy():
    modules, out = loaded("--help")
    for command in ("batch", "initiate", "simulate", "advise", "reproduce", "sets", "initiators", "results"):
        assert command in out
    assert not modules & (HEAVY | {"pydantic"})


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["batch", "--help"], ["--trials", "--workers", "--json"]),
        (["initiate", "-h"], ["--initiator", "--accumulator"]),
        (["advise", "--help"], ["--check", "--apply"]),
        (["sets", "--help"], ["--json"]),
        (["results", "--help"], ["list", "show"]),
    ],
    ids=" ".join,
)
def test_the_help_of_a_command_imports_nothing_heavy(arguments, words):
    modules, out = loaded(*arguments)
    for word in words:
        assert word in out
    # pydantic is not among these: typer itself loads it for the options of a command.
    assert not modules & HEAVY


def test_the_version_imports_nothing_heavy():
    modules, out = loaded("--version")
    assert out.startswith("hough-tui ")
    assert not modules & (HEAVY | {"pydantic", "rich"})


def test_listing_sets_loads_no_screen():
    modules, out = loaded("sets")
    assert "course-report" in out
    assert not modules & {"textual", "plotext"}
