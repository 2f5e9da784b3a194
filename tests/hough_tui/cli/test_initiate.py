"""`hough-tui initiate`: simulated plots, real flights, and a million plots."""

import csv
import io
import json
import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

PROJECT = Path(__file__).parents[3]
FLIGHTS = PROJECT.parent / "shared" / "data" / "flights_paris_4s.csv"

GRID = ("grid.theta_bins=90", "grid.rho_min=-150", "grid.rho_step=0.6", "grid.rho_bins=1000")
LIKE = ["--like", "course-report:two-crossing", "--initiator", "standard"]
LIKE += [part for value in GRID for part in ("--set", value)]

TARGETS = {0: ((40.0, 20.0), (0.3, 0.18)), 1: ((20.0, 80.0), (0.3, -0.18))}


@pytest.fixture
def document(cli):
    """Run `initiate --json`; return the document."""

    def run(*arguments: object) -> dict:
        status, out, err = cli("initiate", *arguments, "--json")
        assert status == 0, err
        return json.loads(out)

    return run


@pytest.fixture
def simulated(cli, tmp_path):
    """The plots of a trial of the course report's scene."""
    path = tmp_path / "plots.csv"
    status, text, _ = cli("simulate", "course-report", "--scenario", "two-crossing", "--trial", 3)
    assert status == 0
    path.write_text(text)
    return path


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def shuffled(text: str, seed: int) -> tuple[str, list[int]]:
    """Return a CSV text with its rows in another order, and which row each of them was."""
    header, *rows = text.splitlines()
    order = np.random.default_rng(seed).permutation(len(rows)).tolist()
    return "\n".join([header, *(rows[row] for row in order)]) + "\n", order


def test_the_document_has_the_form_that_scripts_rely_on(document, simulated):
    found = document(simulated, *LIKE)
    plots = rows_of(simulated.read_text())
    assert found["initiator"] == "standard"
    assert found["plots"] == len(plots)
    assert found["scans"] == 15
    assert 0 < found["seconds"] < 10
    assert found["parameters"]["grid"]["theta_bins"] == 90
    assert found["parameters"]["grid"]["rho_step"] == 0.6
    assert found["parameters"]["votes"] == 15
    assert found["accumulator"].keys() >= {
        "theta_bins", "rho_bins", "rho_min", "rho_step", "votes", "votes_outside", "max", "argmax",
    }  # fmt: skip
    accumulator = found["accumulator"]
    assert (accumulator["theta_bins"], accumulator["rho_bins"]) == (90, 1000)
    assert (accumulator["rho_min"], accumulator["rho_step"]) == (-150.0, 0.6)
    assert accumulator["votes"] + accumulator["votes_outside"] == 90 * len(plots)
    assert len(found["tracks"]) == found["tracks_total"] > 0
    scores = [track["score"] for track in found["tracks"]]
    assert scores == sorted(scores, reverse=True)
    assert scores[0] == accumulator["max"]
    row, column = accumulator["argmax"]
    # The strongest cells, one of which is the greatest that the accumulator names.
    cells = {(round(track["theta_deg"] / 2 - 0.5), track["score"]) for track in found["tracks"]}
    assert (row, accumulator["max"]) in cells
    assert 0 <= column < 1000
    for track in found["tracks"]:
        assert track.keys() >= {"theta_deg", "rho", "score", "plots", "position", "velocity", "time"}
        assert 0 <= track["theta_deg"] < 180
        # The line is the centre of a cell.
        assert (track["theta_deg"] - 1) % 2 == pytest.approx(0, abs=1e-9)
        assert (track["rho"] + 150) / 0.6 % 1 == pytest.approx(0.5, abs=1e-6)
        scans = [int(plots[plot]["scan"]) for plot in track["plots"]]
        assert scans == sorted(set(scans))
        assert (track["first_scan"], track["confirmed_scan"]) == (scans[0], 14)
        assert track["time"] == float(plots[track["plots"][0]]["time"])
        covariance = np.array(track["covariance"], dtype=float)
        assert covariance.shape == ((4, 4) if len(scans) > 1 else ())
        if len(scans) > 1:
            assert np.linalg.eigvalsh(covariance).min() > 0


