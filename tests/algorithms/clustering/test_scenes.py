"""What clustering does on scenes of extended targets, in numbers of targets and places of their plots."""

from __future__ import annotations

import numpy as np
import pytest

from algorithms.clustering.modes import cluster
from algorithms.clustering.parameters import CorrectedPatent, Dbscan, KMeans, Recommended
from algorithms.clustering.points import Points
from algorithms.clustering.scoring import score_clusters
from scenarios.files.set_files import load_set
from scenarios.range_doppler import draw_scene

TRIALS = 200
SCENES = {scene.name: scene for scene in load_set("range-doppler").scenes}
EXTENTS = {"range_extent": 16.0, "doppler_extent": 12.0}


def scored(name, parameters, trials=TRIALS):
    drawn = draw_scene(SCENES[name], 1, 0, trials)
    return score_clusters(cluster(drawn.points, parameters), drawn.centres)


@pytest.mark.parametrize("name", SCENES)
def test_the_recommended_mode_counts_targets_and_places_them_as_k_means_that_knows_their_number(name):
    ours = scored(name, Recommended(**EXTENTS))
    assert ours.exact_rate >= 0.97
    known = scored(name, KMeans(number=len(SCENES[name].targets), **EXTENTS))
    assert known.exact_rate == 1.0
    assert ours.rmse <= 1.1 * known.rmse
    # A mean of n points of standard deviation s scatters by s/√n, and by √(4/π) more with Rayleigh's weights.
    ideal = [sum(side**2 for side in target.spread) / target.points for target in SCENES[name].targets]
    assert ours.rmse == pytest.approx(np.sqrt(4.0 / np.pi * np.mean(ideal)), rel=0.15)


def test_the_patent_fails_where_it_is_said_to():
    patent = CorrectedPatent(range_extent=16.0)
    rates = {name: scored(name, patent).exact_rate for name in SCENES}
    # Alone in range it does what it says.
    assert rates.pop("same-doppler") >= 0.97
    # A chord that correlation shortens, a cut through the larger target, no cut in Doppler, a target
    # out of every stray point.
    assert rates.pop("diagonal") <= 0.1
    assert rates.pop("same-range") == 0.0
    assert max(rates.values()) <= 0.6


def test_the_patent_takes_targets_on_a_diagonal_for_one_and_cuts_the_larger_of_two():
    patent = CorrectedPatent(range_extent=16.0)
    assert np.median(scored("diagonal", patent).excess) == -2
    drawn = draw_scene(SCENES["unequal"], 1, 0, TRIALS)
    clusters = cluster(drawn.points, patent)
    cut = [len(np.unique(clusters.label[own][drawn.origin[own] == 0])) > 1 for own in rows_of(drawn.points)]
    assert np.mean(cut) > 0.4


def rows_of(points):
    return [slice(*points.offsets[scan : scan + 2]) for scan in range(points.scans)]


def test_interference_is_left_out():
    drawn = draw_scene(SCENES["interference"], 2, 0, TRIALS)
    stray = drawn.origin < 0
    clusters = cluster(drawn.points, Recommended(**EXTENTS))
    assert clusters.kept[stray].mean() < 0.1
    assert clusters.kept[~stray].mean() > 0.9


def test_dbscan_counts_well_too():
    for name in SCENES:
        assert scored(name, Dbscan(**EXTENTS)).exact_rate >= 0.9


def test_scores_are_those_of_a_loop():
    random = np.random.default_rng(1)
    place = random.uniform(0, 300, (400, 2))
    points = Points.of(*place.T, np.ones(400), [0, 100, 100, 250, 400])
    clusters = cluster(points, CorrectedPatent(range_extent=90.0))
    centres = random.uniform(0, 300, (4, 3, 2))
    found = score_clusters(clusters, centres)
    for scan in range(4):
        own = np.flatnonzero(clusters.scan == scan)
        assert found.excess[scan] == len(own) - 3
        for target in range(3):
            away = [
                (clusters.range[index] - centres[scan, target, 0]) ** 2
                + (clusters.doppler[index] - centres[scan, target, 1]) ** 2
                for index in own
            ]
            assert found.squared_error[scan, target] == pytest.approx(min(away, default=np.nan), nan_ok=True)
    assert found.rmse == pytest.approx(np.sqrt(np.nanmean(found.squared_error)))
    assert found.exact_rate == np.mean(found.excess == 0)
    nothing = score_clusters(cluster(Points.of([], [], []), Recommended(**EXTENTS)), np.zeros((1, 0, 2)))
    assert nothing.exact_rate == 1.0
    assert np.isnan(nothing.rmse)
