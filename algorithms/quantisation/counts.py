"""Numbers of clutter plots in a cell: Poisson, or binomial where the batch holds a fixed number."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

Array = NDArray[np.float64]


def tails(mean: ArrayLike, most: int, fixed: float | None = None) -> Array:
    """Return P[N ≥ t] for t = 0 … `most`, along a new last axis.

    Parameters
    ----------
    mean : mean numbers μ in a cell
    most : the last t
    fixed : number M of plots in the whole batch, where it is fixed: N is binomial (M, μ/M)
    """
    mean = np.asarray(mean, dtype=float)[..., None]
    t = np.arange(most + 1)
    if fixed is None:
        logarithm = special.xlogy(t, mean) - mean - special.gammaln(t + 1.0)
        last = special.gammainc(most + 1.0, mean)
    else:
        share = np.minimum(mean / max(fixed, 1.0), 1.0)
        possible = np.minimum(t, fixed)
        logarithm = (
            special.gammaln(fixed + 1.0) - special.gammaln(possible + 1.0)
            - special.gammaln(fixed - possible + 1.0)
            + special.xlogy(possible, share) + special.xlog1py(fixed - possible, -share)
        )  # fmt: skip
        logarithm = np.where(t <= fixed, logarithm, -np.inf)
        last = special.betainc(most + 1.0, fixed - most, share) if most < fixed else np.zeros_like(share)
    # Summed from the far end, so that small tails keep their digits.
    summed = np.cumsum(np.exp(logarithm)[..., ::-1], axis=-1)[..., ::-1] + last
    return np.asarray(np.minimum(summed, 1.0))


def integrated_tails(mean: ArrayLike, most: int, fixed: float | None = None) -> Array:
    """Return ∫ P[N ≥ t] dμ from 0 to the mean, for t = 1 … `most`, along a new last axis.

    It is μ·P[N ≥ t] − t·P[N' ≥ t + 1], with N' of the same law; where the number M of plots in the
    batch is fixed N' is binomial (M + 1, μ/M), and its term is multiplied by M/(M + 1).
    """
    mean = np.asarray(mean, dtype=float)
    t = np.arange(1, most + 1)
    first = tails(mean, most, fixed)[..., 1:]
    if fixed is None:
        second = tails(mean, most + 1)[..., 2:]
    else:
        second = tails(mean * (fixed + 1.0) / max(fixed, 1.0), most + 1, fixed + 1.0)[..., 2:]
        second = second * (fixed / (fixed + 1.0))
    return np.asarray(np.maximum(mean[..., None] * first - t * second, 0.0))
