"""The grid: how θ and ρ are divided into cells."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.hough.lines import normal_form
from algorithms.parameters import (
    LEAST,
    Auto,
    Count,
    Declared,
    Dimension,
    Fraction,
    Number,
    Positive,
    parameter,
)

ACCUMULATOR_LIMIT = 2**30
"""The greatest size of an accumulator, in bytes."""

BYTES_PER_CELL = 4

MOST_ROWS = 100_000

DEFAULT_RHO_BINS = 500
"""Columns over the region where neither their width nor the noise is known."""

DEFAULT_STEP = 6.0
"""Default width of a column in standard deviations of the noise: ±3 σ of a line's votes."""


@dataclass(frozen=True, slots=True)
class Grid:
    """A quantisation of lines into θ rows and ρ columns.

    Row i has the centre (i + `theta_offset`)·Δθ, Δθ = π / `theta_bins`. Column j covers
    [`rho_min` + j·`rho_step`, `rho_min` + (j + 1)·`rho_step`), with ρ measured from `origin`.
    """

    theta_bins: int
    rho_bins: int
    rho_min: float
    rho_step: float
    origin: tuple[float, float] = (0.0, 0.0)
    theta_offset: float = 0.5

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the accumulator."""
        return self.theta_bins, self.rho_bins

    @property
    def theta_step(self) -> float:
        """Δθ in radians."""
        return math.pi / self.theta_bins

    @property
    def theta(self) -> NDArray[np.float64]:
        """Centres of the rows, in radians, in [0, π)."""
        return np.asarray(
            (np.arange(self.theta_bins) + self.theta_offset) * self.theta_step, dtype=np.float64
        )

    @property
    def rho(self) -> NDArray[np.float64]:
        """Centres of the columns, measured from `origin`."""
        return np.asarray(self.rho_min + (np.arange(self.rho_bins) + 0.5) * self.rho_step, dtype=np.float64)

    def lines(
        self, rows: NDArray[np.integer], columns: NDArray[np.integer]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the lines at the centres of cells, in normal form about the origin of coordinates."""
        theta = self.theta[rows]
        shift = self.origin[0] * np.cos(theta) + self.origin[1] * np.sin(theta)
        return normal_form(theta, self.rho[columns] + shift)

    def cell(self, theta: float, rho: float) -> tuple[int, int] | None:
        """Return the row and the column nearest to a line; None where it lies outside the grid."""
        row = math.floor(theta / self.theta_step - self.theta_offset + 0.5)
        shifted = rho - self.origin[0] * math.cos(theta) - self.origin[1] * math.sin(theta)
        if not 0 <= row < self.theta_bins:
            row, shifted = row % self.theta_bins, -shifted
        column = math.floor((shifted - self.rho_min) / self.rho_step)
        return (row, column) if 0 <= column < self.rho_bins else None


class GridParameters(Declared):
    """The declared quantisation, from which a `Grid` is worked out."""

    theta_bins: Annotated[Count, Field(le=MOST_ROWS)] = parameter(
        90, dimension=Dimension.COUNT, help="rows of the accumulator: Δθ = 180° / θ bins"
    )
    rho_step: Positive | Auto = parameter(
        "auto",
        dimension=Dimension.LENGTH,
        help="width Δρ of a column",
        auto="6 σ of the measurement noise; with the number of columns given, what covers the region",
    )
    rho_bins: Count | Auto = parameter(
        "auto", dimension=Dimension.COUNT, help="columns of the accumulator", auto="what covers the region"
    )
    rho_min: Number | Auto = parameter(
        "auto",
        dimension=Dimension.LENGTH,
        help="where the first column begins",
        auto="such that the grid is symmetric about its origin",
    )
    origin: tuple[Number, Number] | Auto = parameter(
        "auto",
        dimension=Dimension.LENGTH,
        help="the point from which ρ is measured while voting",
        auto="the centre of the region; [0, 0] where the first column is given",
    )
    theta_offset: Annotated[Fraction, Field(lt=1)] = parameter(
        0.5,
        dimension=Dimension.FRACTION,
        help="centre of the first row, in rows: 0.5 is half a row from 0",
    )

    def grid(self, context: Context, bytes_per_cell: int = BYTES_PER_CELL) -> Grid:
        """Return the grid, every `auto` worked out from the context.

        Parameters
        ----------
        context : what is known of the sensor
        bytes_per_cell : what an initiator keeps of each cell

        Raises
        ------
        RequestError
            Where the accumulator would be larger than `ACCUMULATOR_LIMIT`, or the region is
            needed and not known.
        """
        origin, given_min, given_step, given_bins = (
            self._origin(context),
            self.rho_min,
            self.rho_step,
            self.rho_bins,
        )
        if given_min != "auto":
            rho_min = given_min
        elif given_step != "auto" and given_bins != "auto":
            rho_min = -0.5 * given_step * given_bins
        else:
            rho_min = -self._reach(context, origin)
        if given_step != "auto":
            step = given_step
        elif given_bins == "auto" and context.noise:
            step = DEFAULT_STEP * context.noise
        else:
            bins = DEFAULT_RHO_BINS if given_bins == "auto" else given_bins
            step = self._span(context, origin, rho_min) / bins
        if given_bins != "auto":
            bins = given_bins
        else:
            # Past this the accumulator is refused anyway, and the quotient may not even be a whole number.
            wanted = min(self._span(context, origin, rho_min) / step, 1e15)
            bins = max(1, math.ceil(wanted - 1e-9))
        size = self.theta_bins * bins * bytes_per_cell
        if size > ACCUMULATOR_LIMIT:
            raise RequestError(
                f"grid: an accumulator of {self.theta_bins:,} × {bins:,} cells would need "
                f"{size / 2**30:,.1f} GiB; the limit is {ACCUMULATOR_LIMIT / 2**30:g} GiB; "
                "give fewer theta_bins or rho_bins, or a larger rho_step"
            )
        return Grid(self.theta_bins, bins, float(rho_min), float(step), origin, self.theta_offset)

    def resolved(self, context: Context) -> GridParameters:
        """Return the quantisation with every `auto` worked out; for the errors see `grid`."""
        grid = self.grid(context)
        return self.model_copy(
            update={
                "origin": grid.origin,
                "rho_min": grid.rho_min,
                "rho_step": grid.rho_step,
                "rho_bins": grid.rho_bins,
            }
        )

    def _origin(self, context: Context) -> tuple[float, float]:
        if self.origin != "auto":
            return self.origin
        if self.rho_min == "auto" and context.region is not None:
            return context.region.centre[0], context.region.centre[1]
        return 0.0, 0.0

    @staticmethod
    def _reach(context: Context, origin: tuple[float, float]) -> float:
        if context.region is None:
            raise RequestError(
                "grid: the region is not known, so rho_min, rho_step and rho_bins cannot all be worked out; "
                "give the region, or the three"
            )
        # A region that is one point has no reach; its one line of plots still needs a cell.
        reach = context.region.farthest(origin)
        return reach if reach >= LEAST else 1.0

    def _span(self, context: Context, origin: tuple[float, float], rho_min: float) -> float:
        reach = self._reach(context, origin)
        if rho_min >= reach:
            raise RequestError(
                f"grid: the first column begins at rho_min {rho_min:g}, past the farthest corner "
                f"of the region at {reach:g}; give rho_bins and rho_step, or a smaller rho_min"
            )
        return reach - rho_min
