"""Kernels from one process to the next; each `Kernel` made anew stands for another process."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from algorithms import compiled, notices
from algorithms.compiled import Kernel
from algorithms.kernel_cache import overloads
from algorithms.kernel_cache.folder import KernelFolder
from algorithms.kinematics.gates import can_fly
from algorithms.kinematics.strips import strip

PROJECT = Path(__file__).parents[3]


@pytest.fixture
def place(tmp_path, monkeypatch):
    place = tmp_path / "hough-tui" / "kernels-tests-0123456789abcdef"
    monkeypatch.setattr(compiled, "kernel_folder", lambda package: KernelFolder(place))
    monkeypatch.setattr(notices, "_notices", [])
    monkeypatch.setattr(notices, "_listeners", [])
    return place


def double(x):
    return 2 * x


def double_sum(values):
    total = 0.0
    for value in values:
        total += 2 * value
    return total


def hits(kernel):
    return sum(kernel.compiled.stats.cache_hits.values())


def test_a_kernel_is_compiled_once_for_each_type(place):
    for expected in (0, 1):
        kernel = Kernel(double)
        assert kernel(3) == 6
        assert kernel(1.5) == 3.0
        assert hits(kernel) == 2 * expected
    assert len(list(place.iterdir())) == 2


def test_a_damaged_kernel_is_compiled_again(place):
    assert Kernel(double_sum)(np.arange(4.0)) == 12
    (file,) = place.iterdir()
    whole = file.read_bytes()
    for damaged in (b"", whole[: len(whole) // 2], whole[:-9] + b"\0" + whole[-8:]):
        file.write_bytes(damaged)
        kernel = Kernel(double_sum)
        assert kernel(np.arange(4.0)) == 12
        assert hits(kernel) == 0
        again = Kernel(double_sum)
        assert again(np.arange(4.0)) == 12
        assert hits(again) == 1
    assert len(list(place.iterdir())) == 1


@pytest.mark.parametrize("body", [b"no pickle", pickle.dumps(5), pickle.dumps((1, 2, 3))])
def test_a_whole_file_of_something_else_is_replaced(place, body):
    assert Kernel(double)(3) == 6
    (file,) = place.iterdir()
    KernelFolder(place).write(file.stem, body)
    for expected in (0, 1):
        kernel = Kernel(double)
        assert kernel(3) == 6
        assert hits(kernel) == expected


def test_bounds_checks_have_kernels_of_their_own(place, monkeypatch):
    from numba import config

    assert Kernel(double)(3) == 6
    monkeypatch.setattr(config, "BOUNDSCHECK", 1)
    kernel = Kernel(double)
    assert kernel(3) == 6
    assert hits(kernel) == 0
    assert len(list(place.iterdir())) == 2


def test_another_processor_has_kernels_of_its_own(place, monkeypatch):
    assert Kernel(double)(3) == 6
    own = overloads.OverloadCache._key
    monkeypatch.setattr(overloads.OverloadCache, "_key", lambda *given: (*own(*given), "other features"))
    kernel = Kernel(double)
    assert kernel(3) == 6
    assert hits(kernel) == 0


def test_kernels_with_different_closures_differ(place):
    def scaled(factor):
        def scale(x):
            return factor * x

        return Kernel(scale)

    assert [scaled(factor)(2) for factor in (3, 5)] == [6, 10]
    assert [scaled(factor)(2) for factor in (3, 5)] == [6, 10]
    assert len(list(place.iterdir())) == 2


def test_a_kernel_for_another_kernel_is_not_kept(place):
    applied = Kernel(lambda function, x: function(x))
    assert applied(Kernel(double), 4) == 8
    assert [path.name for path in place.iterdir() if "lambda" in path.name] == []


PROGRAM = """
from algorithms import notices
from algorithms.kernel_cache.folder import kernel_folder
notices.listen(print)
from plug import triple
before = kernel_folder("plug").is_empty
print(triple(2), before, triple.compiled.stats.cache_hits.total())
"""


def test_kernels_lie_in_the_cache_and_nowhere_else(tmp_path):
    site, home = tmp_path / "site", tmp_path / "home"
    site.mkdir()
    home.mkdir()
    (site / "plug.py").write_text(
        "from algorithms.compiled import kernel\n\n\n@kernel\ndef triple(x):\n    return 3 * x\n"
    )

    def run(cache_home):
        done = subprocess.run(
            [sys.executable, "-B", "-c", PROGRAM],
            capture_output=True,
            text=True,
            cwd=tmp_path,
            env={
                **os.environ,
                "PYTHONPATH": os.pathsep.join([str(site), str(PROJECT)]),
                "XDG_CACHE_HOME": cache_home,
                "HOME": str(home),
            },
        )
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout.splitlines()

    # A relative folder is none of the user's choice, but of whoever made the folder that they are in.
    assert run("relative") == ["6 True 0"]
    assert run("relative") == ["6 False 1"]
    (tmp_path / "file").touch()
    told, value = run(str(tmp_path / "file"))
    assert "cannot be kept" in told
    assert value == "6 True 0"
    assert {path.parent for path in tmp_path.rglob("*.nbc")} == {*(home / ".cache/hough-tui").iterdir()}
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "home", "site"]
    assert [path.name for path in site.iterdir()] == ["plug.py"]


def test_kernels_made_around_different_kernels_have_different_names():
    # numba names machine code after the function; of one name, the code of one would run for both.
    def around(inner):
        def call(x):
            return inner(x)

        return Kernel(call)

    names = {around(inner).name for inner in (can_fly, strip)}
    assert len(names) == 2
    assert {around(inner).name for inner in (can_fly, strip)} == names
    assert pickle.loads(pickle.dumps(can_fly)) is can_fly