def test_csv_gives_the_states_of_the_document(cli, document, simulated, tmp_path):
    tracks = document(simulated, *LIKE)["tracks"]
    path = tmp_path / "tracks.csv"
    assert cli("initiate", simulated, *LIKE, "--csv", path)[0] == 0
    status, out, _ = cli("initiate", simulated, *LIKE, "--csv", "-")
    assert (status, out) == (0, path.read_text())
    rows = rows_of(out)
    assert len(rows) == len(tracks) > 0
    names = ("x", "y", "vx", "vy")
    for row, track in zip(rows, tracks, strict=True):
        assert [float(row[f"position.{axis}"]) for axis in range(2)] == track["position"]
        assert [float(row[f"velocity.{axis}"]) for axis in range(2)] == track["velocity"]
        assert (float(row["time"]), int(row["first_scan"])) == (track["time"], track["first_scan"])
        for i, j in ((0, 0), (0, 2), (1, 3), (3, 3)):
            assert float(row[f"covariance.{names[i]}.{names[j]}"]) == track["covariance"][i][j]
    status, out, err = cli("initiate", simulated, "--csv", "-", "--json")
    assert (status, out) == (2, "")
    assert "--json prints one document and nothing else" in err


@pytest.mark.parametrize("order", ["as simulated", "shuffled"])
def test_both_targets_are_among_the_tracks(document, simulated, order):
    if order == "shuffled":
        simulated.write_text(shuffled(simulated.read_text(), 5)[0])
    plots = rows_of(simulated.read_text())
    found = document(simulated, *LIKE)
    for target, (position, velocity) in TARGETS.items():
        own = {row for row, plot in enumerate(plots) if plot["target"] == str(target)}
        assert len(own) == 15
        best = max(found["tracks"], key=lambda track: len(own & set(track["plots"])))
        # The rows are those of the file: who takes others finds hardly any of the target's own.
        assert len(own & set(best["plots"])) >= 13
        np.testing.assert_allclose(best["position"], position, atol=0.3)
        np.testing.assert_allclose(best["velocity"], velocity, atol=0.01)
        # The line of that state, in normal form.
        theta = math.radians(best["fitted_theta_deg"])
        x, y = best["position"]
        assert x * math.cos(theta) + y * math.sin(theta) == pytest.approx(best["fitted_rho"], abs=1e-9)
        vx, vy = best["velocity"]
        assert vx * math.cos(theta) + vy * math.sin(theta) == pytest.approx(0, abs=1e-12)


def test_the_order_of_the_rows_changes_nothing_but_their_numbers(document, simulated):
    before = document(simulated, *LIKE)["tracks"]
    text, order = shuffled(simulated.read_text(), 9)
    simulated.write_text(text)
    after = document(simulated, *LIKE)["tracks"]

    def told(tracks, row):
        return sorted(
            (t["theta_deg"], t["rho"], t["score"], [row(plot) for plot in t["plots"]]) for t in tracks
        )

    assert told(after, order.__getitem__) == told(before, int)


def test_a_pipe_from_simulate(tmp_path, simulated, document):
    command = [sys.executable, "-c", "from hough_tui.cli import main; main()"]
    simulating = [*command, "simulate", "course-report", "--scenario", "two-crossing", "--trial", "3"]
    with subprocess.Popen(simulating, stdout=subprocess.PIPE, cwd=PROJECT) as writer:
        reading = [*command, "initiate", "/dev/stdin", *LIKE, "--json"]
        reader = subprocess.run(reading, stdin=writer.stdout, capture_output=True, text=True, cwd=PROJECT)
    assert reader.returncode == 0, reader.stderr
    piped, read = json.loads(reader.stdout), document(simulated, *LIKE)
    del piped["seconds"], read["seconds"]
    assert piped == read


