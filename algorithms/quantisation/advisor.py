"""The advisor: which Δθ, Δρ and threshold find a target best while clutter stays within a bound."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.hough.grid import ACCUMULATOR_LIMIT, BYTES_PER_CELL, MOST_ROWS, Grid, GridParameters
from algorithms.quantisation.false_cells import false_cells_by_row
from algorithms.quantisation.home_cell import COARSE, home_votes, reaching
from algorithms.quantisation.prediction import Prediction, predict
from algorithms.quantisation.question import Question
from algorithms.quantisation.rules import resolvability, widest_row
from algorithms.quantisation.spread import VoteDistribution

Array = NDArray[np.float64]

WIDTHS = (
    1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5, 3.75, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0, 8.0, 10.0,
    12.0, 16.0, 20.0,
)  # fmt: skip
"""The Δρ of the search, in standard deviations of the noise."""

ROWS = tuple(2.0 ** (step / 4.0) for step in range(-2, 9))
"""The θ bins of the search: as many times those that the rule of Δθ asks for at κ = 1."""

FEWEST_ROWS = 8
MOST_VOTES = 4000

BOUNDS = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
"""The bounds of the trade-off curve, as many times the bound of the question."""

INDIFFERENT = 0.001
"""The share of P_D that is given up for fewer false cells."""

ANGLES = 24
"""Angles over which the false cells of a search are averaged."""


@dataclass(frozen=True, slots=True)
class SearchGrid:
    """The quantisations among which the advisor chooses.

    Attributes
    ----------
    theta_bins : int64 (rows,), ascending
    rho_step : float64 (widths,), ascending
    """

    theta_bins: NDArray[np.int64]
    rho_step: Array

    @property
    def theta_step(self) -> Array:
        """Δθ in radians, float64 (rows,)."""
        return np.asarray(math.pi / self.theta_bins)


@dataclass(frozen=True, slots=True)
class Best:
    """The best threshold of each quantisation within a bound on the false cells.

    Attributes
    ----------
    votes : int64 (rows, widths), the threshold; 0 where no threshold keeps the bound
    p_detection, false_cells : float64 (rows, widths); P_D is 0 where no threshold keeps the bound
    """

    votes: NDArray[np.int64]
    p_detection: Array
    false_cells: Array


@dataclass(frozen=True, slots=True)
class Survey:
    """P_D and false cells of every quantisation of a search at every threshold.

    Attributes
    ----------
    search : the quantisations
    is_allowed : bool (rows, widths), whether the demands on Δθ and Δρ are kept
    p_detection, false_cells : float64 (rows, widths, T − 1), falling with the threshold T
    """

    search: SearchGrid
    is_allowed: NDArray[np.bool_]
    p_detection: Array
    false_cells: Array

    def best(self, bound: float) -> Best:
        """Return the least threshold of each quantisation that keeps a bound, with what it leads to."""
        keeps = self.false_cells <= bound
        first = np.argmax(keeps, axis=-1)
        possible = keeps.any(axis=-1)
        p_detection, cells = (
            np.take_along_axis(values, first[..., None], axis=-1)[..., 0]
            for values in (self.p_detection, self.false_cells)
        )
        return Best(
            np.where(possible, first + 1, 0),
            np.where(possible, p_detection, 0.0),
            cells,
        )

    def choice(self, bound: float) -> tuple[int, int, int]:
        """Return row, width and threshold of the pick.

        The greatest P_D within the bound; of all that come as close to it as `INDIFFERENT`, with
        whatever threshold, the one with the fewest false cells.

        Raises
        ------
        RequestError
            Where no threshold that was looked at keeps the bound.
        """
        best = np.where(self.is_allowed, self.best(bound).p_detection, -1.0)
        if best.max() <= 0.0:
            raise RequestError(
                f"no threshold up to {self.p_detection.shape[-1]:,} votes keeps the expected number of false "
                f"cells within {bound:g}; allow more of them, or expect less clutter"
            )
        good = (self.p_detection >= (1.0 - INDIFFERENT) * best.max()) & (self.false_cells <= bound)
        cells = np.where(good & self.is_allowed[..., None], self.false_cells, np.inf)
        # Without clutter all are equal, and the highest threshold is the one to take.
        row, width, before = max(np.argwhere(cells == cells.min()), key=lambda found: int(found[2]))
        return int(row), int(width), int(before) + 1


@dataclass(frozen=True, slots=True)
class Advice:
    """A recommended quantisation, and what lies around it.

    Attributes
    ----------
    question : that was asked
    grid : the quantisation, symmetric about the centre of the region
    votes : the threshold
    prediction : what they lead to
    survey : everything that was searched
    """

    question: Question
    grid: Grid
    votes: int
    prediction: Prediction
    survey: Survey

    def trade_off(self) -> list[tuple[float, float]]:
        """Return the greatest P_D within bounds on the false cells around that of the question."""
        bounds = [factor * self.question.false_cells for factor in BOUNDS]
        allowed = self.survey.is_allowed
        return [(bound, float(self.survey.best(bound).p_detection[allowed].max())) for bound in bounds]

    def by_step(self) -> Best:
        """Return the best threshold of every quantisation of the search, within the question's bound."""
        return self.survey.best(self.question.false_cells)


