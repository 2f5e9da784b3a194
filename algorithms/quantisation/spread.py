"""The vote distribution: where the plots of one line vote in one row of the accumulator.

In the row at θ_line + δ the plot at the along-line coordinate k votes at ρ + ε + N(0, σ²), with
ε = k·sin δ + ρ·(cos δ − 1); the noise spreads the votes, and so does the extent of the line.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

Array = NDArray[np.float64]

NARROW = 1e-3
"""Below this ratio R/σ differences cancel, and a series in R/σ is exact to 1e-11."""

MOST_STEPS = 200
FARTHEST = 50.0
"""Distance in standard deviations past which a normal distribution is 0 in double precision."""

SQRT_2 = math.sqrt(2.0)
SQRT_2_PI = math.sqrt(2.0 * math.pi)


@dataclass(frozen=True, slots=True)
class VoteDistribution:
    """Votes of one line in one row: normal noise on an offset that is uniform on (ε−, ε+).

    Attributes
    ----------
    sigma : standard deviation σ of the noise across the line, ≥ 0
    lower, upper : the bounds ε− ≤ ε+ of the offset from the line's ρ
    rho : the line's ρ; the votes are at ρ + ε

    References
    ----------
    Master's thesis, Northwestern Polytechnical University, 2004, section 2.2 (equations 2-10, 2-17
    to 2-20). Deviations: the offset is exact, where the thesis keeps its first order in δ, so that
    any angle is allowed; equation 2-5 sums over the plots of a line what is a mixture of them.
    """

    sigma: float
    lower: float
    upper: float
    rho: float = 0.0

    @classmethod
    def of_line(
        cls, sigma: float, along: tuple[float, float], delta: float, rho: float = 0.0
    ) -> VoteDistribution:
        """Return the distribution in the row that lies δ beside a line.

        Parameters
        ----------
        sigma : standard deviation of the noise across the line
        along : first and last along-line coordinate k = −x·sin θ + y·cos θ of the plots
        delta : θ of the row less θ of the line, in radians
        rho : ρ of the line, measured from the same origin as `along`
        """
        turned = -2.0 * rho * math.sin(0.5 * delta) ** 2
        ends = [k * math.sin(delta) + turned for k in along]
        return cls(sigma, min(ends), max(ends), rho)

    @property
    def bias(self) -> float:
        """Distance of the votes' centre from the line's ρ (equation 2-18)."""
        return 0.5 * (self.lower + self.upper)

    @property
    def radius(self) -> float:
        """Half the spread R that the extent of the line gives (equation 2-18)."""
        return 0.5 * (self.upper - self.lower)

    @property
    def centre(self) -> float:
        """The ρ about which the votes lie."""
        return self.rho + self.bias

    @property
    def peak_density(self) -> float:
        """The greatest density, (2Φ(R/σ) − 1)/2R; infinite without noise and extent."""
        if self.sigma == 0.0:
            return 0.5 / self.radius if self.radius else math.inf
        ratio = self.radius / self.sigma
        if ratio < NARROW:
            return (1.0 - ratio**2 / 6.0 + ratio**4 / 40.0) / (self.sigma * SQRT_2_PI)
        return math.erf(ratio / SQRT_2) / (2.0 * self.radius)

    def density(self, rho: ArrayLike) -> Array:
        """Return the density of votes at places of the row (equation 2-17), by unit of length."""
        away = -np.abs(np.asarray(rho, dtype=float) - self.centre)
        if self.sigma == 0.0:
            height = math.inf if self.radius == 0.0 else 0.5 / self.radius
            return np.where(-away <= self.radius, height, 0.0)
        ratio = self.radius / self.sigma
        t = np.maximum(away / self.sigma, -FARTHEST - ratio)
        if ratio < NARROW:
            series = 1.0 + ratio**2 / 6.0 * (t**2 - 1.0) + ratio**4 / 120.0 * (t**4 - 6.0 * t**2 + 3.0)
            return np.asarray(np.exp(-0.5 * t**2) * series / (self.sigma * SQRT_2_PI))
        # On the left of the centre neither term is close to 1, so their difference keeps its digits.
        return np.asarray((special.ndtr(t + ratio) - special.ndtr(t - ratio)) / (2.0 * self.radius))

    def distribution(self, rho: ArrayLike) -> Array:
        """Return the share of votes below places of the row."""
        away = np.asarray(rho, dtype=float) - self.centre
        below = self._lower_tail(-np.abs(away))
        # The point mass of a line without noise and extent is not below itself.
        return np.where(away > 0.0, 1.0 - below, below)

    def quantile(self, share: ArrayLike) -> Array:
        """Return the places below which shares of the votes lie; ±∞ for 0 and 1 where there is noise."""
        share = np.asarray(share, dtype=float)
        if not bool(np.all((share >= 0.0) & (share <= 1.0))):
            raise ValueError(f"a share of votes must lie in [0, 1]; {share} is given")
        tail = np.minimum(share, 1.0 - share)
        if self.sigma == 0.0:
            away = self.radius * (2.0 * tail - 1.0)
        else:
            away = self._lower_quantile(tail)
        return np.asarray(self.centre + np.where(share > 0.5, -away, away))

    def half_width(self, confidence: float) -> float:
        """Return h, such that the given share of the votes lies within ±h of their centre."""
        return float(self.quantile(0.5 + 0.5 * confidence)) - self.centre

    def share(self, offset: ArrayLike, width: float) -> Array:
        """Return the share of votes in cells.

        Parameters
        ----------
        offset : of the cells' centres from the votes' centre
        width : Δρ of a cell
        """
        # Cells on the left: there the tails are small numbers, not differences from 1.
        inner = -np.abs(np.asarray(offset, dtype=float))
        low, high = inner - 0.5 * width, inner + 0.5 * width
        within = self._lower_tail(-np.abs(high))
        return np.asarray(np.where(high > 0.0, 1.0 - within, within) - self._lower_tail(low))

    def mean_share(self, width: float) -> float:
        """Return the mean share of votes in the cell in which their centre lies.

        The centre is taken as anywhere in the cell, equally likely: the mean over the offset u,
        uniform over one width, which is E max(0, 1 − |vote − centre|/Δρ).
        """
        # Its integral ∫ P(|vote − centre| < x) dx/Δρ, 0 ≤ x ≤ Δρ: straight, then the noise's edge, then 1.
        reach = 9.0 * self.sigma
        edges = np.clip([0.0, self.radius - reach, self.radius + reach, width], 0.0, width)
        nodes, weights = np.polynomial.legendre.leggauss(64)
        total = 0.0
        for low, high in itertools.pairwise(edges):
            x = 0.5 * (low + high) + 0.5 * (high - low) * nodes
            total += 0.5 * (high - low) * float(weights @ (1.0 - 2.0 * self._lower_tail(-x)))
        return total / width

    def _lower_tail(self, away: ArrayLike) -> Array:
        """Return the share of votes below centre + away, for away ≤ 0."""
        away = np.asarray(away, dtype=float)
        if self.sigma == 0.0:
            if self.radius == 0.0:
                return np.zeros_like(away)
            return np.asarray(np.clip(0.5 + 0.5 * away / self.radius, 0.0, 0.5))
        ratio = self.radius / self.sigma
        t = np.maximum(away / self.sigma, -FARTHEST - ratio)
        if ratio < NARROW:
            slope = t * np.exp(-0.5 * t**2) / SQRT_2_PI
            series = ratio**2 / 6.0 + ratio**4 / 120.0 * (t**2 - 3.0)
            return np.asarray(special.ndtr(t) - slope * series)
        high, low = t + ratio, t - ratio
        return np.asarray((np.maximum(high, 0.0) + _ramp(-np.abs(high)) - _ramp(low)) / (2.0 * ratio))

    def _lower_quantile(self, tail: Array) -> Array:
        """Return the place, from the centre, below which a share ≤ 0.5 of the votes lies."""
        # The logarithm of a log-concave distribution is concave: Newton's steps rise to the root.
        with np.errstate(divide="ignore"):
            normal = self.sigma * special.ndtri(tail)
        away = normal - self.radius
        finite = np.isfinite(away)
        if not finite.any():
            return np.asarray(away)
        goal, highest = tail[finite], np.minimum(normal[finite] + self.radius, 0.0)
        place = away[finite]
        for _ in range(MOST_STEPS):
            below = self._lower_tail(place)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = below / self.density(self.centre + place) * np.log(goal / below)
            after = np.where(np.isfinite(step), np.clip(place + step, place, highest), place)
            if np.array_equal(after, place):
                break
            place = after
        result = np.array(away, dtype=float)
        result[finite] = place
        return result


def _ramp(z: Array) -> Array:
    """Return the integral of Φ from −∞ to z ≤ 0, z·Φ(z) + φ(z), to its last digits in the tail too."""
    z = np.maximum(z, -FARTHEST)
    scaled = math.sqrt(0.5 * math.pi) * special.erfcx(-z / SQRT_2)
    return np.asarray(np.exp(-0.5 * z**2) / SQRT_2_PI * np.maximum(1.0 + z * scaled, 0.0))