def test_the_accumulator_file_holds_what_a_histogram_counts(document, simulated, tmp_path):
    path = tmp_path / "votes.npz"
    found = document(simulated, *LIKE, "--accumulator", path)["accumulator"]
    with np.load(path, allow_pickle=False) as archive:
        votes, theta, rho = archive["votes"], archive["theta"], archive["rho"]
    np.testing.assert_allclose(theta, (np.arange(90) + 0.5) * np.pi / 90, rtol=1e-14)
    np.testing.assert_allclose(rho, -150 + (np.arange(1000) + 0.5) * 0.6, rtol=1e-12)
    place = np.array([(float(plot["x"]), float(plot["y"])) for plot in rows_of(simulated.read_text())])
    edges = -150 + 0.6 * np.arange(1001)
    counted = [np.histogram(place @ (math.cos(angle), math.sin(angle)), edges)[0] for angle in theta]
    np.testing.assert_array_equal(votes, counted)
    assert votes.sum() == found["votes"]
    assert votes.max() == found["max"] == votes[tuple(found["argmax"])]


def test_the_accumulator_file_of_weighted_votes_holds_deviations_too(cli, simulated, tmp_path):
    path = tmp_path / "weighted.npz"
    status, _, _ = cli("initiate", simulated, *LIKE, "--initiator", "weighted", "--accumulator", path)
    assert status == 0
    with np.load(path, allow_pickle=False) as archive:
        assert set(archive) == {"votes", "theta", "rho", "std", "weighted"}
        votes, std, weighted = archive["votes"], archive["std"], archive["weighted"]
    assert std.shape == weighted.shape == votes.shape
    known = np.isfinite(std)
    assert known.any()
    assert (weighted[~known] == 0).all()
    assert (weighted <= votes).all()


def test_votes_outside_the_grid_are_counted_and_said(cli, simulated):
    narrow = ["grid.theta_bins=90", "grid.rho_min=-10", "grid.rho_step=0.5", "grid.rho_bins=100"]
    status, out, err = cli("initiate", simulated, *[p for v in narrow for p in ("--set", v)], "--json")
    assert status == 0
    place = np.array([(float(plot["x"]), float(plot["y"])) for plot in rows_of(simulated.read_text())])
    theta = (np.arange(90) + 0.5) * np.pi / 90
    rho = place @ np.stack([np.cos(theta), np.sin(theta)])
    outside = int(((rho < -10) | (rho >= 40)).sum())
    found = json.loads(out)
    assert outside > 0
    assert found["accumulator"]["votes_outside"] == outside
    assert found["accumulator"]["votes"] == rho.size - outside
    assert f"{outside:,} of {rho.size:,} votes fell outside the grid" in err


def test_the_assigned_file_is_the_input_with_the_tracks_of_each_row(document, simulated, tmp_path):
    simulated.write_text(shuffled(simulated.read_text(), 2)[0])
    path = tmp_path / "assigned.csv"
    found = document(simulated, *LIKE, "--assigned", path)
    given, assigned = rows_of(simulated.read_text()), rows_of(path.read_text())
    tracks = [row.pop("track") for row in assigned]
    assert assigned == given
    expected = [[] for _ in given]
    for number, track in enumerate(found["tracks"]):
        for plot in track["plots"]:
            expected[plot].append(str(number))
    assert tracks == [";".join(numbers) for numbers in expected]
    assert any(tracks)


def test_a_column_z_is_ignored_and_said(cli, tmp_path):
    path = tmp_path / "plots.csv"
    path.write_text("scan,x,y,z\n" + "".join(f"{scan},{scan},0,{scan * 9}\n" for scan in range(4)))
    status, out, err = cli("initiate", path, "--sigma", 0.1, "--set", "votes=4", "--json")
    assert status == 0
    assert "hough-tui: standard works in the plane: the column z is ignored\n" in err
    assert any(track["plots"] == [0, 1, 2, 3] for track in json.loads(out)["tracks"])


@pytest.fixture
def approach(cli, tmp_path):
    """The plots of a trial of the precision approach radar's scene, with the targets they come from."""
    path = tmp_path / "approach.csv"
    assert cli("simulate", "par-table-2", "--scenario", "together", "-o", path)[0] == 0
    return path


