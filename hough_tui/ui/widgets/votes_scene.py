"""What the votes of pairs are, and how they are painted: each pair of plots is a point (d, θ)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from rich.style import Style

from hough_tui.ui.drawing.braille import Canvas
from hough_tui.ui.drawing.palette import Palette, ink
from hough_tui.ui.drawing.viewport import Limits, Viewport

LIT_MARK, CURSOR_MARK = "●", "◆"

HALF_TURN = 180.0

CONFIRMED_SIZE = 2
"""Side of the point of a confirmed vote, in dots; that of another is one dot."""

SINGLE, CONFIRMED, LIT, CURSOR = 1, 2, 3, 4
"""Layers, from the lowest."""


@dataclass(frozen=True, eq=False)
class VotesScene:
    """The votes of pairs of plots in one plane.

    Attributes
    ----------
    plane : "xy", "xz" or "yz"
    theta_deg : float64 (k,), direction of the line through each pair, in [0, 180); NaN for none
    distance : float64 (k,), signed distance d of that line
    confirmed : bool (k,), whether a window with enough votes holds it
    pairs : int64 (k, 2), the two plots
    scans : int (k, 2), their scans
    unit : of d
    """

    plane: str
    theta_deg: NDArray[np.float64]
    distance: NDArray[np.float64]
    confirmed: NDArray[np.bool_]
    pairs: NDArray[np.int64]
    scans: NDArray[np.integer]
    unit: str

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """Where the votes are: float64 (k, 2), d and θ."""
        return np.column_stack([self.distance, self.theta_deg])

    def home(self) -> Limits:
        """Return limits with all votes in view, d = 0 in the middle and θ = 0 above."""
        known = self.distance[np.isfinite(self.distance)]
        farthest = 1.06 * float(np.abs(known).max(initial=0.0)) or 1.0
        return Limits(-farthest, farthest, HALF_TURN, 0.0)


def vote_styles(colours: Palette) -> list[Style | None]:
    """Return the style of each layer."""
    return [
        None,
        ink(colours.muted),
        ink(colours.unknown),
        ink(colours.lit, bold=True),
        ink(colours.lit, bold=True, reverse=True),
    ]


def painted_votes(
    scene: VotesScene, viewport: Viewport, lit: NDArray[np.int64], cursor: int | None
) -> Canvas:
    """Return the picture of votes, some of them lit up, one of them under the cursor."""
    canvas, points = Canvas(viewport), scene.points
    canvas.points(points[~scene.confirmed], SINGLE)
    canvas.points(points[scene.confirmed], CONFIRMED, CONFIRMED_SIZE)
    canvas.marks(points[lit], LIT_MARK, LIT)
    if cursor is not None:
        canvas.marks(points[[cursor]], CURSOR_MARK, CURSOR)
    return canvas
