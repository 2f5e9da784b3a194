"""The tree of splits of one scan, set by set, for people to follow."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from algorithms.clustering.clusters import NONE, Clusters
from algorithms.clustering.ellipse import Ellipse, moments
from algorithms.clustering.parameters import CorrectedPatent, Recommended
from algorithms.clustering.splitting import DOPPLER, SLACK, WHOLE, Rule, Splits


class Verdict(StrEnum):
    """What becomes of a set of points."""

    SPLIT = "split"
    TARGET = "target"
    TOO_FEW = "too few"


@dataclass(frozen=True, slots=True)
class Step:
    """One set of points that was looked at.

    Attributes
    ----------
    parent : the step of which it is a part; None for all points of the scan
    parts : the steps of its two parts, the lower first; empty for a whole set
    depth : number of splits that led to it
    points : int64 (m,), rising, as rows of the points of the chunk
    ellipse : theirs, with what the mode adds to the variances
    verdict : what becomes of it
    why : the reason, in words
    axis : `range` or `doppler`, along which it is split; None for a whole set
    cut : the value up to which points go to the lower part
    gap : how far the parts are apart along the axis
    cluster : index of the cluster that it is; None where it is none
    """

    parent: int | None
    parts: tuple[int, ...]
    depth: int
    points: NDArray[np.int64]
    ellipse: Ellipse
    verdict: Verdict
    why: str
    axis: str | None
    cut: float | None
    gap: float | None
    cluster: int | None


def steps(
    splits: Splits, clusters: Clusters, parameters: Recommended | CorrectedPatent, scan: int
) -> list[Step]:
    """Return the steps of one scan in the order in which they are taken, the whole scan first.

    Parameters
    ----------
    splits, clusters : what `cluster` made of the points
    parameters : by which it did
    scan : which one
    """
    points, rule = clusters.points, Rule.of(parameters)
    begin, stop = int(splits.offsets[scan]), int(splits.offsets[scan + 1])
    parts: dict[int, list[int]] = {index: [] for index in range(begin, stop)}
    depths: dict[int, int] = {}
    for index in range(begin, stop):
        parent = int(splits.parent[index])
        depths[index] = 0 if parent < 0 else depths[parent] + 1
        if parent >= 0:
            parts[parent].append(index - begin)
    found = []
    for index in range(begin, stop):
        members = splits.order[splits.first[index] : splits.end[index]]
        mean_r, mean_d, a, b, c = moments(points.range, points.doppler, members)
        ellipse = Ellipse((mean_r, mean_d), a + rule.range_added, b + rule.doppler_added, c)
        axis, parent = int(splits.axis[index]), int(splits.parent[index])
        label = int(clusters.label[members[0]]) if axis == WHOLE else NONE
        if axis != WHOLE:
            verdict = Verdict.SPLIT
        else:
            verdict = Verdict.TARGET if label != NONE else Verdict.TOO_FEW
        found.append(
            Step(
                None if parent < 0 else parent - begin,
                tuple(parts[index]),
                depths[index],
                np.sort(members),
                ellipse,
                verdict,
                _why(ellipse, parameters, verdict, len(members)),
                None if axis == WHOLE else "doppler" if axis == DOPPLER else "range",
                None if axis == WHOLE else float(splits.cut[index]),
                None if axis == WHOLE else float(splits.gap[index]),
                None if label == NONE else label,
            )
        )
    return found


def _why(ellipse: Ellipse, parameters: Recommended | CorrectedPatent, verdict: Verdict, count: int) -> str:
    """Return what the verdict rests on, in words."""
    if isinstance(parameters, CorrectedPatent):
        prefix, sizes = "", [("chord", ellipse.chord, parameters.range_extent)]
    else:
        along, across = ellipse.widths
        prefix = "extent: "
        sizes = [
            ("range", along, parameters.range_extent),
            ("Doppler", across, parameters.doppler_extent),
        ]
    if verdict == Verdict.TOO_FEW:
        return f"{count} of at least {parameters.least_points} points"
    wide = [f"{axis} {size:.4g} > {most:g}" for axis, size, most in sizes if size > most * SLACK]
    fitting = [f"{axis} {size:.4g} ≤ {most:g}" for axis, size, most in sizes if size <= most * SLACK]
    reasons = wide or fitting
    if wide and verdict == Verdict.TARGET:
        reasons = [*wide, "no gap to split at"]
    return prefix + ", ".join(reasons)
