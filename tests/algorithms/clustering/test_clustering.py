"""Clusters: against a recursion in plain numpy, on hazards, under changes of unit and of order."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.clustering.clusters import NONE
from algorithms.clustering.modes import cluster, cluster_with_splits
from algorithms.clustering.parameters import CorrectedPatent, Dbscan, KMeans, Recommended
from algorithms.clustering.points import Points
from algorithms.clustering.splitting import DOPPLER, RANGE, WHOLE
from algorithms.clustering.tree import Verdict, steps
from algorithms.errors import RequestError

# No whole number of cells, so that no set of whole cells is exactly as wide as a target.
EXTENTS = {"range_extent": 16.31, "doppler_extent": 12.17}
RECOMMENDED = Recommended(**EXTENTS)
PATENT = CorrectedPatent(range_extent=EXTENTS["range_extent"])
MODES = [RECOMMENDED, PATENT]


def points_of(r, d, amplitude=None, offsets=None):
    return Points.of(r, d, np.ones(len(r)) if amplitude is None else amplitude, offsets)


@st.composite
def scans(draw, most=4):
    """Return scans of whole cells: targets of any slope, and points anywhere."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    parts = []
    for _ in range(draw(st.integers(1, most))):
        blocks = [random.integers(-60, 60, (draw(st.integers(0, 8)), 2))]
        for _ in range(draw(st.integers(0, 4))):
            spread = random.standard_normal((draw(st.integers(1, 25)), 2)) @ random.uniform(-3, 3, (2, 2))
            blocks.append(np.rint(spread + random.uniform(-60, 60, 2)))
        parts.append(np.concatenate(blocks).astype(float))
    place = np.concatenate(parts)
    amplitude = random.integers(0, 9, len(place)).astype(float)
    return Points.of(place[:, 0], place[:, 1], amplitude, np.cumsum([0, *map(len, parts)]))


# A recursion in plain numpy


def parts_of(r, d, own, parameters):
    """Return the sets that are not split, and how often one was."""
    if isinstance(parameters, CorrectedPatent):
        (a, c), (_, b) = np.cov(r[own], d[own], bias=True) if len(own) > 1 else np.zeros((2, 2))
        chord = math.sqrt(8.0 * max(0.0, a - c * c / b if b > 1e-20 else a))
        below = r[own] <= r[own].mean()
        is_single = chord <= parameters.range_extent
    else:
        candidates = []
        cells = (parameters.range_cell, parameters.doppler_cell)
        extents = (parameters.range_extent, parameters.doppler_extent)
        for values, cell, extent in zip((r[own], d[own]), cells, extents, strict=True):
            gaps = np.diff(np.sort(values))
            if math.sqrt(8.0 * (values.var() + cell**2 / 12.0)) > extent and len(gaps) and gaps.max() > 0.0:
                widest = np.flatnonzero(np.isclose(gaps, gaps.max(), rtol=1e-7))
                middles = np.sort(values)[widest] + 0.5 * gaps.max()
                away = np.round(abs(middles - values.mean()), 6)
                candidates.append((round(gaps.max() / extent, 7), values < middles[np.argmin(away)]))
        is_single = not candidates
        # The first of equals, which is range.
        below = max(candidates, key=lambda found: found[0])[1] if candidates else None
    if is_single:
        return [own]
    return parts_of(r, d, own[below], parameters) + parts_of(r, d, own[~below], parameters)


def expected_clusters(points, parameters):
    """Return members, kept points and plot of each cluster."""
    found = []
    for scan in range(points.scans):
        own = np.arange(points.offsets[scan], points.offsets[scan + 1])
        for members in parts_of(points.range, points.doppler, own, parameters) if len(own) else []:
            if len(members) < parameters.least_points:
                continue
            place = np.stack([points.range[members], points.doppler[members]])
            away = place - place.mean(axis=1, keepdims=True)
            matrix = np.cov(place, bias=True) if len(members) > 1 else np.zeros((2, 2))
            if isinstance(parameters, Recommended):
                matrix = matrix + np.diag([parameters.range_cell**2, parameters.doppler_cell**2]) / 12.0
            # Of a line the inverse must be the one along it, whatever the units are.
            scale = np.sqrt(np.where(np.diag(matrix) > 0.0, np.diag(matrix), 1.0))
            inverse = np.linalg.pinv(matrix / np.outer(scale, scale), rcond=1e-9)
            standard = away / scale[:, None]
            distance = np.einsum("in,ij,jn->n", standard, inverse, standard)
            kept = members[distance <= parameters.radius**2 * (1.0 + 1e-6)]
            kept = kept if len(kept) else members
            weight = points.amplitude[kept] if points.amplitude[kept].any() else np.ones(len(kept))
            place = np.stack([points.range[kept], points.doppler[kept]])
            plot = tuple(np.average(place, axis=1, weights=weight))
            strongest = kept[np.argmax(points.amplitude[kept])]
            found.append((members.tolist(), kept.tolist(), plot, points.amplitude[kept].mean(), strongest))
    return found


