from __future__ import annotations

import pytest

from algorithms.errors import RequestError
from scenarios.files.point_files import parse_points


def parse(text, only=None):
    return parse_points(text, "points.csv", only)


def test_scans_are_gathered_and_rows_are_remembered():
    text = "\ufeffDoppler, Range ,amplitude,scan,note\n1,2,3,7,a\n\n4,5,6,0,b\n7,8,9,7,c\n"
    found = parse(text)
    assert found.scans.tolist() == [0, 7]
    assert found.rows.tolist() == [1, 0, 2]
    assert found.points.offsets.tolist() == [0, 1, 3]
    assert found.points.range.tolist() == [5, 2, 8]
    assert found.points.doppler.tolist() == [4, 1, 7]
    assert found.points.amplitude.tolist() == [6, 3, 9]
    only = parse(text, 7)
    assert only.rows.tolist() == [0, 2]
    assert only.scans.tolist() == [7]
    assert only.points.range.tolist() == [2, 8]


def test_without_scans_all_points_are_of_scan_0():
    found = parse("range,doppler,amplitude\n1,2,3\n4,5,6\n")
    assert found.scans.tolist() == [0]
    assert found.points.offsets.tolist() == [0, 2]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "points.csv: the file is empty; it must have a header with range, doppler and amplitude"),
        ("range,doppler,amplitude\n", "points.csv: the file has a header and no rows of points below it"),
        ("range,doppler\n1,2\n",
         "points.csv:1: there is no column 'amplitude'; the header has 'range', 'doppler'"),
        ("range_m,doppler,amplitude\n1,2,3\n",
         "points.csv:1: there is no column 'range'; the header has 'range_m', 'doppler', 'amplitude'; "
         "rename 'range_m', if that is it"),
        ("range;doppler;amplitude\n1;2;3\n", "points.csv:1: the delimiter is ';'; it must be a comma"),
        ("range,doppler,amplitude\n1,2,3\n1,oops,3\n",
         "points.csv:3: column 'doppler': 'oops' is given; it must be a number"),
        ("range,doppler,amplitude\nnan,2,3\n",
         "points.csv:2: column 'range': 'nan' is given; it must be a number from -1e+12 to 1e+12"),
        ("range,doppler,amplitude\n1,2e12,3\n",
         "points.csv:2: column 'doppler': '2e12' is given; it must be a number from -1e+12 to 1e+12"),
        ("range,doppler,Amplitude\n1,2,-3\n",
         "points.csv:2: column 'Amplitude': '-3' is given; it must be a finite number, at least 0; "
         "amplitudes are linear, x dB are 10^(x/20)"),
        ("range,doppler,amplitude\n1_0,2,3\n",
         "points.csv:2: column 'range': '1_0' is given; it must be a number"),
        ("range,doppler,amplitude,scan\n1,2,3,1.5\n",
         "points.csv:2: column 'scan': '1.5' is given; it must be a whole number from 0 to 2147483647"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_place(text, message):
    with pytest.raises(RequestError) as caught:
        parse(text)
    assert str(caught.value) == message


def test_a_scan_without_points():
    with pytest.raises(RequestError, match=r"points.csv: scan 3 is asked for.*in 2 of the scans 1 to 8"):
        parse("scan,range,doppler,amplitude\n8,1,2,3\n1,1,2,3\n", 3)
