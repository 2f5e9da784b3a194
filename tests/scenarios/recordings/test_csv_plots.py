"""Recorded plots: what is read, what is assumed, what is refused and in which words."""

import csv
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.errors import RequestError
from algorithms.parameters import LARGEST
from algorithms.plots import PlotChunk
from scenarios.files.csv_tables import BLOCK
from scenarios.model import Scenario
from scenarios.recordings.csv_plots import (
    LATEST,
    Recording,
    parse_plots,
    read_plots,
    write_assigned,
    write_plots,
)
from scenarios.simulate import Draw, draw
from scenarios.world import World

FLIGHTS = Path(__file__).parents[3].parent / "shared" / "data" / "flights_paris_4s.csv"


def parse(text: str, **options) -> Recording:
    return parse_plots(text, "plots.csv", **options)


def refusal(text: str, **options) -> str:
    with pytest.raises(RequestError) as caught:
        parse(text, **options)
    message = str(caught.value)
    assert "\n" not in message
    return message


def scenario(targets: int = 2) -> Scenario:
    return Scenario.model_validate(
        {
            "name": "two",
            "scans": 15,
            "interval": 4,
            "region": {"x": [0, 100], "y": [0, 100]},
            "sensor": {"kind": "cartesian", "sigma": 0.1},
            "clutter": [{"kind": "poisson", "rate": 5}],
            "targets": [
                {"position": [40, 20], "velocity": [0.3, 0.18]},
                {"position": [20, 80], "velocity": [0.3, -0.18], "birth": 3},
            ][:targets],
        }
    )


def same_bits(one, other) -> bool:
    return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()


# Reading


def test_columns_land_where_they_belong():
    found = parse("scan,time,x,y,z,amplitude,doppler\n0,1.5,2,3,4,5,6\n1,2.5,-2,-3,-4,-5,-6\n")
    plots = found.plots
    assert plots.scan.dtype == np.int32
    assert plots.scan.tolist() == [0, 1]
    assert plots.time.tolist() == [1.5, 2.5]
    assert plots.position.tolist() == [[2, 3, 4], [-2, -3, -4]]
    assert plots.amplitude.tolist() == [5, -5]
    assert plots.doppler.tolist() == [6, -6]
    assert found.extra == {}
    assert found.interval == 1.0


def test_optional_columns_may_be_absent():
    plots = parse("scan,x,y\n0,1,2\n").plots
    assert plots.position.shape == (1, 2)
    assert plots.amplitude is None
    assert plots.doppler is None


@pytest.mark.parametrize(
    "text",
    [
        "\ufeffscan,x,y\n3,1,2\n",
        " Scan , X,y \n3.0, 1 ,2\n",
        "scan,x,y\r\n3,1,2\r\n",
        "scan,x,y\r3,1,2\r",
        "\n\nscan,x,y\n\n  \n3,1,2\n\n\n",
        '"scan","x","y"\n"3","1","2"',
        "y,x,scan\n2,1,3e0\n",
    ],
)
def test_layouts_that_mean_the_same(text):
    found = parse(text)
    assert found.plots.scan.tolist() == [3]
    assert found.plots.position.tolist() == [[1, 2]]
    assert found.rows.tolist() == [0]


def test_a_file_is_read_with_its_byte_order_mark(tmp_path):
    path = tmp_path / "plots.csv"
    path.write_bytes(b"\xef\xbb\xbfscan,x,y\r\n0,1,2\r\n")
    assert read_plots(path).plots.position.tolist() == [[1, 2]]
    with pytest.raises(RequestError, match=r"nowhere\.csv: there is no such file"):
        read_plots(tmp_path / "nowhere.csv")


