"""Loading the kernels before they are first wanted."""

from __future__ import annotations

from algorithms.association import with_states
from algorithms.context import Box, Context
from algorithms.initiators.base import ChunkInitiator
from algorithms.initiators.registry import initiators
from algorithms.scoring import Criterion, score
from scenarios.model import CartesianSensor, PoissonClutter, Region, Scenario, Target
from scenarios.simulate import draw, truth
from scenarios.world import World


def warm() -> None:
    """Load, or compile, the kernels of drawing, of every compiled initiator, and of scoring."""
    scenario = Scenario(
        name="warm",
        scans=3,
        interval=1.0,
        region=Region(x=(0.0, 10.0), y=(0.0, 10.0)),
        sensor=CartesianSensor(sigma=0.1),
        clutter=[PoissonClutter(rate=2.0)],
        targets=[Target(position=(1.0, 1.0), velocity=(0.1, 0.1))],
    )
    context = Context(3, 1.0, sigma=(0.1, 0.1), region=Box((0.0, 0.0), (10.0, 10.0)))
    drawn = draw(World.of(scenario), 1, 0)
    known = truth(scenario, drawn)
    for algorithm in initiators().values():
        if not isinstance(algorithm, ChunkInitiator):
            continue
        parameters = algorithm.parameters.model_validate({}).resolved(context)
        tracks = algorithm.initiate_chunk(drawn.chunk, context, parameters)
        tracks = algorithm.associate_chunk(drawn.chunk, tracks, context, parameters)
        with_states(drawn.chunk.trial(0), tracks)
        algorithm.accumulator(drawn.chunk.trial(0), context, parameters)
        for criterion in (Criterion(rho=1.0), Criterion(plots=2)):
            score(tracks, known, drawn.chunk.offsets, criterion)
