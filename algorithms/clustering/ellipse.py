"""The standard-deviation ellipse of points in the range-Doppler plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel

Array = NDArray[np.float64]

COLLINEAR = 1e-12
"""Below this 1 − (c²/ab), points lie on one line: what is left is rounding."""


@dataclass(frozen=True, slots=True)
class Ellipse:
    """The √2 σ ellipse of points: λ1 r² + λ2 r d + λ3 d² + λ4 = 0 about its centre.

    Attributes
    ----------
    centre : mean range and mean Doppler
    range_variance, doppler_variance, covariance : a, b and c, each a sum over the points by their
        number, as the source has it

    Notes
    -----
    The source's formulas contradict each other: its angle (5) is measured from the Doppler axis and
    used in (7) as if from the range axis, so that σ1 ≤ σ2 always, and (9) exchanges λ1 and λ3, which
    mirrors the ellipse in r = d; its chord then measures Doppler. Here the coefficients are those of
    (p − centre)ᵀ C⁻¹ (p − centre) = 2 times 2(ab − c²), C the covariance matrix; the source's axes,
    √2 times the standard deviations, are kept. Its centre (4), the mean of points that have been
    centred before, is always 0 and is used on raw points in (13); here it is the mean.

    References
    ----------
    Patent on clustering the detections of a high-resolution radar by the standard-deviation
    ellipse, equations (1) to (10).
    """

    centre: tuple[float, float]
    range_variance: float
    doppler_variance: float
    covariance: float

    @property
    def coefficients(self) -> tuple[float, float, float, float]:
        """λ1 to λ4: 2b, −4c, 2a, −4(ab − c²)."""
        a, b, c = self.range_variance, self.doppler_variance, self.covariance
        return 2.0 * b, -4.0 * c, 2.0 * a, -4.0 * max(0.0, a * b - c * c)

    @property
    def semi_axes(self) -> tuple[float, float]:
        """Half the major and half the minor axis: √2 times the standard deviations along them."""
        a, b, c = self.range_variance, self.doppler_variance, self.covariance
        middle, reach = 0.5 * (a + b), math.hypot(0.5 * (a - b), c)
        return math.sqrt(2.0 * (middle + reach)), math.sqrt(2.0 * max(0.0, middle - reach))

    @property
    def angle(self) -> float:
        """Angle from the range axis to the major axis, in (−π/2, π/2]; 0 for a circle."""
        return 0.5 * math.atan2(2.0 * self.covariance, self.range_variance - self.doppler_variance)

    @property
    def chord(self) -> float:
        """Length of the chord through the centre along range, 2√2·√(a − c²/b)."""
        return float(chord(self.range_variance, self.doppler_variance, self.covariance))

    @property
    def widths(self) -> tuple[float, float]:
        """Extent in range and in Doppler: 2√2 standard deviations."""
        return width(self.range_variance), width(self.doppler_variance)

    def outline(self, radius: float = math.sqrt(2.0), count: int = 90) -> tuple[Array, Array]:
        """Return range and Doppler of points all around, so many standard deviations from the centre."""
        turn = np.linspace(0.0, 2.0 * np.pi, count + 1)
        major, minor = (radius / math.sqrt(2.0) * half for half in self.semi_axes)
        along, across = major * np.cos(turn), minor * np.sin(turn)
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        return (
            self.centre[0] + along * cosine - across * sine,
            self.centre[1] + along * sine + across * cosine,
        )


@kernel
def moments(along, doppler, members):  # type: ignore[no-untyped-def]
    """Return mean range, mean Doppler, a, b and c of the members, at least one.

    Parameters
    ----------
    along, doppler : float64 (n,), range and Doppler of all points
    members : int64 (m,), which points
    """
    count = len(members)
    # From the first member, so that equal coordinates have a variance of exactly 0.
    first_r, first_d = along[members[0]], doppler[members[0]]
    mean_r, mean_d = 0.0, 0.0
    for member in members:
        mean_r += along[member] - first_r
        mean_d += doppler[member] - first_d
    mean_r, mean_d = mean_r / count, mean_d / count
    a, b, c = 0.0, 0.0, 0.0
    for member in members:
        r, d = along[member] - first_r - mean_r, doppler[member] - first_d - mean_d
        a += r * r
        b += d * d
        c += r * d
    return first_r + mean_r, first_d + mean_d, a / count, b / count, c / count


@kernel
def width(variance):  # type: ignore[no-untyped-def]
    """Return the extent of points along an axis, 2√2 standard deviations."""
    return 2.0 * math.sqrt(2.0 * variance)


@kernel
def chord(a, b, c):  # type: ignore[no-untyped-def]
    """Return the chord of the √2 σ ellipse through its centre along range; 2√2·σ_r for b = 0."""
    if a <= 0.0 or b <= 0.0:
        return width(a)
    correlation = c / (math.sqrt(a) * math.sqrt(b))
    return width(a * max(0.0, 1.0 - correlation * correlation))


@kernel
def squared_distance(r, d, a, b, c):  # type: ignore[no-untyped-def]
    """Return the squared distance of a member from the centre, in standard deviations.

    Notes
    -----
    Members of one line, for whom the covariance has no inverse, are measured along it. The mean
    over the members is 2, or 1 where they lie on one line.
    """
    if a <= 0.0 and b <= 0.0:
        return 0.0
    if a <= 0.0:
        return d * d / b
    if b <= 0.0:
        return r * r / a
    u, v = r / math.sqrt(a), d / math.sqrt(b)
    correlation = c / (math.sqrt(a) * math.sqrt(b))
    free = 1.0 - correlation * correlation
    if free <= COLLINEAR:
        return 0.5 * (u * u + v * v)
    return (u * u - 2.0 * correlation * u * v + v * v) / free