def test_rows_are_sorted_by_scan_and_extra_columns_stay_in_file_order():
    found = parse('scan,x,y,Note,\n2,0,0,a,\n0,1,0," b,\n",\n2,2,0,é,\n0,3,0,,7\n')
    assert found.plots.scan.tolist() == [0, 0, 2, 2]
    assert found.plots.position[:, 0].tolist() == [1, 3, 0, 2]
    assert found.rows.tolist() == [1, 3, 0, 2]
    assert found.rows.dtype == np.int64
    assert found.extra == {"Note": ("a", " b,\n", "é", ""), "": ("", "", "", "7")}


def test_plots_of_a_scan_stay_in_the_order_of_the_file():
    scan = np.random.default_rng(5).integers(0, 3, 1000)
    found = parse("scan,x,y\n" + "".join(f"{number},{row},0\n" for row, number in enumerate(scan.tolist())))
    assert found.rows.tolist() == sorted(range(1000), key=lambda row: scan[row])
    assert found.plots.position[:, 0].tolist() == found.rows.tolist()


def test_times_at_their_bounds():
    text = "scan,time,x,y\n" + "".join(f"{scan},{sign}1e19,0,0\n" for scan in range(3) for sign in "-+")
    assert parse(text).assumed == {"interval": "1 s, as the times do not tell it"}


def test_scans_without_times():
    found = parse("scan,x,y\n0,0,0\n5,0,0\n")
    assert found.interval == 1.0
    assert found.plots.time.tolist() == [0, 5]
    assert found.assumed == {"interval": "1 s, as the file has no times", "time": "scan × 1 s"}
    found = parse("scan,x,y\n0,0,0\n5,0,0\n", interval=2.5)
    assert found.interval == 2.5
    assert found.plots.time.tolist() == [0, 12.5]
    assert found.assumed == {"time": "scan × 2.5 s"}


def test_times_without_scans_each_distinct_time_is_a_scan():
    found = parse("time,x,y\n14,0,0\n10,1,0\n14,2,0\n18,3,0\n30,4,0\n")
    assert found.plots.scan.tolist() == [0, 1, 1, 2, 3]
    assert found.rows.tolist() == [1, 0, 2, 3, 4]
    assert found.interval == 4.0
    assert found.assumed == {
        "scan": "each distinct time is a scan, 4 in all",
        "interval": "4 s, the median step of time",
    }


def test_times_without_scans_and_with_an_interval():
    found = parse("time,x,y\n14,0,0\n10,0,0\n13.999,0,0\n22,0,0\n", interval=4)
    assert found.plots.scan.tolist() == [0, 0, 1, 3]
    assert found.rows.tolist() == [1, 2, 0, 3]
    assert found.interval == 4.0
    assert found.assumed == {"scan": "each 4 s from the earliest time is a scan"}


@pytest.mark.parametrize("start", [0.0, 1.7e9])
def test_a_time_on_the_border_of_two_scans_belongs_to_the_later(start):
    times = [start + 0.1 * scan for scan in range(200)]  # 0.1 has no exact binary form
    text = "time,x,y\n" + "".join(f"{t!r},0,0\n" for t in times)
    assert parse(text, interval=0.1).plots.scan.tolist() == list(range(200))


def test_interval_from_scans_and_times():
    # Means 1, 5, (no scan 2), 13, 20 and steps 4, 8/2, 7.
    found = parse("scan,time,x,y\n0,0,0,0\n0,2,0,0\n1,5,0,0\n3,12,0,0\n3,14,0,0\n4,20,0,0\n")
    assert found.interval == 4.0
    assert found.assumed == {"interval": "4 s, the median step of time"}
    assert parse("scan,time,x,y\n0,0,0,0\n1,5,0,0\n", interval=7).interval == 7
    assert parse("scan,time,x,y\n0,0,0,0\n1,5,0,0\n", interval=7).assumed == {}


def test_equal_times_of_a_scan_leave_the_interval_exact():
    text = "scan,time,x,y\n" + "".join(f"{row // 3},{0.1 * (row // 3)!r},0,0\n" for row in range(6))
    assert parse(text).interval == 0.1


