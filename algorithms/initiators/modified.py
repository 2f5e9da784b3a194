"""The modified Hough initiator: three scans, speed gates, one direction."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import Field

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.hough.lines import line_through
from algorithms.initiators.base import ChunkInitiator
from algorithms.initiators.speeds import SpeedParameters
from algorithms.kinematics.gates import SpeedGate, can_fly
from algorithms.kinematics.strips import by_x, strip
from algorithms.parameters import Auto, Dimension, NotNegative, Positive, parameter
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk

LARGEST_RESULT = 2_000_000
"""The most triples that one chunk may give."""


class ModifiedParameters(SpeedParameters):
    """The parameters of `modified`."""

    fastest = 700.0

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


class Steadiness(NamedTuple):
    """What makes three plots a track.

    Attributes
    ----------
    gate : `SpeedGate`, of both displacements
    tolerance : the greatest angle between them, radians
    is_document : whether angles are compared as the source's program does
    """

    gate: SpeedGate
    tolerance: float
    is_document: bool


@kernel
def _one_direction(x1, y1, x2, y2, rule):  # type: ignore[no-untyped-def]
    """Return whether two displacements have nearly one direction."""
    if rule.is_document:
        first, second = math.atan(x1 / -y1), math.atan(x2 / -y2)
        return abs(first - second) <= rule.tolerance and (y2 / x2) / (y1 / x1) > 0.0
    dot = x1 * x2 + y1 * y2
    lengths = math.sqrt((x1 * x1 + y1 * y1) * (x2 * x2 + y2 * y2))
    return dot > 0.0 and dot >= math.cos(rule.tolerance) * lengths


@kernel
def _can_follow(position, time, first, second, gate):  # type: ignore[no-untyped-def]
    """Return whether a target can fly from one plot to another, which is a later one."""
    x, y = position[second, 0] - position[first, 0], position[second, 1] - position[first, 1]
    elapsed = time[second] - time[first]
    return elapsed > 0.0 and can_fly(gate, math.sqrt(x * x + y * y), elapsed, 0.0)


@kernel
def _triples_of(position, time, scan, rule, triples, count, limit):  # type: ignore[no-untyped-def]
    """Append the triples of one trial; return them, their number and whether they are too many."""
    order, begins = by_x(position, scan)
    for window in range(len(begins) - 3):
        first, second = begins[window], begins[window + 1]
        third, last = begins[window + 2], begins[window + 3]
        if scan[second] != scan[first] + 1 or scan[third] != scan[first] + 2:
            continue
        # Sorted by x, the plots within reach are a short run.
        middle, ahead = order[second:third], order[third:last]
        middle_x, ahead_x = position[middle, 0], position[ahead, 0]
        reach = rule.gate.fastest * (time[second:third].max() - time[first:second].min())
        reach_on = rule.gate.fastest * (time[third:last].max() - time[second:third].min())
        for a in range(first, second):
            begin, end = strip(middle_x, position[a, 0], reach)
            for b in middle[begin:end]:
                if not _can_follow(position, time, a, b, rule.gate):
                    continue
                x1, y1 = position[b, 0] - position[a, 0], position[b, 1] - position[a, 1]
                begin_on, end_on = strip(ahead_x, position[b, 0], reach_on)
                for c in ahead[begin_on:end_on]:
                    if not _can_follow(position, time, b, c, rule.gate):
                        continue
                    x2, y2 = position[c, 0] - position[b, 0], position[c, 1] - position[b, 1]
                    if not _one_direction(x1, y1, x2, y2, rule):
                        continue
                    if count == limit:
                        return triples, count, True
                    if count == len(triples):
                        larger = np.empty((2 * count, 3), np.int64)
                        larger[:count] = triples
                        triples = larger
                    triples[count, 0], triples[count, 1], triples[count, 2] = a, b, c
                    count += 1
    return triples, count, False


@kernel
def _triples(position, time, scan, offsets, rule, limit):  # type: ignore[no-untyped-def]
    """Return the triples of each trial, where those of each end, and whether there are too many."""
    trials = len(offsets) - 1
    ends = np.zeros(trials + 1, np.int64)
    triples = np.empty((4 * trials + 64, 3), np.int64)
    count = 0
    for trial in range(trials):
        begin, end = offsets[trial], offsets[trial + 1]
        triples, count, is_full = _triples_of(
            position[begin:end], time[begin:end], scan[begin:end], rule, triples, count, limit
        )
        if is_full:
            return triples, ends, True
        ends[trial + 1] = count
    return triples[:count], ends, False


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
        """Return the triples of each trial as tracks, with their plots; the third scan confirms each.

        Raises
        ------
        RequestError
            Where there are more than `LARGEST_RESULT` triples.
        """
        gate = SpeedGate(float(parameters.speed_min), float(parameters.speed_max))
        tolerance = math.radians(parameters.angle_tolerance_deg)
        rule = Steadiness(gate, tolerance, parameters.mode == "document")
        triples, offsets, overflow = _triples(
            np.ascontiguousarray(chunk.position), chunk.time, chunk.scan, chunk.offsets, rule, LARGEST_RESULT
        )
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
        confirmed = chunk.scan[rows[:, 2]].astype(np.int64)
        outside = np.zeros(chunk.trials, np.int64)
        return TrackChunk(offsets, theta, rho, score, outside, triples, confirmed_scan=confirmed)

    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks as they are: a triple is its plots."""
        return tracks


INITIATOR = Modified()