@pytest.mark.parametrize("name", ["combinatorial-3d", "hough-logic-3d", "hough-3d"])
def test_plots_in_space(cli, approach, name):
    status, out, err = cli("initiate", approach, "-i", name, "--like", "par-table-2:together", "--json")
    assert status == 0
    assert "ignored" not in err
    found, rows = json.loads(out), rows_of(approach.read_text())
    assert set(rows[0]) == {"scan", "time", "x", "y", "z", "target", "true_x", "true_y", "true_z"}
    own = {tuple({rows[plot]["target"] for plot in track["plots"]}) for track in found["tracks"]}
    assert own == {("0",), ("1",), ("2",), ("3",), ("4",)}
    assert found["notes"] == []
    assert found["effort"]["pairs"] > 50 * found["effort"]["pairs_gated"] > 0
    for track in found["tracks"]:
        assert len(track["position"]) == len(track["velocity"]) == 3
        first = rows[track["plots"][0]]
        assert math.dist(track["position"], [float(first[f"true_{axis}"]) for axis in "xyz"]) < 400.0
    table = cli("initiate", approach, "-i", name, "--like", "par-table-2:together")[1]
    assert f"Counted: pairs {found['effort']['pairs']:,}, pairs gated " in table


def test_the_noise_of_plots_in_space_is_that_of_the_sensor_unless_sigma_is_given(document, cli, approach):
    given = ("-i", "combinatorial-3d", "--unit", "m", "--set", "plots=4")
    alike = document(approach, *given, "--like", "par-table-2:together")
    assert len(alike["tracks"]) == 5
    # So little noise that no fit passes; it goes before that of the scenario.
    assert document(approach, *given, "--like", "par-table-2:together", "--sigma", 1)["tracks"] == []
    assert len(document(approach, *given, "--sigma", 100)["tracks"]) >= 4
    status, _, err = cli("initiate", approach, *given)
    assert (status, err) == (
        2,
        "hough-tui: the noise is not known: give sigma, or plots of a sensor with known noise\n",
    )


def test_several_sensors_lend_the_greatest_of_their_noise(cli, approach, tmp_path):
    path = tmp_path / "two.yaml"
    radar = (
        "{kind: polar, sigma_range: 50, sigma_azimuth_deg: .3, sigma_elevation_deg: .2, range: [1e3, 4e4]}"
    )
    path.write_text(
        "name: two\nscenarios:\n"
        f"  - {{name: both, unit: m, scans: 4, interval: 1, sensor: {radar}, further_sensors: [{radar}]}}\n"
    )
    status, out, _ = cli("initiate", approach, "-i", "combinatorial-3d", "--like", path, "--json")
    assert status == 0
    assert json.loads(out)["assumed"]["sigma"].startswith("the greatest of the sensors on each axis")


@pytest.mark.parametrize("name", ["combinatorial-3d", "hough-logic-3d", "hough-3d"])
def test_a_vertical_track_has_no_line_in_the_plane(document, cli, tmp_path, name):
    path = tmp_path / "climb.csv"
    path.write_text("scan,x,y,z\n" + "".join(f"{scan},3000,4000,{3000 + 100 * scan}\n" for scan in range(4)))
    given = (path, "-i", name, "--unit", "m", "--sigma", 10)
    (track,) = document(*given)["tracks"]
    assert (track["theta_deg"], track["rho"], track["fitted_theta_deg"], track["fitted_rho"]) == (None,) * 4
    np.testing.assert_allclose(track["velocity"], (0, 0, 100), atol=1e-9)
    status, out, _ = cli("initiate", *given, "--plot")
    assert status == 0
    assert "1 track" in out


def test_an_initiator_in_space_needs_z(cli, simulated):
    status, out, err = cli("initiate", simulated, "-i", "combinatorial-3d", "--sigma", 0.1)
    assert (status, out) == (2, "")
    assert "combinatorial-3d works in space, and the plots have no z; give a column z" in err


def test_a_track_of_one_plot_has_no_velocity(document, tmp_path):
    path = tmp_path / "plots.csv"
    path.write_text("scan,x,y\n0,5,5\n")
    given = ("--region", "0,10,0,10", "--sigma", "0.1", "--set", "votes=1")
    found = document(path, *given)
    assert found["tracks"]
    for track in found["tracks"]:
        assert track["plots"] == [0]
        assert track["velocity"] is track["covariance"] is None
        assert track["fitted_theta_deg"] is None


