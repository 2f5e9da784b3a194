"""From a trial to what the charts show of it: its planes and its accumulator."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Box
from algorithms.scoring.matching import DUPLICATE, FALSE, FINDER
from hough_tui.ui.drawing.graticule import Sector
from hough_tui.ui.widgets.heatmap_scene import HeatmapScene
from hough_tui.ui.widgets.plane_scene import PlaneScene, PlaneTrack
from hough_tui.ui.widgets.votes_scene import VotesScene
from scenarios.sensors import PolarSensor

if TYPE_CHECKING:
    from algorithms.hough.voting import Accumulator
    from hough_tui.inspection.trial import Picture, TrialLook
    from scenarios.model import Scenario

STATES = {FALSE: "false", FINDER: "found", DUPLICATE: "duplicate"}

DEVIATION = "deviation"
"""What the standard deviation of the ρ that voted for a cell is called."""

MOST_DRAWN = 300
"""Weaker tracks than these are not drawn: they would hide the plots."""

PLANES = ((0, 1), (0, 2), (1, 2))
"""The axes of the planes xy, xz and yz."""

GROUND = PLANES[0]


def sectors(scenario: Scenario) -> tuple[Sector, ...]:
    """Return what the polar sensors of a scenario see, as it lies on the ground."""
    return tuple(_sector(sensor) for sensor in scenario.sensors if isinstance(sensor, PolarSensor))


def _sector(sensor: PolarSensor) -> Sector:
    low, high = sensor.limits[2] if sensor.dimensions == 3 else (0.0, 0.0)
    levellest = min(max(0.0, low), high)
    steepest = max(abs(low), abs(high))
    near, far = sensor.range
    x, y = sensor.station[:2]
    return Sector((x, y), near * math.cos(steepest), far * math.cos(levellest), sensor.azimuth_deg)


def picture_scene(
    seen: Picture, tracks: tuple[PlaneTrack, ...] = (), axes: tuple[int, int] = GROUND
) -> PlaneScene:
    """Return a plane of a draw: its plots and true paths, and tracks.

    Parameters
    ----------
    seen : the draw
    tracks : as they lie in this plane
    axes : of the plane; rings and spokes lie in that of x and y only
    """
    scenario, chosen = seen.scenario, list(axes)
    box, seen_there = scenario.box, sectors(scenario) if axes == GROUND else ()
    return PlaneScene(
        seen.plots.position[:, chosen],
        seen.plots.scan,
        Box(tuple(box.lower[axis] for axis in axes), tuple(box.upper[axis] for axis in axes)),
        scenario.unit.value,
        seen.origin,
        tuple(path[:, chosen] for path in seen.paths),
        tracks,
        seen_there,
        ("xyz"[axes[0]], "xyz"[axes[1]]),
        is_projection=scenario.dimensions == 3,
        # Where none is given, the region is but a box around the sectors.
        is_framed=scenario.region is not None or not seen_there,
    )


def plane_scene(seen: TrialLook, axes: tuple[int, int] = GROUND) -> PlaneScene:
    """Return a plane of a trial, with the tracks."""
    position = seen.picture.plots.position[:, list(axes)]
    tracks = tuple(
        PlaneTrack(
            position[seen.tracks.plots[index]],
            "unknown" if seen.state is None else STATES[int(seen.state[index])],
            str(index),
        )
        for index in range(min(len(seen.tracks), MOST_DRAWN))
    )
    return picture_scene(seen.picture, tracks, axes)


def votes_scene(seen: TrialLook, plane: int) -> VotesScene:
    """Return the votes of pairs in one of `PLANES`."""
    votes = seen.plane_votes
    assert votes is not None
    return VotesScene(
        "".join("xyz"[axis] for axis in PLANES[plane]),
        np.degrees(votes.theta[plane]),
        votes.distance[plane],
        votes.confirmed[plane],
        votes.pairs,
        seen.picture.plots.scan[votes.pairs],
        seen.picture.scenario.unit.value,
    )


def layers(accumulator: Accumulator) -> dict[str, NDArray[Any]]:
    """Return the arrays of an accumulator by what they are called; votes come first."""
    known = {"votes": accumulator.votes, DEVIATION: accumulator.std, "weighted votes": accumulator.weighted}
    return {name: values for name, values in known.items() if values is not None}


def heatmap_scene(seen: TrialLook, layer: str = "votes") -> HeatmapScene:
    """Return the accumulator of a trial, or another of its `layers` where it has that."""
    assert seen.accumulator is not None
    known = layers(seen.accumulator)
    shown = layer if layer in known else "votes"
    grid = seen.accumulator.grid
    cells = (
        grid.cell(float(theta), float(rho))
        for theta, rho in zip(seen.tracks.theta[:MOST_DRAWN], seen.tracks.rho[:MOST_DRAWN], strict=True)
    )
    return HeatmapScene(
        known[shown],
        np.degrees(grid.theta),
        grid.rho,
        seen.picture.scenario.unit.value,
        shown,
        tuple(cell for cell in cells if cell is not None),
        tuple((name, values) for name, values in known.items() if name != shown),
        is_descending=shown == DEVIATION,
    )
