"""The votes of pairs of plots in one plane, to look at closely and to choose from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from textual.binding import Binding
from textual.message import Message

from hough_tui.ui.drawing.axes import Axis, figures, foot
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.viewport import Limits, Viewport
from hough_tui.ui.widgets.chart import Drawn
from hough_tui.ui.widgets.plane_scene import Words
from hough_tui.ui.widgets.scatter import NOTHING, Scatter
from hough_tui.ui.widgets.votes_scene import VotesScene, painted_votes, vote_styles

__all__ = ["PairVotes", "VotesScene"]

EMPTY = VotesScene(
    "",
    np.empty(0),
    np.empty(0),
    np.empty(0, np.bool_),
    np.empty((0, 2), np.int64),
    np.empty((0, 2), np.int64),
    "",
)


class PairVotes(Scatter):
    """Each pair of plots as a point, its distance d across and its direction θ from above to below."""

    BINDINGS = [
        Binding("left,h", "pan(-0.1, 0)", "Less d", show=False, id="votes.left"),
        Binding("right,l", "pan(0.1, 0)", "More d", show=False, id="votes.right"),
        Binding("up,k", "pan(0, -0.1)", "Less θ", show=False, id="votes.up"),
        Binding("down,j", "pan(0, 0.1)", "More θ", show=False, id="votes.down"),
        Binding("plus,equals_sign", "zoom(1)", "Zoom in", show=False, id="votes.zoom-in"),
        Binding("minus", "zoom(-1)", "Zoom out", show=False, id="votes.zoom-out"),
        Binding("0", "fit", "Fit", show=False, id="votes.fit"),
        Binding("n", "next_point(1)", "Next vote", id="votes.next"),
        Binding("N", "next_point(-1)", "Previous vote", show=False, id="votes.previous"),
    ]

    class VoteChosen(Message):
        """A vote was chosen, by its row in the scene."""

        def __init__(self, votes: PairVotes, index: int) -> None:
            super().__init__()
            self.votes = votes
            self.index = index

        @property
        def control(self) -> PairVotes:
            """The chart in which it was chosen."""
            return self.votes

    def __init__(self, *, name: str | None = None, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(name=name, id=id, classes=classes)
        self._scene, self._home = EMPTY, EMPTY.home()

    @property
    def is_waiting(self) -> bool:
        return self._scene is EMPTY

    @property
    def points(self) -> NDArray[np.float64]:
        return self._scene.points

    def tell(self, point: int) -> None:
        self.post_message(self.VoteChosen(self, point))

    def show(self, scene: VotesScene) -> None:
        """Show the votes of a trial; nothing is lit up or chosen, unless the pairs are the same."""
        before, self._scene, self._home = self._scene, scene, scene.home()
        if not np.array_equal(scene.pairs, before.pairs):
            self._lit, self._cursor = NOTHING, None
        # The scale of d is that of the votes: a part of the one before may hold none of them.
        self._limits = None
        self.changed()

    def home(self) -> Limits:
        return self._home

    def bounds(self) -> Limits:
        left, right, bottom, top = self._home
        return Limits(3.0 * left, 3.0 * right, bottom, top)

    def least(self) -> tuple[float, float]:
        return 1e-5 * (self._home.right - self._home.left), 1e-3 * self._home.bottom

    def axes(self, limits: Limits) -> tuple[Axis, Axis]:
        across = Axis(limits.left, limits.right, f"d [{self._scene.unit}]")
        return across, Axis(limits.top, limits.bottom, "°", is_angle=True)

    def drawn(self, viewport: Viewport, colours: Palette, width: int) -> Drawn:
        canvas = painted_votes(self._scene, viewport, self._lit, self._cursor)
        line = foot(self._words(viewport, colours), self._hidden(viewport, colours), width)
        return Drawn(canvas.strips(vote_styles(colours)), None, line)

    def clicked(self, row: int, column: int, times: int) -> None:
        near = self.nearest(list(self.points[:, None, :]), row, column)
        if near is not None:
            self.move_to(near)

    def _words(self, viewport: Viewport, colours: Palette) -> Words:
        """Return the line at the foot: the chosen vote, or else what the points mean."""
        scene, vote = self._scene, self._cursor
        plain, strong, muted = ink(colours.text), ink(colours.lit, bold=True), ink(colours.muted)
        words: Words = [(f"{scene.plane} ", ink(colours.text, bold=True))]
        if vote is None:
            confirmed = int(scene.confirmed.sum())
            return [
                *words,
                ("▪ ", ink(colours.unknown)),
                (f"{confirmed:,} confirmed", muted),
                ("   · ", muted),
                (f"{len(scene.pairs) - confirmed:,} not", muted),
            ]
        (first, second), scans = scene.pairs[vote].tolist(), scene.scans[vote].tolist()
        words.append((f"plots {first}, {second} ", strong))
        if np.isfinite(scene.theta_deg[vote]):
            step = (viewport.limits.right - viewport.limits.left) / max(1, viewport.width)
            (d,) = figures([float(scene.distance[vote])], 10.0 ** np.floor(np.log10(step)))
            words.append((f" θ {scene.theta_deg[vote]:.1f}°  d {d} {scene.unit}", plain))
        else:
            words.append((" coincide here: no line", plain))
        words.append(("  confirmed" if scene.confirmed[vote] else "  not confirmed", plain))
        words.append((f"  scans {scans[0]}, {scans[1]}", muted))
        return words

    def _hidden(self, viewport: Viewport, colours: Palette) -> Words:
        """Return how many votes lie outside the view."""
        points = self.points
        hidden = len(points) - int(np.count_nonzero(viewport.limits.holds(points[:, 0], points[:, 1])))
        return [(f"{hidden:,} out of view", ink(colours.muted))] if hidden else []
