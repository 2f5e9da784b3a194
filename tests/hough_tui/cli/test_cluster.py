"""`hough-tui cluster`: the document, the tables, the CSV, the tree and the picture of recorded points."""

import csv
import io
import json
import math

import numpy as np
import pytest

from scenarios.files.set_files import load_set
from scenarios.range_doppler import draw_scene

EXTENTS = ("--range-extent", 16, "--doppler-extent", 12)
SQUARE = ((0, 0), (0, 2), (2, 0), (2, 2))


@pytest.fixture
def cli(cli, tmp_path, monkeypatch):
    """Run a command in a folder and at a width of its own."""
    monkeypatch.setenv("COLUMNS", "110")
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        status, out, err = cli(*arguments)
        return status, out, err.rstrip("\n")

    return run


@pytest.fixture
def clustered(cli, points):
    """Run `cluster --json`; return the document."""

    def run(*arguments: object) -> dict:
        status, out, err = cli("cluster", points, *EXTENTS, *arguments, "--json")
        assert status == 0, err
        return json.loads(out)

    return run


@pytest.fixture
def points(tmp_path):
    """Two scans in turn, each of two squares of four points 40 cells apart, and of a stray point."""
    rows = ["scan,range,doppler,amplitude"]
    for at, level in ((10, 1.0), (50, 3.0)):
        for r, d in SQUARE:
            rows += [f"{scan},{at + scan + r},{at + d},{level}" for scan in (7, 3)]
    rows += [f"{scan},90,-60,9" for scan in (7, 3)]
    path = tmp_path / "points.csv"
    path.write_text("\n".join(rows) + "\n")
    return path


def test_members_are_rows_of_the_file(clustered):
    told = clustered()
    assert (told["points"], told["scans"], told["mode"]) == (18, 2, "recommended")
    found = [(cluster["scan"], cluster["members"]) for cluster in told["clusters"]]
    assert found == [(3, [1, 3, 5, 7]), (3, [9, 11, 13, 15]), (7, [0, 2, 4, 6]), (7, [8, 10, 12, 14])]
    assert all(cluster["kept"] == cluster["members"] for cluster in told["clusters"])
    assert told["interference"] == [16, 17]
    first = told["clusters"][0]
    assert (first["range"], first["doppler"], first["amplitude"]) == (14.0, 11.0, 1.0)
    # A square of two cells: a variance of 1, and a twelfth for the cell.
    variance = 1.0 + 1.0 / 12.0
    ellipse = first["ellipse"]
    assert ellipse["centre"] == [14.0, 11.0]
    assert ellipse["coefficients"] == pytest.approx([2 * variance, 0.0, 2 * variance, -4 * variance**2])
    assert ellipse["chord"] == pytest.approx(np.sqrt(8.0 * variance))
    assert ellipse["widths"] == pytest.approx([np.sqrt(8.0 * variance)] * 2)
    assert told["parameters"]["radius"] == 2.5


def test_the_contract_of_the_document(clustered):
    for cluster in clustered()["clusters"]:
        assert {"scan", "members", "kept", "range", "doppler", "amplitude", "ellipse"} <= set(cluster)
        assert {"centre", "coefficients", "chord"} <= set(cluster["ellipse"])


def test_options_reach_the_clustering(clustered):
    strongest = clustered("--result", "strongest")
    assert [cluster["strongest"] for cluster in strongest["clusters"]] == [1, 9, 0, 8]
    assert [cluster["range"] for cluster in strongest["clusters"]] == [13.0, 53.0, 17.0, 57.0]
    assert len(clustered("--set", "least_points=1")["clusters"]) == 6
    assert len(clustered("--set", "least_points=5")["clusters"]) == 0
    assert len(clustered("--set", "range_extent=200", "--set", "doppler_extent=200")["clusters"]) == 2
    alone = clustered("--scan", 7)
    assert [cluster["members"] for cluster in alone["clusters"]] == [[0, 2, 4, 6], [8, 10, 12, 14]]
    assert alone["interference"] == [16]
    patent = clustered("--mode", "corrected-patent")
    # The stray point makes the ellipse of a square steep and its chord short, so it is not split off.
    assert [len(cluster["members"]) for cluster in patent["clusters"]] == [4, 5] * 2


