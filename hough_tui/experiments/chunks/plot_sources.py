"""Where the plots of a chunk of trials come from: drawn as plots, or made of points, in several ways."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TypeVar

from scenarios.detections import PointDraw, ResolvedWorld, draw_points
from scenarios.entries import ClusteringEntry, WithoutClustering
from scenarios.front_end import clustered, every_point
from scenarios.model import Scenario
from scenarios.simulate import Draw, draw
from scenarios.sweeps import Stage
from scenarios.world import World

Made = TypeVar("Made")


def stage_key(stage: Stage) -> str:
    """Return what decides the plots that a stage makes: its parameters, not its name."""
    if stage is None:
        return ""
    return (stage.parameters if isinstance(stage, ClusteringEntry) else stage).model_dump_json()


class PlotChunks(ABC):
    """The plots of one chunk of trials, by stage; each is made when it is asked for, and once."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[Draw, float]] = {}
        self._controls: dict[str, Draw] = {}

    def plots(self, stage: Stage) -> tuple[Draw, float]:
        """Return the plots of a stage, and the processor time that they take."""
        key = stage_key(stage)
        if key not in self._made:
            self._made[key] = self._make(stage)
        return self._made[key]

    def control(self, stage: Stage) -> Draw:
        """Return the plots of a stage with the targets taken out of the draw."""
        key = stage_key(stage)
        if key not in self._controls:
            self._controls[key] = self._make_control(stage)
        return self._controls[key]

    @abstractmethod
    def _make(self, stage: Stage) -> tuple[Draw, float]: ...

    @abstractmethod
    def _make_control(self, stage: Stage) -> Draw: ...


class PlotSource(ABC):
    """What draws chunks of a scenario's trials."""

    @abstractmethod
    def chunk(self, seed: int, first: int, trials: int) -> PlotChunks:
        """Return the plots of consecutive trials."""


class _DrawnPlots(PlotChunks):
    def __init__(self, world: World, seed: int, first: int, trials: int) -> None:
        super().__init__()
        self._given = world, seed, first, trials

    def _make(self, stage: Stage) -> tuple[Draw, float]:
        return _timed(lambda: draw(*self._given))

    def _make_control(self, stage: Stage) -> Draw:
        return self.plots(stage)[0].without_targets()


class _PointPlots(PlotChunks):
    def __init__(self, resolved: ResolvedWorld, seed: int, first: int, trials: int) -> None:
        super().__init__()
        self._resolved, self._given = resolved, (seed, first, trials)
        self._points: dict[bool, tuple[PointDraw, float]] = {}

    def _make(self, stage: Stage) -> tuple[Draw, float]:
        points, drawing = self._drawn(stage)
        plots, seconds = _timed(lambda: points_as_plots(self._resolved, points, stage))
        return plots, drawing + seconds

    def _make_control(self, stage: Stage) -> Draw:
        return points_as_plots(self._resolved, self._drawn(stage)[0].without_targets(), stage)

    def _drawn(self, stage: Stage) -> tuple[PointDraw, float]:
        ideal = is_ideal(stage)
        if ideal not in self._points:
            world = self._resolved.ideal() if ideal else self._resolved
            self._points[ideal] = _timed(lambda: draw_points(world, *self._given))
        return self._points[ideal]


class _OfPlots(PlotSource):
    def __init__(self, scenario: Scenario) -> None:
        self._world = World.of(scenario)

    def chunk(self, seed: int, first: int, trials: int) -> PlotChunks:
        return _DrawnPlots(self._world, seed, first, trials)


class _OfPoints(PlotSource):
    def __init__(self, scenario: Scenario) -> None:
        self._resolved = ResolvedWorld.of(scenario)

    def chunk(self, seed: int, first: int, trials: int) -> PlotChunks:
        return _PointPlots(self._resolved, seed, first, trials)


def plot_source(scenario: Scenario) -> PlotSource:
    """Return what draws the plots of a scenario."""
    return _OfPoints(scenario) if scenario.is_resolved else _OfPlots(scenario)


def is_ideal(stage: Stage) -> bool:
    """Return whether each target is seen as one point."""
    return isinstance(stage, WithoutClustering) and stage.name == "ideal"


def points_as_plots(resolved: ResolvedWorld, points: PointDraw, stage: Stage) -> Draw:
    """Return what a stage makes of points; without one, every point is a plot."""
    if isinstance(stage, ClusteringEntry):
        return clustered(resolved, points, stage.parameters)
    return every_point(resolved, points)


def plots_of(scenario: Scenario, seed: int, trial: int, stage: Stage = None) -> Draw:
    """Return the plots of one trial, whether they are drawn or made of points."""
    return plot_source(scenario).chunk(seed, trial, 1).plots(stage)[0]


def _timed(make: Callable[[], Made]) -> tuple[Made, float]:
    began = time.thread_time()
    made = make()
    return made, time.thread_time() - began
