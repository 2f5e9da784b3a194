"""Combinatorial Hough transform on three planes, then a fit in space."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.parameters import Auto, Count, Dimension, Positive, parameter
from algorithms.plots import PlotChunk, Plots
from algorithms.space.motion import MOST_FOUND, chi_square_limits, write_track
from algorithms.space.noise import covariances, in_space
from algorithms.space.pairs import components, pairs_within_reach
from algorithms.space.planes import PLANES, PlaneVotes, confirm, votes_of_pairs
from algorithms.space.tracks import (
    LEAST_PLOTS,
    STEPS,
    MotionParameters,
    SpaceInitiator,
    track_chunk,
    tracks_along,
    with_track_room,
)
from algorithms.tracks import TrackChunk

WINDOW_DEG = {"sound": 90.0, "document": 20.0}
WINDOW_LENGTH = {"sound": 800.0, "document": 20_000.0}
"""Default windows, in degrees and metres: the sound one is wide, since the fit decides afterwards."""

LEAST_VOTES = {"sound": 3, "document": 2}


class CombinatorialParameters(MotionParameters):
    """The parameters of `combinatorial-3d`."""

    window_deg: Annotated[Positive, Field(lt=180)] | Auto = parameter(
        "auto",
        dimension=Dimension.ANGLE,
        help="width Δθ of a window of votes",
        auto="90° for sound, 20° for document",
    )
    window_length: Positive | Auto = parameter(
        "auto",
        dimension=Dimension.LENGTH,
        help="height Δd of a window of votes",
        auto="800 m for sound, 20 km for document",
    )
    votes: Count | Auto = parameter(
        "auto",
        dimension=Dimension.COUNT,
        help="the least votes of a window, each a pair of plots",
        auto="3 for sound, 2 for document",
    )
    planes: Annotated[Count, Field(le=3)] = parameter(
        2, dimension=Dimension.COUNT, help="in how many of the planes xy, xz, yz plots must be confirmed"
    )
    mode: Literal["sound", "document"] = parameter(
        "sound",
        help="sound measures d from the middle of connected plots and fits a constant velocity; document "
        "measures d from the radar in fixed cells of θ, allows nothing for noise and fits nothing, as the "
        "source does",
    )

    def resolved(self, context: Context) -> Self:
        """Return these parameters with speeds, windows and votes worked out; see `MotionParameters`."""
        resolved = super().resolved(context)
        update: dict[str, float | int] = {}
        if self.window_deg == "auto":
            update["window_deg"] = WINDOW_DEG[self.mode]
        if self.window_length == "auto":
            update["window_length"] = WINDOW_LENGTH[self.mode] / context.unit.metres
        if self.votes == "auto":
            update["votes"] = LEAST_VOTES[self.mode]
        return resolved.model_copy(update=update)


@kernel
def _votes(  # type: ignore[no-untyped-def]
    position, pairs, groups, station, is_document, width, height, least_votes, planes
):
    """Return the votes of each pair in each plane: θ, d and whether it is confirmed."""
    count = len(pairs)
    theta, distance = np.empty((len(planes), count)), np.empty((len(planes), count))
    confirmed = np.zeros((len(planes), count), np.bool_)
    inside, sorted_in = np.empty(count, np.int64), np.empty(count)
    own_theta, own_distance, is_own = np.empty(count), np.empty(count), np.empty(count, np.bool_)
    group_of = np.empty(count, np.int64)
    for pair in range(count):
        group_of[pair] = groups[pairs[pair, 0]]
    order = np.argsort(group_of, kind="mergesort")
    centre = station.copy()
    first = 0
    while first < count:
        end = first
        while end < count and group_of[order[end]] == group_of[order[first]]:
            end += 1
        chosen = order[first:end]
        if not is_document:
            # The mean over the ends of pairs: each plot counts as often as it votes.
            centre[:] = 0.0
            for pair in chosen:
                for axis in range(3):
                    both = position[pairs[pair, 0], axis] + position[pairs[pair, 1], axis]
                    centre[axis] += 0.5 * both / len(chosen)
        for plane in range(len(planes)):
            votes_of_pairs(
                position, pairs, chosen, planes[plane, 0], planes[plane, 1], centre, own_theta, own_distance
            )
            is_own[: len(chosen)] = False
            if len(chosen) >= least_votes:
                confirm(
                    own_theta, own_distance, len(chosen), width, height, is_document, least_votes, is_own,
                    inside, sorted_in,
                )  # fmt: skip
            for vote in range(len(chosen)):
                theta[plane, chosen[vote]], distance[plane, chosen[vote]] = (
                    own_theta[vote],
                    own_distance[vote],
                )
                confirmed[plane, chosen[vote]] = is_own[vote]
        first = end
    return theta, distance, confirmed


@kernel
def _groups(count, pairs, is_document):  # type: ignore[no-untyped-def]
    """Return which plots vote together: those that pairs connect, in the document's mode all."""
    if is_document:
        return np.zeros(count, np.int64)
    return components(count, pairs, np.ones(len(pairs), np.bool_))