@pytest.mark.parametrize("mode", ["dbscan", "k-means"])
def test_comparisons(clustered, mode):
    pytest.importorskip("sklearn")
    more = ("--set", "number=3") if mode == "k-means" else ()
    found = [cluster["members"] for cluster in clustered("--mode", mode, *more)["clusters"]]
    targets = [[1, 3, 5, 7], [9, 11, 13, 15], [0, 2, 4, 6], [8, 10, 12, 14]]
    # k-means, which must put the stray point somewhere, makes it a target.
    assert sorted(found) == sorted(targets + ([[16], [17]] if mode == "k-means" else []))


def test_steps_are_a_tree(clustered):
    told = clustered("--steps")
    steps = [step for step in told["steps"] if step["scan"] == 3]
    assert [step["step"] for step in steps] == list(range(5))
    assert sorted(steps[0]["points"]) == list(range(1, 18, 2))
    assert (steps[0]["axis"], steps[0]["gap"]) == ("doppler", 70.0)
    for step in steps:
        if step["parts"]:
            parts = [steps[part] for part in step["parts"]]
            assert all(part["parent"] == step["step"] for part in parts)
            assert sorted(part_row for part in parts for part_row in part["points"]) == step["points"]
    ended = {step["cluster"]: step["points"] for step in steps if step["verdict"] == "target"}
    assert ended == {index: told["clusters"][index]["members"] for index in (0, 1)}
    assert "steps" not in clustered()


def test_csv_holds_what_the_document_holds(cli, clustered, points, tmp_path):
    status, out, _ = cli("cluster", points, *EXTENTS, "--csv", "-")
    assert status == 0
    rows = list(csv.DictReader(io.StringIO(out)))
    told = clustered()["clusters"]
    for row, cluster in zip(rows, told, strict=True):
        assert {key: float(row[key]) for key in ("scan", "range", "doppler", "amplitude")} == {
            key: cluster[key] for key in ("scan", "range", "doppler", "amplitude")
        }
        assert (int(row["members"]), int(row["kept"])) == (len(cluster["members"]), len(cluster["kept"]))
    status, printed, _ = cli("cluster", points, *EXTENTS, "--csv", "plots.csv", "--json")
    assert status == 0
    assert (tmp_path / "plots.csv").read_text() == out
    assert json.loads(printed)["clusters"] == told


def test_plots_can_be_clustered_again(cli, points, tmp_path):
    """The CSV of plots is itself a file of points."""
    assert cli("cluster", points, *EXTENTS, "--csv", "plots.csv")[0] == 0
    status, out, _ = cli("cluster", "plots.csv", *EXTENTS, "--set", "least_points=1", "--json")
    assert status == 0
    assert [cluster["members"] for cluster in json.loads(out)["clusters"]] == [[0], [1], [2], [3]]


def test_tables_and_picture(cli, points):
    status, out, err = cli("cluster", points, *EXTENTS, "--steps", "--plot")
    assert status == 0
    assert err == "hough-tui: scan 3 is shown, the first of 2; see --scan"
    assert "recommended · 4 clusters" in out
    assert "18 points, 2 scans, 2 of the points in no plot" in out
    assert "splits of scan 3" in out
    assert "split in Doppler at -60, gap 70.0" in out
    assert "1 of at least 4 points" in out
    assert "Doppler · 9 points · 2 clusters · 1 left out · ellipses of 2.5 σ" in out
    assert out.count("✚") == 2
    assert "\x1b" not in out
    assert max(map(len, out.splitlines())) <= 110


def test_a_scan_is_shown_alone(cli, points):
    status, out, err = cli("cluster", points, *EXTENTS, "--steps", "--scan", 7)
    assert (status, err) == (0, "")
    assert "splits of scan 7" in out
    assert "9 points, 1 scan" in out