def test_what_was_assumed_is_said_and_what_is_given_is_not(cli, tmp_path):
    path = tmp_path / "plots.csv"
    path.write_text("scan,x,y\n" + "".join(f"{scan},{scan},{2 * scan}\n" for scan in range(4)))
    status, out, err = cli("initiate", path, "--json")
    assert status == 0
    assumed = json.loads(out)["assumed"]
    assert assumed.keys() == {"interval", "time", "region", "detection_probability", "unit", "sigma"}
    for field, value in assumed.items():
        assert f"hough-tui: assumed {field}: {value}\n" in err
    given = ("--interval", 2, "--sigma", 0.1, "--pd", 0.9, "--unit", "m", "--region", "0,10,-5,5")
    status, out, _ = cli("initiate", path, *given, "--json")
    assert status == 0
    found = json.loads(out)
    assert found["assumed"].keys() == {"time"}
    assert found["unit"] == "m"
    track = found["tracks"][0]
    np.testing.assert_allclose(track["velocity"], (0.5, 1.0), atol=1e-9)


def test_the_config_is_read_and_set_goes_before_it(document, simulated, tmp_path):
    config = tmp_path / "initiator.yaml"
    config.write_text("name: standard\nvotes: 12\ngrid: {theta_bins: 45}\n")
    found = document(simulated, "--like", "course-report:two-crossing", "--config", config)
    assert (found["parameters"]["votes"], found["parameters"]["grid"]["theta_bins"]) == (12, 45)
    given = ("--config", config, "--set", "votes=14", "--set", "grid.theta_offset=0")
    found = document(simulated, "--like", "course-report:two-crossing", *given)
    assert found["parameters"]["votes"] == 14
    assert found["parameters"]["grid"]["theta_bins"] == 45
    assert found["parameters"]["grid"]["theta_offset"] == 0


def test_selected_scans_keep_the_rows_of_the_file(document, simulated):
    found = document(simulated, *LIKE, "--scans", "5:10")
    plots = rows_of(simulated.read_text())
    chosen = {row for row, plot in enumerate(plots) if 5 <= int(plot["scan"]) < 10}
    assert found["scans"] == 5
    assert found["plots"] == len(chosen)
    assert found["tracks"]
    assert all(set(track["plots"]) <= chosen for track in found["tracks"])
    for track in found["tracks"]:
        assert track["time"] == float(plots[track["plots"][0]]["time"])


def test_the_most_tracks_are_the_strongest(cli, document, simulated):
    every = document(simulated, *LIKE, "--set", "votes=12")
    assert every["tracks_total"] > 5
    status, out, err = cli("initiate", simulated, *LIKE, "--set", "votes=12", "--most", 5, "--json")
    assert status == 0
    found = json.loads(out)
    assert found["tracks"] == every["tracks"][:5]
    assert found["tracks_total"] == every["tracks_total"]
    assert f"{every['tracks_total']:,} tracks were found; the 5 strongest are given" in err


def test_tables_and_pictures_have_no_colour_where_there_is_no_terminal(cli, simulated):
    status, out, err = cli("initiate", simulated, *LIKE, "--plot")
    assert status == 0
    assert "standard" in out
    assert "\x1b" not in out + err


def test_a_million_plots(document, tmp_path):
    count, bins = 10**6, 30
    random = np.random.default_rng(1)
    place = random.uniform(0.0, 100.0, (count, 2))
    scan = np.sort(random.integers(0, 15, count))
    path = tmp_path / "plots.csv"
    with path.open("w") as file:
        file.write("scan,x,y\n")
        rows = zip(scan.tolist(), place.tolist(), strict=True)
        file.writelines(f"{number},{x!r},{y!r}\n" for number, (x, y) in rows)
    grid = (f"grid.theta_bins={bins}", "grid.rho_min=-50", "grid.rho_step=0.5", "grid.rho_bins=200")
    began = time.perf_counter()
    found = document(path, "--initiator", "sequential", *[p for v in grid for p in ("--set", v)])
    assert time.perf_counter() - began < 20
    assert found["plots"] == count
    assert found["scans"] == 15
    accumulator = found["accumulator"]
    assert accumulator["votes_outside"] > 0
    assert accumulator["votes"] == count * bins - accumulator["votes_outside"]
    assert len(found["tracks"]) == 2
    assert found["tracks"][0]["score"] == accumulator["max"]


