"""YAML with marks: what is read, what is refused and where, and what is written."""

from __future__ import annotations

import math
from enum import IntEnum, StrEnum
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.errors import RequestError
from scenarios.files.marked_yaml import Mark, MarkedDocument, read, reading, rewrite, write


def same(one: Any, other: Any) -> bool:
    """Equality that tells 1 from 1.0 and True, -0.0 from 0.0, and finds nan equal to itself."""
    if type(one) is not type(other):
        return False
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(same, one, other))
    return repr(one) == repr(other)


def data_of(text: str) -> Any:
    return read(text, "f.yaml").data


# Reading


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 0.001), ("1E+3", 1000.0), (".5", 0.5), ("1.", 1.0), ("-1.5e2", -150.0), ("+.5", 0.5),
        ("0", 0), ("-0", 0), ("+5", 5), ("007", 7), ("0o17", 15), ("0x1F", 31), ("1e16", 1e16),
        (".inf", math.inf), ("-.Inf", -math.inf), ("+.INF", math.inf), (".nan", math.nan), (".NaN", math.nan),
        ("true", True), ("True", True), ("TRUE", True), ("false", False), ("False", False), ("FALSE", False),
        ("null", None), ("~", None), ("Null", None), ("NULL", None), ("", None),
        ("! 5", "5"), ("!!str 5", "5"), ("!!str", ""), ('"5"', "5"), ("'null'", "null"),
        (r'"\ud83d\ude00\x41"', "\U0001f600A"), ("|\n  a\n  b\n", "a\nb\n"), (">-\n  a\n  b\n", "a b"),
        ("!!seq [1]", [1]), ("!!map {b: 1}", {"b": 1}), ("[b: 1, c]", [{"b": 1}, "c"]),
        ("{b, c: 1}", {"b": None, "c": 1}),
    ],
)  # fmt: skip
def test_core_schema(text: str, value: Any) -> None:
    assert same(data_of(f"a: {text}"), {"a": value})


@pytest.mark.parametrize(
    "text",
    ["no", "yes", "on", "off", "y", "n", "No", "tRUE", "nUll", "12:30", "2001-01-01", "1_000", "0b1", "0O17",
     "-0x1F", "1e", ".e5", "e5", ".", "-.", "inf", "nan", "-.nan", "٣", "=", "1.2.3", "1 000"],
)  # fmt: skip
def test_all_else_is_text(text: str) -> None:
    assert same(data_of(f"a: {text}"), {"a": text})
    assert data_of(f"{text}: 1") == {text: 1}


def test_two_arrows_are_text_but_as_a_key_need_quotes() -> None:
    assert data_of("a: <<\n'<<': b\n") == {"a": "<<", "<<": "b"}
    assert data_of(write({"<<": {"<<": 1}})) == {"<<": {"<<": 1}}
    assert data_of(rewrite("a: 1\n", {"a": 1, "<<": 2})) == {"a": 1, "<<": 2}


@pytest.mark.parametrize("text", ["", "\n", "# nothing\n", "---\n", "---\n# nothing\n...\n"])
def test_empty_document(text: str) -> None:
    document = read(text, "f.yaml")
    assert document.data is None
    assert document.where(("a", 1)).startswith("f.yaml:")


def test_reading_leaves_yaml_alone() -> None:
    yaml = pytest.importorskip("yaml")
    read("a: no", "f.yaml")
    assert yaml.safe_load("[no, 1e-3]") == [False, "1e-3"]


def test_directives_byte_order_mark_and_line_ends() -> None:
    assert data_of("%YAML 1.2\n---\na: no\n...\n") == {"a": "no"}
    document = read("\ufeffa: 1\r\nb: [2,\r\n 3]\r\n", "f.yaml")
    assert document.data == {"a": 1, "b": [2, 3]}
    assert document.mark(("b", 1)) == Mark(3, 2)
    assert document.mark(("a",), key=True) == Mark(1, 1)


MARKED = """\
# comment
name: set
scenarios:
  - name: one   # first
    region: {x: [0, 100], "y": [0, 50]}
  -
    name: two
    region:
    ? long
    : 5
last: &anchor
  deep: 1
again: *anchor
"""


