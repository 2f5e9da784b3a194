"""Range rings and azimuth spokes about the stations of polar sensors, as round as the view asks for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hough_tui.ui.drawing.axes import figures, ticks
from hough_tui.ui.drawing.viewport import Limits, Viewport

Array = NDArray[np.float64]

RINGS = 5
"""Steps of range in view, at the most."""

SPOKE_APART, FEWEST_SPOKES = 30.0, 4
"""Least degrees between the spokes of a wide sector, and steps of a narrow one, at the most."""

CHORDS = 96
"""Straight pieces of the part of a ring that is in view."""

WHOLE_TURN = 360.0


@dataclass(frozen=True, slots=True)
class Sector:
    """What a polar sensor sees, in the plane (x, y).

    Attributes
    ----------
    station : where it stands
    near, far : the distances on the ground that it sees
    azimuth : first and last azimuth, degrees clockwise from the upright axis
    """

    station: tuple[float, float]
    near: float
    far: float
    azimuth: tuple[float, float]

    @property
    def is_whole_turn(self) -> bool:
        """Whether it sees all round."""
        return self.azimuth[1] - self.azimuth[0] >= WHOLE_TURN

    def at(self, distance: Array | float, azimuth_deg: Array | float) -> Array:
        """Return points by their distance and azimuth: float64 (…, 2)."""
        azimuth = np.radians(azimuth_deg)
        x, y = distance * np.sin(azimuth), distance * np.cos(azimuth)
        points: Array = np.stack(np.broadcast_arrays(x, y), axis=-1) + np.array(self.station)
        return points


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure of the graticule.

    Attributes
    ----------
    words : what is written
    places : points beside which it may be written, the best first
    """

    words: str
    places: Array


@dataclass(frozen=True, slots=True)
class Graticule:
    """The lines about stations.

    Attributes
    ----------
    edges : the outlines of sectors, each float64 (k, 2)
    lines : rings and spokes
    figures : what they stand for
    """

    edges: list[Array]
    lines: list[Array]
    figures: list[Figure]


@lru_cache(maxsize=16)
def graticule(sectors: tuple[Sector, ...], viewport: Viewport) -> Graticule:
    """Return rings and spokes that suit a view; the rings of all stations have one step."""
    seen = [(sector, part) for sector in sectors for part in _parts(sector, viewport.limits)]
    made = Graticule([], [], [])
    if not seen:
        return made
    _, step = ticks(0.0, max(part.farthest - part.nearest for _, part in seen), RINGS)
    for sector, part in seen:
        across = np.linspace(part.first, part.last, CHORDS + 1)
        made.edges.extend(sector.at(far, across) for far in (sector.near, sector.far) if far > 0.0)
        if not sector.is_whole_turn:
            made.edges.extend(sector.at(np.array([sector.near, sector.far]), end) for end in sector.azimuth)
        spokes, apart = _spokes(sector, part)
        numbers = range(math.ceil(part.nearest / step), math.floor(part.farthest / step) + 1)
        ranges = [number * step for number in numbers if sector.near < number * step < sector.far]
        middles = _middles(spokes, part)
        for distance, words in zip(ranges, figures(ranges, step), strict=True):
            made.lines.append(sector.at(distance, across))
            made.figures.append(Figure(words, sector.at(distance, middles)))
        # Where they come together at the station, spokes would hide one another and all else.
        reach = np.array([max(sector.near, min(step, 0.5 * sector.far)), sector.far])
        outer = part.farthest - step * np.arange(1, 2 * RINGS) / RINGS
        names = [azimuth % WHOLE_TURN if sector.is_whole_turn else azimuth for azimuth in spokes]
        for azimuth, words in zip(spokes, figures(names, apart), strict=True):
            made.lines.append(sector.at(reach, azimuth))
            made.figures.append(Figure(f"{words}°", sector.at(outer, azimuth)))
    return made


def _spokes(sector: Sector, part: Part) -> tuple[list[float], float]:
    """Return the azimuths of spokes in view, and their step."""
    span = part.last - part.first
    found, apart = ticks(part.first, part.last, max(FEWEST_SPOKES, round(span / SPOKE_APART)), is_angle=True)
    inside = [azimuth for azimuth in found if part.first <= azimuth <= part.last]
    # All round, the last one is the first one again.
    return [azimuth for azimuth in inside if azimuth < inside[0] + WHOLE_TURN], apart


def _middles(spokes: Sequence[float], part: Part) -> Array:
    """Return the azimuths between spokes, from the middle of the view outwards: no figure covers a spoke."""
    middle = 0.5 * (part.first + part.last)
    ends = [part.first, *spokes, part.last]
    between = [0.5 * (one + other) for one, other in pairwise(ends)]
    return np.array(sorted(between, key=lambda azimuth: abs(azimuth - middle)))


class Part(NamedTuple):
    """What of a sector is in view: distances, and azimuths as the sector counts them."""

    nearest: float
    farthest: float
    first: float
    last: float


def _parts(sector: Sector, limits: Limits) -> list[Part]:
    """Return what of a sector is in view: nothing, one part, or one at each end of a wide sector."""
    x, y = sector.station
    left, right, bottom, top = limits
    low_y, high_y = min(bottom, top), max(bottom, top)
    near = math.hypot(max(left - x, 0.0, x - right), max(low_y - y, 0.0, y - high_y))
    corners = [(across - x, up - y) for across in (left, right) for up in (bottom, top)]
    far = max(math.hypot(*corner) for corner in corners)
    low, high = max(near, sector.near), min(far, sector.far)
    if not low < high:
        return []
    first, last = sector.azimuth
    if near == 0.0:
        return [Part(low, high, first, last)]
    # From outside, the view spans less than half a turn about the azimuth of its middle.
    middle = math.degrees(math.atan2(0.5 * (left + right) - x, 0.5 * (bottom + top) - y))
    turns = [(math.degrees(math.atan2(*corner)) - middle + 180.0) % WHOLE_TURN - 180.0 for corner in corners]
    begin, end = middle + min(turns), middle + max(turns)
    if sector.is_whole_turn:
        return [Part(low, high, begin, end)]
    rounds = range(math.ceil((first - end) / WHOLE_TURN), math.floor((last - begin) / WHOLE_TURN) + 1)
    ends = [
        (max(first, begin + number * WHOLE_TURN), min(last, end + number * WHOLE_TURN)) for number in rounds
    ]
    return [Part(low, high, start, stop) for start, stop in ends if start < stop]