# Real flights, made into radar plots


@pytest.fixture(scope="module")
def flights():
    if not FLIGHTS.exists():
        pytest.skip("the recorded flights, ../shared/data/flights_paris_4s.csv, are not there")
    table = np.loadtxt(FLIGHTS, delimiter=",", skiprows=1)
    return {name: table[:, column] for column, name in enumerate(("scan", "time", "x", "y", "z", "target"))}


WEST, EAST, SOUTH, NORTH = -120_000.0, 110_000.0, -145_000.0, 110_000.0
NOISE, CLUTTER, SCANS = 50.0, 50, 15


def straight_flights(flights, first):
    """Return the velocities of the flights that are straight and alone in a window of scans.

    Straight: within 60 m of constant velocity, faster than 50 m/s, there in every scan. Alone:
    no other flight comes within 3 km of where it is at any time of the window.
    """
    window = (flights["scan"] >= first) & (flights["scan"] < first + SCANS)
    place = np.stack([flights["x"], flights["y"]], axis=1)
    found = {}
    for target in np.unique(flights["target"][window]).astype(int):
        own = window & (flights["target"] == target)
        if own.sum() < SCANS:
            continue
        elapsed = flights["time"][own] - flights["time"][own].min()
        model = np.stack([np.ones(SCANS), elapsed], axis=1)
        state = np.linalg.lstsq(model, place[own], rcond=None)[0]
        residual = np.linalg.norm(place[own] - model @ state, axis=1).max()
        others = place[window & (flights["target"] != target)]
        nearest = np.linalg.norm(place[own][:, None] - others[None], axis=2).min()
        if residual < 60 and np.linalg.norm(state[1]) > 50 and nearest > 3000:
            found[target] = state[1]
    return found


def radar_plots(flights, first, seed):
    """Return CSV of a window with noise and clutter, its rows in any order, and each row's flight."""
    random = np.random.default_rng(seed)
    window = (flights["scan"] >= first) & (flights["scan"] < first + SCANS)
    count, clutter = int(window.sum()), CLUTTER * SCANS
    scan = np.concatenate([flights["scan"][window], np.repeat(np.arange(first, first + SCANS), CLUTTER)])
    x = flights["x"][window] + random.normal(0, NOISE, count)
    y = flights["y"][window] + random.normal(0, NOISE, count)
    x = np.concatenate([x, random.uniform(WEST, EAST, clutter)])
    y = np.concatenate([y, random.uniform(SOUTH, NORTH, clutter)])
    flight = np.concatenate([flights["target"][window], np.full(clutter, -1)]).astype(int)
    order = random.permutation(count + clutter)
    columns = (column[order].tolist() for column in (scan.astype(int), 4 * scan, x, y))
    rows = "".join(",".join(map(repr, row)) + "\n" for row in zip(*columns, strict=True))
    return "scan,time,x,y\n" + rows, flight[order]


@pytest.mark.parametrize(("first", "least"), [(0, 6), (15, 7), (30, 7)])
def test_straight_flights_are_found_among_clutter(document, flights, tmp_path, first, least):
    straight = straight_flights(flights, first)
    assert len(straight) >= least
    text, flight = radar_plots(flights, first, seed=20)
    path = tmp_path / "radar.csv"
    path.write_text(text)
    found = document(
        path, "--initiator", "standard", "--set", "fraction=0.6", "--scans", f"{first}:{first + SCANS}",
        "--unit", "m", "--sigma", NOISE, "--pd", 1, f"--region={WEST},{EAST},{SOUTH},{NORTH}",
    )  # fmt: skip
    # Far fewer tracks than cells, or finding them means nothing.
    assert found["tracks_total"] < 1000
    for target, velocity in straight.items():
        tracks = [
            track
            for track in found["tracks"]
            if track["velocity"] is not None
            # Noise of 50 m leaves 0.75 m/s over 15 scans of 4 s; the flight's own bends add to it.
            and np.linalg.norm(np.subtract(track["velocity"], velocity)) < 4
            and np.mean(flight[track["plots"]] == target) >= 0.8
            and len(track["plots"]) >= 12
        ]
        assert tracks, f"flight {target}"
