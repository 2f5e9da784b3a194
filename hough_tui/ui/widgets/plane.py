"""The measurement plane: plots, true paths and tracks, to look at closely and to choose from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from textual.binding import Binding
from textual.message import Message

from algorithms.context import Box
from hough_tui.ui.drawing.axes import Axis, figures, foot
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.widgets.chart import Drawn
from hough_tui.ui.widgets.plane_scene import Label, PlaneScene, PlaneTrack, Words, legend, painted, styles
from hough_tui.ui.widgets.scatter import NOTHING, Scatter

__all__ = ["Plane", "PlaneScene", "PlaneTrack"]

EMPTY = PlaneScene(np.empty((0, 2)), np.empty(0, np.int32), Box((0.0, 0.0), (1.0, 1.0)), "")


class Plane(Scatter):
    """A picture of plots and tracks: north up, or a projection of space.

    `n` and `N` step through the plots that are lit up, where there are any, and through all of
    them otherwise. A click chooses a plot, one on a label or a double click a track.
    """

    BINDINGS = [
        Binding("left,h", "pan(-0.1, 0)", "West", show=False, id="plane.west"),
        Binding("right,l", "pan(0.1, 0)", "East", show=False, id="plane.east"),
        Binding("up,k", "pan(0, -0.1)", "North", show=False, id="plane.north"),
        Binding("down,j", "pan(0, 0.1)", "South", show=False, id="plane.south"),
        Binding("plus,equals_sign", "zoom(1)", "Zoom in", show=False, id="plane.zoom-in"),
        Binding("minus", "zoom(-1)", "Zoom out", show=False, id="plane.zoom-out"),
        Binding("0", "fit", "Fit", show=False, id="plane.fit"),
        Binding("e", "toggle_scale", "Equal scales", show=False, id="plane.equal-scales"),
        Binding("n", "next_point(1)", "Next plot", id="plane.next-plot"),
        Binding("N", "next_point(-1)", "Previous plot", show=False, id="plane.previous-plot"),
        Binding("t", "next_track(1)", "Next track", id="plane.next-track"),
        Binding("T", "next_track(-1)", "Previous track", show=False, id="plane.previous-track"),
        Binding("enter", "choose", "Choose plot", id="plane.choose"),
    ]

    class PlotHighlighted(Message):
        """The cursor was moved to a plot."""

        def __init__(self, plane: Plane, index: int) -> None:
            super().__init__()
            self.plane = plane
            self.index = index

        @property
        def control(self) -> Plane:
            """The plane whose cursor it is."""
            return self.plane

    class ViewMoved(Message):
        """Another part of the plane is in view."""

        def __init__(self, plane: Plane) -> None:
            super().__init__()
            self.plane = plane

        @property
        def control(self) -> Plane:
            """The plane."""
            return self.plane

    class PlotChosen(Message):
        """A plot was chosen, by its row in the scene."""

        def __init__(self, plane: Plane, index: int) -> None:
            super().__init__()
            self.plane = plane
            self.index = index

        @property
        def control(self) -> Plane:
            """The plane in which it was chosen."""
            return self.plane

    class TrackChosen(Message):
        """A track was chosen, by its place in the scene."""

        def __init__(self, plane: Plane, index: int) -> None:
            super().__init__()
            self.plane = plane
            self.index = index

        @property
        def control(self) -> Plane:
            """The plane in which it was chosen."""
            return self.plane

    def __init__(self, *, name: str | None = None, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(name=name, id=id, classes=classes)
        self._scene = EMPTY
        self._home = EMPTY.home()
        self._track: int | None = None
        self._labels: list[Label] = []
        self._has_equal_scales = False

    @property
    def is_waiting(self) -> bool:
        return self._scene is EMPTY

    @property
    def points(self) -> NDArray[np.float64]:
        return self._scene.position

    def tell(self, point: int) -> None:
        self.post_message(self.PlotHighlighted(self, point))

    @property
    def track(self) -> int | None:
        """The chosen track."""
        return self._track

    def show(self, scene: PlaneScene) -> None:
        """Show a scene.

        The view stays where it was if the region did, what is lit up and the cursor if the plots did.
        """
        if scene is self._scene:
            return
        before, self._scene, self._home = self._scene, scene, scene.home()
        if scene.limits != before.limits:
            self._limits = None
        if not np.array_equal(scene.position, before.position, equal_nan=True):
            self._lit, self._cursor = NOTHING, None
        self._track = None
        self.changed()

    def choose_track(self, index: int | None) -> None:
        """Mark a track as chosen; None for none."""
        if index is not None and not 0 <= index < len(self._scene.tracks):
            index = None
        if index != self._track:
            self._track = index
            self.changed()

    def look_at(self, limits: Limits | None) -> None:
        before = self._limits
        super().look_at(limits)
        if self._limits != before:
            self.post_message(self.ViewMoved(self))

    def follow(self, other: Plane) -> None:
        """Show the part of a shared axis that another plane shows, and tell nobody."""
        shown = dict(zip(other._scene.names, _sides(other.limits), strict=True))
        whole = dict(zip(other._scene.names, _sides(other.home()), strict=True))
        sides = []
        for name, own, own_whole in zip(
            self._scene.names, _sides(self.limits), _sides(self.home()), strict=True
        ):
            is_whole = name in shown and shown[name] == whole[name]
            sides.append(own_whole if is_whole else shown.get(name, own))
        super().look_at(Limits(*sides[0], *sides[1]))

    def home(self) -> Limits:
        return self._home

    def bounds(self) -> Limits:
        return self._home.expanded(3.0)

    def least(self) -> tuple[float, float]:
        left, right, bottom, top = self._home
        # Coordinates far from zero are not told apart more finely than this.
        resolution = 1e-9 * max(abs(left), abs(right), abs(bottom), abs(top))
        return max(1e-5 * (right - left), resolution), max(1e-5 * (top - bottom), resolution)

    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        scene = self._scene
        unit = f"{scene.names[0]} [{scene.unit}]" if scene.is_projection else scene.unit
        return Axis(limits.left, limits.right, unit), Axis(limits.bottom, limits.top, unit)

    def adapted(self, viewport: Viewport) -> Viewport:
        return viewport.squared() if self._has_equal_scales else viewport

    def drawn(self, viewport: Viewport, colours: Palette, width: int) -> Drawn:
        canvas, self._labels = painted(self._scene, viewport, self._lit, self._cursor, self._track)
        line = foot(self._words(colours, viewport, width), self._hidden(viewport, colours), width)
        return Drawn(canvas.strips(styles(colours)), None, line)

    def clicked(self, row: int, column: int, times: int) -> None:
        at_label = [label.track for label in self._labels if label.holds(row, column)]
        if at_label:
            self._take_track(at_label[0])
        elif times > 1:
            near = self.nearest([track.path for track in self._scene.tracks], row, column)
            if near is not None:
                self._take_track(near)
        else:
            plots = self._scene.position[:, None, :]
            near = self.nearest(list(plots), row, column)
            if near is not None:
                self.move_to(near)
                self.post_message(self.PlotChosen(self, near))

    def action_toggle_scale(self) -> None:
        self._has_equal_scales = not self._has_equal_scales
        self.changed()

    def action_next_track(self, step: int) -> None:
        count = len(self._scene.tracks)
        if count:
            first = 0 if step > 0 else count - 1
            self._take_track(first if self._track is None else (self._track + step) % count)

    def action_choose(self) -> None:
        if self._cursor is not None:
            self.post_message(self.PlotChosen(self, self._cursor))

    def _take_track(self, index: int) -> None:
        self.choose_track(index)
        self.post_message(self.TrackChosen(self, index))

    def _words(self, colours: Palette, viewport: Viewport, width: int) -> Words:
        """Return the line at the foot: the chosen plot or track, or else the legend."""
        scene, plot = self._scene, self._cursor
        words: Words = []
        if scene.is_projection:
            words.append((f"{''.join(scene.names)} ", ink(colours.text, bold=True)))
        if plot is not None:
            limits = viewport.limits
            step = (limits.right - limits.left) / max(1, viewport.width)
            x, y = figures(scene.position[plot].tolist(), 10.0 ** np.floor(np.log10(step) - 0.5))
            across, up = scene.names
            words.append((f"plot {plot} ", ink(colours.lit, bold=True)))
            words.append(
                (f" scan {scene.scan[plot]}  {across} {x}  {up} {y} {scene.unit}", ink(colours.text))
            )
            if scene.origin is not None:
                origin = int(scene.origin[plot])
                words.append((f"  target {origin}" if origin >= 0 else "  clutter", ink(colours.text)))
        if self._track is not None:
            track = scene.tracks[self._track]
            words.append(("   " if plot is not None else "", None))
            words.append((f"track {track.label or self._track} ", ink(colours.lit, bold=True)))
            words.append((f" {track.state}, {len(track.path)} plots", ink(colours.track(track.state))))
        if plot is None and self._track is None:
            words += legend(scene, colours, width - sum(len(text) for text, _ in words))
        return words

    def _hidden(self, viewport: Viewport, colours: Palette) -> Words:
        """Return how many plots lie outside the view."""
        inside = viewport.limits.holds(self._scene.position[:, 0], self._scene.position[:, 1])
        hidden = len(self._scene.position) - int(np.count_nonzero(inside))
        return [(f"{hidden:,} out of view", ink(colours.muted))] if hidden else []


def _sides(limits: Limits) -> tuple[tuple[float, float], tuple[float, float]]:
    return (limits.left, limits.right), (limits.bottom, limits.top)