def test_an_interval_that_the_times_do_not_tell():
    found = parse("scan,time,x,y\n0,7,0,0\n0,8,0,0\n")
    assert found.interval == 1.0
    assert found.assumed == {"interval": "1 s, as the times do not tell it"}


def test_times_that_run_backwards_are_taken_and_said():
    found = parse("scan,time,x,y\n0,0,0,0\n1,4,0,0\n2,2,0,0\n3,6,0,0\n4,5,0,0\n5,9,0,0\n")
    assert found.plots.time.tolist() == [0, 4, 2, 6, 5, 9]
    assert found.interval == 4.0
    assert found.assumed["order"] == (
        "by scan, though time runs backwards from scan 1 to scan 2, the first of 2 such steps"
    )
    within = parse("scan,time,x,y\n0,1,0,0\n0,0,0,0\n1,5,0,0\n")
    assert "order" not in within.assumed
    assert within.plots.time.tolist() == [1, 0, 5]


def test_selected_scans_are_renumbered_and_nothing_else_changes():
    text = "scan,time,x,y,note\n9,90,0,0,a\n3,30,1,0,b\n5,50,2,0,c\n4,40,3,0,d\n6,60,4,0,e\n"
    found = parse(text, scans=(4, 6))
    assert found.plots.scan.tolist() == [0, 1]
    assert found.plots.scan.dtype == np.int32
    assert found.plots.time.tolist() == [40, 50]
    assert found.plots.position[:, 0].tolist() == [3, 2]
    assert found.rows.tolist() == [3, 2]
    assert found.extra["note"] == ("a", "b", "c", "d", "e")
    assert parse(text, scans=(0, 4)).plots.scan.tolist() == [3]
    assert parse("scan,x,y\n7,0,0\n", interval=2, scans=(5, 8)).plots.time.tolist() == [14]


@pytest.mark.parametrize("scans", [(10, 20), (4, 6), (5, 5), (9, 3), (-2, 30), (0, 3), (10**30, 10**31)])
def test_an_empty_selection_names_the_scans_of_the_file(scans):
    message = refusal("scan,x,y\n3,0,0\n3,0,0\n9,0,0\n", scans=scans)
    assert message.startswith(f"plots.csv: the scans from {scans[0]} up to, not including, {scans[1]} ")
    assert message.endswith("the file has plots in 2 of the scans 3 to 9")


# Refusals: each in one line, with its place


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "plots.csv: the file is empty; it must have a header with x, y and scan or time"),
        (" \n\n", "plots.csv: the file is empty; it must have a header with x, y and scan or time"),
        ("scan,x,y\n", "plots.csv: the file has a header and no rows of plots below it"),
        ("scan,x,y\n\n \n", "plots.csv: the file has a header and no rows of plots below it"),
        ("scan;x;y\n0;1;2\n", "plots.csv:1: the delimiter is ';'; it must be a comma"),
        ('\n"scan";"x";"y"\n0;1,5;2\n', "plots.csv:2: the delimiter is ';'; it must be a comma"),
        ("scan\tx\ty\n0\t1\t2\n", "plots.csv:1: the delimiter is a tab; it must be a comma"),
        ('""\n', "plots.csv:1: there is no column 'x' and no column 'y' and neither 'scan' nor 'time'; "
                 "the header has ''"),
        ("scan,x,lat\n0,1,2\n", "plots.csv:1: there is no column 'y'; the header has 'scan', 'x', 'lat'"),
        ("x,y\n1,2\n", "plots.csv:1: there is neither 'scan' nor 'time'; the header has 'x', 'y'"),
        ("Scans,x (km),Y_km\n1,2,3\n",
         "plots.csv:1: there is no column 'x' and no column 'y' and neither 'scan' nor 'time'; "
         "the header has 'Scans', 'x (km)', 'Y_km'; rename 'x (km)' and 'Y_km' and 'Scans', if that is it"),
        ("Scans;x (km);comma, here\n1,2,3\n", "plots.csv:1: the delimiter is ';'; it must be a comma"),
        ("scan,x,lat;lon\n1,2,3\n",
         "plots.csv:1: there is no column 'y'; the header has 'scan', 'x', 'lat;lon'"),
        ("scan,x,y,X\n0,1,2,3\n",
         "plots.csv:1: columns 2 and 4 are both called 'X'; names must differ, in more than case"),
        ("scan,x,y,,\n0,1,2,,\n",
         "plots.csv:1: columns 4 and 5 are both called ''; names must differ, in more than case"),
        ("scan,x,y\n0,1,2\n0,1\n", "plots.csv:3: the header has 3 columns, this row 2"),
        ("scan,x,y\n0,1,2\n\n0,1,5,2\n",
         "plots.csv:4: the header has 3 columns, this row 4; "
         "quote a text with a comma, write numbers with a point"),
        ('scan,x,y\n0,"1,2\n3,4,5\n',
         "plots.csv:2: the row that begins here cannot be read (unexpected end of data); a field that opens "
         "with a quote must end with one, and a quote inside it must be doubled"),
    ],
)  # fmt: skip
def test_a_file_of_another_shape(text, message):
    assert refusal(text) == message


