"""Every kernel stays within its arrays, whatever the numbers that it is called with."""

import ast
import inspect
import os
import runpy
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

from algorithms.kernel_cache.folder import kernel_folder
from algorithms.rounding import FARTHEST, floored

ROOT = Path(__file__).parents[1]

CHECKED = {"NUMBA_BOUNDSCHECK": "1", "NUMBA_OPT": "0"}
"""Code that checks every index; not optimised, it is compiled in a fraction of the time."""

CONVERSIONS = {"int", "round", "math.floor", "math.ceil", "int32", "int64", "uint32", "uint64"}
"""What makes a whole number of a float in a kernel."""

BOUNDED = {"floored", "vote", "vote_with_moments", "column_of"}
"""The kernels that bound a float themselves, in a loop in which a call would cost too much."""

WHOLE = {"scan", "accumulator", "columns", "least_votes", "block", "source", "trial"}
"""The names that hold whole numbers, so that a conversion only widens them."""


def run(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **CHECKED, "XDG_CACHE_HOME": str(folder), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-X", "faulthandler", *arguments]
    return subprocess.run(command, env=environment, capture_output=True, text=True, cwd=ROOT)


@pytest.fixture(scope="module")
def kernels():
    return runpy.run_path(str(ROOT / "tests" / "kernel_cases.py"))["kernels"]()


def test_no_kernel_leaves_its_arrays(kernels, tmp_path):
    done = run("tests/kernel_cases.py", folder=tmp_path)
    assert done.returncode == 0, done.stderr[-4000:]
    missing = sorted(set(kernels) - set(done.stdout.split()))
    assert not missing, f"no case of tests/kernel_cases.py calls {', '.join(missing)}"


def test_an_index_beyond_its_array_is_seen(tmp_path):
    program = tmp_path / "faulty.py"
    program.write_text(
        "import numpy as np\n"
        "from algorithms.compiled import kernel\n"
        "@kernel\n"
        "def last(values, index):\n"
        "    return values[index]\n"
        "last.__module__ = 'algorithms.faulty'\n"
        "print(last(np.zeros(3), 3))\n"
    )
    done = run(str(program), folder=tmp_path)
    assert done.returncode == 1
    assert "IndexError" in done.stderr


def test_checked_code_is_kept_apart(monkeypatch):
    monkeypatch.delenv("NUMBA_BOUNDSCHECK", raising=False)
    plain = kernel_folder.__wrapped__().path
    monkeypatch.setenv("NUMBA_BOUNDSCHECK", "1")
    assert kernel_folder.__wrapped__().path != plain


def conversions(function) -> list[str]:
    """Return the calls in a kernel that may make a whole number of a float."""
    found = []
    for node in ast.walk(ast.parse(textwrap.dedent(inspect.getsource(function)))):
        if not isinstance(node, ast.Call) or ast.unparse(node.func).removeprefix("np.") not in CONVERSIONS:
            continue
        names = {part.id for part in ast.walk(node.args[0]) if isinstance(part, ast.Name)}
        if not (isinstance(node.args[0], ast.Constant | ast.UnaryOp | ast.Compare) or names & WHOLE):
            found.append(ast.unparse(node))
    return found


def test_kernels_bound_floats_before_converting(kernels):
    found = {
        name: calls
        for name, kernel in kernels.items()
        if (calls := conversions(kernel.function)) and kernel.__name__ not in BOUNDED
    }
    assert not found, f"use algorithms.rounding.floored: {found}"


@pytest.mark.parametrize(
    ("value", "whole"),
    [
        (2.9, 2), (-0.5, -1), (0.0, 0), (5e-324, 0), (-5e-324, -1), (FARTHEST - 1.0, 2**53 - 1),
        (1e300, 2**53), (-1e300, -(2**53)), (np.inf, 2**53), (-np.inf, -(2**53)), (np.nan, -(2**53)),
    ],
)  # fmt: skip
def test_floats_are_floored_within_bounds(value, whole):
    assert floored(value) == whole
