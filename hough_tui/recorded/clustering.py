"""Clustering of recorded points: parameters, clusters, and the document that tells them."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.cells import cell_of, extent_of_cell
from algorithms.clustering.circle import cut_open, folded, lowest
from algorithms.clustering.clusters import NONE, Clusters
from algorithms.clustering.comparisons import TooFewPoints
from algorithms.clustering.ellipse import Ellipse
from algorithms.clustering.modes import cluster, cluster_with_splits
from algorithms.clustering.parameters import MODES, Clustering, Recommended, SplittingClustering
from algorithms.clustering.points import Points
from algorithms.clustering.splitting import Splits
from algorithms.clustering.tree import Step, steps
from algorithms.errors import RequestError
from algorithms.parameters import Positive, checked, unknown, validated
from hough_tui.recorded.initiation import assign
from scenarios.files.point_files import PointRecording

OPTIONS = {
    "range_extent": "--range-extent",
    "doppler_extent": "--doppler-extent",
    "number": "--set number=N",
}
"""How parameters without a default are given."""


@dataclass(frozen=True, slots=True)
class Clustered:
    """The clusters of one recording, with all that led to them.

    Attributes
    ----------
    parameters : by which it was clustered
    recording, clusters : points in, clusters out
    splits : the splits that led to them; None where none did
    seconds : of the clustering alone
    circle : where the circle of Doppler begins, and how long it is; None where Doppler is a line
    """

    parameters: Clustering
    recording: PointRecording
    clusters: Clusters
    splits: Splits | None
    seconds: float
    circle: tuple[float, float] | None = None

    def on_circle(self, doppler: float) -> float:
        """Return a Doppler within the unambiguous span, where there is one."""
        return doppler if self.circle is None else folded(doppler, *self.circle)

    @property
    def radius(self) -> float:
        """How far from its centre a cluster reaches, in standard deviations; √2 where the mode has none."""
        is_bounded = isinstance(self.parameters, SplittingClustering)
        return cast("SplittingClustering", self.parameters).radius if is_bounded else math.sqrt(2.0)

    def steps(self, scan: int) -> list[Step]:
        """Return the steps of one scan; none of a mode that does not split."""
        if self.splits is None:
            return []
        return steps(self.splits, self.clusters, cast("Any", self.parameters), scan)


def given_clustering(
    mode: str,
    range_extent: float | None,
    doppler_extent: float | None,
    result: str | None,
    assignments: Sequence[str] = (),
) -> tuple[Clustering, list[str]]:
    """Return the parameters of a mode, and in words what of the given is not used.

    Parameters
    ----------
    mode, range_extent, doppler_extent, result : as declared; None where nothing is given
    assignments : `key=value` of any parameter of the mode; they go before the others

    Raises
    ------
    RequestError
        Where the mode is unknown, or a parameter is missing or not allowed.
    """
    if mode not in MODES:
        raise RequestError(f"--mode: {unknown(mode, list(MODES), 'mode')}")
    model, notes = MODES[mode], []
    data: dict[str, Any] = {"mode": mode, "range_extent": range_extent, "result": result}
    if "doppler_extent" in model.model_fields:
        data["doppler_extent"] = doppler_extent
    elif doppler_extent is not None:
        notes.append(f"mode {mode} looks at the extent in range alone: --doppler-extent is not used")
    data = {name: value for name, value in data.items() if value is not None}
    for assignment in assignments:
        assign(data, assignment)
    if data["mode"] != mode:
        raise RequestError("--set mode: give --mode instead, on which the parameters depend")
    for name, option in OPTIONS.items():
        if name in model.model_fields and name not in data:
            raise RequestError(f"mode {mode} needs {option}: {model.model_fields[name].description}")
    return validated(model, data, f"mode {mode}"), notes


def with_cells(parameters: Clustering, recording: PointRecording) -> tuple[Clustering, list[str]]:
    """Return the parameters with the cells of recorded points, and in words what was assumed of them.

    Parameters
    ----------
    parameters : as given; cells that were given stay
    recording : whose points tell the others

    Notes
    -----
    The default of a cell, 1, is that of a scene. Points in km would all lie in one such cell, and none of
    their sets would be as narrow as a target.
    """
    if not isinstance(parameters, Recommended):
        return parameters, []
    found, notes = {}, []
    axes = (
        ("range", recording.points.range, parameters.range_extent, parameters.range_cell),
        ("doppler", recording.points.doppler, parameters.doppler_extent, parameters.doppler_cell),
    )
    for axis, values, extent, cell in axes:
        if f"{axis}_cell" not in parameters.model_fields_set:
            found[f"{axis}_cell"] = cell = cell_of(values, extent)
            if cell == 0.0:
                notes.append(f"{axis}_cell is not given: 0 is taken, for the points lie on no grid of cells")
            elif cell != 1.0:
                notes.append(f"{axis}_cell is not given: {cell:g} is taken, the step of the points")
        elif extent_of_cell(cell) > extent:
            notes.append(
                f"{axis}_cell {cell:g} alone has an extent of {extent_of_cell(cell):.3g}, more than "
                f"{axis}_extent {extent:g}: every set is too wide, and is split while it has a gap"
            )
    return parameters.model_copy(update=found), notes


def cluster_recording(
    recording: PointRecording, parameters: Clustering, span: float | None = None
) -> Clustered:
    """Return the clusters of recorded points.

    Parameters
    ----------
    recording, parameters : what is clustered, and how
    span : the unambiguous span of Doppler, in the unit of the points; None: Doppler is a line

    Raises
    ------
    RequestError
        As `cluster` does, and where Dopplers do not lie within one span.
    """
    circle = None
    if span is not None:
        recording, circle = _opened(recording, span)
    # Compiled code is loaded here, so that the time given below is that of the clustering.
    nothing = np.zeros(0)
    cluster(Points.of(nothing, nothing, nothing), parameters)
    began = time.perf_counter()
    try:
        clusters, splits = cluster_with_splits(recording.points, parameters)
    except TooFewPoints as error:
        # By the scan's number in the file.
        raise TooFewPoints(error.number, error.different, int(recording.scans[error.scan])) from None
    return Clustered(parameters, recording, clusters, splits, time.perf_counter() - began, circle)


def _opened(recording: PointRecording, span: float) -> tuple[PointRecording, tuple[float, float]]:
    """Return points with Doppler cut open in the widest gap of each scan or dwell, and the circle."""
    points = recording.points
    checked(span, Positive, "--doppler-span")
    low = lowest(points.doppler, span)
    if low is None:
        raise RequestError(
            f"--doppler-span: {span:g} is given; the points have Dopplers from {points.doppler.min():g} to "
            f"{points.doppler.max():g}, which must lie from {-0.5 * span:g} to {0.5 * span:g}, or from 0 to "
            f"{span:g}"
        )
    opened = cut_open(points.doppler, points.offsets, np.full(points.scans, span))
    return replace(recording, points=replace(points, doppler=opened)), (low, span)


def _at(along: float, dwell: float) -> dict[str, float]:
    """Return the place of a range and an azimuth in degrees, clockwise from north."""
    azimuth = math.radians(dwell)
    return {"x": along * math.sin(azimuth), "y": along * math.cos(azimuth)}


def document(found: Clustered, with_steps: bool = False, with_places: bool = False) -> dict[str, Any]:
    """Return a clustering as `cluster --json` prints it.

    Parameters
    ----------
    found : a clustering
    with_steps : whether to tell every set that was looked at
    with_places : whether to tell x and y of plots, their dwell being the azimuth in degrees

    Raises
    ------
    RequestError
        Where places are asked for, and the points have no dwells.
    """
    clusters, recording = found.clusters, found.recording
    rows, dwells = recording.rows, recording.dwells
    if with_places and dwells is None:
        raise RequestError("--xy: the file has no column 'dwell', the azimuth of the points in degrees")
    told: dict[str, Any] = {
        "mode": found.parameters.mode,
        "parameters": found.parameters.model_dump(mode="json"),
        "points": len(clusters.points),
        "scans": len(np.unique(recording.scans)),
        "seconds": found.seconds,
        "clusters": [
            {
                **recording.place(int(clusters.scan[index])),
                "members": _rising(rows[members]),
                "kept": _rising(rows[members[clusters.kept[members]]]),
                "range": float(clusters.range[index]),
                "doppler": found.on_circle(float(clusters.doppler[index])),
                "amplitude": float(clusters.amplitude[index]),
                "strongest": int(rows[clusters.strongest[index]]),
                "ellipse": _ellipse(clusters.ellipse(index)),
                **(
                    _at(float(clusters.range[index]), float(dwells[clusters.scan[index]]))
                    if with_places and dwells is not None
                    else {}
                ),
            }
            for index, members in enumerate(clusters.members())
        ],
        "interference": _rising(rows[(clusters.label == NONE) | ~clusters.kept]),
    }
    if with_steps:
        told["steps"] = [
            _step(step, index, recording.place(scan), rows)
            for scan in range(recording.points.scans)
            for index, step in enumerate(found.steps(scan))
        ]
    return told


def plot_rows(told: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the plots of a document as rows of a table."""
    return [
        {
            **{key: found[key] for key in ("scan", "dwell", "x", "y") if key in found},
            "range": found["range"],
            "doppler": found["doppler"],
            "amplitude": found["amplitude"],
            "members": len(found["members"]),
            "kept": len(found["kept"]),
        }
        for found in told["clusters"]
    ]


