"""The range-Doppler plane: points by cluster, plots and true centres, or one step of splitting."""

from __future__ import annotations

import numpy as np
from textual.binding import Binding
from textual.message import Message

from hough_tui.reports.numerals import as_given, fixed, significant
from hough_tui.ui.drawing.axes import Axis, figures, foot
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.widgets.chart import KEY_ZOOM, Chart, Drawn
from hough_tui.ui.widgets.cluster_scene import (
    INNER,
    KEPT,
    NONE,
    STRAYS,
    ClusterScene,
    StepScene,
    Words,
    colour_of,
    legend,
    painted,
    styles,
)

REACH = 2.0
"""Cells within which a click finds a point."""

EMPTY = ClusterScene(
    np.empty((0, 2)), np.empty(0), np.empty(0, np.int64), np.empty(0, np.bool_),
    Limits(0.0, 1.0, 0.0, 1.0), "", np.empty((0, 2)), (), np.empty((0, 2)),
)  # fmt: skip


class ClusterPlane(Chart):
    """A picture of points and clusters, range to the right and Doppler upwards.

    `n` and `N` step through the points, `t` and `T` through the clusters; a click chooses a point. `z` shows
    the set under consideration, or the chosen cluster, as large as it fits; once more shows everything.
    """

    BINDINGS = [
        Binding("left,h", "pan(-0.1, 0)", "Nearer ranges", show=False, id="clusters.nearer"),
        Binding("right,l", "pan(0.1, 0)", "Farther ranges", show=False, id="clusters.farther"),
        Binding("up,k", "pan(0, -0.1)", "Higher Dopplers", show=False, id="clusters.higher"),
        Binding("down,j", "pan(0, 0.1)", "Lower Dopplers", show=False, id="clusters.lower"),
        Binding("plus,equals_sign", "zoom(1)", "Zoom in", show=False, id="clusters.zoom-in"),
        Binding("minus", "zoom(-1)", "Zoom out", show=False, id="clusters.zoom-out"),
        Binding("0", "fit", "Fit", show=False, id="clusters.fit"),
        Binding("z", "close_up", "Zoom to the set, or the cluster", show=False, id="clusters.close-up"),
        Binding("n", "next_point(1)", "Next point", show=False, id="clusters.next-point"),
        Binding("N", "next_point(-1)", "Previous point", show=False, id="clusters.previous-point"),
        Binding("t", "next_cluster(1)", "Next cluster", show=False, id="clusters.next-cluster"),
        Binding("T", "next_cluster(-1)", "Previous cluster", show=False, id="clusters.previous-cluster"),
    ]

    class PointChosen(Message):
        """A point was chosen, by its row in the scene."""

        def __init__(self, plane: ClusterPlane, index: int) -> None:
            super().__init__()
            self.plane, self.index = plane, index

        @property
        def control(self) -> ClusterPlane:
            """The plane in which it was chosen."""
            return self.plane

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._scene, self._home = EMPTY, EMPTY.home()
        self._step: StepScene | None = None
        self._cursor: int | None = None
        self._cluster: int | None = None

    @property
    def scene(self) -> ClusterScene:
        """What is shown."""
        return self._scene

    @property
    def step(self) -> StepScene | None:
        """The set under consideration; None where the clusters are shown."""
        return self._step

    @property
    def cursor(self) -> int | None:
        """The point under the cursor."""
        return self._cursor

    @property
    def cluster(self) -> int | None:
        """The chosen cluster."""
        return self._cluster

    def show(self, scene: ClusterScene, step: StepScene | None = None) -> None:
        """Show a scene, or one step of it.

        The view stays where it was if the region did, the cursor if the points did.
        """
        before, self._scene, self._home = self._scene, scene, scene.home()
        if scene.region != before.region:
            self._limits = None
        if not np.array_equal(scene.position, before.position):
            self._cursor = None
        if scene is not before:
            self._cluster = None
        self._step = step
        self.changed()

    # What a chart asks

    @property
    def is_waiting(self) -> bool:
        return self._scene is EMPTY

    def home(self) -> Limits:
        return self._home

    def bounds(self) -> Limits:
        return self._home.expanded(3.0)

    def least(self) -> tuple[float, float]:
        left, right, bottom, top = self._home
        return 1e-4 * (right - left), 1e-4 * (top - bottom)

    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        unit = f"range, {self._scene.unit}" if self._scene.unit else "range"
        return Axis(limits.left, limits.right, unit), Axis(limits.bottom, limits.top)

    def drawn(self, viewport: Viewport, colours: Palette, width: int) -> Drawn:
        canvas = painted(self._scene, viewport, self._step, self._cluster, self._cursor)
        # The gutter has room for figures only: what they are of stands in the corner.
        canvas.write(0, 1, f"Doppler, {self._scene.unit}" if self._scene.unit else "Doppler", STRAYS)
        words = self._words(colours, viewport) or legend(self._scene, colours, width, self._step)
        return Drawn(
            canvas.strips(styles(colours)), None, foot(words, self._hidden(viewport, colours), width)
        )

    def clicked(self, row: int, column: int, times: int) -> None:
        view, position = self.viewport, self._scene.position
        columns, rows = view.column(position[:, 0]), view.row(position[:, 1])
        distance = np.hypot(columns - (column + 0.5), rows - (row + 0.5))
        if len(distance) and distance.min() <= REACH:
            self._move_to(int(distance.argmin()))

    # Keys

    def action_pan(self, across: float, down: float) -> None:
        self.pan(across, down)

    def action_zoom(self, steps: int) -> None:
        view = self.viewport
        x, y = view.x(0.5 * view.width), view.y(0.5 * view.height)
        chosen = self._place()
        if chosen is not None and view.limits.holds(*chosen):
            x, y = chosen
        self.zoom(KEY_ZOOM**steps, x, y)

    def action_close_up(self) -> None:
        """Fill the plane with the set under consideration, or the chosen cluster; once more shows all."""
        limits = self._close_up()
        if limits is None or self._limits == limits:
            self.action_fit()
        else:
            self.look_at(limits)

    def _close_up(self) -> Limits | None:
        """Return what holds the set or the cluster with its ellipse; None where neither is chosen."""
        scene, step, cluster = self._scene, self._step, self._cluster
        if step is not None:
            around = [scene.position[step.members], step.ellipse, step.box]
        elif cluster is not None:
            around = [scene.position[scene.members(cluster)], *scene.ellipses[cluster : cluster + 1]]
        else:
            return None
        around = [places for places in around if len(places)]
        (left, bottom) = np.min([places.min(axis=0) for places in around], axis=0).tolist()
        (right, top) = np.max([places.max(axis=0) for places in around], axis=0).tolist()
        # A single point, and one that lies alone on its axis, has room about it.
        home = self._home
        x = max(0.01 * (home.right - home.left), 0.05 * (right - left))
        y = max(0.01 * (home.top - home.bottom), 0.05 * (top - bottom))
        return Limits(left - x, right + x, bottom - y, top + y)

    def action_next_point(self, step: int) -> None:
        points = np.arange(len(self._scene.position)) if self._step is None else self._step.members
        if len(points):
            here = np.flatnonzero(points == self._cursor)
            place = int(here[0]) + step if len(here) else min(step, 0)
            self._move_to(int(points[place % len(points)]))

    def action_next_cluster(self, step: int) -> None:
        count = len(self._scene.plots)
        if count and self._step is None:
            self._cluster = (
                (self._cluster + step) % count if self._cluster is not None else min(step, 0) % count
            )
            self._cursor = None
            self._bring_into_view()

    def _move_to(self, point: int) -> None:
        self._cursor, self._cluster = point, None
        self._bring_into_view()
        self.post_message(self.PointChosen(self, point))

    def _place(self) -> tuple[float, float] | None:
        """Return where what is chosen lies."""
        if self._cursor is not None:
            x, y = self._scene.position[self._cursor].tolist()
        elif self._cluster is not None:
            x, y = self._scene.plots[self._cluster].tolist()
        else:
            return None
        return x, y

    def _bring_into_view(self) -> None:
        self.changed()
        place, view, bounds = self._place(), self.viewport, self.bounds()
        if place is not None and not view.limits.holds(*place):
            x = min(max(place[0], bounds.left), bounds.right)
            y = min(max(place[1], bounds.bottom), bounds.top)
            self.look_at(view.showing(x, y).limits)

    # Words at the foot

    def _words(self, colours: Palette, viewport: Viewport) -> Words:
        if self._cursor is not None:
            return self._point_words(colours)
        return self._cluster_words(colours, viewport) if self._cluster is not None else []

    def _point_words(self, colours: Palette) -> Words:
        scene, point = self._scene, self._cursor
        assert point is not None
        r, d = scene.position[point].tolist()
        label, text = int(scene.label[point]), ink(colours.text)
        where = f" range {as_given(r)}  Doppler {as_given(d)}"
        words: Words = [
            (f"point {point} ", ink(colours.lit, bold=True)),
            (f"{where}  amplitude {significant(float(scene.amplitude[point]))}", text),
        ]
        if label == NONE:
            words.append(("  in no cluster", ink(colours.muted)))
        else:
            is_kept = "" if scene.kept[point] else ", beyond the radius"
            words.append((f"  cluster {label}{is_kept}", styles(colours)[INNER + int(colour_of(label))]))
        if scene.origin is not None:
            origin = int(scene.origin[point])
            words.append((f"  of target {origin}" if origin >= 0 else "  of no target", text))
        return words

    def _cluster_words(self, colours: Palette, viewport: Viewport) -> Words:
        scene, cluster = self._scene, self._cluster
        assert cluster is not None
        members, text = scene.members(cluster), ink(colours.text)
        limits = viewport.limits
        step = (limits.right - limits.left) / max(1, viewport.width)
        r, d = figures(scene.plots[cluster].tolist(), min(0.1, 10.0 ** np.floor(np.log10(step))))
        words: Words = [
            (
                f"{KEPT[cluster % len(KEPT)]} cluster {cluster} ",
                styles(colours)[INNER + int(colour_of(cluster))],
            ),
            (f" range {r}  Doppler {d}", text),
            (f"  {len(members)} points, {int(scene.kept[members].sum())} kept", text),
        ]
        if len(scene.truth):
            away = np.hypot(*(scene.truth - scene.plots[cluster]).T)
            words.append((f"  {fixed(float(away.min()), 2)} from target {int(away.argmin())}", text))
        return words

    def _hidden(self, viewport: Viewport, colours: Palette) -> Words:
        inside = viewport.limits.holds(self._scene.position[:, 0], self._scene.position[:, 1])
        hidden = len(self._scene.position) - int(np.count_nonzero(inside))
        return [(f"{hidden:,} out of view", ink(colours.muted))] if hidden else []
