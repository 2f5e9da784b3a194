"""The modified Hough initiator: three scans, speed gates, one direction."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.hough.lines import line_through
from algorithms.initiators.base import ChunkInitiator
from algorithms.parameters import Auto, Dimension, NotNegative, Parameters, Positive, parameter
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk

LARGEST_RESULT = 2_000_000
"""The most triples that one chunk may give."""

SLOWEST, FASTEST = 50.0, 700.0
"""Default speeds, in m/s."""


class ModifiedParameters(Parameters):
    """The parameters of `modified`."""

    speed_min: NotNegative | Auto = parameter(
        "auto", dimension=Dimension.SPEED, help="the least speed between two scans", auto="50 m/s"
    )
    speed_max: Positive | Auto = parameter(
        "auto", dimension=Dimension.SPEED, help="the greatest speed between two scans", auto="700 m/s"
    )
    angle_tolerance_deg: Annotated[Positive, Field(lt=90)] = parameter(
        6.0, dimension=Dimension.ANGLE, help="the greatest angle between the two displacements"
    )
    mode: Literal["sound", "document"] = parameter(
        "sound",
        help="sound compares the displacements themselves; document the angles of atan and the signs of "
        "the slopes, as the source's program does",
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
        """Return these parameters with the speeds worked out from the unit.

        Raises
        ------
        RequestError
            Where one speed is given and lies beyond the other's default.
        """
        slowest = SLOWEST / context.unit.metres if self.speed_min == "auto" else self.speed_min
        fastest = FASTEST / context.unit.metres if self.speed_max == "auto" else self.speed_max
        if float(slowest) >= float(fastest):
            raise RequestError(
                f"modified: speed_min is {float(slowest):g} and speed_max {float(fastest):g} "
                f"{context.unit}/s; speed_min must be the smaller one; give both"
            )
        return self.model_copy(update={"speed_min": float(slowest), "speed_max": float(fastest)})


@kernel
def _one_direction(x1, y1, x2, y2, tolerance, document):  # type: ignore[no-untyped-def]
    """Return whether two displacements have nearly one direction."""
    if document:
        first, second = math.atan(x1 / -y1), math.atan(x2 / -y2)
        return abs(first - second) <= tolerance and (y2 / x2) / (y1 / x1) > 0.0
    dot = x1 * x2 + y1 * y2
    return dot > 0.0 and dot >= math.cos(tolerance) * math.sqrt((x1 * x1 + y1 * y1) * (x2 * x2 + y2 * y2))


@kernel
def _is_gated(x, y, elapsed, slowest, fastest):  # type: ignore[no-untyped-def]
    length = math.sqrt(x * x + y * y)
    return elapsed > 0.0 and slowest * elapsed <= length <= fastest * elapsed


@kernel
def _triples(x, y, time, scan, offsets, slowest, fastest, tolerance, document, limit):  # type: ignore[no-untyped-def]
    trials = len(offsets) - 1
    found = np.zeros(trials + 1, np.int64)
    triples = np.empty((4 * trials + 64, 3), np.int64)
    count = 0
    for trial in range(trials):
        begin, end = offsets[trial], offsets[trial + 1]
        first = begin
        while first < end:
            # Three scans in a row: [first, second), [second, third), [third, last).
            second = first
            while second < end and scan[second] == scan[first]:
                second += 1
            third = second
            while third < end and scan[third] == scan[first] + 1:
                third += 1
            last = third
            while last < end and scan[last] == scan[first] + 2:
                last += 1
            if third > second and last > third:
                # Sorted by x, the plots within reach are a short run.
                middle = second + np.argsort(x[second:third])
                ahead = third + np.argsort(x[third:last])
                middle_x, ahead_x = x[middle], x[ahead]
                reach = fastest * (time[second:third].max() - time[first:second].min())
                reach_on = fastest * (time[third:last].max() - time[second:third].min())
                for a in range(first, second):
                    low = np.searchsorted(middle_x, x[a] - reach)
                    for k in range(low, len(middle)):
                        if middle_x[k] > x[a] + reach:
                            break
                        b = middle[k]
                        x1, y1 = x[b] - x[a], y[b] - y[a]
                        if not _is_gated(x1, y1, time[b] - time[a], slowest, fastest):
                            continue
                        low_on = np.searchsorted(ahead_x, x[b] - reach_on)
                        for m in range(low_on, len(ahead)):
                            if ahead_x[m] > x[b] + reach_on:
                                break
                            c = ahead[m]
                            x2, y2 = x[c] - x[b], y[c] - y[b]
                            if not _is_gated(x2, y2, time[c] - time[b], slowest, fastest):
                                continue
                            if not _one_direction(x1, y1, x2, y2, tolerance, document):
                                continue
                            if count == limit:
                                return triples, found, True
                            if count == len(triples):
                                larger = np.empty((2 * count, 3), np.int64)
                                larger[:count] = triples
                                triples = larger
                            triples[count, 0] = a - begin
                            triples[count, 1] = b - begin
                            triples[count, 2] = c - begin
                            count += 1
            first = second
        found[trial + 1] = count
    return triples[:count], found, False


class Modified(ChunkInitiator):
    """Triples of plots of three consecutive scans that move steadily in one direction.

    Every window of three consecutive scans is searched. A triple is kept where both speeds
    pass the gates and both displacements point in nearly one direction.

    References
    ----------
    Course report on track initiation by the Hough transform, Northwestern Polytechnical
    University, 2018, section 2.3.2 (equations 2-6 and 2-7). Deviations of the sound mode: the angle is
    that between the displacements, so that headings near an axis are like any other, and a
    reversal is refused, as the source's text demands and its program does not.
    """

    name = "modified"
    summary = "three plots in a row that pass speed gates and keep their direction"
    source = "course report 2018, section 2.3.2"
    parameters = ModifiedParameters

    def initiate_chunk(
        self, chunk: PlotChunk, context: Context, parameters: ModifiedParameters
    ) -> TrackChunk:
        """Return the triples of each trial as tracks; their plots are known at once.

        Raises
        ------
        RequestError
            Where there are more than `LARGEST_RESULT` triples.
        """
        x, y = (np.ascontiguousarray(chunk.position[:, axis]) for axis in (0, 1))
        triples, offsets, overflow = _triples(
            x, y, chunk.time, chunk.scan, chunk.offsets, parameters.speed_min, parameters.speed_max,
            math.radians(parameters.angle_tolerance_deg), parameters.mode == "document", LARGEST_RESULT,
        )  # fmt: skip
        if overflow:
            raise RequestError(
                f"modified: more than {LARGEST_RESULT:,} triples pass the gates; narrow speed_min and "
                "speed_max, or angle_tolerance_deg, or take fewer scans"
            )
        rows = triples + np.repeat(chunk.offsets[:-1], np.diff(offsets))[:, None]
        place = chunk.position[rows, :2]
        direction = place[:, 2] - place[:, 0]
        back = ~direction.any(axis=1)
        direction[back] = (place[:, 1] - place[:, 0])[back]
        theta, rho = line_through(place.mean(axis=1), direction)
        score = np.full(len(triples), 3.0)
        return TrackChunk(offsets, theta, rho, score, np.zeros(chunk.trials, np.int64), triples)

    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks as they are: a triple is its plots."""
        return tracks


INITIATOR = Modified()