def test_many_scans_are_clustered_as_each_alone(cli, tmp_path):
    drawn = draw_scene(load_set("range-doppler").scene("close"), 3, 0, 5).points
    scan = np.repeat(np.arange(5), np.diff(drawn.offsets))
    rows = np.stack([scan, drawn.range, drawn.doppler, drawn.amplitude], axis=1)
    order = np.random.default_rng(1).permutation(len(rows))
    header = "scan,range,doppler,amplitude"
    np.savetxt(tmp_path / "all.csv", rows[order], delimiter=",", header=header, comments="")
    status, out, _ = cli("cluster", "all.csv", *EXTENTS, "--json")
    assert status == 0
    told = json.loads(out)["clusters"]
    assert [cluster["scan"] for cluster in told] == [0, 0, 1, 1, 2, 2, 3, 3, 4, 4]
    status, out, _ = cli("cluster", "all.csv", *EXTENTS, "--scan", 2, "--json")
    assert status == 0
    assert json.loads(out)["clusters"] == told[4:6]


def test_an_option_without_effect_is_told(cli, points):
    status, _, err = cli("cluster", points, *EXTENTS, "--mode", "corrected-patent")
    assert status == 0
    assert err == (
        "hough-tui: mode corrected-patent looks at the extent in range alone: --doppler-extent is not used"
    )


K_MEANS = ("--mode", "k-means", "--set")
REFUSED = [
    ((), "mode recommended needs --range-extent: the greatest extent D_r"),
    (("--range-extent", 16), "mode recommended needs --doppler-extent: the greatest extent D_d"),
    (("--range-extent", 0, "--doppler-extent", 12), "range_extent: 0.0 is given; it must be greater than 0"),
    (("--range-extent", 16, "--doppler-extent", -1), "doppler_extent: -1.0 is given; it must be greater"),
    (("--range-extent", "nan", "--doppler-extent", 1), "range_extent: nan is given; it must be a finite"),
    ((*EXTENTS, "--mode", "patent"), "--mode: there is no mode 'patent'"),
    ((*EXTENTS, "--set", "radios=2"), "there is no field 'radios'; did you mean 'radius'?"),
    ((*EXTENTS, "--set", "radius=0"), "mode recommended: radius: 0 is given; it must be greater than 0"),
    ((*EXTENTS, "--set", "mode=dbscan"), "--set mode: give --mode instead"),
    ((*EXTENTS, "--mode", "k-means"), "mode k-means needs --set number=N: the number of targets"),
    ((*EXTENTS, *K_MEANS, "number=10"), "scan 3: k-means is to find 10 targets among 9 different points"),
    ((*EXTENTS, "--scan", 5), "points.csv: scan 5 is asked for, which holds no points"),
    ((*EXTENTS, "--mode", "dbscan", "--steps"), "--steps: mode dbscan splits nothing"),
    ((*EXTENTS, "--json", "--plot"), "--json prints one document and nothing else"),
    ((*EXTENTS, "--json", "--csv", "-"), "--json and --csv - both print to standard output"),
    ((*EXTENTS, "--csv", "-", "--plot"), "--csv - prints nothing but CSV"),
    ((*EXTENTS, "--xy"), "--xy: the file has no column 'dwell'"),
    ((*EXTENTS, "--doppler-span", 0), "--doppler-span 0.0: it must be greater than 0"),
    ((*EXTENTS, "--doppler-span", 20), "must lie from -10 to 10, or from 0 to 20"),
]


@pytest.mark.parametrize(("options", "told"), REFUSED)
def test_a_wrong_request_is_refused(cli, points, options, told):
    if "k-means" in options:
        pytest.importorskip("sklearn")
    status, out, err = cli("cluster", points, *options)
    assert (status, out) == (2, "")
    assert told in err
    assert err.startswith("hough-tui: ")
    assert err.count("\n") == 0


def test_a_file_that_cannot_be_written_ends_with_1(cli, points):
    status, out, err = cli("cluster", points, *EXTENTS, "--csv", "none/plots.csv")
    assert (status, out, err) == (1, "", "hough-tui: none/plots.csv: No such file or directory")


def test_a_wrong_file_is_refused_with_its_place(cli, tmp_path):
    (tmp_path / "bad.csv").write_text("range,doppler,amplitude\n1,2,3\n4,nan,6\n")
    status, out, err = cli("cluster", "bad.csv", *EXTENTS)
    assert (status, out) == (2, "")
    assert err == (
        "hough-tui: bad.csv:3: column 'doppler': 'nan' is given; it must be a number from -1e+12 to 1e+12"
    )
    status, out, err = cli("cluster", "none.csv", *EXTENTS)
    assert (status, out) == (2, "")
    assert err == "hough-tui: none.csv: there is no such file"


