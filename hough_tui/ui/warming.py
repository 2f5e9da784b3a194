"""Loading the kernels before they are first wanted."""

from __future__ import annotations

from pydantic import ValidationError

from algorithms.errors import RequestError, WorkFailedError
from algorithms.initiators.base import ChunkInitiator
from algorithms.initiators.registry import initiators
from algorithms.scoring.matching import Criterion, score
from scenarios.clutter import PoissonClutter, Region
from scenarios.model import Scenario, ScenarioSet
from scenarios.sensors import CartesianSensor
from scenarios.simulate import draw, truth
from scenarios.targets import Target
from scenarios.world import World


def warm(given: ScenarioSet) -> None:
    """Load, or compile, all kernels, and first those that a set has use for."""
    found = {scenario.dimensions for scenario in given.scenarios}
    parts = {warm_plane: 2 in found, warm_space: 3 in found, warm_clustering: bool(given.scenes)}
    for part in sorted(parts, key=lambda part: not parts[part]):
        part()
    _warm_prediction(_scene(dimensions=2))


def warm_plane() -> None:
    """Load the kernels of draws, of the initiators and of scoring in the plane."""
    _warm_initiators(_scene(dimensions=2))


def warm_space() -> None:
    """Load the kernels of draws, of the initiators and of scoring in space."""
    _warm_initiators(_scene(dimensions=3))


def _scene(dimensions: int) -> Scenario:
    """Return the smallest scene that has everything: a target, noise, clutter, a region."""
    return Scenario(
        name="warm",
        scans=3,
        interval=1.0,
        region=Region(**{axis: (0.0, 10.0) for axis in "xyz"[:dimensions]}),
        sensor=CartesianSensor(sigma=0.1),
        clutter=[PoissonClutter(rate=2.0)],
        targets=[Target(position=(1.0,) * dimensions, velocity=(0.1,) * dimensions)],
    )


def warm_clustering() -> None:
    """Load the kernels of scenes and of clustering."""
    from algorithms.clustering.parameters import Recommended
    from hough_tui.inspection.scene import cluster_look, scene_picture
    from scenarios.scenes import ExtendedTarget, Scene, SceneRegion

    scene = Scene(
        name="warm",
        region=SceneRegion(range=(0.0, 10.0), doppler=(0.0, 10.0)),
        targets=[ExtendedTarget(range=5.0, doppler=5.0)],
    )
    parameters = Recommended(range_extent=16.0, doppler_extent=12.0)
    cluster_look(scene_picture(scene, 1, 0), "warm", parameters)


def _warm_initiators(scenario: Scenario) -> None:
    """Run every compiled initiator that works in the dimensions of a scene, and score it."""
    context = scenario.context
    drawn = draw(World.of(scenario), 1, 0)
    known = truth(scenario, drawn)
    for algorithm in initiators().values():
        if not isinstance(algorithm, ChunkInitiator) or algorithm.dimensions != scenario.dimensions:
            continue
        try:
            parameters = algorithm.parameters.model_validate({}).resolved(context)
            tracks = algorithm.tracks_of_chunk(drawn.chunk, context, parameters, plots=True, states=True)
            algorithm.accumulator(drawn.chunk.trial(0), context, parameters)
        except (RequestError, WorkFailedError, ValidationError):
            # A plug-in may want more than this scene has, or fail: nobody asked for it yet.
            continue
        for criterion in (Criterion(rho=1.0), Criterion(plots=2)):
            score(tracks, known, drawn.chunk.offsets, criterion)


def _warm_prediction(scenario: Scenario) -> None:
    """Load what predictions need, and measure what votes cost: last, since it is wanted last."""
    from hough_tui.quantisation.forecast import recommendation
    from hough_tui.quantisation.vote_cost import vote_cost

    for is_weighted in (False, True):
        vote_cost(is_weighted)
    recommendation(scenario, 1.0)
