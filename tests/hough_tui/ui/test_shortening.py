"""Lines that are made to fit."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len

from hough_tui.ui.drawing.shortening import BETWEEN, Part, cut, fitted, ranked
from hough_tui.ui.widgets.status_line import shortened

WORDS = st.text("aθ1.,", min_size=1, max_size=8)
PARTS = st.builds(
    Part, st.lists(WORDS, min_size=1, max_size=4).map(" ".join), st.integers(0, 4), st.just("") | WORDS
)


@given(st.lists(PARTS, max_size=6), st.integers(0, 80))
def test_a_line_fits_and_says_whole_words_only(parts, width):
    line = fitted(parts, width)
    assert cell_len(line) <= width
    known = {word for part in parts for text in (part.text, part.short) for word in text.split()}
    known |= {word.rstrip(",:;") for word in known}
    assert set(line.split()) <= known | {"·", "…", ""}


def test_what_matters_least_goes_first():
    parts = (
        Part("standard on two-crossing", short="standard"),
        Part("2 duplicate", 1, "2 dup."),
        Part("767 plots", 3),
        Part("0.13 ms", 4),
    )
    lines = list(dict.fromkeys(fitted(parts, width) for width in range(80, 0, -1)))
    assert lines[:6] == [
        "standard on two-crossing · 2 duplicate · 767 plots · 0.13 ms",
        "standard on two-crossing · 2 duplicate · 767 plots",
        "standard on two-crossing · 2 duplicate",
        "standard on two-crossing · 2 dup.",
        "standard on two-crossing",
        "standard",
    ]
    assert lines[6:] == ["…"]


def test_of_a_plain_line_the_last_parts_go_first():
    line = BETWEEN.join(("6,000 trials in 1 s", "5,000/s", "kept as 20250101-course-report"))
    assert fitted(ranked(line), 32) == "6,000 trials in 1 s · 5,000/s"


@pytest.mark.parametrize(
    ("text", "width", "left"),
    [("one two", 7, "one two"), ("one, two", 7, "one …"), ("onetwo", 4, "…"), ("one", 0, "")],
)
def test_a_cut_leaves_whole_words(text, width, left):
    assert cut(text, width) == left


def test_a_path_loses_its_first_folders():
    path = "/home/analyst/studies/spring/course.yaml"
    assert [shortened(path, width) for width in (40, 39, 27, 15, 13)] == [
        path,
        "…/analyst/studies/spring/course.yaml",
        "…/spring/course.yaml",
        "…/course.yaml",
        "…/course.yaml",
    ]
    assert [shortened(path, width) for width in (11, 10)] == ["course.yaml", "…"]