@pytest.mark.parametrize(
    ("path", "value", "key"),
    [
        ((), (2, 1), (2, 1)),
        (("name",), (2, 7), (2, 1)),
        (("scenarios",), (4, 3), (3, 1)),
        (("scenarios", 0), (4, 5), (4, 5)),
        (("scenarios", 0, "name"), (4, 11), (4, 5)),
        (("scenarios", 0, "region", "x", 1), (5, 21), (5, 21)),
        (("scenarios", 0, "region", "y"), (5, 32), (5, 27)),
        (("scenarios", 1, "name"), (7, 11), (7, 5)),
        (("scenarios", 1, "region"), (8, 12), (8, 5)),
        (("scenarios", 1, "long"), (10, 7), (9, 7)),
        (("last", "deep"), (12, 9), (12, 3)),
        (("again",), (13, 8), (13, 1)),
        (("again", "deep"), (12, 9), (12, 3)),
        # What is not there stands where its nearest ancestor stands.
        (("nothing",), (2, 1), (2, 1)),
        (("scenarios", 0, "region", "z", 3, "deeper"), (5, 13), (5, 13)),
        (("scenarios", 2, "name"), (4, 3), (4, 3)),
        (("scenarios", -1), (4, 3), (4, 3)),
        (("scenarios", "0"), (4, 3), (4, 3)),
        (("name", 0), (2, 7), (2, 7)),
    ],
)
def test_marks(path: tuple[str | int, ...], value: tuple[int, int], key: tuple[int, int]) -> None:
    document = read(MARKED, "set.yaml")
    assert document.mark(path) == Mark(*value)
    assert document.mark(path, key=True) == Mark(*key)
    assert document.where(path) == f"set.yaml:{value[0]}:{value[1]}"
    assert document.where(path, key=True) == f"set.yaml:{key[0]}:{key[1]}"


def test_document_can_be_made_without_a_text() -> None:
    document = MarkedDocument({"a": 1}, "made up")
    assert document.where(("a",)) == "made up:1:1"


LAUGHS = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 30)
)
DEEP_ALIASES = "- &a0 " + "[" * 60 + "]" * 60 + "\n- " + "[" * 60 + "*a0" + "]" * 60 + "\n"


