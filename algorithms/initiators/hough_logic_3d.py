"""Coarse Hough gates on two planes, then logic: the baseline of combinatorial initiation in space."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.parameters import Auto, Count, Dimension, Positive, parameter
from algorithms.plots import PlotChunk
from algorithms.space.motion import MOST_FOUND, chi_square_limits
from algorithms.space.noise import covariances, in_space
from algorithms.space.pairs import pairs_within_reach
from algorithms.space.tracks import (
    LEAST_PLOTS,
    STEPS,
    MotionParameters,
    SpaceInitiator,
    track_chunk,
    tracks_along,
)
from algorithms.tracks import TrackChunk

AXES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
Plane = Literal["xy", "xz", "yz"]

CELL_LENGTH = 1000.0
"""Default Δd, in metres."""


class HoughLogicParameters(MotionParameters):
    """The parameters of `hough-logic-3d`."""

    first_plane: Plane = parameter("xz", help="one of the planes on which the plots are projected")
    second_plane: Plane = parameter("yz", help="the other plane")
    cell_deg: Annotated[Positive, Field(le=90)] = parameter(
        15.0, dimension=Dimension.ANGLE, help="height Δθ of a cell of the accumulator of a plane"
    )
    cell_length: Positive | Auto = parameter(
        "auto", dimension=Dimension.LENGTH, help="width Δd of such a cell", auto="1 km"
    )
    plots: Annotated[Count, Field(ge=LEAST_PLOTS)] | Auto = parameter(
        "auto",
        dimension=Dimension.COUNT,
        help="the least number of plots of a track, each of another scan, and the least votes of a cell",
        auto="the number of scans, at least 3",
    )
    speed_gate: Literal["space", "planes"] = parameter(
        "space",
        help="space tests the speed as it is; planes demands the least speed of both projections of a "
        "track's velocity, too, which shuts out whoever flies across a plane",
    )

    @model_validator(mode="after")
    def _two_planes(self) -> Self:
        if self.first_plane == self.second_plane:
            raise ValueError(
                f"first_plane and second_plane are both {self.first_plane}; choose two of xy, xz, yz"
            )
        return self

    def resolved(self, context: Context) -> Self:
        """Return these parameters with speeds, cells and plots worked out; see `MotionParameters`."""
        resolved = super().resolved(context)
        update: dict[str, float | int] = {}
        if self.cell_length == "auto":
            update["cell_length"] = CELL_LENGTH / context.unit.metres
        if self.plots == "auto":
            update["plots"] = max(LEAST_PLOTS, context.scans)
        return resolved.model_copy(update=update)


@kernel
def _pass_gate(position, station, across, up, rows, step, length, votes, passed):  # type: ignore[no-untyped-def]
    """Set where a plot lies in a cell of a plane's accumulator with at least so many votes."""
    farthest = 0.0
    for plot in range(len(position)):
        x, y = position[plot, across] - station[across], position[plot, up] - station[up]
        farthest = max(farthest, math.sqrt(x * x + y * y))
    reach = int(farthest / length) + 1
    counts = np.zeros(2 * reach, np.int64)
    columns = np.empty(len(position), np.int64)
    for row in range(rows):
        theta = (row + 0.5) * step
        counts[:] = 0
        for plot in range(len(position)):
            x, y = position[plot, across] - station[across], position[plot, up] - station[up]
            columns[plot] = math.floor((x * math.cos(theta) + y * math.sin(theta)) / length) + reach
            counts[columns[plot]] += 1
        for plot in range(len(position)):
            if counts[columns[plot]] >= votes:
                passed[plot] = True


