"""The harness of fuzzing: cases repeat, faults are seen, a lost worker costs its own command only."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.fuzzing.cases import make_case
from benchmarks.fuzzing.faults import faults
from benchmarks.fuzzing.watch import LONGEST, MOST_MEMORY, Outcome, Watch

TRACEBACK = b"""Traceback (most recent call last):
  File "/somewhere/algorithms/hough/grid.py", line 7, in span
ValueError: no
"""


def test_case_repeats_in_another_process():
    names = [f"{kind}:{seed}" for kind in ("sets", "tables") for seed in range(8)]
    program = "import sys; from benchmarks.fuzzing.cases import make_case\n"
    program += "for name in sys.argv[1:]: print(make_case(name))"
    environment = {**os.environ, "PYTHONHASHSEED": "5", "PYTHONPATH": str(Path(__file__).parents[2])}
    command = [sys.executable, "-c", program, *names]
    printed = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
    assert printed.splitlines() == [str(make_case(name)) for name in names]
    assert len(set(printed.splitlines())) == len(names)


def outcome(**changed):
    usual = {
        "arguments": ("batch", "case.yaml"),
        "status": 0,
        "out": b"",
        "err": b"",
        "seconds": 1.0,
        "peak": 1,
    }
    return Outcome(**{**usual, **changed})


FAULTS = {
    "crash": {"status": -11},
    "hang": {"status": None, "ending": 20.0},
    "deaf": {"status": 130, "ending": 3.0, "seconds": LONGEST + 1, "err": b"hough-tui: takes about 40 s"},
    "slow": {"status": 130, "ending": 0.2, "seconds": LONGEST + 1, "err": b"hough-tui: interrupted"},
    "traceback": {"status": 1, "err": TRACEBACK},
    "warning": {"err": b"/x/grid.py:7: RuntimeWarning: overflow encountered in multiply\n  a * b\n"},
    "words": {"status": 2, "err": b"hough-tui: case.yaml:1:1: Input should be a valid list\n"},
    "memory": {"peak": MOST_MEMORY + 1},
    "control": {"out": b"a\x1b[31m"},
    "status": {"status": 1, "err": b"hough-tui: case.yaml: no\n"},
    "output": {"status": 2, "out": b"{}", "err": b"hough-tui: case.yaml: no\n"},
    "silent": {"status": 2},
    "placeless": {"status": 2, "err": b"hough-tui: must be less\n"},
    "json": {"arguments": ("batch", "case.yaml", "--json"), "out": b'{"rate": NaN}'},
}


@pytest.mark.parametrize("kind", FAULTS)
def test_fault_is_seen(kind):
    assert [fault.partition(":")[0] for fault in faults(outcome(**FAULTS[kind]))] == [kind]


@pytest.mark.parametrize(
    "well",
    [
        {"out": b"a table\n"},
        {"status": 2, "err": b"hough-tui: case.yaml:3:5: scans: 0 is given; it must be at least 1\n"},
        {"status": 130, "ending": 0.3, "seconds": LONGEST + 1, "err": b"hough-tui: this takes about 40 s\n"},
    ],
)
def test_good_outcome_has_no_fault(well):
    assert not list(faults(outcome(**well)))


PROGRAM = """
import os, sys, time
def main():
    what = sys.argv[1]
    if what == "crash":
        os.abort()
    if what == "loop":
        while True:
            time.sleep(0.01) if len(sys.argv) > 2 else None
    if what == "fill":
        kept = []
        while True:
            kept.append(bytes(b"a" * 2**24))
    print(what)
    sys.exit(2 if what == "refuse" else 0)
"""


@pytest.fixture
def watch(tmp_path):
    (tmp_path / "program.py").write_text(PROGRAM)
    with Watch(tmp_path, "program:main", deadly=2**27) as watched:
        yield watched


def test_lost_worker_costs_its_own_command(watch):
    first = [watch.run((what,)) for what in ("fine", "crash", "refuse", "fill", "fine")]
    assert [one.status for one in first] == [0, -6, 2, None, 0]
    assert [one.out for one in first] == [b"fine\n", b"", b"refuse\n", b"", b"fine\n"]
    assert first[3].peak > 2**27
    assert b"in main" in first[1].err


def test_late_command_is_interrupted(watch):
    late = watch.run(("loop",), longest=0.3)
    assert late.status == 1
    assert late.ending is not None
    assert b"KeyboardInterrupt" in late.err
