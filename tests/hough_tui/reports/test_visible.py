"""What acts on a terminal is shown, whatever it is; all else stays."""

import json
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len

from hough_tui.reports.documents import json_text
from hough_tui.reports.layout import Column, Sheet
from hough_tui.reports.look_alikes import CELLS, WORDS, look_alike, spelled
from hough_tui.reports.visible import visible, visible_in_place, visible_line

ANY = st.text(
    st.characters() | st.characters(categories=["Cs"]) | st.sampled_from("\u200e\u202e\u2028\x85\x1b")
)


def is_safe(text: str) -> bool:
    """Return whether nothing acts, by Unicode's own classes: controls, separators, surrogates, directions."""
    directions = {"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI"}
    return not any(
        unicodedata.category(sign) in ("Cc", "Cs", "Zl", "Zp")
        or unicodedata.bidirectional(sign) in directions
        or sign in "\u061c\u200e\u200f"
        for sign in text
    )


@given(ANY)
def test_nothing_visible_acts(text):
    assert is_safe(visible_line(text))
    assert is_safe(visible(text).replace("\n", ""))
    assert visible(text).count("\n") == text.count("\n")
    assert is_safe(visible_in_place(text).replace("\n", ""))
    assert len(visible_in_place(text)) == len(text)


@given(st.text(st.characters(categories=["L", "N", "P", "S", "Zs"])))
def test_what_does_not_act_stays(text):
    assert visible_line(text) == text


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("a\x1b]0;b\x07", r"a\x1b]0;b\x07"),
        ("a\tb\r\n", "a\\tb\\r\n"),
        ("\u202eexe.", r"\u202eexe."),
        ("\x9b31m", r"\x9b31m"),
        ("\udcff", r"\xff"),
        ("\ud800", r"\ud800"),
    ],
)
def test_escapes_are_those_of_yaml(text, shown):
    assert visible(text) == shown


@given(st.recursive(ANY, lambda part: st.lists(part) | st.dictionaries(ANY, part), max_leaves=5))
def test_json_is_safe_and_means_the_same(document):
    text = json_text(document)
    assert is_safe(text.replace("\n", ""))
    assert json.loads(text) == document


def test_sheets_measure_what_they_show():
    sheet = Sheet("a\x1bb\n", (Column("h\x07", ("x\ny",), prose=True),), ("note\x85",), ("\u202e",))
    assert (sheet.title, sheet.notes, sheet.warnings) == (r"a\x1bb\n", (r"note\x85",), (r"\u202e",))
    assert (sheet.columns[0].heading, sheet.columns[0].cells) == (r"h\x07", (r"x\ny",))
    assert sheet.columns[0].natural == len(r"h\x07")


@given(st.characters(exclude_categories=["Cc", "Cs", "Mn", "Me", "Cf", "Cn", "Co", "Zl", "Zp"]))
def test_look_alikes_take_the_same_room(character):
    instead = look_alike(character)
    assert instead.isascii()
    assert instead.isprintable()
    assert len(instead) in (1, 2)
    assert len(instead) == cell_len(character) or cell_len(character) == 0


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "gbk", "utf-8"])
def test_any_text_has_a_form_in_any_encoding(encoding):
    text = "─┼┌╮╲█▀⠛ ±×°≤λσΔθ → é漢 \U0001f600 …"
    for errors in (WORDS, CELLS):
        assert text.encode(encoding, errors)
    assert spelled("Δθ ≤ 3°, σ × 2", "utf-8") == "Δθ ≤ 3°, σ × 2"
    assert spelled("Δθ ≤ 3°, σ × 2 ± é漢", "ascii") == "dtheta <= 3deg, sigma x 2 +/- e??"
    assert "─┼┌╱█θ±".encode("ascii", CELLS) == b"-++/#t~"
