"""The sequential Hough initiator: the greatest cell, again and again."""

from __future__ import annotations

from typing import Literal

from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters, Peaks
from algorithms.parameters import Count, Dimension, Fraction, parameter, with_default


class SequentialParameters(AccumulatingParameters):
    """The parameters of `sequential`."""

    fraction: Fraction = parameter(
        0.0,
        dimension=Dimension.FRACTION,
        help="the least votes of a track as a fraction of the expected n·Pd votes of a target; 0 takes any",
    )
    peaks: Peaks = with_default(AccumulatingParameters, "peaks", "sequential")
    maxima: Count | None = with_default(AccumulatingParameters, "maxima", 2)
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

    def goes_on(self, parameters: SequentialParameters) -> bool:
        """Return whether a window around a cell goes on across θ = 0 and π: not in the document's mode."""
        return parameters.mode == "sound"


INITIATOR = Sequential()
