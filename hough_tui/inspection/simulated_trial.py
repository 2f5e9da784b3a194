"""One simulated trial as a file: plots, or the points of sensors of high resolution."""

from __future__ import annotations

from hough_tui.experiments.chunks.plot_sources import plots_of
from scenarios.detections import ResolvedWorld, draw_points
from scenarios.front_end import every_point, measured_points
from scenarios.model import Scenario
from scenarios.recordings.csv_plots import write_plots
from scenarios.sweeps import Stage


def simulated(scenario: Scenario, seed: int, trial: int, stage: Stage = None) -> str:
    """Return the plots of a trial as CSV, with their truth.

    Parameters
    ----------
    stage : how points become plots; None writes the points, which `cluster` reads by `dwell`, `range`,
        `doppler` and `amplitude`, and `initiate` by `x` and `y`
    """
    if stage is not None or not scenario.is_resolved:
        return write_plots(plots_of(scenario, seed, trial, stage))
    resolved = ResolvedWorld.of(scenario)
    points = draw_points(resolved, seed, trial)
    return write_plots(every_point(resolved, points), measured_points(resolved, points))


def cell_words(scenario: Scenario) -> str:
    """Return in words how large the cells of the first sensor are, as `cluster` must be told."""
    cells = getattr(scenario.sensor, "resolution", None)
    assert cells is not None
    unit = scenario.unit.value
    return (
        f"points in cells of {cells.range_cell:g} {unit} and {cells.doppler_cell:g} {unit}/s, from "
        f"{-0.5 * cells.span:g} to {0.5 * cells.span:g} {unit}/s; for cluster: --set "
        f"range_cell={cells.range_cell:g} --set doppler_cell={cells.doppler_cell:g} "
        f"--doppler-span {cells.span:g}"
    )
