"""What the quantisation of an initiator leads to on a scenario, and what would be recommended there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.errors import RequestError
from algorithms.hough import weighting
from algorithms.hough.grid import BYTES_PER_CELL, Grid
from algorithms.initiators.accumulating import AccumulatingInitiator, AccumulatingParameters
from algorithms.quantisation.advisor import MOST_VOTES, Advice, advise
from algorithms.quantisation.prediction import LinePrediction, Prediction, placed_votes, predict
from algorithms.quantisation.question import Question
from algorithms.quantisation.spread import VoteDistribution
from hough_tui.quantisation.apply_advice import LEAST_VOTES
from hough_tui.quantisation.designs import Demands, moving_targets, question_of, taken_for
from scenarios.entries import InitiatorEntry
from scenarios.model import Scenario

REACH = 4.0
"""Standard deviations beyond the spread by the extent that a picture of the votes goes."""

FEWEST_BINS = 1.5
"""Bins that it shows to each side of the middle of the home cell, at least."""

MARGIN = 1.04
SAMPLES = 800
MOST_WORK = 5_000_000
"""The greatest threshold times rows: the false cells of every row are worked out for every lower one, too."""

BINS_TOLD = 12
"""Bins to each side of the home cell of which the share of votes is worked out."""


@dataclass(frozen=True, slots=True, eq=False)
class VotePicture:
    """The votes of one target in the row nearest to its line, among the bins of ρ.

    Attributes
    ----------
    name : of the target
    curve : float64 (k, 2), ρ in the row and the density of votes there, relative to the greatest
    low, high : the part of ρ that is worth seeing
    first, step, bins : where the columns begin, how wide they are and how many there are
    home : the column in which the middle of the votes lies; −1 outside the grid
    shares : by column, about the home cell, the share of the target's votes that falls into it
    row, theta : the row and its angle in degrees
    away : distance of the row from the line, in degrees
    spread : R in this row, half the width over which the extent of the line spreads its votes
    most_spread : R at worst, of a line midway between two rows
    mean, least, most : share of votes in the home cell: the mean over all lines, and that of a line
        midway between two rows and of one that lies in a row
    """

    name: str
    curve: NDArray[np.float64]
    low: float
    high: float
    first: float
    step: float
    bins: int
    home: int
    shares: dict[int, float]
    row: int
    theta: float
    away: float
    spread: float
    most_spread: float
    mean: float
    least: float
    most: float


@dataclass(frozen=True, slots=True)
class Outlook:
    """What a quantisation and a threshold lead to.

    Attributes
    ----------
    grid, votes : the quantisation, the threshold
    share : mean share of a target's votes in its home cell
    p_detection, false_cells : as in `Prediction`
    size : of the accumulator, in bytes
    votes_cast : mean number of votes of a trial, each plot one in every row
    """

    grid: Grid
    votes: int
    share: float
    p_detection: float
    false_cells: float
    size: int
    votes_cast: float


@dataclass(frozen=True, slots=True)
class Forecast:
    """What is predicted for an initiator entry on a scenario.

    Attributes
    ----------
    entry, scenario : of which
    outlook : what its quantisation and its threshold lead to
    pictures : of the votes, by target
    is_weighted : whether its votes are weighted; what is predicted is of the plain votes
    notes : what else must be known, in sentences
    """

    entry: InitiatorEntry
    scenario: Scenario
    outlook: Outlook
    pictures: tuple[VotePicture, ...]
    is_weighted: bool
    notes: tuple[str, ...]


def forecast(entry: InitiatorEntry, scenario: Scenario) -> Forecast:
    """Return what the quantisation of an accumulating initiator leads to on a scenario.

    Raises
    ------
    RequestError
        Where there is nothing to predict: no target moves, or the threshold is out of all reach.
    """
    context = scenario.context
    parameters = entry.parameters.resolved(context)
    assert isinstance(parameters, AccumulatingParameters)
    question, grid, votes = question_of(scenario), parameters.grid.grid(context), _threshold(parameters)
    if votes > MOST_VOTES or votes * grid.theta_bins > MOST_WORK:
        raise RequestError(
            f"{entry.name}: a threshold of {votes:,} votes in {grid.theta_bins:,} rows; what it leads to is "
            f"worked out for {MOST_VOTES:,} votes at most, and for {MOST_WORK:,} votes times rows"
        )
    told = predict(question, grid, votes)
    names = [scenario.targets[index].name or f"target {index}" for index in moving_targets(scenario)]
    return Forecast(
        entry,
        scenario,
        _outlook(question, told, grid, votes, _is_weighted(entry, parameters)),
        tuple(_picture(name, line, grid) for name, line in zip(names, told.lines, strict=True)),
        _is_weighted(entry, parameters),
        (*_notes(entry, parameters, question), *_simplified(scenario)),
    )


def recommendation(scenario: Scenario, false_cells: float) -> Advice:
    """Return the quantisation and the threshold that are recommended for a scenario.

    Parameters
    ----------
    false_cells : the greatest expected number of false cells a batch

    Raises
    ------
    RequestError
        Where there is none, with the reason.
    """
    return advise(question_of(scenario, Demands(false_cells=false_cells)))


def recommended(advice: Advice, is_weighted: bool) -> Outlook:
    """Return what a recommendation leads to, for an initiator that weights its votes or does not."""
    return _outlook(advice.question, advice.prediction, advice.grid, advice.votes, is_weighted)


def _threshold(parameters: AccumulatingParameters) -> int:
    # Weighted votes have a threshold of their own; before it a cell needs more plain votes than these.
    least = getattr(parameters, LEAST_VOTES, None)
    found = parameters.votes if least is None else least + 1
    assert found is not None
    return max(1, found)


def _is_weighted(entry: InitiatorEntry, parameters: AccumulatingParameters) -> bool:
    algorithm = entry.algorithm
    return isinstance(algorithm, AccumulatingInitiator) and algorithm.weighting(parameters) is not None


def _outlook(question: Question, told: Prediction, grid: Grid, votes: int, is_weighted: bool) -> Outlook:
    plots = question.clutter.plots + question.detection_probability * sum(
        line.scans for line in question.lines
    )
    per_cell = weighting.BYTES_PER_CELL if is_weighted else BYTES_PER_CELL
    return Outlook(
        grid,
        votes,
        told.share,
        told.p_detection,
        told.false_cells,
        math.prod(grid.shape) * per_cell,
        plots * grid.theta_bins,
    )


def _picture(name: str, told: LinePrediction, grid: Grid) -> VotePicture:
    line, placed = told.line, placed_votes(told.line, grid)
    votes, step = placed.votes, grid.rho_step
    home = grid.rho_min + (math.floor((votes.centre - grid.rho_min) / step) + 0.5) * step
    reach = votes.radius + REACH * votes.sigma
    half = MARGIN * max(FEWEST_BINS * step, reach + abs(votes.centre - home))
    columns = range(max(0, placed.column - BINS_TOLD), min(grid.rho_bins, placed.column + BINS_TOLD + 1))
    middles = grid.rho_min + (np.array(columns) + 0.5) * step
    shares = votes.share(middles - votes.centre, step) if placed.column >= 0 else ()
    # The row of the line as its angle has it, which may lie beyond the seam.
    assert line.theta is not None
    turns = line.theta / grid.theta_step - grid.theta_offset
    midway, within = (
        VoteDistribution.of_line(line.sigma, (-0.5 * line.extent, 0.5 * line.extent), delta)
        for delta in (0.5 * grid.theta_step, 0.0)
    )
    return VotePicture(
        name,
        _curve(votes, home - half, home + half, reach),
        home - half,
        home + half,
        grid.rho_min,
        step,
        grid.rho_bins,
        placed.column,
        dict(zip(columns, map(float, shares), strict=False)),
        placed.row,
        math.degrees((placed.row + grid.theta_offset) * grid.theta_step),
        math.degrees(abs(turns - round(turns)) * grid.theta_step),
        votes.radius,
        midway.radius,
        told.share,
        midway.mean_share(step),
        within.mean_share(step),
    )


def _curve(votes: VoteDistribution, low: float, high: float, reach: float) -> NDArray[np.float64]:
    top = votes.peak_density
    if math.isinf(top):
        # All votes fall on one ρ.
        return np.array([(votes.centre, 0.0), (votes.centre, 1.0)])
    # Closely where the votes are, which may be a small part of a wide bin.
    near = np.linspace(votes.centre - reach, votes.centre + reach, SAMPLES)
    rho = np.union1d(np.linspace(low, high, SAMPLES), near)
    rho = rho[(rho >= low) & (rho <= high)]
    return np.column_stack([rho, votes.density(rho) / top])


def _simplified(scenario: Scenario) -> list[str]:
    return [f"Assumed {name}: {value}." for name, value in taken_for(scenario).items()]


def _notes(entry: InitiatorEntry, parameters: AccumulatingParameters, question: Question) -> list[str]:
    said = []
    if _is_weighted(entry, parameters):
        said.append(
            "Votes are weighted here: what is predicted is that the home cell has more plain votes than T1, "
            "without which its deviation does not count."
        )
    if question.noise == 0.0:
        said.append("Without noise all votes of a line fall on one ρ in its own row.")
    if parameters.maxima is not None:
        many = (
            "one, the greatest, is" if parameters.maxima == 1 else f"{parameters.maxima}, the greatest, are"
        )
        said.append(f"Of the cells with enough votes {many} taken at most.")
    return said
