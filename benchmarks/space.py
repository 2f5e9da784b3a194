"""Initiators in space: a trial of the approach scene, and lines beside hough3d on the same points.

Run it with `python benchmarks/space.py`; it needs the extra `dev`.
"""

from __future__ import annotations

import statistics
import warnings
from functools import partial

import hough3d
import numpy as np
from measure import ratio, rounds, verdict
from numba.core.errors import NumbaPerformanceWarning
from numpy.typing import NDArray

from algorithms.context import Context, Unit
from algorithms.initiators.registry import initiator
from algorithms.parameters import validated
from algorithms.plots import PlotChunk
from scenarios.files.set_files import load_set
from scenarios.simulate import draw
from scenarios.world import World

TRIALS = 100
SEED = 1

INITIATORS = ("combinatorial-3d", "hough-logic-3d", "hough-3d")
BOUNDS = {"together": 1.0, "dense": 5.0}
"""Milliseconds a trial of `combinatorial-3d`, by scenario."""

POINTS = 100
LINES = 5
TESSELLATION = 4
LATTICE = 64
LEAST = 5
DEVIATION = 0.2


def a_trial(name: str) -> None:
    """Print how long each initiator takes for a trial of a scenario, on one core, the draw left out."""
    scenario = load_set("par-table-2").scenario(name)
    chunk = draw(World.of(scenario), SEED, 0, TRIALS).chunk
    print(f"{name}, {len(chunk.scan) / TRIALS:.0f} plots a trial")
    contenders = {}
    for known in INITIATORS:
        algorithm = initiator(known)
        parameters = algorithm.parameters().resolved(scenario.context)
        contenders[known] = partial(algorithm.initiate_chunk, chunk, scenario.context, parameters)
    seconds = rounds(contenders, count=7)
    for known, taken in seconds.items():
        print(f"  {known:16} {statistics.median(taken) / TRIALS * 1e3:8.3f} ms a trial")
    taken = statistics.median(seconds[INITIATORS[0]]) / TRIALS * 1e3
    print(f"  {INITIATORS[0]} (bound {BOUNDS[name]:g} ms: {verdict(taken, BOUNDS[name])})")


def points_on_lines() -> NDArray[np.float64]:
    """Return points, half of them on lines in a cube of 100 m, half anywhere in it."""
    random = np.random.default_rng(SEED)
    each = POINTS // (2 * LINES)
    lines = []
    for _ in range(LINES):
        ends = random.uniform(0.0, 100.0, (2, 3))
        along = np.linspace(0.0, 1.0, each)[:, None]
        lines.append(ends[0] + along * (ends[1] - ends[0]) + random.normal(scale=DEVIATION, size=(each, 3)))
    anywhere = random.uniform(0.0, 100.0, (POINTS - LINES * each, 3))
    return np.concatenate([*lines, anywhere])


def beside_hough3d() -> None:
    """Print how long both take for the lines of the same points, by as many directions and cells.

    Our call also tests the plots of each line in time, which hough3d does not: the points of a line
    are in order of scan, as a target would have flown along it.
    """
    place, scans = points_on_lines(), POINTS // (2 * LINES)
    scan = np.tile(np.arange(scans, dtype=np.int32), POINTS // scans)
    order = np.argsort(scan, kind="stable")
    noise = np.tile(DEVIATION**2 * np.eye(3), (POINTS, 1, 1))
    chunk = PlotChunk(scan[order], scan[order].astype(float), place[order], np.array([0, POINTS]), noise)
    # hough3d divides the diagonal of the box around the points.
    cell = float(np.linalg.norm(np.ptp(place, axis=0))) / LATTICE
    algorithm, context = initiator("hough-3d"), Context(scans, 1.0, unit=Unit.METRE)
    given = {"tessellation": TESSELLATION, "cell": cell, "speed_min": 0.1, "speed_max": 20.0, "plots": LEAST}
    parameters = validated(algorithm.parameters, given, "hough-3d").resolved(context)
    around = np.ascontiguousarray(hough3d.genIcosahedron(TESSELLATION))

    def ours() -> int:
        return len(algorithm.initiate_chunk(chunk, context, parameters).theta)

    def theirs() -> int:
        # It measures from the corner of a cell, so that its reach must be wider than one.
        return len(hough3d.hough3D(place, around, LATTICE, 2.0 / LATTICE, LEAST))

    print(f"{POINTS} points, {LINES} lines of {scans} and clutter, {len(around):,} directions")
    with warnings.catch_warnings():
        # Of arrays that are not contiguous, while it compiles.
        warnings.simplefilter("ignore", NumbaPerformanceWarning)
        print(f"  hough-tui: tracks found {ours()}; hough3d: lines found {theirs()}")
    seconds = rounds({"hough-tui": ours, "hough3d": theirs}, count=7)
    for name, taken in seconds.items():
        print(f"  {name:16} {statistics.median(taken) * 1e3:8.2f} ms")
    value = ratio(seconds, "hough3d", "hough-tui")
    print(f"  hough3d / hough-tui: {value:.1f} (bound 10: {verdict(value, 10.0, at_most=False)})")


if __name__ == "__main__":
    for scene in BOUNDS:
        a_trial(scene)
    beside_hough3d()
