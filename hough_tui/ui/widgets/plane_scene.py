"""What the plane shows, and how it is painted: plots by age, true paths, tracks by state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from rich.style import Style

from algorithms.context import Box
from hough_tui.ui.drawing.braille import Canvas
from hough_tui.ui.drawing.graticule import Figure, Sector, graticule
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.viewport import Limits, Viewport

Array = NDArray[np.float64]
Words = list[tuple[str, Style | None]]

MARKS = {"found": "○", "duplicate": "◇", "false": "×", "unknown": "□"}
"""Characters at the plots of tracks: their states are told apart without colour."""

NAMES = {
    "found": ("found", "found"),
    "duplicate": ("duplicate", "dup."),
    "false": ("false", "false"),
    "unknown": ("tracks", "tracks"),
}
"""Long and short names of the states in the legend."""

LIT_MARK, CURSOR_MARK = "●", "◆"

AGES = 4
"""Shades of plots, from the oldest scans to the newest."""

MOST_LABELS = 40
"""More labels than these would hide what they are for."""

DASH, RING_DASH = 3, 1
"""Dots of a dash of a true path, and of rings and spokes."""

TARGET_SIZE = 2
"""Side of the plot of a target, in dots; that of clutter is one dot."""

# Layers, from the lowest; those of plots are followed by one for each further age.
RULE, CLUTTER, TRUTH = 1, 2, 2 + AGES
TARGET = TRUTH + 1
DUPLICATE = TARGET + AGES
TRACKS = {"duplicate": DUPLICATE, "unknown": DUPLICATE + 1, "found": DUPLICATE + 2, "false": DUPLICATE + 3}
CHOSEN = DUPLICATE + len(TRACKS)
LIT, CURSOR = CHOSEN + 1, CHOSEN + 2


@dataclass(frozen=True, slots=True, eq=False)
class PlaneTrack:
    """A track in the plane.

    Attributes
    ----------
    path : float64 (k, 2), its plots in order of scan
    state : "found", "false", "duplicate" or "unknown"
    label : what is written at its last plot; may be empty
    """

    path: Array
    state: str
    label: str = ""


@dataclass(frozen=True, eq=False)
class PlaneScene:
    """Everything that the plane shows of a trial.

    Attributes
    ----------
    position : float64 (n, 2), the plots; of 3-D plots without further words the plane shows x and y
    scan : int32 (n,), their scans
    limits : the region
    unit : of length
    origin : int32 (n,), the target that caused each plot, −1 for clutter; None where it is not known
    truth : the true paths, each float64 (k, 2)
    tracks : the tracks
    sectors : what polar sensors see; rings and spokes are drawn about their stations
    names : what the axes are called
    is_projection : whether it is one of the planes on which space is projected
    is_framed : whether the region has a frame
    """

    position: Array
    scan: NDArray[np.int32]
    limits: Box
    unit: str
    origin: NDArray[np.int32] | None = None
    truth: tuple[Array, ...] = ()
    tracks: tuple[PlaneTrack, ...] = ()
    sectors: tuple[Sector, ...] = ()
    names: tuple[str, str] = ("x", "y")
    is_projection: bool = False
    is_framed: bool = True

    def __post_init__(self) -> None:
        given = np.asarray(self.position, float)
        position = given.reshape(len(given), -1)[:, :2] if given.size else np.empty((0, 2))
        object.__setattr__(self, "position", position)

    @cached_property
    def is_target(self) -> NDArray[np.bool_]:
        """Which plots a target is known to have caused."""
        if self.origin is None:
            return np.zeros(len(self.position), np.bool_)
        return np.asarray(self.origin) >= 0

    @cached_property
    def age(self) -> NDArray[np.int64]:
        """The shade of each plot: 0 for the oldest scans, the highest for the newest."""
        scan = np.asarray(self.scan, np.int64)
        if not len(scan):
            return scan
        first, last = int(scan.min()), int(scan.max())
        if first == last:
            return np.full(len(scan), AGES - 1, np.int64)
        return (scan - first) * (AGES - 1) // (last - first)

    def home(self) -> Limits:
        """Return limits with the region and what lies around it in view, and a margin."""
        lower, upper = self.limits.lower, self.limits.upper
        region = _never_flat(Limits(lower[0], upper[0], lower[1], upper[1]))
        near = region.expanded(3.0)
        points = np.concatenate([self.position, *self.truth, *(track.path for track in self.tracks)])
        # One plot a world away must not make a dot of all the others.
        points = points[near.holds(points[:, 0], points[:, 1])]
        if len(points):
            west, south = np.minimum(points.min(axis=0), (region.left, region.bottom)).tolist()
            east, north = np.maximum(points.max(axis=0), (region.right, region.top)).tolist()
            region = Limits(west, east, south, north)
        return region.expanded(1.06)


def _never_flat(limits: Limits) -> Limits:
    """Return limits with both sides of some length."""
    left, right, bottom, top = limits
    size = max(right - left, top - bottom) or max(1.0, 1e-6 * abs(left), 1e-6 * abs(bottom))
    across = 0.0 if right - left > 1e-6 * size else 0.5 * size
    up = 0.0 if top - bottom > 1e-6 * size else 0.5 * size
    return Limits(left - across, right + across, bottom - up, top + up)


def styles(colours: Palette) -> list[Style | None]:
    """Return the style of each layer."""
    tracks = [ink(colours.track(state)) for state in TRACKS]
    return [
        None,
        ink(colours.rule),
        *(ink(colour) for colour in colours.clutter),
        ink(colours.truth),
        *(ink(colour) for colour in colours.target),
        *tracks,
        ink(colours.lit, bold=True),
        ink(colours.lit, bold=True),
        ink(colours.lit, bold=True, reverse=True),
    ]


@dataclass(frozen=True, slots=True)
class Label:
    """Where the label of a track is written.

    Attributes
    ----------
    row, column : of its first character
    words : the label
    track : whose it is
    """

    row: int
    column: int
    words: str
    track: int

    def holds(self, row: int, column: int) -> bool:
        """Return whether a cell is part of it."""
        return row == self.row and self.column <= column < self.column + len(self.words)


def painted(
    scene: PlaneScene,
    viewport: Viewport,
    lit: NDArray[np.int64],
    cursor: int | None,
    track: int | None,
) -> tuple[Canvas, list[Label]]:
    """Return the picture of a scene, and where its labels are.

    Parameters
    ----------
    scene : what there is
    viewport : what part of it is in view
    lit : plots that light up
    cursor : the plot under the cursor
    track : the chosen track
    """
    canvas = Canvas(viewport)
    round_stations = graticule(scene.sectors, viewport)
    canvas.lines(round_stations.lines, [RULE] * len(round_stations.lines), RING_DASH)
    canvas.lines(round_stations.edges, [RULE] * len(round_stations.edges))
    canvas.as_ground()
    (west, south), (east, north) = scene.limits.lower[:2], scene.limits.upper[:2]
    corners = np.array([(west, south), (east, south), (east, north), (west, north), (west, south)])
    if scene.is_framed:
        canvas.lines([corners], [RULE])
    is_target, age = scene.is_target, scene.age
    canvas.points(scene.position[~is_target], CLUTTER + age[~is_target])
    canvas.points(scene.position[is_target], TARGET + age[is_target], TARGET_SIZE)
    canvas.lines(scene.truth, [TRUTH] * len(scene.truth), DASH)
    layers = [
        CHOSEN if index == track else TRACKS.get(one.state, TRACKS["unknown"])
        for index, one in enumerate(scene.tracks)
    ]
    canvas.lines([one.path for one in scene.tracks], layers)
    for state, mark in MARKS.items():
        # A false track has its mark at every plot, and so has the chosen one; others have it at the last.
        paths = [
            (one.path if state == "false" or layer == CHOSEN else one.path[-1:], layer)
            for one, layer in zip(scene.tracks, layers, strict=True)
            if (one.state if one.state in MARKS else "unknown") == state
        ]
        if paths:
            of_each = np.repeat([layer for _, layer in paths], [len(path) for path, _ in paths])
            canvas.marks(np.concatenate([path for path, _ in paths]), mark, of_each)
    canvas.marks(scene.position[lit], LIT_MARK, LIT)
    if cursor is not None:
        canvas.marks(scene.position[[cursor]], CURSOR_MARK, CURSOR)
    labels = _labelled(canvas, scene.tracks, track)
    for label in labels:
        canvas.write(
            label.row, label.column, label.words, CURSOR if label.track == track else layers[label.track]
        )
    _write_figures(canvas, round_stations.figures)
    return canvas, labels


def _write_figures(canvas: Canvas, given: Sequence[Figure]) -> None:
    """Write the figures of rings and spokes where they cover nothing but these, or not at all."""
    viewport = canvas.viewport
    for figure in given:
        for x, y in figure.places.tolist():
            if not viewport.limits.holds(x, y):
                continue
            row, column = int(viewport.row(y)), int(viewport.column(x)) - len(figure.words) // 2
            # A blank on each side keeps figures apart.
            if canvas.is_ground(row, column - 1, len(figure.words) + 2):
                canvas.write(row, column, figure.words, RULE)
                break


def _labelled(canvas: Canvas, tracks: Sequence[PlaneTrack], chosen: int | None) -> list[Label]:
    """Return the labels for which there is room beside the last plots, that of the chosen track first."""
    viewport, found = canvas.viewport, list[Label]()
    for index in sorted(range(len(tracks)), key=lambda index: index != chosen):
        path, words = tracks[index].path, tracks[index].label
        finite = path[np.isfinite(path).all(axis=1)][-1:]
        if not words or not len(finite) or not viewport.limits.holds(*finite[0].tolist()):
            continue
        row, column = int(viewport.row(float(finite[0, 1]))), int(viewport.column(float(finite[0, 0])))
        places = [
            Label(row, column + 2, words, index),
            Label(row, column - 1 - len(words), words, index),
            Label(row - 1, column + 1, words, index),
            Label(row + 1, column + 1, words, index),
        ]
        # A blank on each side keeps labels and marks apart.
        free = [label for label in places if canvas.is_free(label.row, label.column - 1, len(words) + 2)]
        if not free and index == chosen:
            free = [label for label in places if 0 <= label.column <= viewport.width - len(words)]
        if free:
            found.append(free[0])
            canvas.write(free[0].row, free[0].column, words, RULE)
        if len(found) == MOST_LABELS:
            break
    return found


def legend(scene: PlaneScene, colours: Palette, width: int) -> Words:
    """Return what the marks mean and how many there are of each, in so many columns if possible."""
    targets = int(scene.is_target.sum())
    clutter = "plots" if scene.origin is None else "clutter"
    # Mark, style, number, long and short name.
    entries = [
        ("·", ink(colours.clutter[-1], bold=True), len(scene.position) - targets, clutter, clutter),
        ("▪", ink(colours.target[-1]), targets, "of targets", "target"),
        ("╌", ink(colours.truth), len(scene.truth), "true", "true"),
    ]
    for state, mark in MARKS.items():
        count = sum((track.state if track.state in MARKS else "unknown") == state for track in scene.tracks)
        entries.append((mark, ink(colours.track(state)), count, *NAMES[state]))
    muted = ink(colours.muted)
    words: Words = []
    for between, name in (("   ", 3), ("  ", 4), (" ", 4), ("  ", None)):
        words = []
        for entry in entries:
            if entry[2] or entry is entries[0]:
                words.append((f"{between if words else ''}{entry[0]} ", entry[1]))
                words.append((f"{entry[2]:,} {entry[name]}" if name else f"{entry[2]:,}", muted))
        if sum(len(text) for text, _ in words) <= width:
            break
    return words