@pytest.mark.parametrize(
    ("text", "place", "said"),
    [
        ("a: 1\nb: 2\na: 3\n", "3:1", ["'a'", "line 1", "line 3", "keep one"]),
        ("x:\n  - {a: 1,\n     'a': 2}\n", "3:6", ["'a'", "line 2", "line 3"]),
        ("x: 1\n5: y\n", "2:1", ["the key 5", "quote"]),
        ("a: {b: 1, true: 2}", "1:11", ["the key true"]),
        ("~: 1", "1:1", ["the key ~"]),
        ("? \n: 1", "1:2", ["the key (none)"]),
        ("1.0: 1", "1:1", ["the key 1.0"]),
        ("a:\n  [b, c]: 1", "2:3", ["the key [b, c]"]),
        ("? - b\n  - c\n: 1", "1:3", ["the key - b - c"]),
        ("? {\n  }\n: 1", "1:3", ["the key { }"]),
        ("a: !foo 1", "1:4", ["!foo", "remove"]),
        ("a:\n  b: !foo {c: 1}", "2:6", ["!foo"]),
        ("a: !!python/name:os.system ''", "1:4", ["!!python/name:os.system"]),
        ("a: !!set {b}", "1:4", ["!!set"]),
        ("a: !!map [1]", "1:4", ["!!map"]),
        ("a: &x {p: 1}\nb:\n  <<: *x\n", "3:3", ["merge keys (<<) are not YAML 1.2; write the fields out"]),
        ("- &x {p: 1}\n- q: {<<: *x, r: 2}\n", "2:7", ["merge keys (<<)"]),
        ("- &x {p: 1}\n- q: 1\n  <<: [*x, *x]\n", "3:3", ["merge keys (<<)"]),
        ("- !!merge <<: *x\n", "1:3", ["merge keys (<<)"]),
        ("- ? <<\n  : {p: 1}\n", "1:5", ["merge keys (<<)"]),
        ("a: {<<}\n", "1:5", ["merge keys (<<)"]),
        ("a: {scans:5, interval: 4}", "1:5", ["scans:5 is no field with a value; write scans: 5"]),
        ("a: 1\n---\nb: 2\n", "2:1", ["second document", "file of its own"]),
        ("a: 1\n...\n---\n", "3:1", ["second document"]),
        ("a: 1\nb: *x", "2:4", ["*x", "no anchor"]),
        ("a: &x\n  - 1\n  - *x", "3:5", ["*x", "inside its own anchor"]),
        ("&x {a: [*x]}", "1:9", ["*x", "inside its own anchor"]),
        ("a: 1\nb: [1, 2\nc: 3", "3:2", ["flow sequence that began on line 2", "expected ',' or ']'"]),
        ("a: 'x\n\n", "3:1", ["quoted scalar that began on line 1", "end of stream"]),
        ("a: b: c", "1:5", ["mapping values are not allowed here"]),
        ("a: 1\n\tb: 2", "2:1", ["character '\\t'", "use spaces"]),
        ('a: "x\\q"', "1:7", ["unknown escape character 'q'"]),
        ("a: @b", "1:4", ["'@'"]),
        ("a: 1\n b: 2", "2:3", ["mapping values"]),
        ("a: 1\r\nb: ]", "2:4", ["']'"]),
        ("%YAML 2.0\n---\n1", "1:1", ["version"]),
        ('a: "\\UFFFFFFFF"', "1:7", ["not valid YAML"]),
        ('a: "\\U00110000"', "1:7", ["not valid YAML"]),
        ('a: "\\ud83d"', "1:4", ["half a character"]),
        ("a: 1\nb: x\x07y", "2:5", ["U+0007"]),
        ("a: \x00", "1:4", ["U+0000"]),
        ("a: \ud800", "1:4", ["U+D800"]),
        ("\r\n\r\n \x7f", "3:2", ["U+007F"]),
        ("a: " + "9" * 5000, "1:4", ["too many digits"]),
        ("a: 0x" + "f" * 5000, "1:4", ["too many digits"]),
        ("[" * 100_000, "1:102", ["nested more than 100 levels"]),
        ("{a: " * 10_000, "1:402", ["nested more than 100 levels"]),
        ("- " * 100_000, "1:203", ["nested more than 100 levels"]),
        ("".join(" " * n + "a:\n" for n in range(1500)), "101:101", ["nested more than 100 levels"]),
        (LAUGHS, "6:10", ["aliases", "too large"]),
        (DEEP_ALIASES, "2:63", ["aliases", "too large"]),
    ],
)
def test_refused(text: str, place: str, said: list[str]) -> None:
    with pytest.raises(RequestError) as caught:
        read(text, "f.yaml")
    message = str(caught.value)
    assert message.startswith(f"f.yaml:{place}: ")
    assert all(words in message for words in said)
    assert "; " in message
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize(("text", "place"), [("[1, 2, 3, 4]", "1:11"), ("a: 1\nb: 2\nc: 3", "3:1")])
def test_keys_and_values_are_counted(text: str, place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "MOST_VALUES", 4 if text[0] == "[" else 5)
    with pytest.raises(RequestError, match=rf"f\.yaml:{place}: more than \d keys and values"):
        read(text, "f.yaml")


def test_aliases_share_nothing() -> None:
    document = read("a: &x {p: [1]}\nb: *x\nc: *x\n", "f.yaml")
    document.data["b"]["p"].append(2)
    assert document.data == {"a": {"p": [1]}, "b": {"p": [1, 2]}, "c": {"p": [1]}}


def test_deepest_nesting_goes_both_ways() -> None:
    data: Any = 1
    for _ in range(100):
        data = [data]
    assert data_of(write(data)) == data
    assert data_of(rewrite("a: 1", data)) == data
    with pytest.raises(RequestError, match="100 levels"):
        write([data])


@settings(max_examples=300)
@given(st.text() | st.text(alphabet=list(" \n\t-:?,[]{}#&*!|>'\"%@ab01.\\u~\x85\u2028\ufeff")))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        document = read(text, "f.yaml")
    except RequestError as error:
        message = str(error)
        document = None
    if document is None:
        assert message.startswith("f.yaml:")
        assert "\n" not in message
    else:
        assert rewrite(text, document.data) == text


# Writing