def test_simulated_points_are_clustered_by_dwell_as_simulate_does_it(cli, tmp_path):
    options = ("range-doppler", "--trial", 3, "--seed", 2)
    status, _, said = cli("simulate", *options, "-o", "points.csv")
    assert status == 0
    assert "cells of 0.015 km and 0.001 km/s, from -0.2 to 0.2 km/s" in said
    cells = ("--set", "range_cell=0.015", "--set", "doppler_cell=0.001")
    extents = ("--range-extent", 0.24, "--doppler-extent", 0.012)
    status, out, _ = cli("cluster", "points.csv", *extents, *cells, "--json")
    assert status == 0
    document = json.loads(out)
    assert document["scans"] == 8
    _, plots, _ = cli("simulate", *options, "--clustering", "recommended")
    rows = list(csv.DictReader(io.StringIO(plots)))
    told = sorted(document["clusters"], key=lambda cluster: (cluster["scan"], cluster["dwell"]))
    assert [int(row["scan"]) for row in rows] == [cluster["scan"] for cluster in told]
    assert [float(row["doppler"]) for row in rows] == pytest.approx([cluster["doppler"] for cluster in told])
    for row, cluster in zip(rows, told, strict=True):
        azimuth = math.radians(cluster["dwell"])
        place = cluster["range"] * math.sin(azimuth), cluster["range"] * math.cos(azimuth)
        assert (float(row["x"]), float(row["y"])) == pytest.approx(place, abs=2e-3)
    # Both files are plots, too.
    for name, text in (("points.csv", None), ("plots.csv", plots)):
        if text is not None:
            (tmp_path / name).write_text(text)
        status, out, _ = cli("initiate", name, "--like", "range-doppler", "--json")
        assert status == 0
        assert json.loads(out)["scans"] == 8


def test_cells_that_are_not_given_are_those_of_the_points(cli, tmp_path):
    cli("simulate", "range-doppler", "-o", "simulated.csv")
    extents = ("--range-extent", 0.24, "--doppler-extent", 0.012)
    given = ("--set", "range_cell=0.015", "--set", "doppler_cell=0.001")
    _, out, _ = cli("cluster", "simulated.csv", *extents, *given, "--json")
    known = json.loads(out)
    status, out, err = cli("cluster", "simulated.csv", *extents, "--json")
    told = json.loads(out)
    assert status == 0
    assert len(told["clusters"]) == 16
    assert [found["members"] for found in told["clusters"]] == [
        found["members"] for found in known["clusters"]
    ]
    assert told["parameters"] == pytest.approx(known["parameters"])
    assert "range_cell is not given: 0.015 is taken, the step of the points" in err
    assert "doppler_cell is not given: 0.001 is taken, the step of the points" in err


def test_a_cell_wider_than_a_target_is_told(cli, tmp_path):
    cli("simulate", "range-doppler", "-o", "simulated.csv")
    extents = ("--range-extent", 0.24, "--doppler-extent", 0.012)
    _, _, err = cli("cluster", "simulated.csv", *extents, "--set", "range_cell=1")
    assert "range_cell 1 alone has an extent of 0.816, more than range_extent 0.24" in err
    assert "doppler_cell 1 " not in err


def test_tables_tell_small_sizes_apart(cli, tmp_path):
    cli("simulate", "range-doppler", "-o", "simulated.csv")
    status, out, _ = cli(
        *("cluster", "simulated.csv", "--scan", 0, "--range-extent", 0.24, "--doppler-extent", 0.012)
    )
    assert status == 0
    row = next(line.split() for line in out.splitlines() if line.startswith("0 "))
    assert row[3:5] == ["42.7027", "-0.18044"]
    assert row[8:11] == ["0.1049", "0.1088", "0.00482"]


