"""What a plug-in package imports to add an initiator.

A plug-in declares its initiator as an entry point of the group `hough_tui.initiators`, either
an instance of `Initiator` or a class of it. With `initiate` alone its trials run in worker
processes; as a `ChunkInitiator` in compiled code its chunks run in threads.
"""

from algorithms.association import associate
from algorithms.compiled import kernel
from algorithms.context import Box, Context, Unit
from algorithms.errors import RequestError
from algorithms.hough.grid import Grid, GridParameters
from algorithms.hough.lines import line_through, normal_form
from algorithms.hough.peaks.extraction import Extraction
from algorithms.hough.voting import Accumulator, accumulate
from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters
from algorithms.initiators.base import ChunkInitiator, Initiator
from algorithms.kinematics.states import fitted_states, with_states
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
from algorithms.tracks import TrackChunk, Tracks, TrackStates

__all__ = [
    "AccumulatingInitiator",
    "AccumulatingParameters",
    "Accumulator",
    "Auto",
    "Box",
    "ChunkInitiator",
    "Context",
    "Count",
    "Dimension",
    "Extraction",
    "Fraction",
    "Grid",
    "GridParameters",
    "Initiator",
    "NotNegative",
    "Number",
    "Parameters",
    "PlotChunk",
    "Plots",
    "Positive",
    "RequestError",
    "TrackChunk",
    "TrackStates",
    "Tracks",
    "Unit",
    "Whole",
    "accumulate",
    "associate",
    "fitted_states",
    "kernel",
    "line_through",
    "normal_form",
    "parameter",
    "with_states",
]
