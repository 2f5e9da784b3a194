"""The ratio of false tracks, trial by trial, as the course report draws it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from textual_plotext.plot import Plot

from hough_tui.reports.dots import Axis, dotted, span, ticks
from hough_tui.ui.drawing.shortening import Part, fitted

DOTS_ACROSS = 8
"""Of so many trials a column of cells one each is drawn; more would be a solid band."""

DOTS, MEAN = 67, 208
"""Of the 256 colours, such as can be read on a dark and on a light ground."""


def trial_chart(
    called: str, numbers: NDArray[np.int32], ratio: NDArray[np.float64], width: int, height: int
) -> str:
    """Return a chart of a ratio in per cent against the number of the trial, and its mean so far.

    Parameters
    ----------
    called : what the trials are of
    numbers : of the trials, rising
    ratio : of each trial, in [0, 1]
    width, height : of the chart with its title, in cells
    """
    step = max(1, math.ceil(len(ratio) / (DOTS_ACROSS * width)))
    x, y = numbers[::step].astype(np.float64), 100.0 * ratio[::step]
    reach = span(numbers[[0, -1]].astype(np.float64))
    # Many ratios lie in a narrow band, which from 0 to 100 would be a line.
    low, high = max(0.0, float(y.min()) - 2.0), min(100.0, float(y.max()) + 2.0)
    marks = ticks(low, high, max(2, min(6, height // 3)))
    below = ticks(*reach, max(2, width // 12))
    names = [f"{mark:.10g}" for mark in marks]
    across = Axis(*reach, max(2, width - 1 - max(map(len, names))))
    up = Axis(low, high, max(2, height - 4))
    # Its type says less than plotext can do: a marker for each point.
    figure: Any = Plot()
    # Otherwise plotext cuts it to the size that it believes the terminal to have.
    figure._limit_size(False, False)
    figure.plot_size(width, height - 1)
    figure.theme("clear")
    figure.xlim(across.low, across.high)
    figure.ylim(up.low, up.high)
    figure.xaxes(True, False)
    figure.yaxes(True, False)
    figure.yticks(marks, names)
    figure.xticks(below, [f"{mark:,.10g}" for mark in below])
    figure.xlabel("trial")
    if len(x) <= width // 2:
        # Few enough for the line of the report.
        figure.plot(x.tolist(), y.tolist(), marker="braille", color=DOTS)
    cells = dotted(x, y, np.zeros(len(x), np.int64), across, up)
    figure.scatter(cells.x.tolist(), cells.y.tolist(), marker=cells.glyphs, color=DOTS)
    places = np.unique(np.linspace(0, len(ratio) - 1, min(len(ratio), across.cells)).astype(np.int64))
    means = 100.0 * np.cumsum(ratio, dtype=np.float64)[places] / (places + 1)
    line_x, line_y = across.snapped(numbers[places].astype(np.float64)), up.snapped(means)
    figure.scatter(line_x.tolist(), line_y.tolist(), marker="━", color=MEAN)
    title = [
        Part("false % by trial"),
        Part(f"━ mean so far, in the end {means[-1]:.1f}", 2, f"━ mean {means[-1]:.1f}"),
        Part(called, 1),
    ]
    if step > 1:
        title.append(Part(f"one of {step:,} drawn", 4, f"1 of {step:,}"))
    text = figure.build().rstrip("\n")
    return f"{fitted(title, width)}\n{text}"
