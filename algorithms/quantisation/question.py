"""The question of a design: which lines, which noise, which clutter, how many false cells."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from algorithms.context import Box
from algorithms.errors import RequestError
from algorithms.hough.lines import line_through
from algorithms.quantisation.spread import VoteDistribution

Array = NDArray[np.float64]

ALONG_AXIS = 1e-12
"""Cosine or sine of a line's θ up to which the line lies along an axis."""

MOST_SCANS = 1000
"""The most scans of a batch: the votes of a line are worked out scan by scan."""


@dataclass(frozen=True, slots=True)
class TargetLine:
    """The line of one target within the batch.

    Attributes
    ----------
    sigma : standard deviation of the noise across the line
    scans : number of scans in which the target is there
    extent : length L of the line between the first and the last of them
    theta : of the line in normal form; None where only its length is known
    middle : the place of mid-track; None where only its length is known
    """

    sigma: float
    scans: int
    extent: float
    theta: float | None = None
    middle: tuple[float, float] | None = None

    @classmethod
    def of_motion(
        cls,
        first: tuple[float, float],
        velocity: tuple[float, float],
        scans: int,
        interval: float,
        sigma: tuple[float, float],
    ) -> TargetLine:
        """Return the line of a target that moves steadily.

        Parameters
        ----------
        first : its place in its first scan
        velocity : in unit of length a second, not zero
        scans, interval : number of scans, seconds between them
        sigma : standard deviations of the noise on x and on y
        """
        theta = float(line_through(first, velocity)[0])
        elapsed = (scans - 1) * interval
        middle = (first[0] + 0.5 * elapsed * velocity[0], first[1] + 0.5 * elapsed * velocity[1])
        # A line along an axis has no share of the noise along it, not even that of a rounded right angle.
        shares = (side if abs(side) > ALONG_AXIS else 0.0 for side in (math.cos(theta), math.sin(theta)))
        across = math.hypot(*(noise * share for noise, share in zip(sigma, shares, strict=True)))
        return cls(across, scans, elapsed * math.hypot(*velocity), theta, middle)

    def about(self, origin: tuple[float, float]) -> tuple[float, float]:
        """Return ρ of the line and the along-line coordinate k of mid-track, from an origin.

        A line of which only the length is known is taken to pass through the origin in mid-track.
        """
        if self.theta is None or self.middle is None:
            return 0.0, 0.0
        x, y = self.middle[0] - origin[0], self.middle[1] - origin[1]
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        return x * cosine + y * sine, y * cosine - x * sine

    def votes_at(self, theta: float, origin: tuple[float, float] = (0.0, 0.0)) -> VoteDistribution:
        """Return how its plots vote in the row at an angle, with ρ measured from an origin."""
        rho, along = self.about(origin)
        # The distribution is exact for any angle, so it needs no row on this side of the seam.
        half = 0.5 * self.extent
        delta = theta - (self.theta or 0.0)
        return VoteDistribution.of_line(self.sigma, (along - half, along + half), delta, rho)


