"""What a given quantisation and threshold lead to."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from algorithms.hough.grid import Grid
from algorithms.quantisation.false_cells import false_cells
from algorithms.quantisation.home_cell import home_votes, reaching
from algorithms.quantisation.question import Question, TargetLine
from algorithms.quantisation.rules import SuppressionWindow, peak_rows, suppression_window
from algorithms.quantisation.spread import VoteDistribution


@dataclass(frozen=True, slots=True)
class LinePrediction:
    """What is predicted for one target.

    Attributes
    ----------
    line : of the target
    share : mean share of its votes in its home cell
    p_detection : probability that its home cell reaches the threshold
    other_votes : mean number of votes in that cell by clutter and by the other targets
    peak_rows : rows that its peak reaches to each side
    window : the suppression window that covers its peak
    """

    line: TargetLine
    share: float
    p_detection: float
    other_votes: float
    peak_rows: float
    window: SuppressionWindow


@dataclass(frozen=True, slots=True)
class Prediction:
    """What a quantisation and a threshold lead to.

    Attributes
    ----------
    lines : by target
    false_cells : expected number of cells at or above the threshold by clutter alone
    """

    lines: tuple[LinePrediction, ...]
    false_cells: float

    @property
    def p_detection(self) -> float:
        """The mean over the targets."""
        return float(np.mean([line.p_detection for line in self.lines]))

    @property
    def share(self) -> float:
        """The mean over the targets."""
        return float(np.mean([line.share for line in self.lines]))

    @property
    def window(self) -> SuppressionWindow:
        """The window that covers the peak of every target."""
        windows = [line.window for line in self.lines]
        return SuppressionWindow(
            max(window.theta for window in windows),
            max(window.rho for window in windows),
            max(window.rho_upright for window in windows),
        )


def predict(question: Question, grid: Grid, votes: int) -> Prediction:
    """Return what a grid and a threshold lead to.

    Parameters
    ----------
    question : of the design; its bounds play no part
    grid : the quantisation, centred or not
    votes : the threshold T ≥ 1

    Notes
    -----
    P_D is that of the home cell, the one that holds ρ of mid-track in the row nearest to the line, the mean
    over all places of the line in its cell. Any cell of the 3 × 3 block reaches the threshold more often. The
    exact offset ε of a vote from that ρ is (k − k_middle)·sin δ, whatever the grid's origin.
    """
    lines = tuple(_predict_line(question, line, grid, votes) for line in question.lines)
    return Prediction(lines, false_cells(question.clutter, grid, votes))


def _predict_line(question: Question, line: TargetLine, grid: Grid, votes: int) -> LinePrediction:
    other_votes = question.other_votes(line, grid.rho_step)
    probability = question.detection_probability
    own = home_votes(
        np.array([grid.theta_step]),
        np.array([grid.rho_step]),
        line.sigma,
        line.scans,
        line.extent,
        probability,
    )
    reached = reaching(own, np.array([other_votes]), votes, question.clutter.fixed_number)
    expected = probability * line.scans
    rows = peak_rows(expected, line.extent, votes, grid.theta_step, grid.rho_step)
    _, along = line.about(grid.origin)
    return LinePrediction(
        line,
        _mean_share(line, grid),
        float(reached[0, 0, votes - 1]),
        other_votes,
        rows,
        suppression_window(rows, line.sigma, line.extent, along, grid.theta_step, grid.rho_step),
    )


def _mean_share(line: TargetLine, grid: Grid) -> float:
    """Return the mean share of a target's votes in its home cell, which no detection probability changes."""
    certain = home_votes(
        np.array([grid.theta_step]), np.array([grid.rho_step]), line.sigma, line.scans, line.extent, 1.0
    )
    return float(certain[0, 0] @ np.arange(line.scans + 1)) / line.scans


@dataclass(frozen=True, slots=True)
class PlacedVotes:
    """The votes of a target in the row nearest to its line, as a grid has it.

    Attributes
    ----------
    row : of the grid
    votes : their distribution, with ρ measured from the grid's origin
    column : of the home cell; −1 where it lies outside the grid
    share : of the votes that fall into the home cell
    """

    row: int
    votes: VoteDistribution
    column: int
    share: float


def placed_votes(line: TargetLine, grid: Grid) -> PlacedVotes:
    """Return where the votes of a target lie among the bins of a grid.

    Parameters
    ----------
    line : of the target; its place must be known
    grid : the quantisation, centred or not
    """
    assert line.theta is not None
    row = math.floor(line.theta / grid.theta_step - grid.theta_offset + 0.5)
    # Beyond the seam the line has −ρ, which the row's own angle gives.
    row %= grid.theta_bins
    votes = line.votes_at((row + grid.theta_offset) * grid.theta_step, grid.origin)
    column = math.floor((votes.centre - grid.rho_min) / grid.rho_step)
    middle = grid.rho_min + (column + 0.5) * grid.rho_step
    share = float(votes.share(middle - votes.centre, grid.rho_step))
    is_inside = 0 <= column < grid.rho_bins
    return PlacedVotes(row, votes, column if is_inside else -1, share if is_inside else 0.0)
