"""Combinatorial Hough transform in a plane: each pair of plots is one vote for its line."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.rounding import floored

PLANES = np.array([[0, 1], [0, 2], [1, 2]])
"""Axes of the planes xy, xz and yz."""


@dataclass(frozen=True, slots=True, eq=False)
class PlaneVotes:
    """The votes of pairs of plots in the planes xy, xz and yz, each pair with one in each.

    Attributes
    ----------
    pairs : int64 (k, 2), rows of the two plots, the earlier one first
    theta : float64 (3, k), direction of the line through the two, in [0, π); NaN where they coincide
    distance : float64 (3, k), d = x·sin θ − y·cos θ from where the initiator measures it; NaN likewise
    confirmed : bool (3, k), whether enough other votes lie with it in a window of the plane
    tried : how many pairs there were before the gate of their distance
    window : size of a window, in radians and in length
    least : the least votes of a window that confirms them
    """

    pairs: NDArray[np.int64]
    theta: NDArray[np.float64]
    distance: NDArray[np.float64]
    confirmed: NDArray[np.bool_]
    tried: int
    window: tuple[float, float]
    least: int

    def __len__(self) -> int:
        return len(self.pairs)


@kernel
def votes_of_pairs(position, pairs, chosen, across, up, centre, theta, distance):  # type: ignore[no-untyped-def]
    """Write the line of each chosen pair in a plane, NaN where its projections coincide.

    With θ the direction of the line and d = x·sin θ − y·cos θ its signed distance from the
    centre, (θ, d) and (θ + π, −d) are one line; θ is in [0, π).

    Parameters
    ----------
    position : float64 (n, 3)
    pairs : int64 (k, 2)
    chosen : int64 (m,), which of the pairs vote
    across, up : the axes of the plane
    centre : float64 (3,)
    theta, distance : float64 (≥ m,), written
    """
    for vote in range(len(chosen)):
        first, second = pairs[chosen[vote], 0], pairs[chosen[vote], 1]
        x = position[second, across] - position[first, across]
        y = position[second, up] - position[first, up]
        if x == 0.0 and y == 0.0:
            theta[vote], distance[vote] = np.nan, np.nan
            continue
        angle = math.atan2(y, x)
        if angle < 0.0:
            angle += math.pi
        if angle >= math.pi:
            angle = 0.0
        theta[vote] = angle
        # The line through the middle of the two: each alone would give its own rounding.
        at_x = 0.5 * (position[first, across] + position[second, across]) - centre[across]
        at_y = 0.5 * (position[first, up] + position[second, up]) - centre[up]
        distance[vote] = at_x * math.sin(angle) - at_y * math.cos(angle)


@kernel
def confirm(theta, distance, count, width, height, is_fixed, least, confirmed, inside, sorted_in):  # type: ignore[no-untyped-def]
    """Mark the votes that lie in a window of θ and d with at least so many votes.

    A window that holds enough votes can be moved until one of them lies on its lower edge in θ
    and one on its lower edge in d; so the windows that begin at votes are tried. Beyond θ = π
    they go on at 0 with the sign of d changed.

    Parameters
    ----------
    theta, distance : float64 (≥ count,), NaN for none
    width, height : of a window, in radians and in length
    is_fixed : whether windows are the fixed cells of θ that begin at 0, and end at π
    least : least number of votes
    confirmed : bool (≥ count,), set where a vote lies in such a window
    inside, sorted_in : int64 and float64 (≥ count,), working space
    """
    for begin in range(-floored(-math.pi / width) if is_fixed else count):
        lowest = begin * width if is_fixed else theta[begin]
        if np.isnan(lowest):
            continue
        found = 0
        for vote in range(count):
            if np.isnan(theta[vote]):
                continue
            beyond = theta[vote] - lowest
            sign = 1.0
            if beyond < 0.0:
                if is_fixed:
                    continue
                beyond, sign = beyond + math.pi, -1.0
            if beyond < width or (beyond == width and not is_fixed):
                inside[found] = vote
                sorted_in[found] = sign * distance[vote]
                found += 1
        if found < least:
            continue
        order = np.argsort(sorted_in[:found])
        end = 0
        for first in range(found):
            while end < found and sorted_in[order[end]] <= sorted_in[order[first]] + height:
                end += 1
            if end - first >= least:
                for k in range(first, end):
                    confirmed[inside[order[k]]] = True
