from __future__ import annotations

import pytest

from hough_tui.reports.layout import broken, enumerated
from hough_tui.reports.numerals import (
    aligned,
    as_given,
    durations,
    fixed,
    intervals,
    number,
    percent,
    significant,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (4.1, "4.10"),
        (9.996, "10.0"),
        (164.137, "164"),
        (12345.6, "12,346"),
        (0.0065, "0.0065"),
        (2.9e-6, "2.90e-6"),
        (-0.18, "-0.180"),
        (None, "–"),
    ],
)
def test_significant(value, text):
    assert significant(value) == text


def test_fixed_has_no_negative_zero():
    assert fixed(-0.001, 1) == "0.0"
    assert percent(0.9996) == "100.0"
    assert percent(None) == "–"


@pytest.mark.parametrize("value", [None, float("nan"), float("inf"), "7", True, [1]])
def test_what_is_no_number(value):
    assert number(value) is None


def test_as_given():
    assert [as_given(value) for value in (5, 5.0, 0.95, 1e-3, None, "last")] == [
        "5", "5", "0.95", "0.001", "–", "last",
    ]  # fmt: skip


def test_aligned():
    assert aligned(["240", "4.10", "–", "0.003"]) == ("240    ", "4.10 ", "–    ", "0.003")
    points = [text.rjust(12) for text in aligned(["240", "4.10", "0.003"])]
    assert points[1].index(".") == points[2].index(".") == points[0].index("0") + 1


def test_intervals():
    assert intervals([("98.9", "100.0"), ("1.0", "2.5"), ("–", "–")]) == ("98.9–100.0", " 1.0–  2.5", "–")
    assert intervals([("-1.0", "2.0")]) == ("-1.0 to 2.0",)


def test_durations():
    assert durations([0.00021, None]) == ("µs", ("210", "–"))
    assert durations([0.5])[0] == "ms"
    assert durations([20.0])[0] == "s"


def test_broken_at_its_joints():
    assert broken("dense-clutter-five-targets", 14) == "dense-clutter-\nfive-targets"
    assert broken("grid.theta_bins", 8) == "grid.\ntheta_\nbins"
    assert broken("scans", 8) == "scans"


def test_enumerated():
    assert enumerated(["a", "b", "c"]) == "a, b and c"
    assert enumerated(["a"]) == "a"
