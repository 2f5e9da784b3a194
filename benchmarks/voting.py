"""One vote, beside OpenCV, scikit-image and itself with moments: the same points, bins, one thread.

Run it with `python benchmarks/voting.py`; it needs the extra `dev`.
"""

from __future__ import annotations

import statistics
from functools import partial

import cv2
import numpy as np
from measure import ratio, rounds, verdict
from skimage.transform import hough_line

from algorithms.hough.grid import Grid
from algorithms.hough.moments import reciprocals, vote_with_moments
from algorithms.hough.voting import GridArrays, vote

SIDE = 353
"""Side of the square of points: its diagonal, both ways, gives scikit-image about 1,000 columns."""

THETA_BINS = 90


def compare(points: int) -> None:
    """Print nanoseconds a vote, and ratios, for one number of points."""
    random = np.random.default_rng(1)
    pixels = random.choice(SIDE * SIDE, points, replace=False)
    y, x = np.divmod(pixels, SIDE)
    image = np.zeros((SIDE, SIDE), dtype=bool)
    image[y, x] = True
    theta = np.arange(THETA_BINS) * np.pi / THETA_BINS
    columns = len(hough_line(image, theta)[2])
    reach = columns // 2

    grid = Grid(THETA_BINS, columns, -reach - 0.5, 1.0, theta_offset=0.0)
    arrays = GridArrays.of(grid)
    accumulator, working = arrays.accumulator(), np.empty(points, np.int32)
    xs, ys = x.astype(np.float64), y.astype(np.float64)
    votes = partial(vote, xs, ys, arrays, accumulator, working)

    mean, squares, places = np.zeros(accumulator.shape), np.zeros(accumulator.shape), np.empty(points)
    inverse = reciprocals(points)

    def with_moments() -> None:
        # Counts grow from call to call, and the table of their reciprocals does not.
        accumulator[:] = 0
        vote_with_moments(xs, ys, arrays, accumulator, mean, squares, inverse, places)

    # The threshold leaves OpenCV no peak to sort, so that its time is that of its votes.
    cloud = np.stack([x, y], axis=1).astype(np.float32)[:, None, :]
    cv2.setNumThreads(1)
    opencv = partial(
        cv2.HoughLinesPointSet,
        cloud,
        1,
        points,
        -float(reach),
        float(reach),
        1.0,
        0.0,
        np.pi - 1e-9,
        np.pi / THETA_BINS,
    )
    contenders = {"hough-tui": votes, "with moments": with_moments, "OpenCV": opencv}
    seconds = rounds({**contenders, "scikit-image": partial(hough_line, image, theta)})
    print(f"{points:,} points, {THETA_BINS} × {columns} cells")
    for name, times in seconds.items():
        print(f"  {name:13} {statistics.median(times) / points / THETA_BINS * 1e9:6.2f} ns a vote")
    for other, bound in (("OpenCV", 1 / 2), ("scikit-image", 1 / 3)):
        value = ratio(seconds, "hough-tui", other)
        print(f"  hough-tui / {other}: {value:.3f} (bound {bound:.3f}: {verdict(value, bound)})")
    value = ratio(seconds, "with moments", "hough-tui")
    print(f"  with moments / hough-tui: {value:.2f} (bound 6: {verdict(value, 6.0)})")


if __name__ == "__main__":
    for number in (780, 7_800):
        compare(number)
