"""How many cells clutter alone lifts to a threshold."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from algorithms.hough.grid import Grid
from algorithms.quantisation.counts import integrated_tails, tails
from algorithms.quantisation.question import Clutter

Array = NDArray[np.float64]

FLAT = 1e-5
"""Relative difference of the two ends of a stretch of ρ below which its middle stands for it."""


def false_cells_by_row(
    clutter: Clutter,
    theta: Array,
    rho_step: Array,
    most: int,
    origin: tuple[float, float] = (0.0, 0.0),
    limits: tuple[float, float] = (-np.inf, np.inf),
) -> Array:
    """Return the expected number of cells with at least 1 … `most` votes in rows, by clutter alone.

    Parameters
    ----------
    clutter : of the batch
    theta : float64 (rows,), centres of rows
    rho_step : float64 (widths,), Δρ
    most : the greatest threshold
    origin : from which ρ is measured
    limits : the columns cover this stretch of ρ; clutter beyond votes outside

    Returns
    -------
    float64 (rows, widths, most)

    Notes
    -----
    Clutter that is uniform over a rectangle has a trapezoid as its density of votes over ρ. Along
    a stretch on which the density is straight, the mean number of cells is that of the stretch in
    cells, times the mean of P[N ≥ T], which is an integral in closed form. For one source, a grid that
    covers it and a fixed number M of plots this is Σ [2f·I + 2(s − f)(I − T·I′/((M + 1)q))]/Δρ.
    """
    edges = [np.full_like(theta, limits[0]), np.full_like(theta, limits[1])]
    for source in clutter.sources:
        flat, foot, _ = source.trapezoid(theta)
        x, y = source.region.centre[0] - origin[0], source.region.centre[1] - origin[1]
        centre = x * np.cos(theta) + y * np.sin(theta)
        edges += [centre - foot, centre - flat, centre + flat, centre + foot]
    if not clutter.sources:
        return np.zeros((len(theta), len(rho_step), most))
    bounds = np.sort(np.clip(np.stack(edges, axis=-1), *limits), axis=-1)
    # Beyond the sources there is nothing, and infinite bounds have no middle.
    covered = np.stack(edges[2:], axis=-1)
    bounds = np.clip(bounds, covered.min(axis=-1)[:, None], covered.max(axis=-1)[:, None])
    found = np.zeros((len(theta), len(rho_step), most))
    for low, high in zip(bounds.T[:-1], bounds.T[1:], strict=True):
        length = high - low
        if length.any():
            # The density at the ends by way of places within: at the ends themselves it may jump.
            near, far = (clutter.density(theta, low + part * length, origin) for part in (0.25, 0.75))
            means = [
                np.maximum(density, 0.0)[:, None] * rho_step
                for density in (1.5 * near - 0.5 * far, 1.5 * far - 0.5 * near)
            ]
            cells = length[:, None] / rho_step
            found += cells[..., None] * _mean_tails(means[0], means[1], most, clutter.fixed_number)
    return found


def _mean_tails(low: Array, high: Array, most: int, fixed: float | None) -> Array:
    """Return the mean of P[N ≥ t], t = 1 … `most`, over mean numbers that go evenly from `low` to `high`."""
    rise = high - low
    is_flat = np.abs(rise) <= FLAT * np.maximum(low, high)
    shares = tails(0.5 * (low + high), most, fixed)[..., 1:]
    if not is_flat.all():
        integrals = [integrated_tails(mean, most, fixed) for mean in (low, high)]
        with np.errstate(divide="ignore", invalid="ignore"):
            sloping = (integrals[1] - integrals[0]) / rise[..., None]
        shares = np.where(is_flat[..., None], shares, sloping)
    return shares


def false_cells(clutter: Clutter, grid: Grid, votes: int) -> float:
    """Return the expected number of cells of a grid with at least so many votes, by clutter alone."""
    limits = (grid.rho_min, grid.rho_min + grid.rho_bins * grid.rho_step)
    by_row = false_cells_by_row(clutter, grid.theta, np.array([grid.rho_step]), votes, grid.origin, limits)
    return float(by_row[:, 0, votes - 1].sum())
