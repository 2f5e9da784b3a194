"""What the initiators in space share: speeds, the form of a track, the search along pairs of plots."""

from __future__ import annotations

import math
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.hough.lines import line_through
from algorithms.initiators.base import ChunkInitiator
from algorithms.parameters import (
    Auto,
    Count,
    Dimension,
    Fraction,
    NotNegative,
    Parameters,
    Positive,
    parameter,
)
from algorithms.plots import PlotChunk
from algorithms.space.motion import MOST_FOUND, choose_disjoint, search_motions, write_track
from algorithms.space.pairs import by_first
from algorithms.tracks import TrackChunk

SLOWEST, FASTEST = 50.0, 400.0
"""Default speeds, in m/s."""

STEPS = 3
"""The most scans between the plots of a pair."""

SHARE = 0.75
"""Default share of the scans in which a track has a plot: 3 of 4."""

LEAST_PLOTS = 3


class MotionParameters(Parameters):
    """The parameters of every initiator in space that looks for constant velocities."""

    speed_min: NotNegative | Auto = parameter(
        "auto", dimension=Dimension.SPEED, help="the least speed of a target", auto="50 m/s"
    )
    speed_max: Positive | Auto = parameter(
        "auto", dimension=Dimension.SPEED, help="the greatest speed of a target", auto="400 m/s"
    )
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

    @model_validator(mode="after")
    def _speeds_in_order(self) -> Self:
        if not isinstance(self.speed_min, str) and not isinstance(self.speed_max, str):
            if self.speed_min >= self.speed_max:
                raise ValueError(
                    f"speed_min {self.speed_min:g} is given with speed_max {self.speed_max:g}; "
                    "speed_min must be the smaller one"
                )
        return self

    def resolved(self, context: Context) -> Self:
        """Return these parameters with speeds and least plots worked out.

        Raises
        ------
        RequestError
            Where one speed is given and lies beyond the other's default.
        """
        slowest = SLOWEST / context.unit.metres if self.speed_min == "auto" else float(self.speed_min)
        fastest = FASTEST / context.unit.metres if self.speed_max == "auto" else float(self.speed_max)
        if slowest >= fastest:
            raise RequestError(
                f"speed_min is {slowest:g} and speed_max {fastest:g} {context.unit}/s; "
                "speed_min must be the smaller one; give both"
            )
        plots = self.plots
        if plots == "auto":
            plots = max(LEAST_PLOTS, math.ceil(SHARE * context.scans - 1e-9))
        return self.model_copy(update={"speed_min": slowest, "speed_max": fastest, "plots": plots})


class SpaceInitiator(ChunkInitiator):
    """An initiator in space, whose tracks are their plots from the start."""

    dimensions = 3

    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks as they are: they have their plots."""
        return tracks


@kernel
def tracks_along(  # type: ignore[no-untyped-def]
    position, time, weight, pairs, kept, usable, least, limits, slowest, fastest, allowance, planes,
    found, squares, plots, state, count,
):  # fmt: skip
    """Append the disjoint tracks of constant velocity along kept pairs of usable plots.

    For the parameters see `search_motions`.

    Returns
    -------
    plots, state : as given, or enlarged
    count : number of tracks so far
    is_full : whether more tracks fit than can be compared
    """
    sorted_pairs, begins = by_first(pairs, kept, len(position))
    number = search_motions(
        position, time, weight, sorted_pairs, usable, begins, least, limits, slowest, fastest, allowance,
        planes, found, squares,
    )  # fmt: skip
    if number == len(found):
        return plots, state, count, True
    taken, chosen = np.zeros(len(position), np.bool_), np.empty(number, np.int64)
    for k in range(choose_disjoint(found, squares, number, taken, chosen)):
        plots, state = with_track_room(plots, state, count + 1)
        write_track(position, time, weight, found[chosen[k]], plots, state, count)
        count += 1
    return plots, state, count, False


@kernel
def with_track_room(plots, state, needed):  # type: ignore[no-untyped-def]
    """Return the arrays of tracks, enlarged where they have not the rows that are needed."""
    if needed <= len(plots):
        return plots, state
    more_plots = np.full((2 * needed, plots.shape[1]), -1, np.int64)
    more_state = np.empty((2 * needed, 2, 3))
    more_plots[: len(plots)] = plots
    more_state[: len(state)] = state
    return more_plots, more_state


def track_chunk(
    name: str,
    offsets: NDArray[np.int64],
    plots: NDArray[np.int64],
    state: NDArray[np.float64],
    effort: dict[str, NDArray[np.int64]],
    *,
    is_full: bool,
) -> TrackChunk:
    """Return tracks in space as a chunk; the line of each is that of its motion in the plane (x, y).

    Raises
    ------
    RequestError
        Where a trial had more tracks than can be compared.
    """
    if is_full:
        raise RequestError(
            f"{name}: more than {MOST_FOUND:,} tracks fit the plots of one batch; ask for more `plots`, "
            "narrow speed_min and speed_max, or take fewer scans"
        )
    theta, rho = line_through(state[:, 0, :2], state[:, 1, :2])
    score = (plots >= 0).sum(axis=1).astype(np.float64)
    return TrackChunk(offsets, theta, rho, score, np.zeros(len(offsets) - 1, np.int64), plots, effort)