@pytest.mark.parametrize("parameters", MODES, ids=lambda given: given.mode)
@settings(max_examples=150)
@given(points=scans())
def test_clusters_are_those_of_a_recursion_in_numpy(parameters, points):
    clusters = cluster(points, parameters)
    expected = expected_clusters(points, parameters)
    assert [members.tolist() for members in clusters.members()] == [members for members, *_ in expected]
    for index, (members, kept, plot, amplitude, strongest) in enumerate(expected):
        assert np.array(members)[clusters.kept[members]].tolist() == kept
        assert (clusters.range[index], clusters.doppler[index]) == pytest.approx(plot)
        assert clusters.amplitude[index] == pytest.approx(amplitude)
        assert clusters.strongest[index] == strongest
        assert points.offsets[clusters.scan[index]] <= members[0] < points.offsets[clusters.scan[index] + 1]
    assert not clusters.kept[clusters.label == NONE].any()
    assert clusters.counts.tolist() == [int((clusters.scan == scan).sum()) for scan in range(points.scans)]


@given(scans())
def test_the_strongest_point_is_given_as_it_is(points):
    for mean in MODES:
        clusters = cluster(points, mean.model_copy(update={"result": "strongest"}))
        assert (clusters.strongest == cluster(points, mean).strongest).all()
        assert (clusters.range == points.range[clusters.strongest]).all()
        assert (clusters.doppler == points.doppler[clusters.strongest]).all()
        assert (clusters.amplitude == points.amplitude[clusters.strongest]).all()


@pytest.mark.parametrize("parameters", MODES, ids=lambda given: given.mode)
@settings(max_examples=60)
@given(points=scans(most=2), unit=st.floats(1e-3, 1e3))
def test_a_change_of_the_doppler_unit_changes_no_membership(parameters, points, unit):
    changed = parameters
    if isinstance(parameters, Recommended):
        scaled = {name: unit * getattr(parameters, name) for name in ("doppler_extent", "doppler_cell")}
        changed = parameters.model_copy(update=scaled)
    before = cluster(points, parameters)
    after = cluster(Points.of(points.range, unit * points.doppler, points.amplitude, points.offsets), changed)
    assert (after.label == before.label).all()
    assert (after.kept == before.kept).all()
    assert after.range == pytest.approx(before.range)
    assert after.doppler == pytest.approx(unit * before.doppler)
    assert [after.ellipse(index).chord for index in range(len(after))] == pytest.approx(
        [before.ellipse(index).chord for index in range(len(before))], rel=1e-6, abs=1e-6
    )


@pytest.mark.parametrize("parameters", MODES, ids=lambda given: given.mode)
@given(points=scans())
def test_scans_do_not_meet(parameters, points):
    together = cluster(points, parameters)
    for scan in range(points.scans):
        alone = cluster(points.scan(scan), parameters)
        own = together.scan == scan
        first = int(np.flatnonzero(own)[0]) if own.any() else 0
        rows = slice(points.offsets[scan], points.offsets[scan + 1])
        assert (alone.range == together.range[own]).all()
        label = together.label[rows]
        assert (alone.label == np.where(label == NONE, NONE, label - first)).all()


# The tree


@pytest.mark.parametrize("parameters", MODES, ids=lambda given: given.mode)
@given(points=scans())
def test_the_tree_ends_in_the_clusters(parameters, points):
    clusters, splits = cluster_with_splits(points, parameters)
    members = clusters.members()
    ended = []
    for scan in range(points.scans):
        own = np.arange(points.offsets[scan], points.offsets[scan + 1])
        found = steps(splits, clusters, parameters, scan)
        assert bool(found) == bool(len(own))
        assert sum(step.verdict == Verdict.SPLIT for step in found) <= max(0, len(own) - 1)
        for index, step in enumerate(found):
            if step.parent is None:
                assert index == 0
                assert step.points.tolist() == own.tolist()
            else:
                assert index in found[step.parent].parts
                assert step.depth == found[step.parent].depth + 1
            if step.verdict != Verdict.SPLIT:
                assert step.parts == ()
                assert step.axis is None
            else:
                low, high = (found[part].points for part in step.parts)
                assert sorted([*low, *high]) == step.points.tolist()
                values = points.range if step.axis == "range" else points.doppler
                assert values[low].max() <= step.cut < values[high].min()
                assert values[high].min() - values[low].max() == step.gap > 0.0
            if step.verdict == Verdict.TARGET:
                assert step.points.tolist() == members[step.cluster].tolist()
                assert step.ellipse == clusters.ellipse(step.cluster)
                ended.append(step.cluster)
            elif step.verdict == Verdict.TOO_FEW:
                assert len(step.points) < parameters.least_points
                assert (clusters.label[step.points] == NONE).all()
    assert ended == list(range(len(clusters)))


