"""Votes in the home cell: the one in which the line of a target lies."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.quantisation.counts import tails

Array = NDArray[np.float64]

COARSE, FINE = (6, 10), (24, 32)
"""Nodes of the means over δ and over u, for a search with R ≤ σ and for any quantisation.

The integrand is even in both. With R ≤ σ, Δρ ≤ 8σ, 100 scans the coarse mean is exact to .004 (to .001
with 40 scans), the fine one to .0001; with R = 16σ the fine one is exact to .001.
"""


class Passage(NamedTuple):
    """A target's way through a batch.

    Attributes
    ----------
    sigma : standard deviation of the noise across the line, above 0
    scans, extent : its scans n, evenly spaced over the length L of the line
    probability : Pd
    """

    sigma: float
    scans: int
    extent: float
    probability: float


class Nodes(NamedTuple):
    """Nodes and weights of the means over the angle and over the place in the cell, float64 each."""

    angles: Array
    angle_weights: Array
    places: Array
    place_weights: Array


@kernel
def _home_votes(theta_step, rho_step, passage, nodes, votes):  # type: ignore[no-untyped-def]
    scale = 1.0 / (math.sqrt(2.0) * passage.sigma)
    scans, extent, probability = passage.scans, passage.extent, passage.probability
    angles, places = nodes.angles, nodes.places
    distribution = np.empty(scans + 1, np.float64)
    for i in range(len(theta_step)):
        for j in range(len(rho_step)):
            votes[i, j] = 0.0
            half = 0.5 * rho_step[j]
            for a in range(len(angles)):
                turned = math.sin(0.5 * theta_step[i] * angles[a])
                for b in range(len(places)):
                    place = half * places[b]
                    distribution[0] = 1.0
                    for scan in range(scans):
                        along = extent * (scan / (scans - 1) - 0.5) if scans > 1 else 0.0
                        away = place + along * turned
                        share = 0.5 * (math.erf((away + half) * scale) - math.erf((away - half) * scale))
                        hit = probability * share
                        # One more scan: each number of votes stays, or rises by one.
                        distribution[scan + 1] = distribution[scan] * hit
                        for k in range(scan, 0, -1):
                            distribution[k] = distribution[k] * (1.0 - hit) + distribution[k - 1] * hit
                        distribution[0] *= 1.0 - hit
                    weight = nodes.angle_weights[a] * nodes.place_weights[b]
                    for k in range(scans + 1):
                        votes[i, j, k] += weight * distribution[k]


def home_votes(
    theta_step: Array,
    rho_step: Array,
    sigma: float,
    scans: int,
    extent: float,
    probability: float,
    nodes: tuple[int, int] = FINE,
) -> Array:
    """Return how many of its votes a line has in its home cell: the probability of 0 … n.

    Parameters
    ----------
    theta_step, rho_step : float64 (rows,) and (widths,), Δθ in radians and Δρ
    sigma : standard deviation of the noise across the line
    scans, extent : the target's scans n, evenly spaced over the length L of the line
    probability : Pd
    nodes : `COARSE` or `FINE`

    Returns
    -------
    float64 (rows, widths, n + 1)

    Notes
    -----
    The mean over the angle δ between line and row, uniform over Δθ, and over the place u of mid-track
    in the cell, uniform over Δρ. Each scan votes into the cell with its own probability, that of its own
    offset k·sin δ; the votes add up scan by scan. (A binomial number with the mean share of the votes, for
    plots anywhere along the line, scatters more: it is off where R is large beside σ and Pd is near 1.)
    """
    votes = np.empty((len(theta_step), len(rho_step), scans + 1))
    # Without noise each share is 0 or 1; the smallest spread that is a number gives the same.
    least = 1e-12 * float(np.min(rho_step))
    passage = Passage(max(float(sigma), least), scans, float(extent), float(probability))
    every = Nodes(*_half_line(nodes[0]), *_half_line(nodes[1]))
    _home_votes(np.asarray(theta_step, dtype=float), np.asarray(rho_step, dtype=float), passage, every, votes)
    return votes


def reaching(votes: Array, clutter: Array, most: int, fixed: float | None = None) -> Array:
    """Return P[own votes + clutter votes ≥ T] for T = 1 … `most`.

    Parameters
    ----------
    votes : float64 (rows, widths, n + 1), of `home_votes`
    clutter : float64 (widths,), mean number μ of clutter votes in the home cell
    most : the greatest threshold
    fixed : the number of clutter plots in a batch, where it is fixed

    Returns
    -------
    float64 (rows, widths, most)
    """
    own = np.arange(votes.shape[-1])
    needed = np.maximum(np.arange(1, most + 1)[None, :] - own[:, None], 0)
    enough = tails(clutter, most, fixed)[:, needed]
    return np.asarray(np.einsum("ijk,jkt->ijt", votes, enough))


def _half_line(count: int) -> tuple[Array, Array]:
    """Return nodes and weights of the mean over (0, 1)."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * (1.0 + nodes), 0.5 * weights