BOUNDS = {
    **dict.fromkeys(("x", "Y", "z", "doppler"), "a number from -1e+12 to 1e+12"),
    "time": "a number from -1e+19 to 1e+19",
    "amplitude": "a finite number",
}


@pytest.mark.parametrize("name", BOUNDS)
@pytest.mark.parametrize(
    ("cell", "given", "allowed"),
    [
        ("abc", "'abc' is given", "a number"),
        ('"1,5"', "'1,5' is given", "a number with a decimal point"),
        ("", "nothing is given", "a number"),
        ("  ", "nothing is given", "a number"),
        ("nan", "'nan' is given", BOUNDS),
        ("-Infinity", "'-Infinity' is given", BOUNDS),
        ("1e999", "'1e999' is given", BOUNDS),
        ("1_2", "'1_2' is given", "a number"),
        ("0x10", "'0x10' is given", "a number"),
        ('"a\nb"', "'a\\nb' is given", "a number"),
        ("q" * 200, f"'{'q' * 39}…' is given", "a number"),
    ],
)
def test_a_cell_that_is_no_number(name, cell, given, allowed):
    names = ["scan", "time", "x", "Y", "z", "amplitude", "doppler"]
    cells = [cell if column == name else "1" for column in names]
    text = f"{','.join(names)}\n1,1,1,1,1,1,1\n{','.join(cells)}\n1,1,1,1,1,1,1\n"
    allowed = allowed if isinstance(allowed, str) else allowed[name]
    assert refusal(text) == f"plots.csv:3: column {name!r}: {given}; it must be {allowed}"


@pytest.mark.parametrize(
    ("name", "farthest"),
    [("x", "1e12"), ("y", "-1e12"), ("z", "1e12"), ("doppler", "-1e12"), ("time", "1e19")],
)
def test_numbers_up_to_the_bounds_are_read(name, farthest):
    cells = {"scan": "0", "x": "1", "y": "1", name: farthest}
    parse(f"{','.join(cells)}\n{','.join(cells.values())}\n")
    beyond = cells | {name: farthest.replace("1e", "1.001e")}
    assert f"plots.csv:2: column {name!r}" in refusal(f"{','.join(beyond)}\n{','.join(beyond.values())}\n")


@pytest.mark.parametrize("cell", ["1.5", "-1", "2147483648", "nan", "inf", "first", "1_2", "-0.5"])
def test_a_scan_that_is_no_scan(cell):
    assert refusal(f"scan,x,y\n0,1,2\n{cell},1,2\n") == (
        f"plots.csv:3: column 'scan': {cell!r} is given; it must be a whole number from 0 to 2147483647"
    )


