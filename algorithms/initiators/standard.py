"""The standard Hough initiator: every cell with enough votes is a track."""

from __future__ import annotations

from algorithms.hough.search import Extraction, PeakSearch
from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters


class StandardParameters(AccumulatingParameters):
    """The parameters of `standard`."""


class Standard(AccumulatingInitiator):
    """Threshold on the votes of every cell.

    References
    ----------
    Course report on track initiation by the Hough transform, Northwestern Polytechnical
    University, 2018, section 2.3.1. One target fills several cells, and each is a track.
    """

    name = "standard"
    summary = "every cell with at least so many votes is a track"
    source = "course report 2018, section 2.3.1"
    parameters = StandardParameters

    def peaks(self, parameters: StandardParameters) -> PeakSearch:
        """Return the threshold search."""
        assert parameters.votes is not None
        return PeakSearch(Extraction.THRESHOLD, parameters.votes)


INITIATOR = Standard()
