"""What a plug-in package imports to add an initiator.

A plug-in declares its initiator as an entry point of the group `hough_tui.initiators`, either
an instance of `Initiator` or a class of it. With `initiate` alone its trials run in worker
processes; as a `ChunkInitiator` in compiled code its chunks run in threads.
"""

from algorithms.compiled import kernel
from algorithms.context import Box, Context, Unit
from algorithms.errors import RequestError
from algorithms.hough.lines import line_through, normal_form
from algorithms.initiators.base import ChunkInitiator, Initiator
from algorithms.parameters import (
    Auto,
    Count,
    Dimension,
    Fraction,
    NotNegative,
    Number,
    Parameters,
    Positive,
    Whole,
    parameter,
)
from algorithms.plots import PlotChunk, Plots
from algorithms.tracks import TrackChunk, Tracks

__all__ = [
    "Auto",
    "Box",
    "ChunkInitiator",
    "Context",
    "Count",
    "Dimension",
    "Fraction",
    "Initiator",
    "NotNegative",
    "Number",
    "Parameters",
    "PlotChunk",
    "Plots",
    "Positive",
    "RequestError",
    "TrackChunk",
    "Tracks",
    "Unit",
    "Whole",
    "kernel",
    "line_through",
    "normal_form",
    "parameter",
]