def test_why_a_set_is_split_or_not():
    square = np.array([(0, 0), (0, 1), (1, 0), (1, 1)], float)
    place = np.concatenate([square, square + np.array([40, 3]), [(80, 90)]])
    points = points_of(*place.T)
    clusters, splits = cluster_with_splits(points, RECOMMENDED)
    first, *others = steps(splits, clusters, RECOMMENDED, 0)
    assert first.verdict == Verdict.SPLIT
    assert (first.axis, first.cut, first.gap) == ("doppler", 4.0, 86.0)
    along, across = 2.0 * np.sqrt(2.0 * (place.var(axis=0) + 1.0 / 12.0))
    assert first.why == f"extent: range {along:.4g} > 16.31, Doppler {across:.4g} > 12.17"
    assert [step.why for step in others[1:]] == [
        "extent: range 1.633 ≤ 16.31, Doppler 1.633 ≤ 12.17",
        "extent: range 1.633 ≤ 16.31, Doppler 1.633 ≤ 12.17",
        "1 of at least 4 points",
    ]
    # Rounding does not make a set too wide, nor say so.
    exact = PATENT.model_copy(update={"range_extent": math.sqrt(2.0) * (1.0 - 1e-12)})
    clusters, splits = cluster_with_splits(points_of([0.0, 1.0], [0.0, 0.0]), exact)
    assert [step.why for step in steps(splits, clusters, exact, 0)] == ["chord 1.414 ≤ 1.41421"]
    # Cells as large as a target: one place is too wide, and there is nothing to split.
    coarse = Recommended(range_extent=1.0, doppler_extent=1.0, range_cell=4.0)
    clusters, splits = cluster_with_splits(points_of(np.ones(5), np.ones(5)), coarse)
    (only,) = steps(splits, clusters, coarse, 0)
    assert only.why == "extent: range 3.266 > 1, no gap to split at"
    assert only.verdict == Verdict.TARGET


# Hazards


COUNT = 100_000
LINE = np.arange(COUNT, dtype=float)
RANDOM = np.random.default_rng(5)
HAZARDS = {
    "one point": ([3.0], [4.0]),
    "two points": ([0.0, 100.0], [0.0, 3.0]),
    "two of one range": ([5.0, 5.0], [0.0, 100.0]),
    "coincident": (np.full(50, 0.1), np.full(50, 0.3)),
    "equal ranges": (np.full(200, 0.1), 7.0 * np.arange(200)),
    "equal Dopplers": (7.0 * np.arange(200), np.full(200, 0.1)),
    "rising line": (0.3 * np.arange(500), 0.7 * np.arange(500)),
    "falling line": (0.3 * np.arange(500), -0.7 * np.arange(500)),
    "neighbouring floats": (np.array([1.0, np.nextafter(1.0, 2.0)] * 9), np.zeros(18)),
    "nothing but far": (np.array([-1e15, 1e15] * 4), np.array([-1e15, 1e15] * 4)),
    "one cell apart at a distance": (1e15 - np.arange(64.0), np.zeros(64)),
    "growing gaps": (2.0 ** np.arange(49), np.zeros(49)),
    "10⁵ of one range": (np.zeros(COUNT), LINE),
    "10⁵ of one Doppler": (LINE, np.zeros(COUNT)),
    "10⁵ of a rising line": (LINE, LINE),
    "10⁵ of a falling line": (LINE, -LINE),
    "10⁵ anywhere": tuple(RANDOM.uniform(0, 3e4, (2, COUNT))),
    "10⁵ of whole cells": tuple(np.rint(RANDOM.uniform(0, 2e3, (2, COUNT)))),
    "10⁵ coincident": (np.ones(COUNT), np.ones(COUNT)),
}


