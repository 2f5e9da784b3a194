"""What the frame of the application loads, and who may load what."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[3]
HEAVY = {"llvmlite", "numba", "numpy", "plotext", "pydantic", "scipy", "textual_plotext", "yaml"}


def loaded(program: str) -> set[str]:
    """Return the top-level modules that a program has loaded in the end."""
    done = subprocess.run(
        [sys.executable, "-c", f"{program}\nimport sys\nprint(*sys.modules)"],
        capture_output=True,
        text=True,
        cwd=PROJECT,
        check=True,
    )
    return {name.partition(".")[0] for name in done.stdout.split()}


def test_the_frame_is_painted_before_anything_heavy_is_loaded():
    found = loaded("import hough_tui.ui.app")
    assert "textual" in found
    assert found & HEAVY == set()


def test_the_screens_of_the_frame_load_nothing_heavy_to_be_made():
    program = """
from hough_tui.ui.app import HoughApp
from hough_tui.ui.config import read_config
HoughApp("course-report", read_config())
"""
    assert loaded(program) & HEAVY == set()


COMPILER = {"llvmlite", "numba", "scipy"}
READING = """
import hough_tui.ui.views.scenario
from scenarios.files.set_files import load_set
given = load_set("course-report")
"""
DRAWING = """
from hough_tui.inspection.trial import picture
picture(given.scenarios[0], 1, 0)
"""


def test_a_set_is_read_and_its_form_is_made_before_the_compiler_is_loaded():
    assert loaded(READING) & COMPILER == set()


def test_the_tests_of_this_can_fail():
    found = loaded(READING + DRAWING)
    assert {"numpy", "pydantic", "numba", "llvmlite"} <= found


def imported(source: str) -> set[str]:
    """Return the modules that a file imports anywhere in it, whole names."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


def belongs(name: str, package: str) -> bool:
    return name == package or name.startswith(f"{package}.")


SOURCES = sorted(
    path.relative_to(PROJECT)
    for package in ("algorithms", "scenarios", "hough_tui")
    for path in (PROJECT / package).rglob("*.py")
)


def test_only_the_application_imports_textual():
    ui = Path("hough_tui", "ui")
    importers = {
        path
        for path in SOURCES
        if any(
            belongs(name, package)
            for name in imported((PROJECT / path).read_text(encoding="utf-8"))
            for package in ("textual", "textual_plotext")
        )
    }
    assert importers
    assert {path for path in importers if not path.is_relative_to(ui)} == set()


@pytest.mark.parametrize("package", ["hough_tui.ui", "hough_tui.cli"])
def test_nothing_below_imports_the_application(package):
    above = [Path("hough_tui", name) for name in ("ui", "cli", "__main__.py")]
    wrong = [
        path
        for path in SOURCES
        if not any(path.is_relative_to(place) for place in above)
        and any(belongs(name, package) for name in imported((PROJECT / path).read_text(encoding="utf-8")))
    ]
    assert wrong == []


def test_imports_are_found_wherever_they_stand():
    source = "def f():\n    if g():\n        from textual import work\n    import textual.app as a\n"
    assert {"textual", "textual.work", "textual.app"} <= imported(source)
