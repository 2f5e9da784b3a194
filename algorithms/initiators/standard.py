"""The standard Hough initiator: every cell with enough votes is a track."""

from __future__ import annotations

from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters


class StandardParameters(AccumulatingParameters):
    """The parameters of `standard`."""


class Standard(AccumulatingInitiator):
    """Threshold on the votes of every cell.

    References
    ----------
    Course report on track initiation by the Hough transform, Northwestern Polytechnical
    University, 2018, section 2.3.1. One target fills several cells, and each is a track, unless another
    extraction of `peaks` is chosen.
    """

    name = "standard"
    summary = "every cell with at least so many votes is a track"
    source = "course report 2018, section 2.3.1"
    parameters = StandardParameters


INITIATOR = Standard()
