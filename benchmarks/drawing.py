"""The two plot widgets: CPU a frame, and the bytes of a full repaint in 256 colours.

Run it with `python benchmarks/drawing.py`.
"""

from __future__ import annotations

import io
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from measure import verdict
from rich.console import Console
from textual.strip import Strip

from algorithms.context import Box
from algorithms.hough.grid import Grid
from algorithms.hough.voting import accumulate
from hough_tui.ui.drawing.axes import Frame, framed
from hough_tui.ui.drawing.braille import Canvas
from hough_tui.ui.drawing.graticule import Sector
from hough_tui.ui.drawing.halfblock import flattened, picture
from hough_tui.ui.drawing.palette import DARK, ink
from hough_tui.ui.drawing.sampling import levels, pooled, samplings
from hough_tui.ui.drawing.viewport import Viewport
from hough_tui.ui.widgets.heatmap_scene import HeatmapScene
from hough_tui.ui.widgets.plane_scene import PlaneScene, PlaneTrack, painted, styles

HEATMAP_BOUND, PLANE_BOUND = 5.0, 3.0
"""Milliseconds of a frame of 120 × 40 cells; with rings, a plane is bound as a heat-map is."""

BYTES_BOUND = 70_000

SIZES = ((80, 24), (120, 40), (200, 60))


def heatmap(values: np.ndarray, width: int, height: int) -> list[Strip]:
    """Draw an accumulator with its axes, as the widget does."""
    scene = HeatmapScene(
        values,
        (np.arange(values.shape[0]) + 0.5) * 180 / values.shape[0],
        np.arange(values.shape[1]) * 0.6,
        "km",
    )
    limits = scene.home()
    axes = scene.axes(limits)
    frame = Frame.within(width, height, axes[1])
    viewport = Viewport(limits, frame.width, frame.height)
    shown = levels(pooled(scene.comparable, *samplings(viewport, scene.shape)), *scene.extremes)
    return framed(picture(flattened(shown)[0], DARK), frame, axes, limits, DARK)


def plots(random: np.random.Generator, count: int, tracks: int) -> PlaneScene:
    """Return a plane with so many plots and tracks."""
    position = random.uniform(0, 100, (count, 2))
    paths = [
        random.uniform(20, 80, 2) + np.linspace([0, 0], random.uniform(-20, 20, 2), 15) for _ in range(tracks)
    ]
    states = ("found", "false", "duplicate", "unknown")
    return PlaneScene(
        position,
        np.sort(random.integers(0, 15, count)).astype(np.int32),
        Box((0.0, 0.0), (100.0, 100.0)),
        "km",
        random.integers(-1, 2, count).astype(np.int32),
        (),
        tuple(PlaneTrack(path, states[index % 4], f"{index}") for index, path in enumerate(paths)),
    )


def dots(scene: PlaneScene, width: int, height: int) -> list[Strip]:
    """Draw points and lines alone."""
    canvas = Canvas(Viewport(scene.home(), width, height))
    canvas.points(scene.position, 1 + scene.age)
    canvas.lines([track.path for track in scene.tracks], [5] * len(scene.tracks))
    return canvas.strips([None, *(ink(colour) for colour in DARK.clutter), ink(DARK.found)])


def plane(scene: PlaneScene, width: int, height: int) -> list[Strip]:
    """Draw the whole picture of the plane: marks, labels and all."""
    none = np.empty(0, np.int64)
    return painted(scene, Viewport(scene.home(), width, height), none, None, None)[0].strips(styles(DARK))


def sent(strips: Sequence[Strip]) -> int:
    """Return the bytes for a terminal with 256 colours."""
    console = Console(color_system="256", file=io.StringIO(), force_terminal=True)
    return sum(len(strip.render(console).encode()) for strip in strips)


def cpu(call: Callable[[], object], rounds: int = 15) -> float:
    """Return milliseconds of CPU a call, the median of several: other processes do not count."""
    call()
    found = []
    for _ in range(rounds):
        began = time.process_time_ns()
        call()
        found.append(1e-6 * (time.process_time_ns() - began))
    return statistics.median(found)


def main() -> None:
    random = np.random.default_rng(1)
    position = random.uniform(0, 100, (780, 2))
    report = accumulate(position, Grid(90, 1000, -150.0, 0.6)).votes
    tight = accumulate(position - 50.0, Grid(90, 118, -70.8, 1.2)).votes
    large = accumulate(position, Grid(1800, 20_000, -150.0, 0.03)).votes
    noise = random.random((90, 1000))
    scene = plots(random, 1000, 20)
    # Two sensors, one of which sees all round.
    sensors = (Sector((50.0, 50.0), 1.0, 60.0, (0.0, 360.0)), Sector((0.0, 0.0), 1.0, 120.0, (0.0, 90.0)))
    polar = replace(scene, sectors=sensors)
    for width, height in SIZES:
        contenders = {
            "heat-map, 90 × 1000 of the course report": lambda w=width, h=height: heatmap(report, w, h),
            "heat-map, 90 × 118, full of votes": lambda w=width, h=height: heatmap(tight, w, h),
            "heat-map, 90 × 1000 of noise": lambda w=width, h=height: heatmap(noise, w, h),
            "heat-map, 1800 × 20000": lambda w=width, h=height: heatmap(large, w, h),
            "dots, 1,000 points and 20 lines": lambda w=width, h=height: dots(scene, w, h),
            "plane, 1,000 plots and 20 tracks": lambda w=width, h=height: plane(scene, w, h),
            "the same plane with rings of two sensors": lambda w=width, h=height: plane(polar, w, h),
        }
        print(f"{width} × {height}")
        for name, call in contenders.items():
            milliseconds, size = cpu(call), sent(call())
            told = f"  {name:<42} {milliseconds:6.2f} ms {size:8,} bytes"
            if (width, height) == (120, 40) and "20000" not in name:
                bound = PLANE_BOUND if name.startswith(("dots", "plane")) else HEATMAP_BOUND
                told += f"   {bound:g} ms {verdict(milliseconds, bound)}, 70 kB {verdict(size, BYTES_BOUND)}"
            print(told)


if __name__ == "__main__":
    main()