def test_the_largest_scan():
    assert parse("scan,x,y\n2147483647,1,2\n").plots.scan.tolist() == [2**31 - 1]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_the_line_is_that_of_the_file_though_fields_span_several(end):
    rows = ["note,scan,x,y", '"two', 'lines",0,1,2', "", '"three', "", 'lines",0,1,2', "plain,0,oops,2"]
    assert refusal(end.join(rows)).startswith("plots.csv:8: column 'x': 'oops'")
    # The field's own line, where one before it in the row spans several.
    rows[-1:] = ['"two', 'lines",0,oops,2', ""]
    assert refusal(end.join(rows)).startswith("plots.csv:9: column 'x': 'oops'")
    # The first line of a row that has no field to point at.
    rows[-3:] = ['"two', 'lines",0,2', ""]
    assert refusal(end.join(rows)).startswith("plots.csv:8: the header has 4 columns")


@pytest.mark.parametrize("row", [0, BLOCK - 1, BLOCK, 3 * BLOCK + 7])
def test_the_line_of_a_fault_far_down(row):
    lines = ["scan,x,y", *["0,1,2"] * (4 * BLOCK)]
    for wrong in ("0,1,oops", "0,1"):
        lines[1 + row] = wrong
        assert refusal("\n".join(lines)).startswith(f"plots.csv:{row + 2}: ")


@pytest.mark.parametrize("interval", [0, -1, 1e-300, float("nan"), float("inf"), 1e10])
def test_an_interval_that_is_none(interval):
    message = refusal("scan,x,y\n0,1,2\n", interval=interval)
    assert message == f"interval: {interval:g} is given; it must be from 1e-12 s to 1e+09 s"


@pytest.mark.parametrize("last", ["3e9", "1e19"])
def test_an_interval_too_short_for_the_times(last):
    assert refusal(f"time,x,y\n-1e19,1,2\n{last},1,2\n", interval=1).endswith("give a longer interval")
    assert refusal(f"time,x,y\n0,1,2\n{last},1,2\n", interval=1).endswith(
        "span more than 2147483647 scans; give a longer interval"
    )


# Writing


def test_a_written_trial_has_its_truth():
    given = scenario()
    drawn = draw(World.of(given), 7, 3)
    text = write_plots(drawn)
    assert text.startswith("scan,time,x,y,target,true_x,true_y\n")
    assert "\r" not in text
    found = parse(text)
    plots = drawn.chunk.trial(0)
    assert same_bits(found.plots.scan, plots.scan)
    assert same_bits(found.plots.time, plots.time)
    assert same_bits(found.plots.position, plots.position)
    assert found.extra["target"] == tuple("" if cause < 0 else str(cause) for cause in drawn.origin)
    assert set(found.extra["target"]) == {"", "0", "1"}
    for row, target in enumerate(found.extra["target"]):
        true = (found.extra["true_x"][row], found.extra["true_y"][row])
        if not target:
            assert true == ("", "")
            continue
        elapsed = 4 * (int(plots.scan[row]) - (0, 3)[int(target)])
        start = np.array([(40, 20), (20, 80)][int(target)])
        speed = np.array([(0.3, 0.18), (0.3, -0.18)][int(target)])
        np.testing.assert_allclose(np.array(true, dtype=float), start + speed * elapsed, rtol=1e-14)
        assert np.abs(np.array(true, dtype=float) - plots.position[row]).max() < 1.0


def test_a_draw_without_targets_and_one_of_several_trials():
    given = scenario(targets=0)
    found = parse(write_plots(draw(World.of(given), 7, 0)))
    assert set(found.extra["target"]) == {""}
    with pytest.raises(ValueError, match="2 trials"):
        write_plots(draw(World.of(given), 7, 0, trials=2))


coordinate = st.floats(-LARGEST, LARGEST)
row = st.tuples(
    st.integers(0, 200), st.floats(-LATEST, LATEST), coordinate, coordinate, st.sampled_from([-1, 0, 1])
)


