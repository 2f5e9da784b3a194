"""What the plane of clusters shows, and how it is painted: points by cluster, ellipses, one step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from rich.style import Style

from hough_tui.ui.drawing.braille import Canvas
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.viewport import Limits, Viewport

Array = NDArray[np.float64]
Number = TypeVar("Number", int, NDArray[np.int64])
Words = list[tuple[str, Style | None]]

NONE = -1
"""The cluster of a point that is in none."""

KEPT, DROPPED = "●■▲◆▼", "○□△◇▽"
"""Characters of the points of a cluster, one cluster after the other; hollow, where its plot is not made of
them."""

STRAY, PLOT, TRUE, BOTH, CURSOR_MARK = "·", "+", "×", "*", "◉"
"""Characters of points that are in no cluster, of plots, of true centres, of both in one cell, of the point
under the cursor."""

MOST_LABELS, MOST_ELLIPSES = 40, 400
"""More would hide what they are for."""

DASH = 2
"""Dots of a dash of a line at which a set is split."""

# Layers, from the lowest; those of a kind that has one a colour are followed by the others.
COLOURS = 5
RULE, REST, STRAYS, SPLIT = 1, 2, 3, 4
ELLIPSE = 5
OUTER = ELLIPSE + COLOURS
INNER = OUTER + COLOURS
MEASURE = INNER + COLOURS
TRUTH, LABEL, CENTRE, CURSOR = MEASURE + 1, MEASURE + 2, MEASURE + 3, MEASURE + 4


@dataclass(frozen=True, slots=True, eq=False)
class StepScene:
    """One set of points under consideration.

    Attributes
    ----------
    members : int64 (m,), its points
    is_upper : bool (m,), which of them go to the upper part; none where it is not split
    ellipse : float64 (k, 2), the outline of the ellipse on which it is measured
    chord : float64 (2, 2), the chord of the ellipse through its centre along range
    box : float64 (5, 2), the extents of the ellipse in range and Doppler; empty where they do not matter
    axis, cut : along which axis it is split, and where the line is drawn; None for a whole set
    cluster : the cluster that it is; None where it is none
    """

    members: NDArray[np.int64]
    is_upper: NDArray[np.bool_]
    ellipse: Array
    chord: Array
    box: Array
    axis: str | None = None
    cut: float | None = None
    cluster: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class ClusterScene:
    """Everything that the plane shows of a draw.

    Attributes
    ----------
    position : float64 (n, 2), range and Doppler of the points
    amplitude : float64 (n,)
    label : int64 (n,), the cluster of each; `NONE` of those in none
    kept : bool (n,), whether the plot of its cluster is made of it
    region : of the plane
    unit : of both axes
    plots : float64 (k, 2), what the clusters give
    ellipses : float64 (j, 2) each, outlines at the radius by which points are kept, of each cluster
    truth : float64 (targets, 2), the true centres
    origin : int32 (n,), the target that caused each point, −1 of others; None where it is not known
    """

    position: Array
    amplitude: Array
    label: NDArray[np.int64]
    kept: NDArray[np.bool_]
    region: Limits
    unit: str
    plots: Array
    ellipses: tuple[Array, ...]
    truth: Array
    origin: NDArray[np.int32] | None = None

    def home(self) -> Limits:
        """Return limits with the region and what lies around it in view, and a margin."""
        points = np.concatenate([self.position, self.plots, self.truth])
        # One point a world away must not make a dot of all the others.
        near = self.region.expanded(3.0)
        points = points[near.holds(points[:, 0], points[:, 1])]
        left, right, bottom, top = self.region
        corners = np.concatenate([points, [(left, bottom), (right, top)]])
        (left, bottom), (right, top) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        return Limits(left, right, bottom, top).expanded(1.04)

    def members(self, cluster: int) -> NDArray[np.int64]:
        """Return the points of a cluster."""
        return np.flatnonzero(self.label == cluster)


def colour_of(cluster: Number) -> Number:
    """Return which colour a cluster has: glyph and colour together come again after 25 clusters only."""
    return (cluster + cluster // len(KEPT)) % COLOURS


def styles(colours: Palette) -> list[Style | None]:
    """Return the style of each layer."""
    inks = (colours.unknown, colours.found, colours.target[-1], colours.duplicate, colours.false)
    assert len(inks) == COLOURS
    return [
        None,
        ink(colours.rule),
        ink(colours.rule),
        ink(colours.muted),
        ink(colours.lit, bold=True),
        *(ink(colour) for colour in inks),
        *(ink(colour) for colour in inks),
        *(ink(colour, bold=True) for colour in inks),
        ink(colours.lit),
        ink(colours.truth, bold=True),
        ink(colours.lit, bold=True),
        ink(colours.lit, bold=True),
        ink(colours.lit, bold=True, reverse=True),
    ]


def painted(
    scene: ClusterScene, viewport: Viewport, step: StepScene | None, cluster: int | None, cursor: int | None
) -> Canvas:
    """Return the picture of a scene.

    Parameters
    ----------
    scene : what there is
    viewport : what part of it is in view
    step : the set under consideration; None shows the clusters
    cluster : the chosen cluster
    cursor : the point under the cursor
    """
    canvas = Canvas(viewport)
    left, right, bottom, top = scene.region
    frame = np.array([(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)])
    canvas.lines([frame], [RULE])
    if step is None:
        _paint_clusters(canvas, scene)
    else:
        _paint_step(canvas, scene, step)
    canvas.marks(scene.truth, TRUE, TRUTH)
    if step is None:
        is_shared = _is_shared(viewport, scene.plots, scene.truth)
        canvas.marks(scene.plots[~is_shared], PLOT, CENTRE)
        canvas.marks(scene.plots[is_shared], BOTH, CENTRE)
        _label(canvas, scene, cluster)
    if cursor is not None:
        canvas.marks(scene.position[[cursor]], CURSOR_MARK, CURSOR)
    return canvas


def _paint_clusters(canvas: Canvas, scene: ClusterScene) -> None:
    """Put the points by their clusters, and the ellipses by which points are kept."""
    shown = scene.ellipses[:MOST_ELLIPSES]
    canvas.lines(shown, [ELLIPSE + int(colour_of(index)) for index in range(len(shown))])
    canvas.marks(scene.position[scene.label == NONE], STRAY, STRAYS)
    for glyph in range(len(KEPT)):
        own = (scene.label != NONE) & (scene.label % len(KEPT) == glyph)
        for is_kept, characters, layer in ((False, DROPPED, OUTER), (True, KEPT, INNER)):
            points = own & (scene.kept == is_kept)
            layers = layer + np.asarray(colour_of(scene.label[points]))
            canvas.marks(scene.position[points], characters[glyph], layers)


def _paint_step(canvas: Canvas, scene: ClusterScene, step: StepScene) -> None:
    """Put the points of a set, bright among the others, what it is measured by, and where it is split."""
    is_rest = np.ones(len(scene.position), np.bool_)
    is_rest[step.members] = False
    canvas.marks(scene.position[is_rest], STRAY, REST)
    points = scene.position[step.members]
    if step.cluster is not None:
        glyph, layer = step.cluster % len(KEPT), INNER + int(colour_of(step.cluster))
        canvas.marks(points, KEPT[glyph], layer)
    elif step.axis is None:
        canvas.marks(points, DROPPED[0], STRAYS)
    else:
        canvas.marks(points[~step.is_upper], KEPT[0], INNER)
        canvas.marks(points[step.is_upper], KEPT[1], INNER + 1)
    canvas.lines([step.box], [STRAYS], DASH)
    canvas.lines([step.ellipse, step.chord], [MEASURE, MEASURE])
    if step.axis is not None and step.cut is not None:
        limits, at = canvas.viewport.limits, step.cut
        if step.axis == "range":
            line = np.array([(at, limits.bottom), (at, limits.top)])
        else:
            line = np.array([(limits.left, at), (limits.right, at)])
        canvas.lines([line], [SPLIT], DASH)


def _is_shared(viewport: Viewport, plots: Array, truth: Array) -> NDArray[np.bool_]:
    """Return which plots lie in one cell with a true centre."""

    def cells(points: Array) -> Array:
        return np.floor(np.column_stack([viewport.column(points[:, 0]), viewport.row(points[:, 1])]))

    found: NDArray[np.bool_] = (cells(plots)[:, None] == cells(truth)[None]).all(axis=2).any(axis=1)
    return found


def _label(canvas: Canvas, scene: ClusterScene, chosen: int | None) -> None:
    """Write the numbers of the clusters beside their plots, that of the chosen one in any case."""
    viewport = canvas.viewport
    order = sorted(range(len(scene.plots)), key=lambda index: index != chosen)
    for index in order[:MOST_LABELS]:
        x, y = scene.plots[index].tolist()
        if not viewport.limits.holds(x, y):
            continue
        row, column, words = int(viewport.row(y)), int(viewport.column(x)) + 1, str(index)
        layer = CURSOR if index == chosen else LABEL
        canvas.write(row, column, words, layer)


def legend(scene: ClusterScene, colours: Palette, width: int, step: StepScene | None = None) -> Words:
    """Return what the marks mean and how many there are of each, in so many columns if possible."""
    layers = styles(colours)
    if step is None:
        is_member = scene.label != NONE
        entries: list[tuple[str, Style | None, int | None, str, str]] = [
            (KEPT[0], layers[INNER], int((is_member & scene.kept).sum()), "kept", "kept"),
            (DROPPED[0], layers[OUTER], int((is_member & ~scene.kept).sum()), "beyond the radius", "beyond"),
            (STRAY, layers[STRAYS], int((~is_member).sum()), "in no cluster", "none"),
            (PLOT, layers[CENTRE], len(scene.plots), _many(len(scene.plots), "plot"), "plots"),
        ]
    elif step.axis is not None:
        upper = int(step.is_upper.sum())
        entries = [
            (KEPT[0], layers[INNER], len(step.members) - upper, "lower part", "lower"),
            (KEPT[1], layers[INNER + 1], upper, "upper part", "upper"),
            ("╌", layers[SPLIT], None, "split", "split"),
        ]
    else:
        mark, layer = (DROPPED[0], STRAYS) if step.cluster is None else _member(step.cluster)
        entries = [(mark, layers[layer], len(step.members), "in the set", "in it")]
    entries.append((TRUE, layers[TRUTH], len(scene.truth), _many(len(scene.truth), "true centre"), "true"))
    return _written(entries, ink(colours.muted), width)


def _many(count: int, word: str) -> str:
    return word if count == 1 else f"{word}s"


def _member(cluster: int) -> tuple[str, int]:
    return KEPT[cluster % len(KEPT)], INNER + int(colour_of(cluster))


def _written(
    entries: Sequence[tuple[str, Style | None, int | None, str, str]], muted: Style, width: int
) -> Words:
    """Return mark, number (None where there is none to tell) and name of each entry that there is."""
    words: Words = []
    for between, place in (("   ", 3), ("  ", 4), (" ", 4), ("  ", None)):
        words = []
        for entry in entries:
            mark, style, count = entry[:3]
            if count == 0:
                continue
            number = [] if count is None else [f"{count:,}"]
            words.append((f"{between if words else ''}{mark} ", style))
            words.append((" ".join([*number, *([str(entry[place])] if place else [])]), muted))
        if sum(len(text) for text, _ in words) <= width:
            break
    return words
