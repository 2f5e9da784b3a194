"""The weighted Hough initiator: cells whose votes lie close together count for more."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field

from algorithms.context import Context
from algorithms.hough.weighting import BYTES_PER_CELL, Weighting
from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters, Peaks
from algorithms.parameters import Auto, Dimension, Fraction, Positive, Whole, parameter, with_default

QUALIFIED_SHARE = 0.4
"""Share of a target's expected votes that a cell must exceed for its deviation to count."""


class WeightedParameters(AccumulatingParameters):
    """The parameters of `weighted`."""

    fraction: Fraction = parameter(
        0.6,
        dimension=Dimension.FRACTION,
        help="the least weighted votes of a track as a fraction of the expected n·Pd votes of a target",
    )
    peaks: Peaks = with_default(AccumulatingParameters, "peaks", "best-first")
    mode: Literal["several", "single"] = parameter(
        "several",
        help="several compares a cell with the least deviation of its own θ and its own ρ; single with that "
        "of the whole accumulator, and takes one track unless maxima says otherwise",
    )
    eta: Annotated[Positive, Field(le=1e6)] = parameter(
        2.0,
        help="exponent η of the weight (s_min/s)^(2η) of single; a great one takes the cell of the least "
        "deviation, whatever its votes",
    )
    least_votes: Whole | Auto = parameter(
        "auto",
        dimension=Dimension.COUNT,
        help="T1: the deviation of a cell counts where it has more votes than these, and at least two",
        auto="0.4·n·Pd, rounded down",
    )

    def resolved(self, context: Context) -> Self:
        """Return these parameters with quantisation, thresholds and windows worked out.

        Raises
        ------
        RequestError
            Where votes, deviations and weighted votes together would be larger than an accumulator may be.
        """
        self.grid.grid(context, BYTES_PER_CELL)
        resolved = super().resolved(context)
        least = self.least_votes
        if least == "auto":
            least = math.floor(QUALIFIED_SHARE * context.expected_votes + 1e-9)
        maxima = 1 if self.maxima is None and self.mode == "single" else self.maxima
        return resolved.model_copy(update={"least_votes": least, "maxima": maxima})


class Weighted(AccumulatingInitiator):
    """Peaks of votes that are weighted by the sample standard deviation of the ρ of each cell.

    References
    ----------
    Master's thesis on the Hough transform for track initiation, Northwestern Polytechnical
    University, 2004, chapter 3; for the weights and how they deviate see
    `algorithms.hough.weighting.accumulate_weighted`. T1, which the thesis leaves to the case,
    decides everything: slices of a peak have a smaller deviation than the peak, so that it must
    exceed the votes of a slice.
    """

    name = "weighted"
    summary = "votes weighted by how closely the ρ of a cell lie together"
    source = "master's thesis 2004, chapters 3 and 4"
    parameters = WeightedParameters

    def weighting(self, parameters: WeightedParameters) -> Weighting:
        """Return how votes are weighted."""
        assert parameters.least_votes != "auto"
        return Weighting(parameters.mode == "several", parameters.eta, parameters.least_votes)


INITIATOR = Weighted()