@given(st.lists(row, min_size=1, max_size=30))
@settings(deadline=None)
def test_written_plots_read_back_bit_for_bit(rows):
    rows.sort(key=lambda plot: plot[0])
    scan, times, x, y, origin = (np.array(column) for column in zip(*rows, strict=True))
    position = np.column_stack([x, y])
    chunk = PlotChunk(scan.astype(np.int32), times, position, np.array([0, len(rows)], dtype=np.int64))
    states = draw(World.of(scenario().model_copy(update={"scans": 201})), 7, 0).states
    found = parse(write_plots(Draw(chunk, origin.astype(np.int32), states)))
    assert same_bits(found.plots.scan, chunk.scan)
    assert same_bits(found.plots.time, times)
    assert same_bits(found.plots.position, position)
    assert found.rows.tolist() == list(range(len(rows)))
    assert found.extra["target"] == tuple("" if cause < 0 else str(cause) for cause in origin.tolist())
    assert 0.0 < found.interval < np.inf


def test_assigned_rows_keep_all_that_the_input_has():
    text = '\ufeffX, scan ,y,note\r\n1.50,2,0,"a, ""b"""\r\n\r\n2,0.0,0,\r\n3,1,0,c\r\n4,9,0,d\r\n'
    recording = parse(text, scans=(0, 3))
    assert recording.rows.tolist() == [1, 2, 0]
    tracks = [np.array([0, 2]), np.array([], dtype=np.int64), np.array([2])]
    assert write_assigned(text, recording, tracks) == (
        'X, scan ,y,note,track\n1.50,2,0,"a, ""b""",0;2\n2,0.0,0,,0\n3,1,0,c,\n4,9,0,d,\n'
    )


def test_a_track_column_of_the_input_is_kept_under_another_name():
    text = "scan,x,y, Track ,input_track\n0,1,2,mine,older\n"
    assert write_assigned(text, parse(text), [np.array([0])]) == (
        "scan,x,y,input_track0,input_track,track\n0,1,2,mine,older,0\n"
    )
    text = "scan,x,y,track\n0,1,2,mine\n"
    assert parse(write_assigned(text, parse(text), [])).extra == {"input_track": ("mine",), "track": ("",)}


@given(st.lists(st.text(max_size=8), min_size=1, max_size=8), st.sampled_from(["\n", "\r\n", "\r"]))
@settings(deadline=None)
def test_text_of_any_kind_is_carried_along(notes, end):
    file = io.StringIO()
    writer = csv.writer(file, quoting=csv.QUOTE_ALL, lineterminator=end)
    writer.writerows([["scan", "x", "y", "note"], *([3, 1, 2, note] for note in notes)])
    recording = parse(file.getvalue())
    assert recording.extra == {"note": tuple(notes)}
    again = parse(write_assigned(file.getvalue(), recording, [recording.rows]))
    assert again.extra == {"note": tuple(notes), "track": ("0",) * len(notes)}


# Size, and a real file


def test_a_million_rows():
    count = 10**6
    x = np.random.default_rng(1).normal(size=count)
    lines = (
        f"{row // 1000},{row // 1000 * 4.0!r},{value!r},1.25,n\n" for row, value in enumerate(x.tolist())
    )
    found = parse("scan,time,x,y,note\n" + "".join(lines))
    assert same_bits(found.plots.position[:, 0].copy(), x)
    assert found.plots.scan[-1] == 999
    assert len(found.extra["note"]) == count
    assert found.interval == 4.0


@pytest.mark.skipif(not FLIGHTS.exists(), reason=f"the recorded flights are not there: {FLIGHTS}")
def test_real_flights():
    found = read_plots(FLIGHTS)
    assert len(found.plots) == 5196
    assert found.plots.position.shape == (5196, 3)
    assert len(set(found.extra["target"])) == 43
    assert found.interval == 4.0
    assert found.assumed == {"interval": "4 s, the median step of time"}
    assert (np.diff(found.plots.scan) >= 0).all()