def default_search(question: Question) -> SearchGrid:
    """Return the quantisations that are searched where nothing else is asked for.

    Raises
    ------
    RequestError
        Where there is no noise, from which everything follows, or as much as the region is wide.
    """
    if question.noise == 0.0:
        raise RequestError(
            "the noise is 0, so that any quantisation is fine enough and none is best; give its standard "
            "deviation"
        )
    # The rule at κ = 1, even where the question allows another κ: its demand is applied to this list.
    needed, demanded = math.pi / _widest(question, 1.0), math.pi / _widest(question, question.kappa)
    rows = {max(FEWEST_ROWS, math.ceil(factor * base)) for factor in ROWS for base in (needed, demanded)}
    sigma = min(line.sigma for line in question.lines if line.sigma > 0.0)
    # Short numbers, since people will read and write them.
    widths = np.array([float(f"{width * sigma:.6g}") for width in WIDTHS])
    # A column as wide as the region holds every plot, whatever the row.
    side = min(high - low for low, high in zip(question.region.lower, question.region.upper, strict=True))
    widths = widths[widths < side]
    if not len(widths):
        raise RequestError(
            f"noise of σ = {sigma:g} spreads votes over the whole region, {side:g} from side to side; give "
            "less noise, or a larger region"
        )
    kept = sorted(count for count in rows if count <= MOST_ROWS)
    return SearchGrid(np.array(kept or [MOST_ROWS], dtype=np.int64), widths)


def survey(question: Question, search: SearchGrid) -> Survey:
    """Return P_D and false cells of every quantisation of a search at every threshold."""
    clutter, fixed = question.clutter, question.clutter.fixed_number
    others = [
        np.array([question.other_votes(line, float(step)) for step in search.rho_step])
        for line in question.lines
    ]
    crowd = float(np.max(others))
    scans = max(line.scans for line in question.lines)
    # Past n + n²/9 clutter scatters by so much that n votes of a target are lost in it.
    likely = scans + math.ceil(min(crowd + 8.0 * math.sqrt(crowd), 200.0 + scans**2 / 9.0)) + 8
    most = min(likely, MOST_VOTES)
    p_detection = np.zeros((len(search.theta_bins), len(search.rho_step), most))
    for line, other in zip(question.lines, others, strict=True):
        own = home_votes(
            search.theta_step, search.rho_step, line.sigma, line.scans, line.extent,
            question.detection_probability, COARSE,
        )  # fmt: skip
        p_detection += reaching(own, other, most, fixed)
    # Rows are many, and the mean over them is that over a few angles that are evenly spread.
    angles = (np.arange(ANGLES) + 0.5) * math.pi / ANGLES
    by_row = false_cells_by_row(clutter, angles, search.rho_step, most)
    cells = search.theta_bins[:, None, None] * by_row.mean(axis=0)
    return Survey(search, _allowed(question, search), p_detection / len(question.lines), cells)


