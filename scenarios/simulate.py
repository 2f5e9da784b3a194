"""Simulation: (scenario, seed, trial) to plots and truth.

Trial k of a scenario with a seed is the same draw whatever the chunk, the order or the number
of workers. Each source of plots (a target, a source of clutter) has a stream of its own for
each trial, sensor and scan: a draw without targets has the same clutter, and a draw of fewer scans
is the first part of one of more (but for clutter whose number is fixed for the batch).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from algorithms.compiled import kernel
from algorithms.plots import PlotChunk
from algorithms.rounding import floored
from algorithms.scoring.matching import Truth
from algorithms.target_states import TargetStates
from scenarios.clutter_plots import clutter_numbers, put_clutter, sort_batch
from scenarios.model import Scenario
from scenarios.streams import Streams
from scenarios.target_plots import target_plots, target_states
from scenarios.true_lines import true_lines
from scenarios.world import World

Array = NDArray[np.float64]


@kernel
def _move(plots, covariance, origin, row, at):  # type: ignore[no-untyped-def]
    """Move the plot of one row to another."""
    origin[at] = origin[row]
    for axis in range(plots.shape[1]):
        plots[at, axis] = plots[row, axis]
    if len(covariance) > 0:
        for axis in range(plots.shape[1]):
            for other in range(plots.shape[1]):
                covariance[at, axis, other] = covariance[row, axis, other]


@kernel
def _merged(own, clutter, measurement, streams):  # type: ignore[no-untyped-def]
    """Return the plots of trials: those of clutter as they are drawn, those of targets put among them.

    Parameters
    ----------
    own : the plots of targets, a record `TargetPlots`
    clutter, measurement, streams : records

    Returns
    -------
    scan, time, plots, covariance, origin, offsets
    """
    numbers = clutter_numbers(clutter, measurement, streams)
    trials, scans, sources = numbers.shape
    axes = own.position.shape[1]
    offsets = np.zeros(trials + 1, np.int64)
    for k in range(trials):
        of_targets = own.begins[(k + 1) * scans] - own.begins[k * scans]
        offsets[k + 1] = offsets[k] + numbers[k].sum() + clutter.fixed[:, 1].sum() + of_targets
    scan_column, time_column = np.empty(offsets[trials], np.int32), np.empty(offsets[trials], np.float64)
    origin = np.empty(offsets[trials], np.int32)
    plots = np.empty((offsets[trials], axes), np.float64)
    is_polar = measurement.is_polar.any()
    covariance = np.empty((offsets[trials] if is_polar else 0, axes, axes), np.float64)
    space = np.empty(axes), np.empty(axes), np.empty((2 * axes - 1, axes))
    largest = clutter.fixed[:, 1].max() if sources > 0 else 0
    begins, order = np.zeros((sources, scans + 1), np.int64), np.empty((sources, largest), np.int64)
    scan_of = np.empty(largest, np.int64)
    row = 0
    for k in range(trials):
        trial = streams.first_trial + k
        if largest > 0:
            sort_batch(clutter, streams, trial, scans, begins, order, scan_of)
        for scan in range(scans):
            first = row
            for source in range(sources):
                batch = order[source, begins[source, scan] : begins[source, scan + 1]]
                row = put_clutter(
                    trial, scan, source, numbers[k, scan, source], batch, clutter, measurement, streams,
                    space, plots, covariance, row,
                )  # fmt: skip
            origin[first:row] = -1
            for index in range(own.begins[k * scans + scan], own.begins[k * scans + scan + 1]):
                # At a random place of its scan, so that no order tells targets from clutter.
                at = min(first + floored(own.rank[index] * (row - first + 1)), row)
                _move(plots, covariance, origin, at, row)
                origin[at] = own.target[index]
                plots[at] = own.position[index]
                if is_polar:
                    covariance[at] = own.covariance[index]
                row += 1
            scan_column[first:row] = scan
            time_column[first:row] = measurement.time[scan]
    return scan_column, time_column, plots, covariance, origin, offsets


@dataclass(frozen=True, slots=True)
class Draw:
    """The plots of consecutive trials, and what caused them.

    Attributes
    ----------
    chunk : the plots
    origin : int32 (n,), the target that caused each plot, −1 for clutter
    states : where each target was at every scan of each trial
    """

    chunk: PlotChunk
    origin: NDArray[np.int32]
    states: TargetStates

    def without_targets(self) -> Draw:
        """Return the same draw with the plots of the targets taken out: the control."""
        kept = self.origin < 0
        return Draw(self.chunk.chosen(kept), self.origin[kept], self.states)


def draw(world: World, seed: int, first_trial: int, trials: int = 1) -> Draw:
    """Return the plots of consecutive trials.

    Parameters
    ----------
    world : the scenario's arrays
    seed : in [0, 2⁶⁴)
    first_trial, trials : which trials; they are numbered from 0
    """
    ground, measurement = world.ground, world.measurement
    streams = Streams(np.uint64(seed), first_trial, trials)
    position, velocity, shift = target_states(ground, streams)
    own = target_plots(position, ground.present, measurement, streams)
    scan, time, plots, covariance, origin, offsets = _merged(own, world.clutter, measurement, streams)
    known = covariance if measurement.is_polar.any() else None
    return Draw(
        PlotChunk(scan, time, plots, offsets, known),
        origin,
        TargetStates(measurement.time, ground.present, position, velocity, shift),
    )


def truth(scenario: Scenario, drawn: Draw) -> Truth:
    """Return the truth of a draw as the scorer takes it."""
    return Truth(*true_lines(scenario, drawn.states), drawn.origin, drawn.states)
