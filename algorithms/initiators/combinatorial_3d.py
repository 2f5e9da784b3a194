"""Combinatorial Hough transform on three planes, then a fit in space."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.initiators.in_space import MotionParameters, SpaceInitiator, station_of
from algorithms.kinematics.constant_velocity import Motion, squared_miss
from algorithms.kinematics.least_squares import add_plot, fit
from algorithms.kinematics.matrices import SPACE
from algorithms.kinematics.pairs import components, pairs_within_reach
from algorithms.kinematics.track_search import TrackRule
from algorithms.parameters import Auto, Count, Dimension, Positive, parameter
from algorithms.plots import Plots
from algorithms.space.planes import PLANES, PlaneVotes, confirm, votes_of_pairs
from algorithms.space.trial_loop import LEAST_PLOTS, STEPS, fitted_tracks, trial_loop, with_track

WINDOW_DEG = {"sound": 90.0, "document": 20.0}
WINDOW_LENGTH = {"sound": 800.0, "document": 20_000.0}
"""Default windows, in degrees and metres: the sound one is wide, since the fit decides afterwards."""

LEAST_VOTES = {"sound": 3, "document": 2}


class CombinatorialParameters(MotionParameters):
    """The parameters of `combinatorial-3d`."""

    window_deg: Annotated[Positive, Field(ge=0.01, lt=180)] | Auto = parameter(
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


class Windows(NamedTuple):
    """Windows of votes in three planes, and what in them confirms a plot.

    Attributes
    ----------
    station : float64 (3,), from where d is measured in the document's mode
    width, height : of a window, in radians and in length
    least_votes : the least votes of a window
    least_planes : in how many planes a plot must be confirmed
    is_document : whether d is measured from the station in fixed cells of θ
    """

    station: NDArray[np.float64]
    width: float
    height: float
    least_votes: int
    least_planes: int
    is_document: bool


@kernel
def _votes(position, pairs, groups, windows):  # type: ignore[no-untyped-def]
    """Return the votes of each pair in each plane: θ, d and whether it is confirmed."""
    count = len(pairs)
    theta, distance = np.empty((len(PLANES), count)), np.empty((len(PLANES), count))
    confirmed = np.zeros((len(PLANES), count), np.bool_)
    inside, sorted_in = np.empty(count, np.int64), np.empty(count)
    own_theta, own_distance, is_own = np.empty(count), np.empty(count), np.empty(count, np.bool_)
    group_of = np.empty(count, np.int64)
    for pair in range(count):
        group_of[pair] = groups[pairs[pair, 0]]
    order = np.argsort(group_of, kind="mergesort")
    centre = windows.station.copy()
    first = 0
    while first < count:
        end = first
        while end < count and group_of[order[end]] == group_of[order[first]]:
            end += 1
        chosen = order[first:end]
        if not windows.is_document:
            # The mean over the ends of pairs: each plot counts as often as it votes.
            centre[:] = 0.0
            for pair in chosen:
                for axis in range(3):
                    both = position[pairs[pair, 0], axis] + position[pairs[pair, 1], axis]
                    centre[axis] += 0.5 * both / len(chosen)
        for plane in range(len(PLANES)):
            votes_of_pairs(
                position, pairs, chosen, PLANES[plane, 0], PLANES[plane, 1], centre, own_theta, own_distance
            )
            is_own[: len(chosen)] = False
            if len(chosen) >= windows.least_votes:
                confirm(
                    own_theta, own_distance, len(chosen), windows.width, windows.height,
                    windows.is_document, windows.least_votes, is_own, inside, sorted_in,
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
def _usable_plots(measured, pairs, windows):  # type: ignore[no-untyped-def]
    """Return which plots are confirmed in enough planes, and the number of pairs that voted."""
    count = len(measured.time)
    usable = np.zeros(count, np.bool_)
    if len(pairs) >= windows.least_votes:
        groups = _groups(count, pairs, windows.is_document)
        _, _, confirmed = _votes(measured.position, pairs, groups, windows)
        numbers = _planes_of_plots(count, pairs, confirmed)
        for plot in range(count):
            usable[plot] = numbers[plot] >= windows.least_planes
    return usable, len(pairs)


@kernel
def _nearest_of_scans(measured, rows, count, space, chosen):  # type: ignore[no-untyped-def]
    """Write of each scan the plot that lies nearest to the motion fitted to all; return how many scans.

    Parameters
    ----------
    rows : int64, the plots, the first `count` of them
    space : `Fitting`
    chosen : int64 (≥ scans,), written
    """
    start, fitted = rows[0], space.fit.state
    for k in range(count):
        add_plot(space.sums, min(k, 1), 1, measured, rows[k], start, SPACE)
    fit(space.sums, 1, space.fit, SPACE)
    for axis in range(3):
        fitted[0, axis] += measured.position[start, axis]
    motion = Motion(fitted[0], fitted[1], measured.time[start])
    number, nearest = 0, np.inf
    for k in range(count):
        plot = rows[k]
        miss = squared_miss(motion, measured, plot, SPACE)
        if number == 0 or measured.scan[plot] != measured.scan[chosen[number - 1]]:
            chosen[number] = plot
            number += 1
            nearest = miss
        elif miss < nearest:
            chosen[number - 1] = plot
            nearest = miss
    return number


@kernel
def _connected_tracks(measured, pairs, kept, usable, rule, made, table, count):  # type: ignore[no-untyped-def]
    """Append each set of plots from three scans or more that kept pairs connect, one plot a scan.

    Arguments and results are those of `fitted_tracks`.
    """
    scan = measured.scan
    groups = components(len(scan), pairs, kept)
    rows, chosen = np.empty(len(scan), np.int64), np.empty(len(scan), np.int64)
    for group in range(len(scan)):
        if groups[group] != group:
            continue
        members = 0
        for plot in range(group, len(scan)):
            if groups[plot] == group:
                rows[members] = plot
                members += 1
        scans = 0
        for k in range(members):
            scans += k == 0 or scan[rows[k]] != scan[rows[k - 1]]
        if scans >= LEAST_PLOTS:
            number = _nearest_of_scans(measured, rows, members, made.fitting, chosen)
            table = with_track(table, count, measured, chosen[:number], made.fitting)
            count += 1
    return table, count, False


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

    tracks_of_trials = trial_loop(_usable_plots, fitted_tracks)
    connected_of_trials = trial_loop(_usable_plots, _connected_tracks)

    def kernel_of(self, parameters: CombinatorialParameters) -> Callable[..., Any]:
        """Return the kernel that finds the tracks of each trial: in the document's mode nothing is fitted."""
        both = type(self).connected_of_trials, type(self).tracks_of_trials
        return both[parameters.mode == "sound"]

    def sieve(self, context: Context, parameters: CombinatorialParameters) -> Windows:
        """Return the windows that confirm plots."""
        return Windows(
            station_of(context),
            math.radians(float(parameters.window_deg)),
            float(parameters.window_length),
            int(parameters.votes),
            parameters.planes,
            parameters.mode == "document",
        )

    def rule(self, parameters: CombinatorialParameters, most: int) -> TrackRule:
        """Return what makes plots a track; in the document's mode nothing is allowed for noise."""
        rule = super().rule(parameters, most)
        if parameters.mode == "sound":
            return rule
        return rule._replace(gate=rule.gate._replace(allowance=0.0))

    def confirming_plots(self, parameters: CombinatorialParameters) -> int:
        """Return with how many plots a track can be declared: the least `plots`, or three without a fit."""
        return int(parameters.plots) if parameters.mode == "sound" else LEAST_PLOTS

    def plane_votes(self, plots: Plots, context: Context, parameters: CombinatorialParameters) -> PlaneVotes:
        """Return the votes of all pairs that pass the gate.

        d is measured from the middle of the plots that pairs connect; in the document's mode, from
        the radar.

        Raises
        ------
        RequestError
            Where plots have no z, or their noise is not known.
        """
        measured = self.measured(plots.chunk(), context)
        windows = self.sieve(context, parameters)
        pairs, tried = pairs_within_reach(measured, self.rule(parameters, LEAST_PLOTS).gate, STEPS, SPACE)
        groups = _groups(len(plots), pairs, windows.is_document)
        theta, distance, confirmed = _votes(measured.position, pairs, groups, windows)
        window = windows.width, windows.height
        return PlaneVotes(pairs, theta, distance, confirmed, int(tried), window, windows.least_votes)


INITIATOR = Combinatorial3D()
