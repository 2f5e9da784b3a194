"""Coarse Hough gates on two planes, then logic: the baseline of combinatorial initiation in space."""

from __future__ import annotations

import math
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.initiators.in_space import MotionParameters, SpaceInitiator, station_of
from algorithms.kinematics.track_search import TrackRule
from algorithms.parameters import Auto, Count, Dimension, Positive, parameter
from algorithms.space.trial_loop import LEAST_PLOTS, fitted_tracks, trial_loop

AXES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
Plane = Literal["xy", "xz", "yz"]

CELL_LENGTH = 1000.0
"""Default Δd, in metres."""


class HoughLogicParameters(MotionParameters):
    """The parameters of `hough-logic-3d`."""

    first_plane: Plane = parameter("xz", help="one of the planes on which the plots are projected")
    second_plane: Plane = parameter("yz", help="the other plane")
    cell_deg: Annotated[Positive, Field(ge=0.01, le=90)] = parameter(
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
    count = len(position)
    columns = np.empty(count)
    for row in range(rows):
        cosine, sine = math.cos((row + 0.5) * step), math.sin((row + 0.5) * step)
        for plot in range(count):
            x, y = position[plot, across] - station[across], position[plot, up] - station[up]
            columns[plot] = np.floor((x * cosine + y * sine) / length)
        # Sorted, not counted cell by cell: one distant plot would ask for any number of cells.
        order = np.argsort(columns)
        begin = 0
        while begin < count:
            end = begin + 1
            while end < count and columns[order[end]] == columns[order[begin]]:
                end += 1
            if end - begin >= votes:
                for k in range(begin, end):
                    passed[order[k]] = True
            begin = end


class CoarseCells(NamedTuple):
    """Cells of the accumulators of two planes.

    Attributes
    ----------
    station : float64 (3,), from where d is measured
    planes : int64 (2, 2), axes of the planes
    rows : number of directions θ
    step, length : height Δθ and width Δd of a cell, in radians and in length
    votes : the least votes of a cell
    """

    station: NDArray[np.float64]
    planes: NDArray[np.int64]
    rows: int
    step: float
    length: float
    votes: int


@kernel
def _usable_plots(measured, pairs, cells):  # type: ignore[no-untyped-def]
    """Return which plots pass the gates of both planes, and the number of pairs between these."""
    count = len(measured.time)
    usable = np.ones(count, np.bool_)
    for plane in range(2):
        passed = np.zeros(count, np.bool_)
        across, up = cells.planes[plane, 0], cells.planes[plane, 1]
        _pass_gate(
            measured.position, cells.station, across, up, cells.rows, cells.step, cells.length, cells.votes,
            passed,
        )  # fmt: skip
        for plot in range(count):
            usable[plot] = usable[plot] and passed[plot]
    left = 0
    for pair in range(len(pairs)):
        left += usable[pairs[pair, 0]] and usable[pairs[pair, 1]]
    return usable, left


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

    tracks_of_trials = trial_loop(_usable_plots, fitted_tracks)

    def sieve(self, context: Context, parameters: HoughLogicParameters) -> CoarseCells:
        """Return the cells in which plots must lie."""
        rows = max(2, round(180.0 / parameters.cell_deg))
        return CoarseCells(
            station_of(context),
            self._planes(parameters),
            rows,
            math.pi / rows,
            float(parameters.cell_length),
            int(parameters.plots),
        )

    def rule(self, parameters: HoughLogicParameters, most: int) -> TrackRule:
        """Return what makes plots a track: with `speed_gate: planes` the least speed in both planes, too."""
        rule = super().rule(parameters, most)
        return rule._replace(planes=self._planes(parameters)) if parameters.speed_gate == "planes" else rule

    def confirming_plots(self, parameters: HoughLogicParameters) -> int:
        """Return with how many plots a track can be declared: with m of n the m-th."""
        return int(parameters.plots)

    @staticmethod
    def _planes(parameters: HoughLogicParameters) -> NDArray[np.int64]:
        return np.array([AXES[parameters.first_plane], AXES[parameters.second_plane]])


INITIATOR = HoughLogic3D()
