"""Tables of clusters and of splits, and the picture of a scan."""

from __future__ import annotations

import io
import re

import numpy as np
import pytest
from rich.cells import cell_len
from rich.console import Console

from algorithms.clustering.modes import cluster
from algorithms.clustering.parameters import CorrectedPatent, Recommended
from algorithms.clustering.points import Points
from hough_tui.recorded.clustering import cluster_recording, document
from hough_tui.reports.charts import cluster_chart
from hough_tui.reports.clusters import cluster_table, step_table
from scenarios.files.point_files import PointRecording
from scenarios.files.set_files import load_set
from scenarios.range_doppler import draw_scene

EXTENTS = {"range_extent": 16.0, "doppler_extent": 12.0}
WIDTHS = (60, 80, 120, 160)


@pytest.fixture(scope="module")
def drawn():
    return draw_scene(load_set("range-doppler").scene("interference"), 5, 0, 2).points


def told(points, parameters):
    rows = np.arange(len(points), dtype=np.int64)
    recording = PointRecording(points, np.arange(points.scans, dtype=np.int64), rows)
    return document(cluster_recording(recording, parameters), with_steps=True)


def printed(table, width):
    console = Console(width=width, file=io.StringIO(), force_terminal=False)
    console.print(table)
    return console.file.getvalue()


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_and_no_line_is_too_long(drawn, width):
    found = told(drawn, Recommended(**EXTENTS))
    for table in (cluster_table(found, width), step_table(found, 1, width)):
        text = printed(table, width)
        assert "…" not in text
        assert max(cell_len(line) for line in text.splitlines()) <= width


def test_every_cluster_has_its_row(drawn):
    found = told(drawn, Recommended(**EXTENTS))
    text = printed(cluster_table(found, 160), 160)
    rows = [line.split() for line in text.splitlines() if re.match(r"\d+ +\d+ ", line)]
    assert len(rows) == len(found["clusters"])
    for row, one in zip(rows, found["clusters"], strict=True):
        assert int(row[1]) == one["scan"]
        assert [float(cell) for cell in row[2:4]] == pytest.approx([one["range"], one["doppler"]], abs=0.01)
        assert [int(cell) for cell in row[5:7]] == [len(one["members"]), len(one["kept"])]
        ellipse = one["ellipse"]
        sizes = [ellipse["chord"], *ellipse["widths"]]
        assert [float(cell) for cell in row[7:10]] == pytest.approx(sizes, abs=0.01)
        assert float(row[10]) == pytest.approx(ellipse["angle_deg"], abs=0.06)


def test_no_clusters():
    points = Points.of([1.0, 2.0], [1.0, 2.0], [1.0, 1.0])
    text = printed(cluster_table(told(points, Recommended(**EXTENTS)), 80), 80)
    assert "recommended · 0 clusters" in text
    assert "2 points, 1 scan, 2 of the points in no plot" in text


def test_branches_lead_to_every_step():
    r = np.array([0.0, 1.0, 50.0, 51.0, 200.0, 201.0, 300.0, 301.0])
    found = told(Points.of(r, np.zeros(8), np.ones(8)), CorrectedPatent(range_extent=16.0))
    text = printed(step_table(found, 0, 100), 100)
    branches = [re.match(r"(.*?\d+)  ", line).group(1) for line in text.splitlines()[3:]]
    assert branches == ["0", "├ 1", "│ ├ 2", "│ └ 3", "└ 4", "  ├ 5", "  └ 6"]
    assert "chord" in text
    assert "split in range at 138, gap 149" in text


def plain(text):
    return re.sub(r"\x1b\[[0-9;]*m", "", text)


@pytest.mark.parametrize(("width", "height"), [(66, 16), (80, 24), (160, 48)])
def test_a_picture_keeps_its_size(drawn, width, height):
    clusters = cluster(drawn, Recommended(**EXTENTS))
    text = cluster_chart(clusters, 1, 2.5, width, height, colour=False)
    lines = text.split("\n")
    assert "\x1b" not in text
    assert len(lines) <= height
    assert max(map(cell_len, lines)) <= width
    assert text.count("✚") == 2
    coloured = cluster_chart(clusters, 1, 2.5, width, height, colour=True)
    assert "\x1b" in coloured
    assert [line.rstrip() for line in plain(coloured).split("\n")] == lines


def test_a_picture_shows_where_plots_are():
    square = np.array([(0, 0), (0, 2), (2, 0), (2, 2)], float)
    place = np.concatenate([square, square + np.array([80, 40])])
    clusters = cluster(Points.of(*place.T, np.ones(8)), Recommended(**EXTENTS))
    lines = cluster_chart(clusters, 0, 2.5, 80, 24, colour=False).split("\n")
    at = {
        number: (row, line.index(f"✚{number}"))
        for row, line in enumerate(lines)
        for number in (0, 1)
        if f"✚{number}" in line
    }
    # Range to the right, Doppler upwards.
    assert at[0][1] < at[1][1]
    assert at[0][0] > at[1][0]


def test_a_picture_of_one_point_and_of_none():
    for r in ([5.0], []):
        clusters = cluster(Points.of(r, r, r), CorrectedPatent(range_extent=16.0))
        text = cluster_chart(clusters, 0, 1.414, 60, 20, colour=False)
        assert text.startswith(f"Doppler · {len(r)} point{'' if len(r) == 1 else 's'} · {len(r)} cluster")
        assert max(map(len, text.split("\n"))) <= 60


def test_ellipses_are_drawn_as_far_as_points_are_kept():
    # Far points keep both pictures on one scale.
    r, d = [0.0, 0.0, 8.0, 8.0, 30.0, -30.0], [0.0, 6.0, 0.0, 6.0, 30.0, -30.0]
    clusters = cluster(Points.of(r, d, np.ones(6)), Recommended(**EXTENTS))
    drawn = []
    for radius in (1.0, 2.5):
        title, *lines = cluster_chart(clusters, 0, radius, 80, 40, colour=False).split("\n")
        assert f"ellipses of {radius:.3g} σ" in title
        drawn.append(
            {(row, at) for row, line in enumerate(lines) for at, cell in enumerate(line) if cell == "·"}
        )
    inner, outer = ({row for row, _ in cells} for cells in drawn)
    assert min(outer) < min(inner) < max(inner) < max(outer)
    inner, outer = ({at for _, at in cells} for cells in drawn)
    assert min(outer) < min(inner) < max(inner) < max(outer)
