"""Confidence intervals of rates and means."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

Z95 = 1.959963984540054
"""Quantile of the standard normal distribution for two-sided 95 %."""


def wilson(rate: float, count: float, z: float = Z95) -> tuple[float, float]:
    """Return the Wilson score interval of a rate found in so many independent observations.

    Parameters
    ----------
    rate : found rate, in [0, 1]
    count : number of observations, > 0; need not be whole
    z : normal quantile

    References
    ----------
    E. B. Wilson, Journal of the American Statistical Association 22, 1927.
    """
    shrink = 1.0 + z * z / count
    centre = (rate + 0.5 * z * z / count) / shrink
    half = z / shrink * math.sqrt(max(0.0, rate * (1.0 - rate) / count + 0.25 * z * z / count**2))
    # Rounding must not put the bounds of 0 and 1 beyond the rate itself.
    return max(0.0, min(rate, centre - half)), min(1.0, max(rate, centre + half))


def effective_count(values: ArrayLike) -> float:
    """Return how many independent yes-or-no observations would be as uncertain as the mean of these.

    Parameters
    ----------
    values : per-trial values in [0, 1], shape (n,), n ≥ 1

    Notes
    -----
    For n values of 0 and 1 it is n. It lies above n where a trial holds several targets that are found
    independently of each other, and below where they are not. Without spread it is n.
    """
    values = np.asarray(values, dtype=float)
    mean = float(values.mean())
    variance = float(values.var())
    if variance <= 0.0 or not 0.0 < mean < 1.0:
        return float(len(values))
    return len(values) * mean * (1.0 - mean) / variance


def mean_interval(values: ArrayLike, z: float = Z95) -> tuple[float, float]:
    """Return the interval of the mean of per-trial values in [0, 1], by Wilson's formula."""
    values = np.asarray(values, dtype=float)
    return wilson(float(values.mean()), effective_count(values), z)


def normal_interval(values: ArrayLike, z: float = Z95) -> tuple[float, float]:
    """Return the interval of the mean of per-trial values of any size, by the normal distribution.

    Parameters
    ----------
    values : per-trial values, shape (n,), n ≥ 1; of one value alone the interval is unbounded
    z : normal quantile
    """
    values = np.asarray(values, dtype=float)
    mean = float(values.mean())
    if len(values) < 2:
        return -math.inf, math.inf
    half = z * float(values.std(ddof=1)) / math.sqrt(len(values))
    return mean - half, mean + half


def chi_square_quantile(share: float, freedom: float) -> float:
    """Return the value that so great a share of a χ² distribution lies below.

    Parameters
    ----------
    share : in (0, 1)
    freedom : its degrees of freedom, > 0
    """
    # Imported where it is needed: it takes longer than many a command.
    from scipy.special import chdtri

    return float(chdtri(freedom, 1.0 - share))


def count_interval(values: ArrayLike, z: float = Z95) -> tuple[float, float]:
    """Return the interval of the mean of per-trial counts.

    Parameters
    ----------
    values : per-trial counts, shape (n,), n ≥ 1
    z : normal quantile

    Notes
    -----
    That of the normal distribution, but where nothing was counted at all: what has not been seen in n
    trials may still happen, and the exact upper end of a Poisson mean, 3.7 / n for 95 %, is given.
    """
    values = np.asarray(values, dtype=float)
    if values.any():
        low, high = normal_interval(values, z)
        return max(0.0, low), high
    return 0.0, -math.log(0.5 * math.erfc(z / math.sqrt(2.0))) / len(values)