@kernel
def _planes_of_plots(count, pairs, confirmed):  # type: ignore[no-untyped-def]
    """Return the number of planes in which each plot is confirmed."""
    bits = np.zeros((count, len(confirmed)), np.bool_)
    for plane in range(len(confirmed)):
        for pair in range(len(pairs)):
            if confirmed[plane, pair]:
                bits[pairs[pair, 0], plane] = True
                bits[pairs[pair, 1], plane] = True
    return bits.sum(axis=1)


@kernel
def _nearest_of_scans(position, time, scan, weight, rows, count, chosen):  # type: ignore[no-untyped-def]
    """Write of each scan the plot that lies nearest to the motion fitted to all; return how many scans."""
    plots, state = np.full((1, count), -1, np.int64), np.empty((1, 2, 3))
    write_track(position, time, weight, rows[:count], plots, state, 0)
    number, nearest = 0, np.inf
    for k in range(count):
        plot = rows[k]
        miss = 0.0
        for axis in range(3):
            at = state[0, 0, axis] + state[0, 1, axis] * (time[plot] - time[rows[0]])
            miss += (position[plot, axis] - at) ** 2
        if number == 0 or scan[plot] != scan[chosen[number - 1]]:
            chosen[number] = plot
            number += 1
            nearest = miss
        elif miss < nearest:
            chosen[number - 1] = plot
            nearest = miss
    return number


@kernel
def _connected_tracks(position, time, scan, weight, pairs, kept, plots, state, count):  # type: ignore[no-untyped-def]
    """Append each set of plots from three scans or more that kept pairs connect, one plot a scan."""
    groups = components(len(position), pairs, kept)
    rows, chosen = np.empty(len(position), np.int64), np.empty(len(position), np.int64)
    for group in range(len(position)):
        if groups[group] != group:
            continue
        members = 0
        for plot in range(group, len(position)):
            if groups[plot] == group:
                rows[members] = plot
                members += 1
        scans = 0
        for k in range(members):
            scans += k == 0 or scan[rows[k]] != scan[rows[k - 1]]
        if scans >= LEAST_PLOTS:
            number = _nearest_of_scans(position, time, scan, weight, rows, members, chosen)
            plots, state = with_track_room(plots, state, count + 1)
            write_track(position, time, weight, chosen[:number], plots, state, count)
            count += 1
    return plots, state, count


