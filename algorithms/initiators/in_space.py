"""Base of the initiators in space that look for constant velocities along pairs of plots."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Annotated, Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.initiators.base import ChunkInitiator
from algorithms.initiators.speeds import SpeedParameters
from algorithms.kinematics.gates import SpeedGate
from algorithms.kinematics.measured import Measured
from algorithms.kinematics.noise import covariances
from algorithms.kinematics.track_search import Candidates, TrackRule
from algorithms.parameters import Auto, Count, Dimension, Fraction, NotNegative, parameter
from algorithms.plots import PlotChunk
from algorithms.space.trial_loop import LEAST_PLOTS
from algorithms.tracks import TrackChunk

SHARE = 0.75
"""Default share of the scans in which a track has a plot: 3 of 4."""


class MotionParameters(SpeedParameters):
    """The parameters of every initiator in space that looks for constant velocities."""

    allowance: NotNegative = parameter(
        3.0, help="standard deviations of the noise by which a distance or a speed may miss its gate"
    )
    plots: Annotated[Count, Field(ge=LEAST_PLOTS)] | Auto = parameter(
        "auto",
        dimension=Dimension.COUNT,
        help="the least number of plots of a track, each of another scan",
        auto="three quarters of the scans, rounded up, at least 3",
    )
    confidence: Annotated[Fraction, Field(gt=0, lt=1)] = parameter(
        0.99,
        dimension=Dimension.FRACTION,
        help="the share of targets whose fit to a constant velocity passes the χ² test",
    )

    def resolved(self, context: Context) -> Self:
        """Return these parameters with speeds and least plots worked out; see `SpeedParameters`."""
        resolved = super().resolved(context)
        if self.plots != "auto":
            return resolved
        plots = max(LEAST_PLOTS, math.ceil(SHARE * context.scans - 1e-9))
        return resolved.model_copy(update={"plots": plots})


class SpaceInitiator(ChunkInitiator):
    """An initiator in space, whose tracks have their plots and their states from the start.

    Attributes
    ----------
    tracks_of_trials : kernel that `algorithms.space.trial_loop.trial_loop` makes
    """

    dimensions = 3
    tracks_of_trials: ClassVar[Callable[..., Any]]

    @abstractmethod
    def sieve(self, context: Context, parameters: Any) -> NamedTuple:
        """Return what takes clutter away, as the kernel of the initiator takes it."""

    def rule(self, parameters: Any, most: int) -> TrackRule:
        """Return what makes plots a track of at most so many."""
        gate = SpeedGate(parameters.speed_min, parameters.speed_max, float(parameters.allowance))
        return TrackRule.of(gate, parameters.plots, parameters.confidence, most, self.dimensions)

    def kernel_of(self, parameters: Any) -> Callable[..., Any]:
        """Return the kernel that finds the tracks of each trial."""
        return type(self).tracks_of_trials

    def confirming_plots(self, parameters: Any) -> int | None:
        """Return with how many plots a track can be declared; None where that takes the whole batch."""
        return None

    def measured(self, chunk: PlotChunk, context: Context) -> Measured:
        """Return plots with their noise.

        Raises
        ------
        RequestError
            Where plots have no z, or their noise is not known.
        """
        if chunk.position.shape[1] < self.dimensions:
            raise RequestError(
                f"{self.name} works in space, and the plots have no z; give a column z, or a scenario in "
                "space"
            )
        noise = covariances(chunk, context, self.dimensions)
        if noise is None:
            raise RequestError("the noise is not known: give sigma, or plots of a sensor with known noise")
        return Measured.of(chunk, noise, self.dimensions)

    def initiate_chunk(self, chunk: PlotChunk, context: Context, parameters: Any) -> TrackChunk:
        """Return the tracks of each trial, with their plots and states.

        The line of each is that of its motion in the plane (x, y), its score the number of its plots.

        Raises
        ------
        RequestError
            Where plots have no z, their noise is not known, or too many tracks fit them.
        """
        # A scan number is no bound: recordings may begin anywhere.
        rule = self.rule(parameters, max(chunk.most_scans, LEAST_PLOTS))
        candidates = Candidates.of(rule.most, self.dimensions)
        ends, table, count, tried, left, is_full = self.kernel_of(parameters)(
            self.measured(chunk, context), chunk.offsets, rule, self.sieve(context, parameters), candidates
        )
        if is_full:
            raise RequestError(
                f"{self.name}: more than {len(candidates.plots):,} tracks fit the plots of one batch; "
                "ask for more `plots`, narrow speed_min and speed_max, or take fewer scans"
            )
        plots, states = table.plots[:count], table.states.select(slice(count))
        theta, rho = states.lines
        score = (plots >= 0).sum(axis=1).astype(np.float64)
        return TrackChunk(
            ends, theta, rho, score, np.zeros(chunk.trials, np.int64), plots,
            {"pairs": tried, "pairs_gated": left}, self._confirmed(chunk, ends, plots, parameters), states,
        )  # fmt: skip

    def _confirmed(
        self, chunk: PlotChunk, ends: NDArray[np.int64], plots: NDArray[np.int64], parameters: Any
    ) -> NDArray[np.int64] | None:
        """Return the scan of the plot with which each track has as many as it needs to be declared."""
        number = self.confirming_plots(parameters)
        if number is None or not len(plots):
            return None
        first = np.repeat(chunk.offsets[:-1], np.diff(ends))
        scans: NDArray[np.int64] = chunk.scan[first + plots[:, number - 1]].astype(np.int64)
        return scans

    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks as they are: they have their plots."""
        return tracks


def station_of(context: Context) -> NDArray[np.float64]:
    """Return where the sensor stands, float64 (3,); the origin where that is not known."""
    return np.zeros(3) if context.station is None else np.array(context.station, dtype=float)
