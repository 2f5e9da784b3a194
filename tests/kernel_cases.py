"""Every kernel, called with numbers at their bounds and far beyond; a program, run by `test_kernels.py`.

It prints the kernels that it reached. With `NUMBA_BOUNDSCHECK=1` an index beyond its array ends it.
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

import algorithms
import scenarios
from algorithms.association import associate
from algorithms.clustering.circle import cut_open
from algorithms.clustering.clusters import Conclusion, Sets, conclude
from algorithms.clustering.points import Points
from algorithms.clustering.scoring import score_clusters
from algorithms.clustering.splitting import Rule, split
from algorithms.compiled import Kernel
from algorithms.context import Box, Context
from algorithms.errors import RequestError
from algorithms.hough.grid import Grid
from algorithms.hough.peaks.registry import EXTRACTIONS
from algorithms.hough.search import search
from algorithms.hough.weighting import Weighting
from algorithms.initiators.registry import initiators
from algorithms.kinematics.constant_velocity import ConstantVelocity, start_from_pair
from algorithms.kinematics.kalman import Estimate, predicted, updated
from algorithms.kinematics.matrices import PLANE
from algorithms.kinematics.measured import Measured
from algorithms.kinematics.states import with_states
from algorithms.plots import PlotChunk
from algorithms.quantisation.home_cell import COARSE, home_votes
from algorithms.quantisation.measurement import count_cells
from algorithms.scoring.gospa import gospa
from algorithms.scoring.kinematics import kinematic_errors
from algorithms.scoring.matching import Criterion, Truth, score
from algorithms.target_states import TargetStates
from scenarios.conversion import converted
from scenarios.detections import ResolvedWorld, draw_points
from scenarios.front_end import every_point
from scenarios.model import Scenario
from scenarios.range_doppler import draw_scene
from scenarios.scenes import Scene
from scenarios.simulate import draw
from scenarios.world import World

SCALES = {
    "ordinary": 10.0,
    "the largest": 1e12,
    "the least": 1e-12,
    "squares that are infinite": 1e160,
    "sums that are infinite": 1.7e308,
    "squares that are 0": 1e-160,
    "denormal": 5e-324,
    "infinite": np.inf,
}
"""Coordinates between the negative and the positive of these, some of them exactly these."""


def chunks(axes: int) -> Iterator[tuple[str, PlotChunk]]:
    """Yield chunks of three trials, the second without plots: 4 scans of 3 and 2 plots."""
    random = np.random.default_rng(5)
    scan = np.concatenate([np.repeat(np.arange(4), count) for count in (3, 0, 2)]).astype(np.int32)
    offsets = np.array([0, 12, 12, 20])
    covariance = np.broadcast_to(0.01 * np.eye(axes), (20, axes, axes)).copy()
    for name, scale in SCALES.items():
        share = random.uniform(-1.0, 1.0, (20, axes)) if np.isfinite(scale) else np.ones((20, axes))
        share[::3] = np.sign(share[::3])
        yield (
            name,
            PlotChunk(scan, scan * 1.0, share * scale, offsets, covariance * min(scale * scale, 1e300)),
        )
    moving = np.repeat(scan[:, None] * 0.2, axes, axis=1)
    yield "one track", PlotChunk(scan, scan * 1.0, moving, offsets, covariance)
    alone = moving.copy()
    alone[7, -1] = 1e8
    yield "one plot far from the others", PlotChunk(scan, scan * 1.0, alone, offsets, covariance)
    yield "equal", PlotChunk(scan, np.zeros(20), np.full((20, axes), 7.0), offsets, covariance)
    late = scan * np.int32(2**29)
    yield "great numbers of scans", PlotChunk(late, late * 1e9, moving, offsets, covariance)
    yield "none", PlotChunk(scan[:0], np.zeros(0), np.zeros((0, axes)), offsets * 0, covariance[:0])


WEIGHTING = Weighting(several=True, eta=2.0, least_votes=1)

UNWEIGHTED = ("threshold", "sequential")
"""The extractions that take votes as they are; the others weigh them here."""


def lines() -> None:
    """Call the kernels of accumulators, of association, of states and of scoring."""
    context = Context(4, 1.0, sigma=(0.1, 0.1))
    choices = {"votes": 1, "maxima": 3, "last": True, "rows": 2, "columns": 2, "wrap": True}
    for step, low in ((0.5, -10.0), (1e-12, -1e12), (1e300, -1e300)):
        grid = Grid(6, 40, low, step, (1.0, 2.0))
        for _, chunk in chunks(2):
            states = target_states(low)
            origin = np.zeros(len(chunk.scan), np.int32)
            truth = Truth(np.zeros((3, 1)), np.full((3, 1), low), np.zeros((3, 1, 2)), origin, states)
            for name, extraction in EXTRACTIONS.items():
                weighting = None if name in UNWEIGHTED else WEIGHTING
                tracks = search(chunk, grid, extraction.of(choices), weighting)
                for gate in (step, np.inf):
                    found = with_states(chunk, associate(chunk, tracks, 1.5 * step, gate), context)
                    scores = score(found, truth, chunk.offsets, Criterion(plots=2))
                    if chunk.scan.max(initial=0) < len(states.time):
                        kinematic_errors(scores.best, found.states, states)
                        gospa(found.offsets, found.states, states, min(step, 1e12))
                score(tracks, truth, chunk.offsets, Criterion(step, 0.1, mid_track=True, nearest=True))
            count_cells(chunk, grid, np.array([0.0, 3.1]), np.full((3, 2, 2), low), np.zeros((3, 2)), 4)
    home_votes(np.array([0.1]), np.array([1e-12, 1e12]), 0.0, 4, 1e12, 0.9, COARSE)


def target_states(place: float) -> TargetStates:
    """Return the states of a target that moves about a place in three trials, and is there in four scans."""
    position = np.full((3, 4, 1, 2), place) + np.arange(4.0)[None, :, None, None]
    velocity, shift = np.ones_like(position), np.zeros((3, 1, 2))
    return TargetStates(np.arange(4.0), np.ones((4, 1), np.bool_), position, velocity, shift)


FAST = {"speed_min": 0.0, "speed_max": 1e12}
CHANGES: dict[str, list[dict[str, Any]]] = {
    "modified": [FAST, {"speed_min": 0.0, "speed_max": np.inf}],
    "combinatorial-3d": [{**FAST, "plots": 3}, {**FAST, "mode": "document", "votes": 1}],
    "hough-logic-3d": [{**FAST, "plots": 3}, {"cell_length": 1e-12, "speed_gate": "planes"}],
    "hough-3d": [{**FAST, "plots": 3}, {"cell": 1e3}, {"cell": 1e-3}],
}
"""Values of parameters with which an initiator is called beside its defaults."""


def every_initiator() -> None:
    """Call the kernels of every initiator."""
    for name, algorithm in initiators().items():
        axes = algorithm.dimensions
        region = Box((-10.0,) * axes, (10.0,) * axes)
        context = Context(4, 1.0, sigma=(0.1,) * axes, region=region)
        own = algorithm.parameters.model_validate({}).resolved(context)
        for change in ({}, *CHANGES.get(name, ())):
            for _, chunk in chunks(axes):
                known = chunk if np.isfinite(chunk.position).all() else replace(chunk, covariance=None)
                # What is too much to be compared is refused.
                with suppress(RequestError):
                    algorithm.initiate_chunk(known, context, own.model_copy(update=change))


def filters() -> None:
    """Call the kernels of the Kalman filter."""
    for _, chunk in chunks(2):
        if not len(chunk.scan):
            continue
        measured = Measured.of(chunk, chunk.covariance, 2)
        state, spread = np.empty(4), np.empty((4, 4))
        start_from_pair(measured, 0, 5, state, spread, PLANE)
        began = Estimate(state, spread, float(chunk.time[5]))
        moved = predicted(began, float(chunk.time[8]), ConstantVelocity(1.0))
        updated(moved, chunk.position[8], chunk.covariance[8])


def clustering() -> None:
    """Call the kernels of clustering."""
    for _, chunk in chunks(2):
        along, doppler = (np.ascontiguousarray(chunk.position[:, axis]) for axis in (0, 1))
        for amplitude in (0.0, 1.0, 1e308):
            points = Points(along, doppler, np.full(len(along), amplitude), chunk.offsets)
            for at_mean in (False, True):
                splits = split(points, Rule(at_mean, 1e-3, 1e-3, 0.0, 0.0))
                leaves = splits.leaves
                scan = np.searchsorted(splits.offsets, leaves, side="right") - 1
                sets = Sets(splits.order, splits.first[leaves], splits.end[leaves], scan)
                clusters = conclude(points, sets, Conclusion(1e-9, is_mean=at_mean))
                score_clusters(clusters, np.zeros((3, 2, 2)))
        cut_open(doppler, chunk.offsets, np.full(3, 1e-12))


RADAR = {"kind": "polar", "sigma_range": 0.1, "sigma_azimuth_deg": 1, "range": [1, 50]}
CELLS = {"range_cell": 0.02, "beam_width_deg": 7, "doppler_cell": 0.001, "doppler_cells": 30}
EXTENT = {"points": 3, "range_spread": 0.06, "doppler_spread": 0.003, "correlation": -0.5}


def worlds() -> Iterator[World | ResolvedWorld]:
    """Yield worlds in the plane and in space, with plots and with points."""
    plain = {"name": "world", "scans": 4, "interval": 1}
    region = {axis: [0, 10] for axis in "xy"}
    batch = [{"rate": 2}, {"kind": "exact", "per": "batch", "count": 5}, {"kind": "exact", "count": 1}]
    moving = {"velocity": [1, 0.5], "spread": 1, "motion": {"process_noise": 0.1}}
    flat = {"sensor": {"sigma": 0.1}, "region": region, "clutter": batch}
    yield World.of(Scenario.model_validate({**plain, **flat, "targets": [{"position": [1, 2], **moving}]}))
    yield World.of(Scenario.model_validate({**plain, **flat, "clutter": []}))
    high = {"sensor": {**RADAR, "sigma_elevation_deg": 1}, "clutter": [{"rate": 3, "over": "volume"}]}
    above = {"position": [1, 2, 3], "velocity": [0, 0, 0]}
    yield World.of(Scenario.model_validate({**plain, **high, "targets": [above]}))
    sector = {"sensor": {**RADAR, "resolution": CELLS}, "clutter": [{"rate": 3, "over": "sector"}]}
    seen = [{"position": [10, 20], **moving, "extended": EXTENT}, {"position": [0, 0], "velocity": [0, 0]}]
    yield ResolvedWorld.of(Scenario.model_validate({**plain, **sector, "targets": seen}))


def scaled(world: World, scale: float, noise: float) -> World:
    """Return a world with all its lengths and speeds multiplied by a factor, its noise by another."""
    ground, clutter, measurement = world.ground, world.clutter, world.measurement
    names = ("start", "spread", "displacement", "velocity")
    return World(
        ground._replace(**{name: getattr(ground, name) * scale for name in names}),
        measurement._replace(sigma=measurement.sigma * noise),
        clutter._replace(size=clutter.size * scale),
    )


def drawing() -> None:
    """Call the kernels of draws."""
    for made in worlds():
        for scale in SCALES.values():
            if isinstance(made, World):
                draw(scaled(made, scale, scale), 3, 0, 2)
                continue
            for factor in (1.0, scale, 1.0 / scale):
                cell, width = made.cells.range_cell * factor, made.cells.beam_width / scale
                cells = made.cells._replace(range_cell=cell, doppler_cell=cell, beam_width=width)
                resolved = replace(made, world=scaled(made.world, scale, 1.0), cells=cells)
                every_point(resolved, draw_points(resolved, 3, 0, 2))
    scene = {"name": "scene", "region": {"range": [0, 9], "doppler": [0, 9]}, "interference": 2, "noise": 1}
    for far in (5.0, 1e12, -1e12):
        target = {"range": far, "doppler": far, "points": 3, "spread": [abs(far), 0]}
        draw_scene(Scene.model_validate({**scene, "targets": [target]}), 3, 0, 2)
    for scale in SCALES.values():
        converted(np.full((2, 3), scale), np.full(3, scale))


PARTS: tuple[Callable[[], None], ...] = (lines, every_initiator, filters, clustering, drawing)


def kernels() -> dict[str, Kernel]:
    """Return every kernel of the packages by its module and name."""
    found = {}
    for package in (algorithms, scenarios):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            names = vars(importlib.import_module(module.name))
            classes = {value.__name__: vars(value) for value in names.values() if isinstance(value, type)}
            for owner, members in {"": names, **classes}.items():
                for value in members.values():
                    if isinstance(value, Kernel):
                        found[f"{value.__module__}.{owner + '.' * bool(owner)}{value.__name__}"] = value
    return found


def called_by(kernel: Kernel) -> Iterator[Kernel]:
    """Yield a kernel and all that it calls."""
    yield kernel
    variables = inspect.getclosurevars(kernel.function)
    for inner in (*variables.globals.values(), *variables.nonlocals.values()):
        if isinstance(inner, Kernel) and inner is not kernel:
            yield from called_by(inner)


def main() -> None:
    """Call the kernels, and print which were reached, directly or by another one."""
    called = set()
    call = Kernel.__call__

    def noted(kernel: Kernel, *arguments: Any) -> Any:
        called.add(kernel)
        return call(kernel, *arguments)

    Kernel.__call__ = noted  # type: ignore[method-assign]
    # Beyond the bounds sums and squares overflow; here it matters alone where the kernels write.
    warnings.simplefilter("ignore")
    for part in PARTS:
        part()
    reached = {inner for kernel in called for inner in called_by(kernel)}
    print(*sorted(name for name, kernel in kernels().items() if kernel in reached), sep="\n")


if __name__ == "__main__":
    main()