@kernel
def _combinatorial(  # type: ignore[no-untyped-def]
    position, time, scan, covariance, weight, offsets, station, planes, deepest,
    slowest, fastest, allowance, width, height, least_votes, least_planes, is_document, least, limits,
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
        pairs, every = pairs_within_reach(place, when, of_scan, noise, slowest, fastest, allowance, STEPS)
        tried[trial], gated[trial] = every, len(pairs)
        if len(pairs) >= least_votes:
            groups = _groups(len(place), pairs, is_document)
            _, _, confirmed = _votes(
                place, pairs, groups, station, is_document, width, height, least_votes, planes
            )
            numbers = _planes_of_plots(len(place), pairs, confirmed)
            usable, kept = np.empty(len(place), np.bool_), np.empty(len(pairs), np.bool_)
            for plot in range(len(place)):
                usable[plot] = numbers[plot] >= least_planes
            for pair in range(len(pairs)):
                kept[pair] = usable[pairs[pair, 0]] and usable[pairs[pair, 1]]
            if is_document:
                plots, state, count = _connected_tracks(
                    place, when, of_scan, weights, pairs, kept, plots, state, count
                )
            else:
                plots, state, count, full = tracks_along(
                    place, when, weights, pairs, kept, usable, least, limits, slowest, fastest, allowance,
                    planes[:0], found, squares, plots, state, count,
                )  # fmt: skip
                is_full = is_full or full
        found_by_trial[trial + 1] = count
    return found_by_trial, plots[:count], state[:count], tried, gated, is_full


class Combinatorial3D(SpaceInitiator):
    """Pairs of plots vote for lines in three planes; what two planes confirm is fitted in space.

    Every pair of plots up to three scans apart whose distance a target can fly votes once in each
    of the planes xy, xz, yz. Plots that windows with enough votes confirm in two planes are
    candidates; along the pairs between them tracks of constant velocity are sought that pass a χ²
    test with the covariances of the plots, best first, no plot in two of them.

    References
    ----------
    X. Wang and X. Zhao, "Precise approaching radar track initiation algorithm based on
    combinatorial Hough transform", Electronics Optics & Control 21(1), 2014; D. Ben-Tzvi and M. B.
    Sandler, "A combinatorial Hough transform", Pattern Recognition Letters 11, 1990. Deviations of
    the sound mode: the gate allows for noise, without which 20 to 31 % of a target's own pairs are
    lost; d is measured from the middle of connected plots, since about the radar it scatters by
    kilometres and tests nothing; a fit follows, which parts targets that fly side by side.
    """

    name = "combinatorial-3d"
    summary = "pairs of plots vote in three planes; two planes and a fit in space confirm a track"
    source = "Wang and Zhao, Electronics Optics & Control, 2014"
    parameters = CombinatorialParameters

    def initiate_chunk(
        self, chunk: PlotChunk, context: Context, parameters: CombinatorialParameters
    ) -> TrackChunk:
        """Return the tracks of each trial, with their plots.

        Raises
        ------
        RequestError
            Where plots have no z, their noise is not known, or too many tracks fit them.
        """
        in_space(chunk, self.name)
        is_document = parameters.mode == "document"
        noise = covariances(chunk, context)
        deepest = max(context.scans, LEAST_PLOTS)
        offsets, plots, state, tried, gated, is_full = _combinatorial(
            np.ascontiguousarray(chunk.position), chunk.time, chunk.scan, noise, np.linalg.inv(noise),
            chunk.offsets, _station(context), PLANES, deepest, parameters.speed_min, parameters.speed_max,
            _allowance(parameters), math.radians(float(parameters.window_deg)), parameters.window_length,
            parameters.votes, parameters.planes, is_document, parameters.plots,
            chi_square_limits(parameters.confidence, deepest),
        )  # fmt: skip
        effort = {"pairs": tried, "pairs_gated": gated}
        return track_chunk(self.name, offsets, plots, state, effort, is_full=is_full)

    def plane_votes(self, plots: Plots, context: Context, parameters: CombinatorialParameters) -> PlaneVotes:
        """Return the votes of all pairs that pass the gate.

        d is measured from the middle of the plots that pairs connect; in the document's mode, from
        the radar.

        Raises
        ------
        RequestError
            Where plots have no z, or their noise is not known.
        """
        chunk = plots.chunk()
        in_space(chunk, self.name)
        is_document = parameters.mode == "document"
        position = np.ascontiguousarray(chunk.position)
        pairs, tried = pairs_within_reach(
            position, chunk.time, chunk.scan, covariances(chunk, context), parameters.speed_min,
            parameters.speed_max, _allowance(parameters), STEPS,
        )  # fmt: skip
        window = math.radians(float(parameters.window_deg)), float(parameters.window_length)
        theta, distance, confirmed = _votes(
            position, pairs, _groups(len(position), pairs, is_document), _station(context), is_document,
            *window, parameters.votes, PLANES,
        )  # fmt: skip
        return PlaneVotes(pairs, theta, distance, confirmed, int(tried), window, int(parameters.votes))


def _station(context: Context) -> NDArray[np.float64]:
    return np.zeros(3) if context.station is None else np.array(context.station, dtype=float)


def _allowance(parameters: CombinatorialParameters) -> float:
    return 0.0 if parameters.mode == "document" else parameters.allowance


INITIATOR = Combinatorial3D()
