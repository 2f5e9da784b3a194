"""A whole trial beside its voting, and the engine on one worker and on two.

Run it with `python benchmarks/trials.py`.
"""

from __future__ import annotations

import statistics
from functools import partial

import numpy as np
from measure import ratio, rounds, verdict

from algorithms.hough.voting import GridArrays, vote
from algorithms.initiators.registry import initiator
from algorithms.scoring.matching import score
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from scenarios.files.set_files import load_set
from scenarios.simulate import draw, truth
from scenarios.world import World

TRIALS = 200


def whole_trial() -> None:
    """Print a trial of `standard` at 15 scans (draw, vote, peaks, score) by its voting alone."""
    given = load_set("course-report")
    scenario, entry = given.scenario("two-crossing"), given.entry("standard")
    context, criterion = scenario.context, given.experiments[0].criterion.value
    parameters = entry.parameters.resolved(context)
    grid = parameters.grid.grid(context)
    world = World.of(scenario)
    drawn = draw(world, 7, 0, TRIALS)
    arrays = GridArrays.of(grid)
    accumulator, working = arrays.accumulator(), np.empty(drawn.chunk.largest, np.int32)
    columns = [np.ascontiguousarray(drawn.chunk.position[:, axis]) for axis in (0, 1)]

    def voting() -> None:
        for first, end in zip(drawn.chunk.offsets[:-1], drawn.chunk.offsets[1:], strict=True):
            x, y = (column[first:end] for column in columns)
            vote(x, y, arrays, accumulator, working)

    def trial() -> None:
        found = draw(world, 7, 0, TRIALS)
        tracks = entry.algorithm.initiate_chunk(found.chunk, context, parameters)
        score(tracks, truth(scenario, found), found.chunk.offsets, criterion)

    seconds = rounds({"voting": voting, "whole trial": trial})
    for name, times in seconds.items():
        print(f"  {name:12} {statistics.median(times) / TRIALS * 1e6:6.1f} µs a trial")
    value = ratio(seconds, "whole trial", "voting")
    print(f"  whole trial / voting: {value:.2f} (bound 3: {verdict(value, 3)})")


def weighted() -> None:
    """Print the time of `weighted` alone on the 15-scan scene, by default parameters on the course's grid."""
    given = load_set("course-report")
    scenario, grid = given.scenario("two-crossing"), given.entry("standard").parameters.grid
    algorithm, context = initiator("weighted"), scenario.context
    chunk = draw(World.of(scenario), 7, 0, TRIALS).chunk
    for mode in ("several", "single"):
        parameters = algorithm.parameters.model_validate({"mode": mode, "grid": grid}).resolved(context)
        times = rounds({mode: partial(algorithm.initiate_chunk, chunk, context, parameters)}, count=5)[mode]
        value = statistics.median(times) / TRIALS * 1e3
        print(f"  {mode:12} {value:6.3f} ms a trial (bound 1: {verdict(value, 1.0)})")


def engine() -> None:
    """Print (cell, trial) pairs a second of the set `course-report`, and what a second worker gives."""
    # The sound experiment scores tracks that are found already, so it would flatter the figure.
    plan = plan_run([load_set("course-report")], experiments=["tables", "modified"], trials=5_000)

    def run(workers: int) -> None:
        Job(plan, workers).wait()

    seconds = rounds({"1 worker": partial(run, 1), "2 workers": partial(run, 2)}, count=5, at_least=0.0)
    rates = {name: plan.trials / statistics.median(times) for name, times in seconds.items()}
    for name, rate in rates.items():
        print(f"  {name:12} {rate:10,.0f} pairs a second, control included")
    print(
        f"  pairs a second on two workers (bound 8,000: {verdict(rates['2 workers'], 8_000, at_most=False)})"
    )
    value = ratio(seconds, "1 worker", "2 workers")
    print(f"  two workers / one: {value:.2f} (bound 1.7: {verdict(value, 1.7, at_most=False)})")


if __name__ == "__main__":
    print("standard, 15 scans, λ = 50")
    whole_trial()
    print("weighted, 15 scans, λ = 50")
    weighted()
    print("course-report, 9 cells")
    engine()
