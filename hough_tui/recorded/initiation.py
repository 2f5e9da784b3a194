"""Initiation on recorded plots: context, parameters, tracks, and the document that tells them."""

from __future__ import annotations

import contextlib
import io
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from algorithms.context import Box, Context, Unit
from algorithms.errors import RequestError
from algorithms.hough.voting import Accumulator
from algorithms.initiators.base import Initiator
from algorithms.initiators.guard import PlugInError
from algorithms.parameters import Parameters, problems, validated
from algorithms.plots import Plots
from algorithms.tracks import Tracks
from scenarios.files.atomic import replace_file
from scenarios.files.marked_yaml import read
from scenarios.files.set_files import load_set, located, read_text
from scenarios.model import Scenario
from scenarios.recordings.csv_plots import Recording
from scenarios.sensors import PolarSensor

Array = NDArray[np.float64]

MOST_TRACKS = 1000
"""How many tracks are given where nothing else is asked for."""


@dataclass(frozen=True, slots=True)
class Known:
    """What the user says of the sensor; None where nothing was said."""

    sigma: float | None = None
    detection_probability: float | None = None
    unit: Unit | None = None
    region: Box | None = None


@dataclass(frozen=True, slots=True)
class Initiation:
    """The tracks of one recording, with all that led to them.

    Attributes
    ----------
    algorithm, parameters : what ran; the parameters are resolved
    context, assumed : what it was told, and which parts of that were assumed, in words
    recording, tracks, accumulator : plots in, tracks and votes out; tracks strongest first
    total : number of tracks before the weaker ones were left out
    seconds : of the initiator alone
    """

    algorithm: Initiator
    parameters: Parameters
    context: Context
    assumed: dict[str, str]
    recording: Recording
    tracks: Tracks
    accumulator: Accumulator | None
    total: int
    seconds: float


def context_of(
    recording: Recording, known: Known, like: Context | None, window: tuple[int, int] | None = None
) -> tuple[Context, dict[str, str]]:
    """Return the context of a recording, and in words what of it was assumed.

    Parameters
    ----------
    recording : plots
    known : what the user says; it goes before everything else
    like : the context of a scenario that the plots are like
    window : the scans that were asked for; without it the last scan is the last with a plot
    """
    plots, assumed = recording.plots, dict(recording.assumed)
    scans = int(plots.scan[-1]) + 1 if window is None else window[1] - window[0]
    if like is not None:
        base = replace(like, scans=scans, interval=recording.interval)
    else:
        box = Box.around(plots.position[:, :2])
        base = Context(scans, recording.interval, region=box)
        if known.region is None:
            bounds = [f"{low:g} to {high:g}" for low, high in zip(box.lower, box.upper, strict=True)]
            assumed["region"] = f"x {bounds[0]}, y {bounds[1]}, the extent of the plots"
        if known.detection_probability is None:
            assumed["detection_probability"] = "1"
        if known.unit is None:
            assumed["unit"] = "km"
        if known.sigma is None:
            assumed["sigma"] = "not known: what depends on the noise follows from the region"
    given: dict[str, Any] = {}
    if known.sigma is not None:
        given["sigma"] = (known.sigma, known.sigma)
    if known.detection_probability is not None:
        given["detection_probability"] = known.detection_probability
    if known.unit is not None:
        given["unit"] = known.unit
    if known.region is not None:
        given["region"] = known.region
    return replace(base, **given), assumed


def like_scenario(name: str) -> Scenario:
    """Return a scenario, given as SET or SET:SCENARIO.

    Raises
    ------
    RequestError
        Where there is none of that name, or the set has several and none is named.
    """
    from scenarios.selection import chosen_scenario

    set_name, _, scenario = name.partition(":")
    return chosen_scenario(load_set(set_name), scenario or None)