@pytest.mark.parametrize("name", HAZARDS)
@pytest.mark.parametrize("parameters", MODES, ids=lambda given: given.mode)
@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_it_ends_on_anything(name, parameters, scale):
    r, d = HAZARDS[name]
    extents = {key: scale * extent for key, extent in EXTENTS.items() if key in type(parameters).model_fields}
    parameters = parameters.model_copy(update=extents)
    clusters, splits = cluster_with_splits(points_of(r, d), parameters)
    assert np.isfinite(clusters.range).all()
    assert np.isfinite(clusters.doppler).all()
    assert np.isfinite(clusters.moments).all()
    whole = splits.axis == WHOLE
    assert whole.sum() == (~whole).sum() + 1
    assert (splits.end > splits.first).all()
    assert (splits.end - splits.first)[whole].sum() == len(r)
    assert set(np.unique(splits.axis)) <= {WHOLE, RANGE, DOPPLER}


def test_no_points_and_scans_without_points():
    for parameters in [*MODES, Dbscan(**EXTENTS), KMeans(number=1, **EXTENTS)]:
        nothing = cluster(points_of([], []), parameters)
        assert len(nothing) == 0
        assert nothing.members() == []
        assert nothing.counts.tolist() == [0]
        some = cluster(points_of([1.0] * 5, [2.0] * 5, offsets=[0, 0, 5, 5]), parameters)
        assert some.counts.tolist() == [0, 1, 0]
        assert some.scan.tolist() == [1]


def test_equal_ranges_are_whole_for_the_patent_and_split_in_doppler_by_the_recommended():
    d = np.concatenate([np.arange(6.0), 50 + np.arange(6.0)])
    points = points_of(np.full(12, 30.0), d)
    assert len(cluster(points, PATENT)) == 1
    assert cluster(points, RECOMMENDED).label.tolist() == [0] * 6 + [1] * 6


def test_dense_points_without_a_gap_are_halved():
    points = points_of(np.arange(64.0), np.zeros(64))
    assert cluster(points, RECOMMENDED).counts.tolist() == [4]
    assert np.bincount(cluster(points, RECOMMENDED).label).tolist() == [16] * 4


@pytest.mark.parametrize("unit", [1.0, 0.1, *(np.arange(1, 40) / 7.0)])
def test_of_equal_gaps_equally_far_from_the_centre_the_lower_is_taken_in_any_unit(unit):
    r = unit * np.repeat([10.0, 40.0, 70.0], 4)
    parameters = Recommended(range_extent=unit * 9.0, doppler_extent=9.0, range_cell=unit)
    splits = cluster_with_splits(points_of(r, np.zeros(12)), parameters)[1]
    assert splits.cut[splits.axis == RANGE].tolist() == [unit * 10.0, unit * 40.0]


def test_amplitudes():
    r, d = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0, 1.0])
    dark = cluster(points_of(r, d, np.zeros(4)), RECOMMENDED)
    assert (dark.range[0], dark.doppler[0], dark.amplitude[0], dark.strongest[0]) == (1.5, 0.5, 0.0, 0)
    tied = cluster(points_of(r, d, [1, 5, 2, 5]), RECOMMENDED.model_copy(update={"result": "strongest"}))
    assert (tied.strongest[0], tied.range[0], tied.amplitude[0]) == (1, 1.0, 5.0)
    for huge in (np.finfo(float).max, np.finfo(float).tiny):
        large = cluster(points_of(r, d, [huge, huge, huge, 0.0]), RECOMMENDED)
        assert (large.range[0], large.doppler[0]) == pytest.approx((1.0, 1.0 / 3.0))
        assert large.amplitude[0] == pytest.approx(0.75 * huge)


def test_a_radius_that_drops_all_points_keeps_all():
    corners = np.array([(0, 0), (0, 4), (4, 0), (4, 4)], float)
    # Each lies on the ellipse itself, √2 standard deviations from the centre.
    assert cluster(points_of(*corners.T), PATENT).kept.all()
    small = PATENT.model_copy(update={"radius": 0.5})
    assert cluster(points_of(*corners.T), small).kept.all()
    with_centre = np.concatenate([corners, [(2, 2)]])
    assert cluster(points_of(*with_centre.T), small).kept.tolist() == [False] * 4 + [True]


