"""Rules of quantisation: how wide a column, how fine a row, how far a peak reaches."""

from __future__ import annotations

import math
from dataclasses import dataclass

from algorithms.quantisation.spread import VoteDistribution


@dataclass(frozen=True, slots=True)
class ParallelLines:
    """What two parallel lines leave of the row that they share.

    Attributes
    ----------
    separation : distance of the lines
    half_width : h, such that a share `confidence` of a line's votes lies within ±h of their centre
    confidence : 1 − α
    """

    separation: float
    half_width: float
    confidence: float

    @property
    def gap(self) -> float:
        """The greatest Δρ that holds the lines apart, separation − 2h; negative where none does.

        Then no cell is within reach of both lines' votes (1 − α of them).
        """
        return self.separation - 2.0 * self.half_width

    @property
    def valley(self) -> float:
        """The greatest Δρ that also shows a valley between the lines: there must be an empty column."""
        return 0.5 * self.gap

    @property
    def holding(self) -> float:
        """The least Δρ whose cell can hold a share 1 − α of one line's votes, 2h."""
        return 2.0 * self.half_width

    @property
    def are_apart(self) -> bool:
        """Whether some Δρ holds the lines apart."""
        return self.gap > 0.0


def resolvability(votes: VoteDistribution, separation: float, confidence: float = 0.95) -> ParallelLines:
    """Return how two parallel lines share a row in which each votes as given.

    Parameters
    ----------
    votes : the distribution of either line's votes; that of the other one is shifted
    separation : distance of the lines
    confidence : 1 − α

    References
    ----------
    Master's thesis, Northwestern Polytechnical University, 2004, section 2.3.1 (equations 2-21 and
    2-23). Deviation: the thesis mixes up which line's upper and which line's lower quantile it
    means, so that its bound may grow with the spread; here it is what the spread leaves.
    """
    return ParallelLines(separation, votes.half_width(confidence), confidence)


def widest_row(sigma: float, extent: float, kappa: float = 1.0) -> float:
    """Return the greatest Δθ, in radians, at which the extent spreads votes by R ≤ κσ at most.

    R is greatest where the line lies between two rows: (L/2)·sin(Δθ/2) ≤ κσ, nearly Δθ ≤ 4κσ/L.

    Parameters
    ----------
    sigma : standard deviation σ of the noise across the line
    extent : length L of the line within the batch
    kappa : κ; at 1 extent and noise spread the votes alike

    References
    ----------
    The thesis, section 2.3.2, leaves the choice of Δθ to future work.
    """
    if 2.0 * kappa * sigma >= extent:
        return math.pi
    return 2.0 * math.asin(2.0 * kappa * sigma / extent)


def peak_rows(expected: float, extent: float, votes: int, theta_step: float, rho_step: float) -> float:
    """Return how many rows a peak reaches to each side: there its cells fall below the threshold.

    In a row that lies δ beside the line its votes spread over L·sin δ, so that a cell holds about
    n·Pd·Δρ/(L·sin δ) of them.

    Parameters
    ----------
    expected : votes n·Pd of the line
    extent : its length L within the batch
    votes : the threshold T
    theta_step, rho_step : Δθ in radians, Δρ
    """
    if extent * votes <= expected * rho_step:
        return 0.5 * math.pi / theta_step
    return math.asin(expected * rho_step / (extent * votes)) / theta_step


@dataclass(frozen=True, slots=True)
class SuppressionWindow:
    """How many cells around a peak are of the same line.

    Attributes
    ----------
    theta : rows to each side
    rho : columns to each side, where the window is sheared along the peak's slant
    rho_upright : columns to each side of a window that is not
    """

    theta: int
    rho: int
    rho_upright: int


def suppression_window(
    rows: float, sigma: float, extent: float, along: float, theta_step: float, rho_step: float
) -> SuppressionWindow:
    """Return the window that clears a peak and what noise and clutter raise beside it.

    It covers twice the rows that the peak reaches on average. In its last row the votes spread over
    L·sin δ about ρ + k·sin δ, k the along-line coordinate of the middle of the track: the peak slants.

    Parameters
    ----------
    rows : that the peak reaches to each side, of `peak_rows`
    sigma : standard deviation of the noise across the line
    extent : length of the line within the batch
    along : k of the middle of the track, measured from the grid's origin
    theta_step, rho_step : Δθ in radians, Δρ
    """
    theta = max(1, min(math.ceil(2.0 * rows), math.ceil(0.5 * math.pi / theta_step)))
    turned = math.sin(min(theta * theta_step, 0.5 * math.pi))
    spread = 0.5 * extent * turned + 2.0 * sigma
    upright = spread + abs(along) * turned
    return SuppressionWindow(
        theta, max(1, math.ceil(spread / rho_step)), max(1, math.ceil(upright / rho_step))
    )