def with_noise(recording: Recording, known: Known, like: Scenario | None) -> Recording:
    """Return a recording whose plots have the covariance that a polar sensor gives them where they lie.

    A σ that the user says goes before it. With several sensors plots do not tell whose they are;
    they are left to the context's σ.

    Parameters
    ----------
    recording : plots
    known : what the user says
    like : a scenario that the plots are like
    """
    plots = recording.plots
    if like is None or known.sigma is not None or not isinstance(like.sensor, PolarSensor):
        return recording
    if like.sensor.dimensions != plots.position.shape[1]:
        return recording
    if like.further_sensors:
        said = "the greatest of the sensors on each axis, since plots do not tell whose they are"
        return replace(recording, assumed={**recording.assumed, "sigma": said})
    return replace(recording, plots=replace(plots, covariance=like.sensor.covariance(plots.position)))


def given_parameters(algorithm: Initiator, config: Path | None, assignments: Sequence[str]) -> Parameters:
    """Return an initiator's parameters from a YAML file and `key=value` assignments, which go before it.

    Raises
    ------
    RequestError
        Where the file, a key or a value is wrong.
    """
    data: dict[str, Any] = {}
    if config is not None:
        document = read(read_text(config), str(config))
        if not isinstance(document.data, dict | None):
            raise RequestError(f"{config}: a mapping of parameters to values is expected at the top")
        data = dict(document.data or {})
        named = data.pop("initiator", data.pop("name", algorithm.name))
        data.pop("name", None)
        if named != algorithm.name:
            raise RequestError(
                f"{config}: this is for the initiator '{named}', and '{algorithm.name}' is asked for"
            )
        try:
            algorithm.parameters.model_validate(data)
        except ValueError as error:
            found = problems(error, algorithm.parameters, data)  # type: ignore[arg-type]
            raise RequestError("\n".join(located(problem, document) for problem in found)) from None
    for assignment in assignments:
        assign(data, assignment)
    return validated(algorithm.parameters, data, f"initiator {algorithm.name}")


def assign(data: dict[str, Any], assignment: str) -> None:
    """Put one `key=value` into nested data; the key is dotted, the value is YAML.

    Raises
    ------
    RequestError
        Where it has not that form.
    """
    key, equals, value = assignment.partition("=")
    if not equals or not key.strip():
        raise RequestError(f"--set {assignment}: this is not of the form key=value")
    *path, last = key.strip().split(".")
    here = data
    for name in path:
        inner = here.setdefault(name, {})
        if not isinstance(inner, dict):
            raise RequestError(f"--set {assignment}: '{name}' holds a value, not further fields")
        here = inner
    here[last] = read(value, f"--set {key.strip()}").data


def initiate(
    recording: Recording,
    algorithm: Initiator,
    parameters: Parameters,
    context: Context,
    assumed: dict[str, str],
    most: int = MOST_TRACKS,
) -> Initiation:
    """Return the tracks of recorded plots, the strongest first, at most so many.

    Raises
    ------
    RequestError
        Where the parameters do not fit the context.
    PlugInError
        Where a plug-in fails.
    """
    resolved = parameters.resolved(context)
    plots = recording.plots
    # Compiled code is loaded here, so that the time given below is the algorithm's own. A plug-in need not
    # bear a batch without plots for that: what it refuses of the plots themselves, it refuses below.
    with contextlib.suppress(PlugInError, RequestError):
        algorithm.initiate(_no_plots(plots), context, resolved)
    began = time.perf_counter()
    tracks, total = algorithm.strongest(plots, context, resolved, most)
    seconds = time.perf_counter() - began
    accumulator = algorithm.accumulator(plots, context, resolved)
    return Initiation(
        algorithm,
        resolved,
        context,
        assumed,
        recording,
        tracks,
        accumulator,
        total,
        seconds,
    )


def _no_plots(plots: Plots) -> Plots:
    covariance = None if plots.covariance is None else plots.covariance[:0]
    return Plots(plots.scan[:0], plots.time[:0], plots.position[:0], covariance=covariance)


