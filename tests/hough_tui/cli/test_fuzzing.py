"""Mutated sets and CSV files through the command line: a small part of `python -m benchmarks.fuzzing`."""

import pytest

from benchmarks.fuzzing.cases import make_case
from benchmarks.fuzzing.faults import faults
from benchmarks.fuzzing.watch import Watch

TIMED = ("slow", "deaf")
"""Faults that a busy machine, or a kernel that is compiled, may cause."""


@pytest.fixture(scope="module")
def watch():
    with Watch() as watched:
        yield watched


def faults_of(watch, name):
    case = make_case(name)
    watch.write(case.file, case.content)
    for arguments in case.commands:
        for fault in faults(watch.run(arguments, longest=300.0)):
            if not fault.startswith(TIMED):
                yield f"{name}: {' '.join(arguments)}: {fault}"


@pytest.mark.parametrize("seed", range(0, 44, 2))
def test_mutated_set_is_run_or_refused(watch, seed):
    assert not list(faults_of(watch, f"sets:{seed}"))


@pytest.mark.parametrize("seed", range(20, 52, 4))
def test_mutated_table_is_run_or_refused(watch, seed):
    assert not list(faults_of(watch, f"tables:{seed}"))
