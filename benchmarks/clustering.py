"""Plot clustering beside DBSCAN and k-means of scikit-learn: time on the same points, and what is found.

Run it with `python benchmarks/clustering.py`.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np
from measure import ratio, rounds, verdict

from algorithms.clustering.modes import cluster
from algorithms.clustering.parameters import Clustering, CorrectedPatent, Dbscan, KMeans, Recommended
from algorithms.clustering.points import Points
from algorithms.clustering.scoring import score_clusters
from scenarios.files.set_files import load_set
from scenarios.range_doppler import draw_scene
from scenarios.scenes import ExtendedTarget, Scene, SceneRegion

TRIALS = 200
SEED = 1
EXTENTS = {"range_extent": 16.0, "doppler_extent": 12.0}

CHUNKS = 4
"""Pieces of the same points for the threads."""


def many_points() -> Points:
    """Return 10⁵ points in 100 scans: 36 targets of 24 points in each, and interference."""
    targets = [
        ExtendedTarget(range=60.0 * (column + 1), doppler=50.0 * (row + 1))
        for column in range(6)
        for row in range(6)
    ]
    region = SceneRegion(range=(0.0, 420.0), doppler=(0.0, 350.0))
    stray = 1000 - 24 * len(targets)
    scene = Scene(name="many", region=region, interference=stray, targets=targets)
    return draw_scene(scene, SEED, 0, 100).points


def times() -> None:
    """Print how long each mode takes on 10⁵ points, and one scan of them all."""
    points = many_points()
    modes: dict[str, Clustering] = {
        "recommended": Recommended(**EXTENTS),
        "corrected-patent": CorrectedPatent(range_extent=EXTENTS["range_extent"]),
        "DBSCAN": Dbscan(**EXTENTS),
    }
    contenders: dict[str, Callable[[], object]] = {
        name: lambda given=given: cluster(points, given) for name, given in modes.items()
    }
    print(f"{len(points):,} points in {points.scans} scans")
    seconds = rounds(contenders, count=9)
    for name, taken in seconds.items():
        print(f"  {name:16} {1e3 * statistics.median(taken):8.1f} ms")
    taken = statistics.median(seconds["recommended"])
    print(f"  recommended (bound 200 ms: {verdict(taken, 0.2)})")
    value = ratio(seconds, "recommended", "DBSCAN")
    print(f"  recommended / DBSCAN: {value:.3f} (bound 1: {verdict(value, 1.0)})")
    two_threads(points)
    together = Points.of(points.range, points.doppler, points.amplitude)
    random = np.random.default_rng(SEED)
    steady = np.arange(len(points), dtype=float)
    for name, one in {
        "the same in one scan": together,
        "anywhere": Points.of(*random.uniform(0.0, 1e5, (2, len(points))), points.amplitude),
        "of one range, without a gap": Points.of(0.0 * steady, steady, points.amplitude),
        "on a diagonal, without a gap": Points.of(steady, steady, points.amplitude),
        # Every cut takes off but one point.
        "of gaps that grow steadily, 10⁴ of them": Points.of(*[steady[:10_000] ** 2] * 2, steady[:10_000]),
    }.items():
        began = time.perf_counter()
        found = cluster(one, modes["recommended"])
        print(f"  {name}: {1e3 * (time.perf_counter() - began):.0f} ms, clusters: {len(found):,}")


def two_threads(points: Points) -> None:
    """Print how two threads share scans, cut into chunks."""
    bounds = np.linspace(0, points.scans, CHUNKS + 1).astype(int)
    chunks = []
    for first, end in pairwise(bounds):
        begin, stop = points.offsets[first], points.offsets[end]
        columns = (points.range[begin:stop], points.doppler[begin:stop], points.amplitude[begin:stop])
        chunks.append(Points.of(*columns, points.offsets[first : end + 1] - begin))
    parameters = Recommended(**EXTENTS)
    with ThreadPoolExecutor(2) as pool:
        seconds = rounds(
            {
                "one": lambda: [cluster(chunk, parameters) for chunk in chunks],
                "two": lambda: list(pool.map(lambda chunk: cluster(chunk, parameters), chunks)),
            }
        )
    print(f"  two threads / one: {ratio(seconds, 'two', 'one'):.2f}")


def scenes() -> None:
    """Print exact counts and centroid errors of every mode on every kind of scene."""
    kinds = {scene.name: scene for scene in load_set("range-doppler").scenes}
    print(f"exact count % / centroid RMSE in cells, {TRIALS} scenes each, seed {SEED}")
    rows: dict[str, Callable[[int], Clustering]] = {
        "corrected-patent": lambda _: CorrectedPatent(range_extent=EXTENTS["range_extent"]),
        "recommended": lambda _: Recommended(**EXTENTS),
        "k-means, number known": lambda number: KMeans(number=number, **EXTENTS),
        "DBSCAN": lambda _: Dbscan(**EXTENTS),
    }
    print("  " + "".join(f"{name:>14}" for name in ("", *kinds)).replace(" " * 14, " " * 21, 1))
    found = {}
    for row, mode in rows.items():
        cells = []
        for name, scene in kinds.items():
            drawn = draw_scene(scene, SEED, 0, TRIALS)
            score = score_clusters(cluster(drawn.points, mode(len(scene.targets))), drawn.centres)
            found[row, name] = score
            cells.append(f"{f'{100.0 * score.exact_rate:.4g}/{score.rmse:.2f}':>14}")
        print(f"  {row:21}" + "".join(cells))
    least = min(found["recommended", name].exact_rate for name in kinds)
    print(f"  recommended, least exact count {100 * least:.4g} % (bound 97 %: {at_least(least, 0.97)})")
    worst = max(found["recommended", name].rmse / found["k-means, number known", name].rmse for name in kinds)
    print(f"  recommended / k-means, worst centroid RMSE: {worst:.3f} (bound 1.1: {verdict(worst, 1.1)})")


def at_least(value: float, bound: float) -> str:
    """Return whether a value reaches its bound, in words."""
    return verdict(value, bound, at_most=False)


if __name__ == "__main__":
    times()
    scenes()
