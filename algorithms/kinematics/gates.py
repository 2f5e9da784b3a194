"""Gates: what speed a target can have, and how far a plot may miss a prediction or a fit."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel


class SpeedGate(NamedTuple):
    """Speeds that a target can have.

    Attributes
    ----------
    slowest, fastest : the least and the greatest speed, as length a second
    allowance : by how many standard deviations of the noise a distance or a speed may miss them
    """

    slowest: float
    fastest: float
    allowance: float = 0.0


@kernel
def can_fly(gate, distance, elapsed, deviation):  # type: ignore[no-untyped-def]
    """Return whether a target can fly so far in so many seconds; with 1 s, whether it can be so fast.

    Parameters
    ----------
    gate : `SpeedGate`
    distance : as measured
    deviation : standard deviation of the distance by the noise
    """
    noise = gate.allowance * deviation
    return gate.slowest * elapsed - noise <= distance <= gate.fastest * elapsed + noise


@cache
def chi_square_gate(probability: float, dimensions: int) -> float:
    """Return the greatest normalised squared innovation with which a plot is inside a gate.

    Parameters
    ----------
    probability : share of a target's own plots that lie inside, above 0 and below 1
    dimensions : of a plot: 2 or 3
    """
    # Imported here: scipy takes a tenth of a second that few commands need.
    from scipy.special import chdtri

    if not 0.0 < probability < 1.0:
        raise ValueError(f"a gate of probability {probability:g} is asked for; it lies between 0 and 1")
    return float(chdtri(dimensions, 1.0 - probability))


@cache
def fit_limits(confidence: float, most: int, dimensions: int) -> NDArray[np.float64]:
    """Return the greatest χ² of a constant velocity fitted to 0, 1, …, `most` plots.

    A constant velocity has 2d parameters, so m plots leave d·(m − 2) degrees of freedom; of two plots
    and fewer every fit passes. The second row is for tracks that are to be continued, which need not
    pass the same test: of a target with four plots the first three would fail it as often again.

    Returns
    -------
    limits : float64 (2, most + 1), at the confidence, and at a hundredth of what is left to 1
    """
    from scipy.special import chdtri

    plots = np.arange(most + 1)
    limits = np.full((2, most + 1), np.inf)
    for row, missed in enumerate((1.0 - confidence, 0.01 * (1.0 - confidence))):
        limits[row, 3:] = chdtri(dimensions * (plots[3:] - 2), missed)
    return limits