@dataclass(frozen=True, slots=True)
class ClutterSource:
    """Clutter that is uniform over a region.

    Attributes
    ----------
    plots : mean number of plots in the batch
    region : where they lie
    """

    plots: float
    region: Box

    def trapezoid(self, theta: ArrayLike) -> tuple[Array, Array, Array]:
        """Return how the plots vote in rows: their density in ρ is a trapezoid about the centre's ρ.

        Returns
        -------
        flat, foot : half the width at the top and at the foot
        top : greatest density, plots by unit of length
        """
        width, height = (high - low for low, high in zip(self.region.lower, self.region.upper, strict=True))
        across, up = width * np.abs(np.cos(theta)), height * np.abs(np.sin(theta))
        longer = np.maximum(across, up)
        return 0.5 * np.abs(across - up), 0.5 * (across + up), self.plots / longer

    def density(self, theta: ArrayLike, rho: ArrayLike, origin: tuple[float, float]) -> Array:
        """Return the mean number of votes by unit of length, at ρ measured from an origin."""
        flat, foot, top = self.trapezoid(theta)
        x, y = self.region.centre[0] - origin[0], self.region.centre[1] - origin[1]
        away = np.abs(np.asarray(rho) - (x * np.cos(theta) + y * np.sin(theta)))
        slope = np.maximum(foot - flat, np.finfo(float).eps * foot)
        return np.asarray(top * np.clip((foot - away) / slope, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class Clutter:
    """All clutter of a batch.

    Attributes
    ----------
    sources : they add up
    is_exact : whether the number of plots is the same in every batch, rather than Poisson; with
        several sources the difference is neglected
    """

    sources: tuple[ClutterSource, ...] = ()
    is_exact: bool = False

    @property
    def plots(self) -> float:
        """Mean number of plots in the batch."""
        return sum(source.plots for source in self.sources)

    @property
    def fixed_number(self) -> float | None:
        """The number of plots where it is the same in every batch and all lie in one region."""
        return self.plots if self.is_exact and len(self.sources) == 1 else None

    def density(self, theta: ArrayLike, rho: ArrayLike, origin: tuple[float, float]) -> Array:
        """Return the mean number of votes by unit of length, at ρ measured from an origin."""
        found = np.zeros(np.broadcast_shapes(np.shape(theta), np.shape(rho)))
        for source in self.sources:
            found = found + source.density(theta, rho, origin)
        return found

    def density_on(self, line: TargetLine) -> float:
        """Return the mean number of clutter votes by unit of length at a target's own line.

        Where the line's place is not known: the mean over all lines through a point of the region.
        """
        if line.theta is not None and line.middle is not None:
            rho, _ = line.about((0.0, 0.0))
            return float(self.density(line.theta, rho, (0.0, 0.0)))
        nodes, weights = np.polynomial.legendre.leggauss(32)
        theta, total = 0.25 * math.pi * (1.0 + nodes), 0.0
        for source in self.sources:
            flat, foot, top = source.trapezoid(theta)
            mean = 0.5 * float(weights @ (top**2 * (2.0 * flat + 2.0 / 3.0 * (foot - flat))))
            total += mean / source.plots if source.plots else 0.0
        return total


@dataclass(frozen=True, slots=True)
class Question:
    """What a quantisation is to be good for.

    Attributes
    ----------
    lines : the targets' lines; the predicted P_D is the mean over them, the bound on Δθ that of
        the one that spreads most
    detection_probability : Pd
    clutter : of the whole batch
    region : what the grid has to cover
    false_cells : the greatest expected number of false cells a batch
    kappa : κ, the greatest spread by the extent of a line in standard deviations of the noise
    separation : distance of parallel lines that are to be held apart; None for no such demand
    confidence : share of each line's votes that must stay apart from the other's
    """

    lines: tuple[TargetLine, ...]
    detection_probability: float
    clutter: Clutter
    region: Box
    false_cells: float = 1.0
    kappa: float = 1.0
    separation: float | None = None
    confidence: float = 0.95

    def __post_init__(self) -> None:
        if not self.lines:
            raise RequestError("a quantisation is designed for a target; there is none that moves")
        longest = max(line.scans for line in self.lines)
        if longest > MOST_SCANS:
            raise RequestError(
                f"{longest:,} scans are given; a quantisation is predicted for {MOST_SCANS:,} at most"
            )
        for name in ("false_cells", "kappa"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise RequestError(f"{name} {value:g} is given; it must be greater than 0")
        if self.separation is not None and not (math.isfinite(self.separation) and self.separation > 0.0):
            raise RequestError(f"separation {self.separation:g} is given; it must be greater than 0")
        if not 0.0 < self.confidence < 1.0:
            raise RequestError(f"confidence {self.confidence:g} is given; it must lie between 0 and 1")

    @property
    def noise(self) -> float:
        """The greatest standard deviation of the noise across a line."""
        return max(line.sigma for line in self.lines)

    def other_votes(self, line: TargetLine, rho_step: float) -> float:
        """Return the mean number of votes, in the home cell of a target, that are not its own.

        Clutter lies on its line, and so may plots of the other targets, where their tracks cross it.
        """
        # A cell wider than the clutter's region holds all of it, and no more.
        votes = min(rho_step * self.clutter.density_on(line), self.clutter.plots)
        if line.theta is None:
            return votes
        rho, _ = line.about((0.0, 0.0))
        for other in self.lines:
            if other is not line and other.theta is not None:
                spread = other.votes_at(line.theta)
                plots = self.detection_probability * other.scans
                votes += plots * float(spread.share(rho - spread.centre, rho_step))
        return votes