@pytest.mark.parametrize("low", [-50, 0], ids=["about zero", "from zero on"])
def test_a_target_at_the_fold_of_doppler_is_one(cli, tmp_path, low):
    # Two by two points about the fold, and four more on the other side of the circle.
    dopplers = [low, low + 2, low + 98, low + 100 - 1e-9, *(low + d for d in (48, 50, 52, 54))]
    rows = [f"{10 + index % 2},{doppler},1" for index, doppler in enumerate(dopplers)]
    (tmp_path / "fold.csv").write_text("\n".join(["range,doppler,amplitude", *rows]) + "\n")
    status, out, err = cli("cluster", "fold.csv", *EXTENTS, "--doppler-span", 100, "--json")
    assert status == 0, err
    found = json.loads(out)["clusters"]
    assert sorted(cluster["members"] for cluster in found) == [[0, 1, 2, 3], [4, 5, 6, 7]]
    at_fold = next(cluster for cluster in found if 0 in cluster["members"])
    assert min(abs(at_fold["doppler"] - low), abs(at_fold["doppler"] - low - 100)) < 1e-6
    assert low <= at_fold["doppler"] <= low + 100
    _, out, _ = cli("cluster", "fold.csv", *EXTENTS, "--json")
    assert [cluster["members"] for cluster in json.loads(out)["clusters"]] == [[4, 5, 6, 7]]


def test_plots_with_their_places_are_what_initiators_take(cli, tmp_path):
    cli("simulate", "range-doppler", "-o", "simulated.csv")
    extents = ("--range-extent", 0.24, "--doppler-extent", 0.012)
    status, _, err = cli("cluster", "simulated.csv", *extents, "--xy", "--csv", "plots.csv")
    assert status == 0, err
    rows = list(csv.DictReader(io.StringIO((tmp_path / "plots.csv").read_text())))
    for row in rows:
        x, y = float(row["x"]), float(row["y"])
        assert math.hypot(x, y) == pytest.approx(float(row["range"]))
        assert math.degrees(math.atan2(x, y)) == pytest.approx(float(row["dwell"]))
    # Near the first target's path, from (-15, 40) by (0.25, -0.1) a second: a beam is 0.37 km wide there.
    first = [row for row in rows if float(row["dwell"]) < 0.0]
    for row in first:
        t = 4.0 * int(row["scan"])
        assert abs(float(row["x"]) - (-15.0 + 0.25 * t)) < 0.8
        assert abs(float(row["y"]) - (40.0 - 0.1 * t)) < 0.8
    status, out, err = cli("initiate", "plots.csv", "--like", "range-doppler", "--json")
    assert status == 0, err
    told = json.loads(out)
    assert told["plots"] == 16
    assert max(len(track["plots"]) for track in told["tracks"]) == 8


def test_plots_do_not_replace_their_points(cli, points):
    before = points.read_text()
    status, out, err = cli("cluster", points, *EXTENTS, "--csv", points)
    assert status == 2
    assert not out
    assert "this is the file of the points" in err
    assert points.read_text() == before


def test_the_dwell_of_the_most_points_is_shown(cli, tmp_path):
    lines = ["scan,dwell,range,doppler,amplitude", "0,10,5,5,1"]
    lines += [f"0,20,{r},{d},1" for r, d in SQUARE]
    lines += [f"0,30,{r},{d},1" for r, d in SQUARE[:3]]
    (tmp_path / "dwells.csv").write_text("\n".join(lines))
    status, out, said = cli("cluster", "dwells.csv", *EXTENTS, "--steps", "--plot")
    assert status == 0
    assert "dwell 20, that of the most points among 3" in said
    assert "splits of scan 0, dwell 20" in out
    assert "dwell" in out.splitlines()[1] or "dwell" in out.splitlines()[2]
    status, out, _ = cli("cluster", "dwells.csv", *EXTENTS, "--csv", "-")
    assert out.splitlines()[0].startswith("scan,dwell,range")
    assert len(out.splitlines()) == 2


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("range-doppler", "--clustering", "recomended"), ["did you mean 'recommended'", "ideal"]),
        (("range-doppler", "--clustering", "k-means"), ["no clustering 'k-means'"]),
        (
            ("par-table-2", "--scenario", "T1", "--clustering", "ideal"),
            ["T1", "no sensor of high resolution"],
        ),
    ],
)
def test_clusterings_that_simulate_cannot_use(cli, options, words):
    status, out, said = cli("simulate", *options)
    assert (status, out) == (2, "")
    for word in words:
        assert word in said
