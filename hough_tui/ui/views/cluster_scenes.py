"""From what a clustering made of a draw to what the plane shows of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from hough_tui.ui.drawing.viewport import Limits
from hough_tui.ui.widgets.cluster_scene import MOST_ELLIPSES, ClusterScene, StepScene

if TYPE_CHECKING:
    from algorithms.clustering.tree import Step
    from hough_tui.inspection.scene import ClusterLook

UNIT = "cells"
"""Of range and of Doppler in a scene."""


def cluster_scene(seen: ClusterLook) -> ClusterScene:
    """Return the clusters of a draw."""
    clusters, drawn, region = seen.found.clusters, seen.picture.drawn, seen.picture.scene.region
    points = clusters.points
    outlines = (
        clusters.ellipse(index).outline(seen.found.radius)
        for index in range(min(len(clusters), MOST_ELLIPSES))
    )
    return ClusterScene(
        np.column_stack([points.range, points.doppler]),
        points.amplitude,
        clusters.label,
        clusters.kept,
        Limits(*region.range, *region.doppler),
        UNIT,
        np.column_stack([clusters.range, clusters.doppler]),
        tuple(np.column_stack(outline) for outline in outlines),
        drawn.centres[0],
        drawn.origin,
    )


def step_scene(seen: ClusterLook, step: Step) -> StepScene:
    """Return one set that was looked at."""
    points, ellipse = seen.found.clusters.points, step.ellipse
    r, d = ellipse.centre
    half = 0.5 * ellipse.chord
    along, across = (0.5 * width for width in ellipse.widths)
    box = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]) * (along, across) + (r, d)
    values = points.doppler if step.axis == "doppler" else points.range
    cut = step.cut
    is_upper = np.zeros(len(step.points), np.bool_)
    if cut is not None:
        is_upper = values[step.points] > cut
        if not seen.splits_at_mean:
            # At the widest gap the cut is the last value below it: the line is drawn amid the gap.
            cut += 0.5 * (step.gap or 0.0)
    return StepScene(
        step.points,
        is_upper,
        np.column_stack(ellipse.outline(math.sqrt(2.0))),
        np.array([(r - half, d), (r + half, d)]),
        np.empty((0, 2)) if seen.splits_at_mean else box,
        step.axis,
        cut,
        step.cluster,
    )