def document(found: Initiation) -> dict[str, Any]:
    """Return an initiation as `initiate --json` prints it."""
    tracks, rows = found.tracks, found.recording.rows
    lines = tracks.states.lines
    told: dict[str, Any] = {
        "initiator": found.algorithm.name,
        "parameters": found.parameters.model_dump(mode="json"),
        "plots": len(found.recording.plots),
        "scans": found.context.scans,
        "seconds": found.seconds,
        "unit": found.context.unit.value,
        "assumed": found.assumed,
        "notes": notes(found),
        "effort": dict(tracks.effort),
        "tracks_total": found.total,
        "tracks": [_track(tracks, index, rows, lines) for index in range(len(tracks))],
    }
    if found.accumulator is not None:
        grid, votes = found.accumulator.grid, found.accumulator.votes
        told["accumulator"] = {
            "theta_bins": grid.theta_bins,
            "rho_bins": grid.rho_bins,
            "rho_min": grid.rho_min,
            "rho_step": grid.rho_step,
            "origin": list(grid.origin),
            "votes": found.accumulator.total,
            "votes_outside": found.accumulator.votes_outside,
            "max": int(votes.max()),
            "argmax": list(found.accumulator.greatest),
        }
    return told


def _track(tracks: Tracks, index: int, rows: NDArray[np.int64], lines: tuple[Array, Array]) -> dict[str, Any]:
    """Return one track as `document` gives it; a part of its state that is open is None."""
    states = tracks.states
    theta, rho = (float(column[index]) for column in lines)
    return {
        "theta_deg": math.degrees(tracks.theta[index]),
        "rho": float(tracks.rho[index]),
        "score": _plain(tracks.score[index]),
        "plots": [int(row) for row in rows[tracks.plots[index]]],
        "position": _vector(states.position[index]),
        "velocity": _vector(states.velocity[index]),
        "time": _number(states.time[index]),
        "first_scan": int(states.scan[index]),
        "covariance": _matrix(states.covariance[index]),
        "confirmed_scan": int(tracks.confirmed_scan[index]),
        "fitted_theta_deg": _number(math.degrees(theta)),
        "fitted_rho": _number(rho),
    }


def write_accumulator(found: Initiation, path: Path) -> None:
    """Write votes and centres of rows (radians) and columns as a numpy archive.

    Standard deviations (`std`) and weighted votes (`weighted`) go with them where there are any.
    """
    made = found.accumulator
    assert made is not None
    arrays: dict[str, NDArray[Any] | None] = {
        "votes": made.votes,
        "theta": made.grid.theta,
        "rho": made.grid.rho,
        "std": made.std,
        "weighted": made.weighted,
    }
    written = {name: values for name, values in arrays.items() if values is not None}
    archive = io.BytesIO()
    np.savez_compressed(archive, allow_pickle=False, **written)
    replace_file(path, archive.getvalue())


def notes(found: Initiation) -> list[str]:
    """Return what a reader of the tracks must know."""
    said = []
    if found.recording.plots.position.shape[1] > found.algorithm.dimensions:
        said.append(f"{found.algorithm.name} works in the plane: the column z is ignored")
    if len(found.tracks) and np.isnan(found.tracks.states.covariance).all():
        said.append("the noise is not known, so that states have no covariance: give --sigma or --like")
    if found.total > len(found.tracks):
        said.append(
            f"{found.total:,} tracks were found; the {len(found.tracks):,} strongest are given (see --most)"
        )
    if found.accumulator is not None and found.accumulator.votes_outside:
        votes = found.accumulator.total + found.accumulator.votes_outside
        said.append(f"{found.accumulator.votes_outside:,} of {votes:,} votes fell outside the grid")
    return said


def _plain(score: float) -> int | float:
    return int(score) if float(score).is_integer() else float(score)


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _vector(values: Array) -> list[float] | None:
    return [float(value) for value in values] if np.isfinite(values).all() else None


def _matrix(values: Array) -> list[list[float]] | None:
    return [[float(value) for value in row] for row in values] if np.isfinite(values).all() else None
