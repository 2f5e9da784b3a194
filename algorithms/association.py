"""From a line to its plots."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.errors import RequestError
from algorithms.kinematics.constant_velocity import Motion, squared_miss
from algorithms.kinematics.least_squares import Fitting, add_plot, fit
from algorithms.kinematics.matrices import PLANE
from algorithms.kinematics.measured import Measured, part_of
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk

SEEDS = 128
"""The most plots beside one line among which motions are sought; of more, every k-th is taken."""

REFINEMENTS = 3
"""How often plots are chosen anew about the motion fitted to the plots chosen before."""

MOST_BYTES = 2**30
"""The most memory that the plots of the tracks of a chunk may take."""

FARTHEST = sys.float_info.max
"""No gate reaches beyond it, so that a scan without a plot, whose nearest is infinitely far, never passes."""


@kernel
def _motion(along, time, scan, gate):  # type: ignore[no-untyped-def]
    """Return position (at time 0) and speed along a line that the most scans agree with.

    Every pair of plots of different scans proposes a motion; a scan agrees where one of its
    plots lies within the gate. Equal counts are decided by the smaller sum of squares.
    """
    count = len(along)
    stride = (count + SEEDS - 1) // SEEDS if count > SEEDS else 1
    farthest = min(gate * gate, FARTHEST)
    best_scans, best_squares, best_start, best_speed = 0, np.inf, 0.0, 0.0
    for first in range(0, count, stride):
        for second in range(first + stride, count, stride):
            elapsed = time[second] - time[first]
            if scan[second] == scan[first] or elapsed == 0.0:
                continue
            speed = (along[second] - along[first]) / elapsed
            start = along[first] - speed * time[first]
            scans, squares, nearest, current = 0, 0.0, np.inf, np.int64(-1)
            for plot in range(0, count, stride):
                if scan[plot] != current:
                    if nearest <= farthest:
                        scans += 1
                        squares += nearest
                    current, nearest = np.int64(scan[plot]), np.inf
                miss = along[plot] - start - speed * time[plot]
                nearest = min(nearest, miss * miss)
            if nearest <= farthest:
                scans += 1
                squares += nearest
            if scans > best_scans or (scans == best_scans and squares < best_squares):
                best_scans, best_squares, best_start, best_speed = scans, squares, start, speed
    return best_scans, best_start, best_speed


class Line(NamedTuple):
    """A line ρ = x·cos θ + y·sin θ."""

    cosine: float
    sine: float
    rho: float


class Reach(NamedTuple):
    """How far from a line and from a motion a plot may lie.

    Attributes
    ----------
    half_width : greatest distance from the line
    gate : greatest distance from the fitted motion
    """

    half_width: float
    gate: float


class Beside(NamedTuple):
    """Plots beside a line: working space.

    Attributes
    ----------
    near, chosen : int64 (n,), rows of the plots beside the line, and of those that are taken
    along : float64 (n,), where they lie along it
    time, scan : float64 and int32 (n,)
    fitting : `Fitting`, in the plane
    """

    near: NDArray[np.int64]
    chosen: NDArray[np.int64]
    along: NDArray[np.float64]
    time: NDArray[np.float64]
    scan: NDArray[np.int32]
    fitting: Fitting

    @classmethod
    def of(cls, plots: int) -> Beside:
        """Return space for so many plots."""
        return cls(
            np.empty(plots, np.int64),
            np.empty(plots, np.int64),
            np.empty(plots),
            np.empty(plots),
            np.empty(plots, np.int32),
            Fitting.of(2),
        )


@kernel
def _fitted_motion(measured, rows, fitting):  # type: ignore[no-untyped-def]
    """Return the motion fitted to plots, and whether they are of more than one time."""
    sums, state = fitting.sums, fitting.fit.state
    is_settled = False
    for k in range(len(rows)):
        add_plot(sums, min(k, 1), 1, measured, rows[k], rows[0], PLANE)
        is_settled = is_settled or measured.time[rows[k]] != measured.time[rows[0]]
    fit(sums, 1, fitting.fit, PLANE)
    for axis in range(2):
        state[0, axis] += measured.position[rows[0], axis]
    return Motion(state[0], state[1], measured.time[rows[0]]), is_settled


@kernel
def _choose(measured, near, motion, gate, chosen):  # type: ignore[no-untyped-def]
    """Write the nearest plot of each scan within the gate of a motion; return how many."""
    scan = measured.scan
    count, current, nearest = 0, np.int64(-1), np.inf
    farthest = min(gate * gate, FARTHEST)
    for plot in near:
        if scan[plot] != current:
            if nearest <= farthest:
                count += 1
            current, nearest = np.int64(scan[plot]), np.inf
        miss = squared_miss(motion, measured, plot, PLANE)
        if miss < nearest:
            nearest = miss
            if miss <= farthest:
                chosen[count] = plot
    if nearest <= farthest:
        count += 1
    return count


@kernel
def _plots_of_line(measured, line, reach, beside):  # type: ignore[no-untyped-def]
    """Write the rows of the plots of one line to `beside.chosen`; return how many."""
    x, y, near = measured.position[:, 0], measured.position[:, 1], beside.near
    count = 0
    for plot in range(len(x)):
        if abs(x[plot] * line.cosine + y[plot] * line.sine - line.rho) <= reach.half_width:
            near[count] = plot
            beside.along[count] = y[plot] * line.cosine - x[plot] * line.sine
            beside.time[count] = measured.time[plot]
            beside.scan[count] = measured.scan[plot]
            count += 1
    if count == 0:
        return 0
    scans, start, speed = _motion(beside.along[:count], beside.time[:count], beside.scan[:count], reach.gate)
    if scans < 2:
        closest = 0
        for k in range(count):
            miss = abs(x[near[k]] * line.cosine + y[near[k]] * line.sine - line.rho)
            if miss < abs(x[near[closest]] * line.cosine + y[near[closest]] * line.sine - line.rho):
                closest = k
        beside.chosen[0] = near[closest]
        return 1
    near = near[:count]
    # The gate across the line is that of the strip; only what lies along it is tested at first.
    wide = np.hypot(reach.gate, reach.half_width)
    state = beside.fitting.fit.state
    state[0, 0], state[0, 1] = (
        line.rho * line.cosine - start * line.sine,
        line.rho * line.sine + start * line.cosine,
    )
    state[1, 0], state[1, 1] = -speed * line.sine, speed * line.cosine
    held = _choose(measured, near, Motion(state[0], state[1], 0.0), wide, beside.chosen)
    for _ in range(REFINEMENTS):
        if held == 0:
            break
        motion, is_settled = _fitted_motion(measured, beside.chosen[:held], beside.fitting)
        if not is_settled:
            break
        refined = _choose(measured, near, motion, reach.gate, beside.chosen)
        if refined < 2:
            # The plots lie too loosely for the gate: the motion stands on its first choice.
            held = _choose(measured, near, motion, wide, beside.chosen)
            break
        held = refined
    return held


@kernel
def _associate(measured, offsets, track_offsets, cosine, sine, rho, reach, beside, plots):  # type: ignore[no-untyped-def]
    """Write the plots of each line of each trial."""
    for trial in range(len(offsets) - 1):
        own = part_of(measured, offsets[trial], offsets[trial + 1])
        for track in range(track_offsets[trial], track_offsets[trial + 1]):
            line = Line(cosine[track], sine[track], rho[track])
            count = _plots_of_line(own, line, reach, beside)
            plots[track, :count] = beside.chosen[:count]


def associate(chunk: PlotChunk, tracks: TrackChunk, half_width: float, gate: float) -> TrackChunk:
    """Return tracks with the plots that move along their lines, at most one a scan.

    Of the plots beside a line those are chosen that agree with one constant velocity: nearness
    to the line alone takes clutter for the target (in the scene of the course report, 15 scans,
    it leaves a median velocity error of .139 km/s where the agreement in motion leaves .002).

    Parameters
    ----------
    chunk : plots
    tracks : lines
    half_width : greatest distance of a plot from the line
    gate : greatest distance of a plot from the fitted motion

    Raises
    ------
    RequestError
        Where the plots of all tracks would need more than `MOST_BYTES`.
    """
    # A scan number is no bound for the width: recordings may begin anywhere.
    scans = chunk.most_scans
    size = 8 * len(tracks.rho) * scans
    if size > MOST_BYTES:
        raise RequestError(
            f"{len(tracks.rho):,} tracks, each with a plot of up to {scans:,} scans, would need "
            f"{size / 2**30:,.1f} GiB; the limit is {MOST_BYTES / 2**30:g} GiB; ask for more "
            "votes, or give maxima"
        )
    plots = np.full((len(tracks.rho), scans), -1, np.int64)
    _associate(
        Measured.of(chunk, None, 2), chunk.offsets, tracks.offsets,
        np.cos(tracks.theta), np.sin(tracks.theta), tracks.rho,
        Reach(float(half_width), float(gate)), Beside.of(max(1, chunk.largest)), plots,
    )  # fmt: skip
    return replace(tracks, plots=plots)
