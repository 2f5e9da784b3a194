"""What the initiators share that vote into an accumulator and take its peaks."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any, Self

from algorithms.association import associate
from algorithms.context import Context
from algorithms.hough.grid import GridParameters
from algorithms.hough.search import PeakSearch, search
from algorithms.hough.voting import Accumulator, accumulate
from algorithms.initiators.base import ChunkInitiator
from algorithms.parameters import Count, Dimension, Fraction, Parameters, parameter
from algorithms.plots import PlotChunk, Plots
from algorithms.tracks import TrackChunk

GATE = 4.0
"""Greatest distance of a plot from the fitted motion, in standard deviations of the noise."""

STRIP = 1.5
"""Half the width of the strip in which a line's plots are sought, in ρ columns: the cell and
its two neighbours, since a line between two rows spreads beyond one cell."""


class AccumulatingParameters(Parameters):
    """The parameters of every accumulating initiator."""

    grid: GridParameters = parameter(default_factory=GridParameters, help="the quantisation of θ and ρ")
    votes: Count | None = parameter(
        None,
        dimension=Dimension.COUNT,
        help="the least votes of a track; where it is given, `fraction` is not used",
    )
    fraction: Fraction = parameter(
        0.95,
        dimension=Dimension.FRACTION,
        help="the least votes of a track as a fraction of the expected n·Pd votes of a target",
    )

    def resolved(self, context: Context) -> Self:
        """Return these parameters with the quantisation and the least votes worked out.

        The threshold is ⌈fraction·n·Pd⌉, at least 1; the ceiling forgives rounding errors.
        """
        votes = self.votes
        if votes is None:
            votes = max(1, math.ceil(self.fraction * context.expected_votes - 1e-9))
        return self.model_copy(update={"grid": self.grid.resolved(context), "votes": votes})


class AccumulatingInitiator(ChunkInitiator):
    """An initiator that takes peaks of an accumulator: it says only which cells are tracks."""

    @abstractmethod
    def peaks(self, parameters: Any) -> PeakSearch:
        """Return what makes a cell a track."""

    def initiate_chunk(self, chunk: PlotChunk, context: Context, parameters: Any) -> TrackChunk:
        """Return the tracks of each trial: the lines at the centres of the chosen cells."""
        return search(chunk, parameters.grid.grid(context), self.peaks(parameters))

    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks with the plots that move along their lines."""
        step = parameters.grid.grid(context).rho_step
        gate = GATE * context.noise if context.noise else step
        return associate(chunk, tracks, STRIP * step, gate)

    def accumulator(self, plots: Plots, context: Context, parameters: Any) -> Accumulator:
        """Return the votes of one batch."""
        return accumulate(plots.position, parameters.grid.grid(context))