def test_the_ellipse_of_the_patent_drops_more_than_a_third_of_a_gaussian_target():
    place = np.random.default_rng(3).normal(0.0, (3.0, 2.0), (20_000, 2))
    kept = cluster(points_of(*place.T), PATENT).kept.mean()
    assert kept == pytest.approx(1.0 - math.exp(-1.0), abs=4.0 * math.sqrt(0.37 * 0.63 / 20_000))
    exact = RECOMMENDED.model_copy(update={"range_cell": 0.0, "doppler_cell": 0.0})
    kept = cluster(points_of(*place.T), exact).kept.mean()
    assert kept == pytest.approx(1.0 - math.exp(-0.5 * 2.5**2), abs=4.0 * math.sqrt(0.044 * 0.956 / 20_000))


# What cannot be


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        (([1.0, np.nan], [0, 0], [1, 1]), r"point 1: range nan is given; it must be a number from -1e\+15"),
        (([1.0, 2.0], [np.inf, 0], [1, 1]), "point 0: doppler inf is given"),
        (([1.0, 2.0], [0, -1.1e15], [1, 1]), r"point 1: doppler -1.1e\+15 is given"),
        (([1.0, 2.0], [0, 0], [1, np.nan]), "point 1: amplitude nan is given; it must be a finite number"),
        (
            ([1.0, 2.0], [0, 0], [1, -3]),
            "point 1: amplitude -3 is given; .* at least 0; amplitudes are linear",
        ),
        (([1.0, 2.0], [0], [1, 1]), r"the shapes are range \(2,\), doppler \(1,\), amplitude \(2,\)"),
    ],
)
def test_points_that_are_none(columns, told):
    with pytest.raises(RequestError, match=told):
        Points.of(*columns)


@pytest.mark.parametrize("offsets", [[0, 3], [1, 2], [0, 2, 1, 2], []])
def test_offsets_that_are_none(offsets):
    with pytest.raises(RequestError, match="offsets must rise from 0 to the number of points, 2"):
        points_of([1.0, 2.0], [0.0, 0.0], offsets=offsets)


@pytest.mark.parametrize("model", [Recommended, CorrectedPatent, Dbscan, KMeans])
@pytest.mark.parametrize("extent", [0.0, -1.0, math.nan, math.inf])
def test_extents_that_are_none(model, extent):
    for name in EXTENTS:
        if name in model.model_fields:
            with pytest.raises(ValueError, match=name):
                model.model_validate({**EXTENTS, name: extent})


# Comparisons


def test_dbscan_and_k_means_are_those_of_scikit_learn():
    random = np.random.default_rng(2)
    place = np.concatenate([random.normal(at, (3, 2), (20, 2)) for at in ((0, 0), (40, 5), (3, 50))])
    place = np.concatenate([place, random.uniform(-90, 90, (9, 2))])
    points = points_of(*place.T, random.uniform(0, 1, len(place)), [0, 30, len(place)])
    scaled = place / (EXTENTS["range_extent"], EXTENTS["doppler_extent"])
    learn = pytest.importorskip("sklearn.cluster")
    for parameters, model in (
        (Dbscan(eps=0.5, least_points=3, **EXTENTS), learn.DBSCAN(eps=0.5, min_samples=3)),
        (KMeans(number=3, seed=4, **EXTENTS), learn.KMeans(3, n_init=10, random_state=4)),
    ):
        clusters = cluster(points, parameters)
        first, second = model.fit_predict(scaled[:30]), model.fit_predict(scaled[30:])
        second = np.where(second < 0, NONE, second + first.max() + 1)
        assert clusters.label.tolist() == [*first, *second]
        assert (clusters.kept == (clusters.label != NONE)).all()
        for index, members in enumerate(clusters.members()):
            plot = np.average(place[members], axis=0, weights=points.amplitude[members])
            assert (clusters.range[index], clusters.doppler[index]) == pytest.approx(plot)


def test_k_means_needs_as_many_different_points_as_targets():
    with pytest.raises(RequestError, match="scan 1: k-means is to find 3 targets among 2 different points"):
        cluster(points_of([1, 2, 3, 4, 4, 5], [0] * 6, offsets=[0, 3, 6]), KMeans(number=3, **EXTENTS))


def test_without_scikit_learn_its_absence_is_told(monkeypatch):
    monkeypatch.setitem(sys.modules, "sklearn.cluster", None)
    told = r"mode dbscan needs scikit-learn.*pip install 'hough-tui\[clustering\]'"
    with pytest.raises(RequestError, match=told):
        cluster(points_of([1.0], [1.0]), Dbscan(**EXTENTS))
    assert len(cluster(points_of([1.0] * 4, [1.0] * 4), RECOMMENDED)) == 1