def can_be_followed(parameters: Clustering) -> bool:
    """Return whether a mode splits, so that its steps can be told."""
    return isinstance(parameters, SplittingClustering)


def _step(step: Step, index: int, place: dict[str, int | float], rows: NDArray[np.int64]) -> dict[str, Any]:
    return {
        **place,
        "step": index,
        "parent": step.parent,
        "parts": list(step.parts),
        "depth": step.depth,
        "points": _rising(rows[step.points]),
        "verdict": step.verdict.value,
        "why": step.why,
        "axis": step.axis,
        "cut": step.cut,
        "gap": step.gap,
        "cluster": step.cluster,
        "ellipse": _ellipse(step.ellipse),
    }


def _ellipse(ellipse: Ellipse) -> dict[str, Any]:
    a, b, c = ellipse.range_variance, ellipse.doppler_variance, ellipse.covariance
    return {
        "centre": list(ellipse.centre),
        "coefficients": list(ellipse.coefficients),
        "chord": ellipse.chord,
        "widths": list(ellipse.widths),
        "semi_axes": list(ellipse.semi_axes),
        "angle_deg": math.degrees(ellipse.angle),
        "covariance": [[a, c], [c, b]],
    }


def _rising(rows: NDArray[np.int64]) -> list[int]:
    return sorted(rows.tolist())
