"""A recommended quantisation as a document, with its reasons in words."""

from __future__ import annotations

import math
from typing import Any

from algorithms.hough.grid import BYTES_PER_CELL
from algorithms.quantisation.advisor import WIDTHS, Advice
from algorithms.quantisation.prediction import LinePrediction, predict
from algorithms.quantisation.rules import resolvability, widest_row
from algorithms.quantisation.spread import VoteDistribution
from hough_tui.quantisation.designs import Design

POOR = 0.5
"""P_D below which the reader is warned."""


def document(design: Design, advice: Advice) -> dict[str, Any]:
    """Return a recommendation as `hough-tui advise --json` prints it."""
    grid, told = advice.grid, advice.prediction
    best, search = advice.by_step(), advice.survey.search
    return {
        "theta_bins": grid.theta_bins,
        "theta_step_deg": math.degrees(grid.theta_step),
        "rho_step": grid.rho_step,
        "votes": advice.votes,
        "p_detection": told.p_detection,
        "expected_false_cells": told.false_cells,
        "reasons": reasons(design, advice),
        "unit": design.unit.value,
        "assumed": design.assumed,
        "false_cells_bound": advice.question.false_cells,
        "share": told.share,
        "rho_bins": grid.rho_bins,
        "rho_min": grid.rho_min,
        "origin": list(grid.origin),
        "bytes": grid.theta_bins * grid.rho_bins * BYTES_PER_CELL,
        "suppress_theta": told.window.theta,
        "suppress_rho": told.window.rho_upright,
        "suppress_rho_sheared": told.window.rho,
        "targets": [
            _target(name, line) for name, line in zip(design.names, advice.prediction.lines, strict=True)
        ],
        "trade_off": [{"false_cells": bound, "p_detection": rate} for bound, rate in advice.trade_off()],
        "map": {
            "theta_bins": search.theta_bins,
            "rho_step": search.rho_step,
            "p_detection": best.p_detection,
            "votes": best.votes,
            "allowed": advice.survey.is_allowed,
        },
    }


def _target(name: str, told: LinePrediction) -> dict[str, Any]:
    return {
        "name": name,
        "scans": told.line.scans,
        "extent": told.line.extent,
        "p_detection": told.p_detection,
        "share": told.share,
        "other_votes": told.other_votes,
        "peak_rows": told.peak_rows,
    }


def reasons(design: Design, advice: Advice) -> list[str]:
    """Return why a quantisation is recommended, sentence by sentence."""
    said = [_of_noise(design, advice), _of_extent(design, advice), _of_share(design, advice)]
    said += [_of_threshold(advice), _of_peak(advice), *_of_separation(design, advice)]
    told = advice.prediction
    if told.p_detection < POOR:
        said.append(
            f"Within this bound a target is found in {_percent(told.p_detection)} of batches only: allow "
            "more false cells, take more scans, or let a second stage sort out what a lower threshold lets "
            "through."
        )
    return said


def _of_noise(design: Design, advice: Advice) -> str:
    sigma = advice.question.noise
    half = VoteDistribution(sigma, 0.0, 0.0).half_width(0.95)
    return (
        f"Noise of σ = {_length(design, sigma)} across a line spreads 95 % of its votes over "
        f"{_length(design, 2.0 * half)}: a column that is to hold them all must be at least as wide."
    )


def _of_extent(design: Design, advice: Advice) -> str:
    question, step = advice.question, advice.grid.theta_step
    line = max((line for line in question.lines if line.sigma), key=lambda line: line.extent / line.sigma)
    radius = 0.5 * line.extent * math.sin(0.5 * step)
    widest = math.degrees(widest_row(line.sigma, line.extent, question.kappa))
    longest = "The" if len(question.lines) == 1 else "The longest"
    return (
        f"{longest} target's line is {_length(design, line.extent)} long within the batch. Midway between "
        f"two rows its extent spreads votes by another ±{_length(design, radius)}, "
        f"{radius / line.sigma:.2f} σ with Δθ = {math.degrees(step):.3g}°; at most {question.kappa:g} σ is "
        f"allowed, which is Δθ ≤ {widest:.3g}°."
    )


def _of_share(design: Design, advice: Advice) -> str:
    grid, told = advice.grid, advice.prediction
    sigma = min(line.sigma for line in advice.question.lines if line.sigma)
    alone = VoteDistribution(sigma, 0.0, 0.0).mean_share(grid.rho_step)
    text = (
        f"A column of {_length(design, grid.rho_step)}, {grid.rho_step / sigma:.3g} σ, holds "
        f"{_percent(told.share)} of a target's votes in its home cell on the mean ({_percent(alone)} if "
        "there were noise alone): a wider one holds more of them, and more clutter"
    )
    if grid.rho_step >= WIDTHS[-1] * sigma:
        text += "; it is the widest that was tried"
    return text + "."


def _of_threshold(advice: Advice) -> str:
    told, votes = advice.prediction, advice.votes
    other = max(line.other_votes for line in told.lines)
    expected = max(advice.question.detection_probability * line.line.scans for line in told.lines)
    lower = predict(advice.question, advice.grid, votes - 1).false_cells if votes > 1 else math.inf
    if lower > advice.question.false_cells:
        below = "" if votes == 1 else f"; with one vote less it would be {lower:.3g}"
    else:
        below = "; a lower threshold would find hardly more"
    return (
        f"The home cell holds {expected * told.share:.3g} of the {expected:.3g} votes expected of a target, "
        f"and up to {other:.3g} others. Clutter alone lifts {told.false_cells:.3g} cells to {votes} votes, "
        f"within the bound of {advice.question.false_cells:g}{below}."
    )


def _of_peak(advice: Advice) -> str:
    window = advice.prediction.window
    rows = max(line.peak_rows for line in advice.prediction.lines)
    columns = f"±{window.rho} columns along its slant"
    if window.rho_upright > window.rho:
        columns += f" (±{window.rho_upright} in an upright window)"
    return (
        f"A peak reaches {rows:.1f} rows to each side on the mean; a suppression window of ±{window.theta} "
        f"rows and {columns} covers it."
    )


def _of_separation(design: Design, advice: Advice) -> list[str]:
    question, grid = advice.question, advice.grid
    halves = []
    for line in question.lines:
        half = 0.5 * line.extent
        votes = VoteDistribution.of_line(line.sigma, (-half, half), 0.5 * grid.theta_step)
        halves.append(resolvability(votes, 0.0, question.confidence).half_width)
    least = grid.rho_step + 2.0 * max(halves)
    return [
        f"Parallel lines are held apart from {_length(design, least)} on, with "
        f"{_percent(question.confidence)} of each one's votes; a valley between them shows from "
        f"{_length(design, least + grid.rho_step)} on."
    ]


def _length(design: Design, value: float) -> str:
    return f"{value:.3g} {design.unit.value}"


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"
