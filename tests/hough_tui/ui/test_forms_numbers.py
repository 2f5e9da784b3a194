import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hough_tui.ui.forms.numbers import Unreadable, Wanted, number_text, numbers_text, read

PAIR = Wanted(size=2)
ONE_OR_PAIR = Wanted(size=2, single=True)
WHOLE = Wanted(whole=True)
SWEPT = Wanted(size=None)

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.3", 0.3),
        (".3", 0.3),
        ("3e-1", 0.3),
        ("3E-1", 0.3),
        (" 0.3 ", 0.3),
        ("3.", 3.0),
        ("+5", 5.0),
        ("−5", -5.0),
        ("5e−1", 0.5),
        ("0,3", 0.3),
        (",3", 0.3),
        ("1,5", 1.5),
        ("−1,5e3", -1500.0),
        ("0,300", 0.3),
        ("1000,125", 1000.125),
        ("1.000", 1.0),
        ("-0", 0.0),
    ],
)
def test_one_number_is_read_as_what_it_can_only_mean(text, value):
    assert read(text) == value


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1,000", "may mean 1.000 or 1000"),
        ("12,345e2", "may mean 12.345e2 or 12345e2"),
        ("1 000", "without separators: 1000"),
        ("1\u202f000", "without separators: 1000"),
        ("1'000'000", "without separators: 1000000"),
        ("1_000", "without separators: 1000"),
        ("1,000,000", "without separators: 1000000"),
        ("1.000.000", "without separators: 1000000"),
        ("1.000,5", "without separators: 1000.5"),
        ("1,000.5", "without separators: 1000.5"),
        ("½", "'½' is given; it must be a number"),
        ("٣", "must be a number"),
        ("3,", "must be a number"),
        ("1/2", "must be a number"),
        ("--5", "must be a number"),
        ("40 20", "must be a number"),
        ("auto", "must be a number"),
        ("", "nothing is given; it must be a number"),
        ("inf", "must be a finite number"),
        ("-NaN", "must be a finite number"),
        ("1e999", "too large"),
        ("1e-999", "too small to be told from 0"),
        ("0.6 km", "write the number alone, without 'km'"),
        ("95%", "95% as 0.95"),
    ],
)
def test_what_means_no_number_or_two_is_refused_with_the_reason(text, said):
    found = read(text)
    assert isinstance(found, Unreadable)
    assert said in found.message


@pytest.mark.parametrize(
    "text",
    [
        "40, 20",
        "[40, 20]",
        "(40, 20)",
        "40 20",
        "40  20",
        "[40 20]",
        "[40,20]",
        "40; 20",
        "40 , 20",
        "40,0 20,0",
    ],
)
def test_a_pair_is_read_however_its_numbers_are_separated(text):
    assert read(text, PAIR) == (40.0, 20.0)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0,3 0,18", (0.3, 0.18)),
        ("0,3; -0,18", (0.3, -0.18)),
        ("0.3,0.18", (0.3, 0.18)),
        ("-5,-3", (-5.0, -3.0)),
        ("1e3,5", (1000.0, 5.0)),
    ],
)
def test_a_comma_in_a_pair_is_what_it_can_only_be(text, value):
    assert read(text, PAIR) == value


@pytest.mark.parametrize(
    "text",
    ["40,20", "1,5e3", "1,234.5", "1.234,5", "40 ,20", "40, ,3", "1 000", "[1,000]", "1,000 2", "0,3,0,18"],
)
def test_a_pair_that_can_be_read_in_two_ways_is_refused(text):
    assert isinstance(read(text, PAIR), Unreadable)


@pytest.mark.parametrize("text", ["40", "1 2 3", "[40, 20", "40, 20]", "40, 20,", "[]", "40;", "a b", "1, x"])
def test_what_is_no_pair_is_refused(text):
    assert isinstance(read(text, PAIR), Unreadable)


def test_one_number_or_a_pair():
    assert read("0.1", ONE_OR_PAIR) == 0.1
    assert read(",1", ONE_OR_PAIR) == 0.1
    assert read("0.1 0.2", ONE_OR_PAIR) == (0.1, 0.2)
    for ambiguous in ("0,1", "1 200"):
        assert isinstance(read(ambiguous, ONE_OR_PAIR), Unreadable)


@pytest.mark.parametrize(("text", "value"), [("15", 15), ("15.0", 15), ("1e3", 1000), ("-2", -2), ("2,0", 2)])
def test_a_whole_number(text, value):
    found = read(text, WHOLE)
    assert found == value
    assert isinstance(found, int)


def test_a_whole_number_keeps_every_digit():
    assert read("18446744073709551615", WHOLE) == 2**64 - 1


@pytest.mark.parametrize("text", ["1.5", "1,5", "1e-1", "1e999999999", "9" * 5000, "1,000"])
def test_what_is_no_whole_number_is_refused(text):
    assert isinstance(read(text, WHOLE), Unreadable)


def test_whole_numbers_among_others_stay_whole():
    found = read("5, 10, 0.5", SWEPT)
    assert found == (5, 10, 0.5)
    assert [type(value) for value in found] == [int, int, float]
    assert isinstance(read("5,10", SWEPT), Unreadable)
    assert isinstance(read("0,5 0,6", SWEPT), Unreadable)


def test_words_and_nothing():
    wanted = Wanted(words=("auto",), optional=True)
    assert read(" Auto ", wanted) == "auto"
    assert read("", wanted) is None
    assert read("none", wanted) is None
    found = read("x", wanted)
    assert found == Unreadable("'x' is given; it must be a number or 'auto' or empty")


@given(finite)
def test_the_text_of_a_number_reads_as_it(value):
    assert read(repr(value)) == value
    assert read(number_text(value)) == value


@given(st.integers(-(2**64), 2**64))
def test_the_text_of_a_whole_number_reads_as_it(value):
    assert read(number_text(value), WHOLE) == value


@given(st.tuples(finite, finite))
def test_the_text_of_a_pair_reads_as_it(pair):
    for text in (numbers_text(pair), f"[{numbers_text(pair)}]", f"{pair[0]!r} {pair[1]!r}"):
        assert read(text, PAIR) == pair


@given(st.text(alphabet="0123456789,. -+e_'\u00a0", max_size=12))
def test_what_is_read_has_but_one_meaning(text):
    """Each way of reading that anyone has: what the program takes is what every possible one says."""
    value = read(text)
    if isinstance(value, Unreadable):
        return
    bare = text.strip()
    meanings = {
        float(reading)
        for reading in (
            bare,
            bare.replace(",", "."),
            bare.replace(",", "") if _is_grouped(bare, ",") else bare.replace(",", "."),
        )
        if _is_float(reading)
    }
    assert meanings == {value}
    assert math.isfinite(value)


def _is_float(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text


def _is_grouped(text: str, mark: str) -> bool:
    """Whether a mark may separate thousands: three digits after each, and not a lone zero before."""
    first, *rest = text.lstrip("+-").split("e")[0].split(mark)
    groups_fit = rest and all(len(group) == 3 and group.isdigit() for group in rest)
    return bool(groups_fit and first.isdigit() and len(first) <= 3 and int(first))