@kernel
def _gates_and_logic(  # type: ignore[no-untyped-def]
    position, time, scan, covariance, weight, offsets, station, planes, deepest, rows, step, length,
    in_planes, slowest, fastest, allowance, least, limits,
):  # fmt: skip
    trials = len(offsets) - 1
    found_by_trial = np.zeros(trials + 1, np.int64)
    tried, gated = np.zeros(trials, np.int64), np.zeros(trials, np.int64)
    plots, state = np.full((trials + 8, deepest), -1, np.int64), np.empty((trials + 8, 2, 3))
    found, squares = np.empty((MOST_FOUND, deepest), np.int64), np.empty(MOST_FOUND)
    count, is_full = 0, False
    for trial in range(trials):
        begin, end = offsets[trial], offsets[trial + 1]
        place, when, of_scan = position[begin:end], time[begin:end], scan[begin:end]
        noise, weights = covariance[begin:end], weight[begin:end]
        usable = np.ones(len(place), np.bool_)
        for plane in range(2):
            passed = np.zeros(len(place), np.bool_)
            _pass_gate(place, station, planes[plane, 0], planes[plane, 1], rows, step, length, least, passed)
            for plot in range(len(place)):
                usable[plot] = usable[plot] and passed[plot]
        pairs, every = pairs_within_reach(place, when, of_scan, noise, slowest, fastest, allowance, STEPS)
        tried[trial] = every
        kept = np.empty(len(pairs), np.bool_)
        for pair in range(len(pairs)):
            kept[pair] = usable[pairs[pair, 0]] and usable[pairs[pair, 1]]
        gated[trial] = kept.sum()
        plots, state, count, full = tracks_along(
            place, when, weights, pairs, kept, usable, least, limits, slowest, fastest, allowance,
            planes if in_planes else planes[:0], found, squares, plots, state, count,
        )  # fmt: skip
        is_full = is_full or full
        found_by_trial[trial + 1] = count
    return found_by_trial, plots[:count], state[:count], tried, gated, is_full


class HoughLogic3D(SpaceInitiator):
    """Plots that coarse Hough cells hold in two planes; tracks of m of n scans among them.

    The accumulators of two planes have cells so coarse that they only take clutter away; a plot
    passes where a cell of each plane that it voted for has enough votes. Among those that pass,
    tracks are what pairs of plots within reach and a fit of constant velocity make, m of n scans.

    References
    ----------
    G. Wang, F. Su and Y. He, "Hough transform and logic based track initiator in three dimensional space",
    Journal of System Simulation 16(10), 2004, as Wang and Zhao (2014) compare with it; the cells of 15° and
    1 km are theirs. Deviations: the gate allows for noise, and the logic's gates are the χ² of a
    fit. That it fails on targets which fly across a plane, as published, follows only from
    `speed_gate: planes`.
    """

    name = "hough-logic-3d"
    summary = "coarse Hough gates on two planes, then m of n scans along a constant velocity"
    source = "Wang, Su and He, Journal of System Simulation, 2004"
    parameters = HoughLogicParameters

    def initiate_chunk(
        self, chunk: PlotChunk, context: Context, parameters: HoughLogicParameters
    ) -> TrackChunk:
        """Return the tracks of each trial, with their plots.

        Raises
        ------
        RequestError
            Where plots have no z, their noise is not known, or too many tracks fit them.
        """
        in_space(chunk, self.name)
        noise = covariances(chunk, context)
        deepest = max(context.scans, LEAST_PLOTS)
        station = np.zeros(3) if context.station is None else np.array(context.station, dtype=float)
        rows = max(2, round(180.0 / parameters.cell_deg))
        offsets, plots, state, tried, gated, is_full = _gates_and_logic(
            np.ascontiguousarray(chunk.position), chunk.time, chunk.scan, noise, np.linalg.inv(noise),
            chunk.offsets, station,
            np.array([AXES[parameters.first_plane], AXES[parameters.second_plane]]),
            deepest, rows, math.pi / rows, parameters.cell_length, parameters.speed_gate == "planes",
            parameters.speed_min, parameters.speed_max, parameters.allowance, parameters.plots,
            chi_square_limits(parameters.confidence, deepest),
        )  # fmt: skip
        effort = {"pairs": tried, "pairs_gated": gated}
        return track_chunk(self.name, offsets, plots, state, effort, is_full=is_full)


INITIATOR = HoughLogic3D()
