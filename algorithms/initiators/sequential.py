"""The sequential Hough initiator: the greatest cell, again and again."""

from __future__ import annotations

from typing import Literal

from algorithms.hough.search import Extraction, PeakSearch
from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters
from algorithms.parameters import Count, Dimension, Fraction, Whole, parameter


class SequentialParameters(AccumulatingParameters):
    """The parameters of `sequential`."""

    fraction: Fraction = parameter(
        0.0,
        dimension=Dimension.FRACTION,
        help="the least votes of a track as a fraction of the expected n·Pd votes of a target; 0 takes any",
    )
    maxima: Count = parameter(2, dimension=Dimension.COUNT, help="how many maxima S are taken at most")
    suppress_theta: Whole = parameter(
        5, dimension=Dimension.COUNT, help="rows on each side of a maximum whose votes are cleared"
    )
    suppress_rho: Whole = parameter(
        5, dimension=Dimension.COUNT, help="columns on each side of a maximum whose votes are cleared"
    )
    ties: Literal["last", "first"] = parameter(
        "last", help="which of equal maxima is taken, in θ-major order; the source takes the last"
    )
    mode: Literal["sound", "document"] = parameter(
        "sound",
        help="sound clears across θ = 0 and 180° too; document stops at the edges, as the source does",
    )


class Sequential(AccumulatingInitiator):
    """S maxima, each with its neighbourhood suppressed.

    References
    ----------
    Course report on track initiation by the Hough transform, Northwestern Polytechnical
    University, 2018, section 2.3.3. Deviation: a maximum needs at least one vote, and a
    threshold may ask for more; the source takes S cells whatever they hold.
    """

    name = "sequential"
    summary = "the S greatest cells, the neighbourhood of each suppressed"
    source = "course report 2018, section 2.3.3"
    parameters = SequentialParameters

    def peaks(self, parameters: SequentialParameters) -> PeakSearch:
        """Return the search for successive maxima."""
        assert parameters.votes is not None
        return PeakSearch(
            Extraction.SUCCESSIVE,
            parameters.votes,
            parameters.maxima,
            parameters.suppress_theta,
            parameters.suppress_rho,
            last=parameters.ties == "last",
            wrap=parameters.mode == "sound",
        )


INITIATOR = Sequential()
