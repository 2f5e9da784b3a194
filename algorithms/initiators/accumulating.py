"""What the initiators share that vote into an accumulator and take its peaks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, Self

from algorithms.association import associate
from algorithms.context import Context
from algorithms.hough.grid import GridParameters
from algorithms.hough.peaks.extraction import Extraction
from algorithms.hough.peaks.registry import EXTRACTIONS
from algorithms.hough.search import search
from algorithms.hough.voting import Accumulator, accumulate
from algorithms.hough.weighting import Weighting, accumulate_weighted
from algorithms.initiators.base import ChunkInitiator
from algorithms.parameters import Auto, Count, Dimension, Fraction, Parameters, Whole, parameter
from algorithms.plots import PlotChunk, Plots
from algorithms.tracks import TrackChunk

GATE = 4.0
"""Greatest distance of a plot from the fitted motion, in standard deviations of the noise."""

STRIP = 1.5
"""Half the width of the strip in which a line's plots are sought, in ρ columns: the cell and
its two neighbours, since a line between two rows spreads beyond one cell."""

if TYPE_CHECKING:
    Peaks = str
else:
    Peaks = Literal[tuple(EXTRACTIONS)]


def _windows(axis: int) -> str:
    """Return the default half windows of the extractions in words."""
    every = EXTRACTIONS.values()
    return ", ".join(f"{each.windows[axis]} for {each.name}" for each in every if each.windows is not None)


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
    peaks: Peaks = parameter(
        "threshold",
        help="which cells with enough votes are tracks: "
        + "; ".join(f"{extraction.summary} ({name})" for name, extraction in EXTRACTIONS.items()),
    )
    maxima: Count | None = parameter(
        None, dimension=Dimension.COUNT, help="how many maxima S are taken at most, the greatest"
    )
    suppress_theta: Whole | Auto = parameter(
        "auto",
        dimension=Dimension.COUNT,
        help="rows on each side of a maximum that belong to it; threshold has no window",
        auto=_windows(0),
    )
    suppress_rho: Whole | Auto = parameter(
        "auto",
        dimension=Dimension.COUNT,
        help="columns on each side of a maximum that belong to it; threshold has no window",
        auto=_windows(1),
    )
    ties: Literal["last", "first"] = parameter(
        "last", help="which of equal maxima is taken, in θ-major order; the source takes the last"
    )

    def resolved(self, context: Context) -> Self:
        """Return these parameters with quantisation, least votes and windows worked out.

        The threshold is ⌈fraction·n·Pd⌉, at least 1; the ceiling forgives rounding errors. For
        the windows see the extractions.
        """
        votes = self.votes
        if votes is None:
            votes = max(1, math.ceil(self.fraction * context.expected_votes - 1e-9))
        grid = self.grid.resolved(context)
        rows, columns = EXTRACTIONS[self.peaks].default_window(grid.grid(context), context, votes)
        return self.model_copy(
            update={
                "grid": grid,
                "votes": votes,
                "suppress_theta": rows if self.suppress_theta == "auto" else self.suppress_theta,
                "suppress_rho": columns if self.suppress_rho == "auto" else self.suppress_rho,
            }
        )


class AccumulatingInitiator(ChunkInitiator):
    """An initiator that takes peaks of an accumulator: it says what of its declared choices differs."""

    def extraction(self, parameters: Any) -> Extraction:
        """Return which cells are tracks."""
        choices = {
            "votes": parameters.votes,
            "maxima": parameters.maxima,
            "rows": parameters.suppress_theta,
            "columns": parameters.suppress_rho,
            "last": parameters.ties == "last",
            "wrap": self.goes_on(parameters),
        }
        return EXTRACTIONS[parameters.peaks].of(choices)

    def goes_on(self, parameters: Any) -> bool:
        """Return whether a window around a cell goes on across θ = 0 and π."""
        return True

    def weighting(self, parameters: Any) -> Weighting | None:
        """Return how votes are weighted; None where they count as they are."""
        return None

    def initiate_chunk(self, chunk: PlotChunk, context: Context, parameters: Any) -> TrackChunk:
        """Return the tracks of each trial: the lines at the centres of the chosen cells."""
        grid = parameters.grid.grid(context)
        return search(chunk, grid, self.extraction(parameters), self.weighting(parameters))

    def associate_chunk(
        self, chunk: PlotChunk, tracks: TrackChunk, context: Context, parameters: Any
    ) -> TrackChunk:
        """Return the tracks with the plots that move along their lines."""
        step = parameters.grid.grid(context).rho_step
        gate = GATE * context.noise if context.noise else step
        return associate(chunk, tracks, STRIP * step, gate)

    def accumulator(self, plots: Plots, context: Context, parameters: Any) -> Accumulator:
        """Return the votes of one batch, with standard deviations and weighted votes where it has them."""
        grid, weighting = parameters.grid.grid(context), self.weighting(parameters)
        if weighting is None:
            return accumulate(plots.position, grid)
        return accumulate_weighted(plots.position, grid, weighting)
