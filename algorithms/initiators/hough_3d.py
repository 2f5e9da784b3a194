"""Iterative Hough transform for lines in space, with the plots of each line tested in time."""

from __future__ import annotations

import math
from functools import cache
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from algorithms.compiled import kernel
from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.initiators.in_space import MotionParameters, SpaceInitiator
from algorithms.parameters import Auto, Count, Dimension, Positive, parameter
from algorithms.plots import PlotChunk
from algorithms.rounding import floored
from algorithms.space.trial_loop import fitted_tracks, trial_loop
from algorithms.tracks import TrackChunk

Array = NDArray[np.float64]

CELLS_ACROSS = 64
"""Default number of cells across the greatest extent of the plots, as the source's program takes it."""

NOISE_IN_CELL = 3.0
"""The least width of a default cell in standard deviations: with few plots their extent is no measure."""

MOST_CELLS = 2**30
"""The most cells across the plots of a batch: row and column of a cell are one whole number of 64 bits."""


class Hough3DParameters(MotionParameters):
    """The parameters of `hough-3d`."""

    tessellation: Annotated[Count, Field(le=6)] = parameter(
        4,
        dimension=Dimension.COUNT,
        help="how often the faces of an icosahedron are divided; 4 gives 1,281 directions, 5 gives 5,121",
    )
    cell: Positive | Auto = parameter(
        "auto",
        dimension=Dimension.LENGTH,
        help="width of a cell across a direction",
        auto="a 64th of the greatest extent of the plots of a batch, at least 3 standard deviations of the "
        "noisiest",
    )
    lines: Count = parameter(
        20, dimension=Dimension.COUNT, help="how many lines are taken at most from one batch"
    )


