"""Cases: a mutated file and the commands that read it, made from a kind and a seed alone."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from algorithms.clustering.parameters import MODES
from algorithms.initiators.registry import initiators
from benchmarks.fuzzing.sets import mutated_set, seed_sets
from benchmarks.fuzzing.tables import PLOTS, mutated_table, points


@dataclass(frozen=True, slots=True)
class Case:
    """A mutated file and the commands that read it.

    Attributes
    ----------
    name : kind and seed, such as `sets:1234`
    file : what the commands call the file
    content : its bytes
    commands : arguments of hough-tui
    """

    name: str
    file: str
    content: bytes
    commands: tuple[tuple[str, ...], ...]


def make_case(name: str) -> Case:
    """Return the case of a name, `sets:SEED` or `tables:SEED`."""
    kind, _, seed = name.partition(":")
    if kind not in KINDS or not seed.isdecimal():
        raise SystemExit(f"{name}: a case is {' or '.join(f'{known}:SEED' for known in KINDS)}")
    return KINDS[kind](random.Random(name), name)


def _set_case(dice: random.Random, name: str) -> Case:
    content = mutated_set(dice)
    shown: tuple[str, ...] = dice.choice(((), (), ("--json",), ("--csv", "-"), ("--plot",)))
    batch = ("batch", "case.yaml", "--trials", "2", *shown)
    return Case(name, "case.yaml", content, (("validate", "case.yaml"), batch))


def _table_case(dice: random.Random, name: str) -> Case:
    content = mutated_table(dice)
    sensor = dice.choice(SENSORS)
    shown: tuple[str, ...] = dice.choice(((), (), ("--json",), ("--json",), ("--plot",)))
    initiate = [("initiate", "case.csv", "-i", known, *sensor, *shown) for known in sorted(initiators())]
    clustering = ("--mode", dice.choice(tuple(MODES)), *dice.choice(EXTENTS))
    number = ("--set", f"number={dice.choice((1, 2, 5))}") if "k-means" in clustering else ()
    further = dice.choice(((), ("--json",), ("--csv", "-"), ("--plot",), ("--json", "--xy")))
    return Case(
        name, "case.csv", content, (*initiate, ("cluster", "case.csv", *clustering, *number, *further))
    )


def warm_cases() -> Iterator[Case]:
    """Yield cases that are not mutated and call every kernel, so that later ones find them compiled."""
    for index, data in enumerate(seed_sets()):
        content = json.dumps(data).encode()
        yield Case(f"warm:{index}", "case.yaml", content, (("batch", "case.yaml", "--trials", "2"),))
    dice = random.Random("warm")
    content = "".join(",".join(cells) + "\n" for cells in PLOTS(dice)).encode()
    names = sorted(initiators())
    initiate = (("initiate", "case.csv", "-i", name, "--sigma", "0.1", "--plot") for name in names)
    yield Case("warm:plots", "case.csv", content, tuple(initiate))
    content = "".join(",".join(cells) + "\n" for cells in points(dice)).encode()
    extents = (*EXTENTS[0], "--set", "number=2")
    cluster = (
        ("cluster", "case.csv", "--mode", mode, *extents[: 6 if mode == "k-means" else 4]) for mode in MODES
    )
    yield Case("warm:points", "case.csv", content, tuple(cluster))


SENSORS: tuple[tuple[str, ...], ...] = (
    *((),) * 2,
    *(("--sigma", "0.1", "--unit", "m"),) * 2,
    ("--sigma", "0.1"),
    ("--sigma", "0.1", "--region", "0,10,0,10"),
    ("--sigma", "50", "--unit", "m", "--interval", "1"),
    ("--interval", "4"),
    ("--pd", "0.9", "--sigma", "0"),
    ("--like", "course-report:two-crossing"),
    ("--like", "par-table-2:T1"),
    ("--scans", "0:5"),
    ("--most", "3"),
    ("--sigma", "1e160"),
    ("--sigma", "1e-320"),
    ("--region=-1e300,1e300,-1e300,1e300", "--sigma", "1"),
    ("--interval", "1e308"),
    ("--interval", "1e-320"),
)
"""Options of the sensor that all initiators of a case get."""

EXTENTS: tuple[tuple[str, ...], ...] = (
    *(("--range-extent", "16", "--doppler-extent", "12"),) * 4,
    ("--range-extent", "16"),
    ("--range-extent", "1e-12", "--doppler-extent", "1e-12"),
    ("--range-extent", "1e160", "--doppler-extent", "1e160"),
    ("--range-extent", "16", "--doppler-extent", "12", "--doppler-span", "64"),
    ("--range-extent", "16", "--doppler-extent", "12", "--doppler-span", "1e-300"),
)

KINDS: dict[str, Callable[[random.Random, str], Case]] = {"sets": _set_case, "tables": _table_case}