TRICKY = [
    "no", "true", "~", "1e3", "0x1F", ".5", "1.", ".inf", "12:30", "", " ", " a", "a ", "a: b", "a:",
    ":a", "# a", "a #b", "a#b", "- a", "-", "--- a", "...", "[a", "a]", "a, b", "{a", "a?b", "?", "&a",
    "*a", "!a", "|", ">", "%a", "@a", "`a", "'a'", '"a"', "it's", "\\n", "a\nb", "a\nb\n", "a\n\nb\n",
    "a\n\n", "\na", " a\nb", "a\n  b\n", "a\n \nb", "a\n\tb", "\t", "\r\n", "\x85", "\u2028", "\ufeff",
    "\xa0", "\x00", "\x7f", "😀", "σ, ρ, θ", "<<", "=", "a" * 2000, "a b " * 500,
]  # fmt: skip
scalars = (
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.sampled_from(TRICKY)
)
keys = st.sampled_from(["name", "a", "b", "c", *TRICKY]) | st.text(max_size=4)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=300)
@given(values)
def test_what_is_written_is_read(data: Any) -> None:
    assert same(data_of(write(data)), data)


@pytest.mark.parametrize("text", TRICKY)
def test_tricky_text(text: str) -> None:
    for data in (text, [text], {text: text}, {"a": [[text, 1], {text: [text]}]}, [{"a": text}, [text], text]):
        assert same(data_of(write(data)), data)


@pytest.mark.parametrize(
    "number", [1e-05, 1e16, 1e22, 5e-324, 1.7976931348623157e308, 0.1, 1.0, -0.0, 100.0, 10**30, -7]
)
def test_numbers_come_back_exactly(number: float) -> None:
    assert same(data_of(write({"a": number})), {"a": number})
    assert same(data_of(rewrite("a: 0 # c\n", {"a": number})), {"a": number})
    assert "# c" in rewrite("a: 9 # c\n", {"a": number})


def test_fresh_layout() -> None:
    data = {
        "schema": 1,
        "name": "course-report",
        "about": "Two targets,\nlittle clutter.\n",
        "scenarios": [
            {
                "name": "two-crossing",
                "region": {"x": [0, 100], "y": [0, 100.5]},
                "sensor": {"kind": "cartesian", "sigma": None, "on": True},
                "sweep": {"scans": [5, 10]},
                "note": "a\nb",
            },
            {"name": "no", "code": "12"},
            [[1, 2], [3]],
        ],
        "numbers": list(range(40)),
        "empty": [{}, []],
        "none": {},
    }
    assert write(data) == (
        "schema: 1\n"
        "name: course-report\n"
        "about: |\n"
        "  Two targets,\n"
        "  little clutter.\n"
        "scenarios:\n"
        "  - name: two-crossing\n"
        "    region:\n"
        "      x: [0, 100]\n"
        "      y: [0, 100.5]\n"
        "    sensor: {kind: cartesian, sigma: null, on: true}\n"
        "    sweep:\n"
        "      scans: [5, 10]\n"
        "    note: |-\n"
        "      a\n"
        "      b\n"
        '  - {name: no, code: "12"}\n'
        "  - - [1, 2]\n"
        "    - [3]\n"
        "numbers:\n" + "".join(f"  - {n}\n" for n in range(40)) + "empty:\n  - {}\n  - []\nnone: {}\n"
    )


def test_subclasses_and_tuples_are_written_as_what_they_are() -> None:
    class Unit(StrEnum):
        KM = "km"

    class Level(IntEnum):
        LOW = 3

    class Length(float):
        def __repr__(self) -> str:
            return "Length"

    data = {Unit.KM: (Unit.KM, Level.LOW, Length(0.25))}
    assert same(data_of(write(data)), {"km": ["km", 3, 0.25]})
    assert same(data_of(rewrite("km: []", data)), {"km": ["km", 3, 0.25]})


@pytest.mark.parametrize("data", [{"a": {1, 2}}, [object()], {1: 2}, {None: 1}, b"a"])
def test_data_without_a_form_in_yaml(data: Any) -> None:
    with pytest.raises(TypeError, match="YAML has no form"):
        write(data)
    with pytest.raises(TypeError):
        rewrite("a: 1", data)


def test_data_that_could_not_be_read_back() -> None:
    endless: list[Any] = []
    endless.append({"a": endless})
    for data in ({"a": "\ud800"}, {"\udc80": 1}, [16**5000], endless):
        with pytest.raises(RequestError):
            write(data)
