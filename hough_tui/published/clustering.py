"""Exact counts and centroid errors by kind of scene, as a reference implementation found them."""

from __future__ import annotations

from hough_tui.published.tables import Entry, PublishedTable

SCENES = ("same-doppler", "separated", "unequal", "diagonal", "same-range", "interference", "close")

FIGURES: dict[str, tuple[tuple[float, float], ...]] = {
    "corrected-patent": (
        *((1.0, 1.24), (0.52, 3.7), (0.47, 2.3), (0.07, 8.6), (0.0, 11.2), (0.20, 2.5), (0.36, 6.0)),
    ),
    "recommended": (
        *((1.0, 0.81), (1.0, 0.81), (1.0, 1.12), (1.0, 0.84), (1.0, 0.90), (0.97, 0.87), (1.0, 0.91)),
    ),
    "k-means": (
        *((1.0, 0.80), (1.0, 0.80), (1.0, 1.09), (1.0, 0.82), (1.0, 0.87), (1.0, 1.01), (1.0, 0.88)),
    ),
    "dbscan": (
        *((1.0, 0.80), (0.995, 0.83), (0.96, 1.36), (0.995, 0.85), (1.0, 0.87), (0.995, 0.84), (0.99, 0.95)),
    ),
}

UNKNOWN_POINTS = (
    "number, spread and amplitudes of a target's points are not told: compare with k-means in the same scene"
)
UNKNOWN_SCENE = "hangs on distances, numbers of points or interference, which are not told"

PATENT_KNOWN = ("same-doppler", "same-range")
"""Where the outcome of the patent's method does not hang on the details of a scene."""


def _is_known(method: str, scene: str) -> bool:
    """Return whether a count does not hang on what the source leaves open."""
    if method == "corrected-patent":
        return scene in PATENT_KNOWN
    if method == "dbscan" and scene in ("unequal", "close"):
        return False
    return scene != "interference"


def _table() -> PublishedTable:
    entries = []
    for method, figures in FIGURES.items():
        for scene, (exact, error) in zip(SCENES, figures, strict=True):
            case, known = f"{scene}, {method}", _is_known(method, scene)
            for metric, figure, is_judged, note in (
                ("count_exact_rate", exact, known, None if known else UNKNOWN_SCENE),
                ("centroid_rmse", error, False, UNKNOWN_POINTS),
            ):
                entries.append(
                    Entry(case, "scenes", method, metric, figure, note, is_judged=is_judged, world=scene)
                )
    return PublishedTable(
        name="clustering",
        title="Exact counts of targets and RMSE of their centroids in cells, by kind of scene",
        source="reference implementation of plot clustering by standard-deviation ellipse",
        set_name="range-doppler",
        trials=200,
        rounding=0.0,
        entries=tuple(entries),
    )


TABLES = (_table(),)