@cache
def directions(tessellation: int) -> Array:
    """Return unit vectors spread evenly over half the sphere: one of each pair of opposite ones.

    Parameters
    ----------
    tessellation : how often each triangle of an icosahedron is divided into four

    Returns
    -------
    float64 (5·4^tessellation + 1, 3), with z > 0, or on the equator y > 0, or x = 1
    """
    golden = 0.5 * (1.0 + math.sqrt(5.0))
    corners = np.array([[0.0, s, t * golden] for s in (-1.0, 1.0) for t in (-1.0, 1.0)])
    vertices = np.concatenate([np.roll(corners, turn, axis=1) for turn in range(3)])
    vertices /= np.linalg.norm(vertices[0])
    apart = np.linalg.norm(vertices[:, None] - vertices[None], axis=-1)
    edge = np.min(apart[apart > 1e-9]) + 1e-9
    near = apart < edge
    faces = [
        vertices[[i, j, k]]
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    triangles = np.array(faces)
    for _ in range(tessellation):
        middles = triangles + np.roll(triangles, -1, axis=1)
        middles /= np.linalg.norm(middles, axis=-1, keepdims=True)
        a, b, c = (triangles[:, corner] for corner in range(3))
        ab, bc, ca = (middles[:, corner] for corner in range(3))
        parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = np.concatenate([np.stack(part, axis=1) for part in parts])
    every = np.unique(np.round(triangles.reshape(-1, 3), 9), axis=0)
    x, y, z = every.T
    upper = (z > 0) | ((z == 0) & ((y > 0) | ((y == 0) & (x > 0))))
    chosen = every[upper]
    return np.ascontiguousarray(chosen / np.linalg.norm(chosen, axis=1, keepdims=True))


@kernel
def across(direction, place):  # type: ignore[no-untyped-def]
    """Return where a line through a place meets the plane across its direction, in two coordinates.

    References
    ----------
    K. S. Roberts, "A new representation for a line", CVPR 1988.
    """
    bx, by, bz = direction[0], direction[1], direction[2]
    scale = 1.0 / (1.0 + bz)
    x, y, z = place[0], place[1], place[2]
    first = (1.0 - bx * bx * scale) * x - bx * by * scale * y - bx * z
    second = -bx * by * scale * x + (1.0 - by * by * scale) * y - by * z
    return first, second


@kernel
def _fullest_of(position, middle, left, around, direction, cell, half, keys, place):  # type: ignore[no-untyped-def]
    """Return the cell with the most votes for one direction, and the votes.

    The cells of all plots are written down and sorted: there are far fewer plots than cells.
    """
    width = 2 * half
    for k in range(len(left)):
        for axis in range(3):
            place[axis] = position[left[k], axis] - middle[axis]
        first, second = across(around[direction], place)
        # The middle of the plots is the middle of a cell: a line through it shall not lie at an edge.
        row = min(max(floored(first / cell + 0.5), -half), half - 1)
        column = min(max(floored(second / cell + 0.5), -half), half - 1)
        keys[k] = (row + half) * width + column + half
    cells = keys[: len(left)]
    cells.sort()
    best, where, run = 0, np.int64(0), 0
    for k in range(len(left)):
        run = run + 1 if k > 0 and cells[k] == cells[k - 1] else 1
        if run > best:
            best, where = run, cells[k]
    return where, best


@kernel
def _fullest_cell(position, middle, left, around, cell, half, bounds, keys, place):  # type: ignore[no-untyped-def]
    """Return the direction, the row and the column of the cell with the most votes, and the votes.

    Parameters
    ----------
    bounds : int64 (directions,), no direction has a cell with more votes; brought up to date. Since
        votes only go, few directions must be looked at again for the next line.
    """
    while True:
        direction = np.argmax(bounds)
        where, votes = _fullest_of(position, middle, left, around, direction, cell, half, keys, place)
        if votes == bounds[direction]:
            return direction, where // (2 * half) - half, where % (2 * half) - half, votes
        bounds[direction] = votes


@kernel
def _line_through(position, rows, count, centre, direction):  # type: ignore[no-untyped-def]
    """Write the orthogonal least-squares line through some plots: their mean and main axis.

    Returns
    -------
    whether there is one: the squares of very distant plots are no finite numbers
    """
    centre[:] = 0.0
    for k in range(count):
        for axis in range(3):
            centre[axis] += position[rows[k], axis] / count
    spread = np.zeros((3, 3))
    for k in range(count):
        for first in range(3):
            for second in range(3):
                spread[first, second] += (position[rows[k], first] - centre[first]) * (
                    position[rows[k], second] - centre[second]
                )
    if not np.isfinite(spread.sum()):
        return False
    _, vectors = np.linalg.eigh(spread)
    for axis in range(3):
        direction[axis] = vectors[axis, 2]
    return True


@kernel
def _near_line(position, left, centre, direction, reach, rows):  # type: ignore[no-untyped-def]
    """Write the plots within reach of a line; return how many."""
    count = 0
    for plot in left:
        along, square = 0.0, 0.0
        for axis in range(3):
            step = position[plot, axis] - centre[axis]
            along += step * direction[axis]
            square += step * step
        if square - along * along <= reach * reach:
            rows[count] = plot
            count += 1
    return count


@kernel
def _lines(position, covariance, around, cell, most, least, usable):  # type: ignore[no-untyped-def]
    """Set which plots lie on one of the lines that are taken, the one with the most votes first."""
    count = len(position)
    lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
    for plot in range(count):
        for axis in range(3):
            lower[axis] = min(lower[axis], position[plot, axis])
            upper[axis] = max(upper[axis], position[plot, axis])
    middle, extent = np.empty(3), 0.0
    for axis in range(3):
        middle[axis] = 0.5 * (lower[axis] + upper[axis])
        extent = max(extent, upper[axis] - lower[axis])
    if not extent > 0.0:
        usable[:] = True
        return
    if cell <= 0.0:
        noise = 0.0
        for plot in range(len(covariance)):
            noise = max(noise, covariance[plot, 0, 0] + covariance[plot, 1, 1] + covariance[plot, 2, 2])
        cell = max(extent / CELLS_ACROSS, NOISE_IN_CELL * math.sqrt(noise))
    # No plot is farther from the middle than half the diagonal of its box.
    half = min(floored(0.5 * math.sqrt(3.0) * extent / cell) + 2, MOST_CELLS)
    left = np.arange(count)
    keys, bounds = np.empty(count, np.int64), np.empty(len(around), np.int64)
    rows, centre, direction = np.empty(count, np.int64), np.empty(3), np.empty(3)
    place = np.empty(3)
    for k in range(len(around)):
        _, bounds[k] = _fullest_of(position, middle, left, around, k, cell, half, keys, place)
    for _ in range(most):
        chosen, row, column, best = _fullest_cell(
            position, middle, left, around, cell, half, bounds, keys, place
        )
        if best < least:
            return
        found = 0
        for still in left:
            for axis in range(3):
                place[axis] = position[still, axis] - middle[axis]
            first, second = across(around[chosen], place)
            # The cell and half of its neighbours: the line may lie at its edge.
            if abs(first / cell - row) < 1.0 and abs(second / cell - column) < 1.0:
                rows[found] = still
                found += 1
        if not _line_through(position, rows, found, centre, direction):
            return
        found = _near_line(position, left, centre, direction, cell, rows)
        if found < 2 or not _line_through(position, rows, found, centre, direction):
            return
        found = _near_line(position, left, centre, direction, cell, rows)
        if found == 0:
            return
        for k in range(found):
            usable[rows[k]] = True
        remaining, number = np.empty(len(left), np.int64), 0
        for still in left:
            if not usable[still]:
                remaining[number] = still
                number += 1
        left = remaining[:number]
        if number < least:
            return


class Lines(NamedTuple):
    """Lines that are sought among plots.

    Attributes
    ----------
    around : float64 (directions, 3), unit vectors
    cell : width of a cell across a direction; 0 for the default, which depends on the plots
    most : how many lines are taken at most
    least : the least votes of a line
    """

    around: Array
    cell: float
    most: int
    least: int


@kernel
def _usable_plots(measured, pairs, lines):  # type: ignore[no-untyped-def]
    """Return which plots lie on lines, and the number of pairs between these."""
    usable = np.zeros(len(measured.time), np.bool_)
    if len(measured.time) >= lines.least:
        _lines(
            measured.position, measured.covariance, lines.around, lines.cell, lines.most, lines.least, usable
        )
    left = 0
    for pair in range(len(pairs)):
        left += usable[pairs[pair, 0]] and usable[pairs[pair, 1]]
    return usable, left


class Hough3D(SpaceInitiator):
    """Lines in space by an iterative Hough transform; along their plots, tracks of constant velocity.

    Every plot votes, for each of some thousand directions, for the cell in which the line through
    it crosses the plane across that direction. The cell with the most votes gives a line, which is
    fitted to the plots near it twice; these take their votes back, and the next line is sought.
    Lines know nothing of time: tracks are what a constant velocity makes of the plots on them.

    References
    ----------
    C. Dalitz, T. Schramke and M. Jeltsch, "Iterative Hough transform for line detection in 3D point
    clouds", Image Processing On Line 7, 2017. Deviation: the source's lines end here in a test of
    time, by the same pairs, χ² and gates as the other initiators in space.
    """

    name = "hough-3d"
    summary = "lines in space by an iterative Hough transform, tested in time"
    source = "Dalitz, Schramke and Jeltsch, Image Processing On Line, 2017"
    parameters = Hough3DParameters

    tracks_of_trials = trial_loop(_usable_plots, fitted_tracks)

    def initiate_chunk(self, chunk: PlotChunk, context: Context, parameters: Hough3DParameters) -> TrackChunk:
        """Return the tracks of each trial, with their plots and states; see `SpaceInitiator`.

        Raises
        ------
        RequestError
            Also where the cells are too narrow for the extent of the plots.
        """
        if parameters.cell != "auto" and len(chunk.position):
            _check_cell(float(parameters.cell), float(np.ptp(chunk.position, axis=0).max()))
        return super().initiate_chunk(chunk, context, parameters)

    def sieve(self, context: Context, parameters: Hough3DParameters) -> Lines:
        """Return which lines are sought."""
        cell = 0.0 if parameters.cell == "auto" else float(parameters.cell)
        return Lines(directions(parameters.tessellation), cell, parameters.lines, int(parameters.plots))


def _check_cell(cell: float, extent: float) -> None:
    # The diagonal of the box around the plots, and the cells at its ends.
    across = math.sqrt(3.0) * extent / cell + 4.0
    if across > MOST_CELLS:
        raise RequestError(
            f"hough-3d: cell {cell:g} is given, and the plots extend over {extent:g}, which are {across:.3g} "
            f"cells; the limit is {MOST_CELLS:,}; give a larger cell"
        )


INITIATOR = Hough3D()