def _allowed(question: Question, search: SearchGrid) -> NDArray[np.bool_]:
    widest = _widest(question, question.kappa)
    fine = search.theta_step <= widest * (1.0 + 1e-9)
    reach = 2.0 * question.region.farthest((question.region.centre[0], question.region.centre[1]))
    size = search.theta_bins[:, None] * np.ceil(reach / search.rho_step) * BYTES_PER_CELL
    allowed = fine[:, None] & (size <= ACCUMULATOR_LIMIT)
    if not allowed.any():
        raise RequestError(
            f"no quantisation of the search keeps the spread by the extent within κ = {question.kappa:g} "
            f"standard deviations (Δθ ≤ {math.degrees(widest):.3g}°) and the accumulator within "
            f"{ACCUMULATOR_LIMIT / 2**30:g} GiB; allow a greater κ"
        )
    if question.separation is not None:
        gaps = np.array([_gap(question, step) for step in search.theta_step])
        apart = search.rho_step <= np.maximum(gaps, 0.0)[:, None] * (1.0 + 1e-9)
        if not (allowed & apart).any():
            finest = 2.0 * float(search.rho_step[0]) - float(gaps.max()) + question.separation
            raise RequestError(
                f"lines {question.separation:g} apart cannot be held apart: noise and extent alone spread "
                f"{100.0 * question.confidence:g} % of a line's votes over "
                f"{question.separation - float(gaps.max()):.3g}, and Δρ comes on top; "
                f"give a separation of {finest:.3g} or more, or less confidence"
            )
        allowed &= apart
    return allowed


def _widest(question: Question, kappa: float) -> float:
    # A line along the only axis with noise has none across; no row is fine enough for it.
    return min(widest_row(line.sigma, line.extent, kappa) for line in question.lines if line.sigma > 0.0)


def _gap(question: Question, theta_step: float) -> float:
    assert question.separation is not None
    gaps = []
    for line in question.lines:
        half = 0.5 * line.extent
        votes = VoteDistribution.of_line(line.sigma, (-half, half), 0.5 * theta_step)
        gaps.append(resolvability(votes, question.separation, question.confidence).gap)
    return min(gaps)


def advise(question: Question, search: SearchGrid | None = None) -> Advice:
    """Return the quantisation and threshold with the greatest P_D within the question's demands.

    Parameters
    ----------
    question : of the design
    search : the quantisations to choose from; by default `default_search`

    Raises
    ------
    RequestError
        Where no target can give a line, or no quantisation keeps the demands.

    Notes
    -----
    The thesis gives bounds on Δρ and leaves Δθ and the threshold open. This choice follows from the
    distribution of the votes of a line and of clutter; see `home_cell` and `false_cells`.
    """
    if question.detection_probability == 0.0:
        raise RequestError("the detection probability is 0: targets give no plots, and nothing finds them")
    if max(line.scans for line in question.lines) < 2:
        raise RequestError(
            "targets are there in one scan alone, and one plot is no line; give 2 scans or more"
        )
    found = survey(question, search or default_search(question))
    while True:
        row, width, votes = found.choice(question.false_cells)
        grid = centred_grid(question, int(found.search.theta_bins[row]), float(found.search.rho_step[width]))
        prediction = predict(question, grid, votes)
        if prediction.false_cells <= question.false_cells:
            return Advice(question, grid, votes, prediction, found)
        # The survey takes the mean over a few angles; row by row the bound is just missed.
        found.false_cells[row, width, votes - 1] = prediction.false_cells


def centred_grid(question: Question, theta_bins: int, rho_step: float) -> Grid:
    """Return the grid of a quantisation that covers the question's region, symmetric about its centre."""
    scans = max(line.scans for line in question.lines)
    context = Context(scans, 1.0, region=question.region)
    return GridParameters(theta_bins=theta_bins, rho_step=rho_step).grid(context)
