"""YAML with marks: what is read, what is refused and where, and what a rewrite leaves alone."""

from __future__ import annotations

import copy
import math
import time
from collections.abc import Callable
from enum import IntEnum, StrEnum
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.errors import RequestError
from scenarios.marked_yaml import Mark, MarkedDocument, read, rewrite, rewriting, write


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


def edit(text: str, change: Callable[[Any], Any]) -> str:
    """Rewrite a text to its own data, changed, and check that the data arrives."""
    data = copy.deepcopy(data_of(text))
    change(data)
    changed = rewrite(text, data)
    assert same(data_of(changed), data)
    return changed


@pytest.fixture
def no_fallback(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(data: Any) -> str:
        raise AssertionError(f"no small change was found for {data!r}")

    monkeypatch.setattr(rewriting, "write", refuse)


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
     "-0x1F", "1e", ".e5", "e5", ".", "-.", "inf", "nan", "-.nan", "٣", "<<", "=", "1.2.3", "1 000"],
)  # fmt: skip
def test_all_else_is_text(text: str) -> None:
    assert same(data_of(f"a: {text}"), {"a": text})
    assert data_of(f"{text}: 1") == {text: 1}


def test_merge_key_is_a_plain_key() -> None:
    assert data_of("a: &x {p: 1}\nb:\n  <<: *x\n") == {"a": {"p": 1}, "b": {"<<": {"p": 1}}}


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
    begun = time.perf_counter()
    with pytest.raises(RequestError) as caught:
        read(text, "f.yaml")
    message = str(caught.value)
    assert message.startswith(f"f.yaml:{place}: ")
    assert all(words in message for words in said)
    assert "; " in message
    assert len(message.splitlines()) == 1
    assert time.perf_counter() - begun < 2.0


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


# Rewriting


@settings(max_examples=300)
@given(values, values)
def test_rewrite_arrives(old: Any, new: Any) -> None:
    text = write(old)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rewriting, "write", lambda data: pytest.fail(f"no small change for {data!r}"))
        assert rewrite(text, old) == text
        assert same(data_of(rewrite(text, new)), new)


def change_somewhere(data: Any, new: Any, draw: Callable[[Any], Any]) -> Any:
    """Change one thing somewhere in the data: set it, remove it, add to it or reorder it."""
    if not isinstance(data, dict | list) or not data:
        return new
    places = list(data) if isinstance(data, dict) else list(range(len(data)))
    place = draw(st.sampled_from(places))
    what = draw(st.sampled_from(["deeper", "deeper", "remove", "add", "reorder"]))
    if what == "deeper":
        data[place] = change_somewhere(data[place], new, draw)
    elif what == "remove":
        del data[place]
    elif isinstance(data, dict):
        data["added"] = new
    elif what == "add":
        data.insert(place, new)
    else:
        data[:] = draw(st.permutations(data))
    return data


@settings(max_examples=300)
@given(st.data(), values, values)
def test_small_changes_arrive(drawn: st.DataObject, old: Any, new: Any) -> None:
    text = write(old)
    data = change_somewhere(copy.deepcopy(old), new, drawn.draw)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rewriting, "write", lambda data: pytest.fail(f"no small change for {data!r}"))
        assert same(data_of(rewrite(text, data)), data)


@settings(max_examples=100)
@given(
    st.permutations(range(6)),
    st.integers(0, 6),
    st.booleans(),
    st.sampled_from(["block", "flow", "inline"]),
    st.sampled_from(["\n", "\r\n"]),
)
def test_comments_go_where_their_items_go(
    order: list[int], count: int, blank: bool, layout: str, line_end: str
) -> None:
    """Whichever items stay, in whatever order: theirs are the comments that stay."""
    if layout == "flow":
        item = "  # above {n}\n  {{name: n{n}, v: {n}.50}},  # beside {n}"
    elif layout == "block":
        item = "\n" * blank + "  # above {n}\n  - name: n{n}  # beside {n}\n    v: {n}.50\n    # inside {n}"
    else:
        item = "- {{name: n{n}, v: {n}.50}}  # beside {n}"
    lines = ["list: [" if layout == "flow" else "list:", *(item.format(n=n) for n in range(6))]
    lines += ["]"] if layout == "flow" else []
    text = "\n".join(["# top", *lines, "# end", "last: 0x10  # last", ""]).replace("\n", line_end)
    data = data_of(text)
    kept = order[:count]
    data["list"] = [data["list"][n] for n in kept]
    for item in data["list"][:1]:
        item["v"] = 7
    changed = rewrite(text, data)
    assert same(data_of(changed), data)
    assert changed.count("\n") == changed.count(line_end)
    for words in ("# top", "# end", "last: 0x10  # last"):
        assert words in changed
    for word in ("above", "beside", "inside"):
        found = [int(rest[0]) for rest in changed.split(f"# {word} ")[1:]]
        expected = kept if f"# {word} " in text else []
        # An emptied list keeps what stands above its first item.
        assert found == expected or not kept
    assert all(f"{n}.50" in changed for n in kept[1:])


REALISTIC = """\
# A set for the course report.
# It has two scenarios.

schema: 1
name: 'course-report'        # shown in lists

# ---- scenarios ---------------------------------------------------------------------------------------
scenarios:
  # Two targets that cross; comments above a first item speak for the list.
  - name: two-crossing
    unit: km
    interval: 4            # s
    region: {x: [0, 100], y: [0.00, 1e2]}   # a long line, and nobody asked for it to be wrapped
    sensor: {kind: cartesian,
             sigma: [0.30, 1e-3],   # km
             detection_probability: 1.0}
    clutter: [{kind: poisson, rate: 50}]     # per scan
    targets:
      - {position: [40, 20], velocity: [0.3, 0.18]}   # the first

      # the second comes from above
      - {position: [20, 80], velocity: [0.3, -0.18]}  # the second
      # - {position: [1, 1], velocity: [0, 0]}

    # above note
    note: |   # literal
      Some "text": with # signs

      and a blank line.

  # about empty
  - name: empty
    targets: []  # none
    clutter:   # none either
    colour: "no"

# ---- what is run -------------------------------------------------------------------------------------

experiments:
- name: scans
  sweep:
    scenario.scans: [
      5,    # short
      10,
      15    # long
    ]
  trials: 0x3E8
# the end
# really
"""


def test_nothing_changes_where_nothing_is_asked() -> None:
    assert rewrite(REALISTIC, data_of(REALISTIC)) == REALISTIC
    assert rewrite(MARKED, data_of(MARKED)) == MARKED
    assert rewrite(REALISTIC, dict(reversed(data_of(REALISTIC).items()))) == REALISTIC


def scenario(data: Any, number: int = 0) -> Any:
    return data["scenarios"][number]


NOTE = """    note: |   # literal
      Some "text": with # signs

      and a blank line.
"""
SECOND = """
      # the second comes from above
      - {position: [20, 80], velocity: [0.3, -0.18]}  # the second
"""


def scans(data: Any) -> Any:
    return data["experiments"][0]["sweep"]["scenario.scans"]


@pytest.mark.usefixtures("no_fallback")
@pytest.mark.parametrize(
    ("change", "old", "new"),
    [
        # values in place
        (lambda d: d.update(name="it's new"), "'course-report'", "'it''s new'"),
        (lambda d: scenario(d).update(interval=2.5), "interval: 4 ", "interval: 2.5 "),
        (lambda d: scenario(d).update(unit="1e3"), "unit: km", 'unit: "1e3"'),
        (lambda d: scenario(d)["region"].update(y=[0.0, 1e-05]), "[0.00, 1e2]", "[0.00, 1e-05]"),
        (lambda d: scenario(d)["sensor"].update(detection_probability=1), "1.0}", "1}"),
        (lambda d: scenario(d, 1).update(clutter="some"), "clutter:   # none", "clutter: some   # none"),
        (lambda d: scenario(d, 1).update(colour="on"), '"no"', '"on"'),
        (lambda d: scenario(d, 1).update(colour=True), '"no"', "true"),
        (
            lambda d: scenario(d).update(note="one\ntwo\n"),
            NOTE,
            "    note: |  # literal\n      one\n      two\n",
        ),
        # more
        (lambda d: scenario(d)["sensor"]["sigma"].append(math.inf), "1e-3]", "1e-3, .inf]"),
        (lambda d: scenario(d)["sensor"].update(bias=0.0), "1.0}", "1.0,\n             bias: 0.0}"),
        (lambda d: scenario(d)["clutter"].append({"kind": "x"}), "rate: 50}]", "rate: 50}, {kind: x}]"),
        (
            lambda d: scenario(d)["targets"].append({"position": [1, 2], "velocity": [3, 4]}),
            "# the second\n",
            "# the second\n\n      - {position: [1, 2], velocity: [3, 4]}\n",
        ),
        (
            lambda d: scenario(d, 1)["targets"].append({"position": [1]}),
            "targets: []  # none",
            "targets:  # none\n      - position: [1]",
        ),
        (
            lambda d: scenario(d, 1).update(last={"a": [[1]]}),
            'colour: "no"\n',
            'colour: "no"\n    last:\n      a:\n        - [1]\n',
        ),
        (lambda d: scans(d).append(20), "15    # long", "15,    # long\n      20"),
        (lambda d: scans(d).insert(1, 7), "# short\n", "# short\n      7,\n"),
        (lambda d: d["experiments"].append({"name": "more"}), "0x3E8\n", "0x3E8\n- name: more\n"),
        (lambda d: d.update(more=[1]), "0x3E8\n", "0x3E8\nmore: [1]\n"),
        # less
        (lambda d: d.pop("schema"), "schema: 1\n", ""),
        (lambda d: scenario(d).pop("note"), "\n    # above note\n" + NOTE, ""),
        (lambda d: scenario(d)["sensor"].pop("kind"), "{kind: cartesian,\n             sigma", "{sigma"),
        (
            lambda d: scenario(d)["targets"].pop(0),
            "      - {position: [40, 20], velocity: [0.3, 0.18]}   # the first\n\n",
            "",
        ),
        (lambda d: scenario(d)["targets"].pop(1), SECOND, ""),
        (lambda d: scans(d).pop(0), "      5,    # short\n", ""),
        (lambda d: scans(d).pop(2), "10,\n      15    # long\n", "10\n"),
    ],
)
def test_only_what_is_asked_changes(change: Callable[[Any], Any], old: str, new: str) -> None:
    assert REALISTIC.count(old) == 1
    assert edit(REALISTIC, change) == REALISTIC.replace(old, new)


@pytest.mark.usefixtures("no_fallback")
def test_items_take_their_comments_along() -> None:
    first = "# about a\n- name: a\n  v: 1  # v of a\n"
    second = "\n# section\n\n# about b\n- name: b\n  v: 2  # v of b\n"
    text = "list:\n" + first + second
    assert edit(text, lambda d: d["list"].reverse()) == "list:\n" + second + "\n" + first
    # A new name alone is the same item; other values under another name are another item.
    assert "v: 2  # v of b" in edit(text, lambda d: d["list"][1].update(name="new"))
    assert "v of b" not in edit(text, lambda d: d["list"].__setitem__(1, {"name": "new", "v": 3}))
    # A comment with a blank line below it is not the item's own.
    assert edit(text, lambda d: d["list"].pop(1)) == "list:\n" + first + "\n# section\n\n"
    assert edit(text, lambda d: d["list"].pop(0)).startswith("list:\n\n# section\n\n# about b\n- name: b\n")


def test_equal_items_are_told_apart_by_their_neighbours() -> None:
    text = "- 1  # first\n- 2  # second\n- 1  # third\n"
    assert edit(text, lambda d: d.pop(0)) == "- 2  # second\n- 1  # third\n"
    assert edit(text, lambda d: d.pop()) == "- 1  # first\n- 2  # second\n"


@pytest.mark.usefixtures("no_fallback")
@pytest.mark.parametrize(
    ("text", "data", "expected"),
    [
        # indentation is kept as the file has it
        ("a:\n- 1\n", {"a": [1], "b": {"c": [[2]]}}, "a:\n- 1\nb:\n  c:\n  - [2]\n"),
        (
            "a:\n    b: 1\n",
            {"a": {"b": 1, "c": {"d": {"e": [1]}}}},
            "a:\n    b: 1\n    c:\n        d:\n            e: [1]\n",
        ),
        ("-   a: 1\n    b: 2\n", [{"a": 1, "b": [[3]]}], "-   a: 1\n    b:\n      - [3]\n"),
        ("- a: 1 # a\n  # on b\n  b: 2\n", [{"b": 2}], "- \n  # on b\n  b: 2\n"),
        ("- - 1\n  - 2 # c\n", [[2], 3], "- - 2 # c\n- 3\n"),
        # new items look like their siblings
        ("- a: 1\n  b: 2\n", [{"a": 1, "b": 2}, {"a": 3}], "- a: 1\n  b: 2\n- a: 3\n"),
        ("- {a: [[1]]}\n", [{"a": [[1]]}, {"a": [[2]]}], "- {a: [[1]]}\n- {a: [[2]]}\n"),
        ("- a: 1\n\n- a: 2\n", [{"a": 1}, {"a": 2}, {"a": 3}], "- a: 1\n\n- a: 2\n\n- a: 3\n"),
        # missing values, explicit keys, keys with no colon
        (
            "a:\nb: # c\n  1\nc:   # d\n",
            {"a": 1, "b": 2, "c": [[3]]},
            "a: 1\nb: # c\n  2\nc:  # d\n  - [3]\n",
        ),
        ("-\n- # c\n", [1, 2], "- 1\n- 2 # c\n"),
        ("? a\n? b # c\n: 1\n", {"a": 2, "b": 3}, "a: 2\n? b # c\n: 3\n"),
        ("{a, b: , 'c':1, \"d\": 2}\n", {"a": 1, "b": 2, "c": 3, "d": 4}, "{a: 1, b: 2 , 'c':3, \"d\": 4}\n"),
        ("x: [b: 1, c] # d\n", {"x": [{"b": 2}, "c"]}, "x: [{b: 2}, c] # d\n"),
        ("? a\n# on b\n? b\n", {"b": None}, "# on b\n? b\n"),
        ("'a' : 1\n", {"a": [[1]]}, "'a':\n  - [1]\n"),
        # comments above the first item
        ("# top\na: 1\n# on b\nb: 2\n", {"b": 2}, "# top\n# on b\nb: 2\n"),
        ("l:\n  # on l\n  - 1\n  - 2\n", {"l": [2]}, "l:\n  # on l\n  - 2\n"),
        ("l:  # l\n  # on 1\n  - 1\n  # on 2\n  - 2\n", {"l": [2]}, "l:  # l\n  # on 2\n  - 2\n"),
        # brackets, commas and their comments
        ("[ 1, 2 ] # c\n", [1, 2, 3], "[ 1, 2, 3 ] # c\n"),
        ("[1, # one\n 2]\n", [1], "[1 # one\n]\n"),
        ("[1 # one, I\n , 2]\n", [1], "[1 # one, I\n ]\n"),
        ("[\n  1, # one\n  2, # two\n]\n", [2], "[\n  2, # two\n]\n"),
        ("[1, 2,\n 3, 4]\n", [1, 2, 4], "[1, 2, 4]\n"),
        ("[1] # c\n", [1, {"a": "b: c"}], '[1, {a: "b: c"}] # c\n'),
        ("a: {b: 1}\n", {"a": {"b": {"c": "t\nu\n"}}}, 'a: {b: {c: "t\\nu\\n"}}\n'),
        # text of several lines
        ("a: >  # c\n  x\n  y\n\nb: 1\n", {"a": "z", "b": 1}, "a: z  # c\n\nb: 1\n"),
        ("a: |\r\n  x\r\n\r\nb: 1\r\n", {"a": "x\n", "c": 2}, "a: |\r\n  x\r\n\r\nc: 2\r\n"),
        (
            "a: |\r\n  x\r\n\r\nb: 1\r\n",
            {"a": "x\n", "b": 1, "c": 2},
            "a: |\r\n  x\r\n\r\nb: 1\r\n\r\nc: 2\r\n",
        ),
        ("a: |+\n  x\n\n\n", {"a": "x\n\n\n", "b": 2}, "a: |+\n  x\n\n\nb: 2\n"),
        ("a: &t |\n  x\nb: 1 # c\n", {"a": 5, "b": 1}, "a: 5\nb: 1 # c\n"),
        ("a: 1\n  # below\nb: 2\n", {"a": "x\ny\n", "b": 2}, 'a: "x\\ny\\n"\n  # below\nb: 2\n'),
        # the ends of the text
        ("", {"a": 1}, "a: 1\n"),
        ("# c", {"a": 1}, "# c\na: 1\n"),
        ("a: 1", {"a": 1, "b": 2}, "a: 1\nb: 2\n"),
        ("a: 1 # c", {"a": 2}, "a: 2 # c"),
        ("--- {a: 1} # c\n...\n", {"a": 2}, "--- {a: 2} # c\n...\n"),
        ("---\na: 1\n...\n# c\n", {"a": 1, "b": 2}, "---\na: 1\nb: 2\n...\n# c\n"),
        ("\ufeffa: 1 # c\nb: 2\n", {"a": 2, "b": 2}, "\ufeffa: 2 # c\nb: 2\n"),
        ("# top\n- 1\n# c\n", {"a": 1}, "# top\na: 1\n# c\n"),
        ("# top\na: 1\n# c\n", {}, "# top\n{}\n# c\n"),
        ("a: # c\n# d\n- 1\nb: 2\n", {"a": [], "b": 2}, "a: []  # c  # d\nb: 2\n"),
        ("a: 1\r\nb: 2 # c\r\n", {"a": 1, "b": [[1]]}, "a: 1\r\nb:  # c\r\n  - [1]\r\n"),
        # anchors and aliases
        ("a: &x [1]\nb: *x # c\n", {"a": [1], "b": [1], "c": 2}, "a: &x [1]\nb: *x # c\nc: 2\n"),
        ("a: &x [1]\nb: *x # c\n", {"a": [1], "b": [2]}, "a: &x [1]\nb: [2] # c\n"),
        ("a: &x [1]\nb: *x # c\n", {"a": [3], "b": [1]}, "a: &x [3]\nb: [1] # c\n"),
        ("a: &x [1]\nb: *x # c\n", {"b": [1]}, "b: [1] # c\n"),
        (
            "a: &x\n  k: 1 # k\nb: *x # c\n",
            {"a": {"k": 2}, "b": {"k": 1}},
            "a: &x\n  k: 2 # k\nb: {k: 1} # c\n",
        ),
    ],
)
def test_layouts(text: str, data: Any, expected: str) -> None:
    assert rewrite(text, data) == expected
    assert same(data_of(expected), data)


def test_long_keys_are_found_again() -> None:
    text = "a: {b: 1} # c\n"
    data = {"a": {"b": 1, "k" * 1100: 2}, "l" * 1100: [[3]]}
    changed = rewrite(text, data)
    assert same(data_of(changed), data)
    assert "# c" in changed


@pytest.mark.parametrize("wrong", ["a: 7\n", "a: [1", ""])
def test_a_wrong_change_is_never_returned(monkeypatch: pytest.MonkeyPatch, wrong: str) -> None:
    monkeypatch.setattr(rewriting._Rewriter, "apply", lambda self, data: wrong)
    assert rewrite("a: 1 # c\n", {"a": 2}) == "a: 2\n"


def test_text_that_cannot_be_read_is_not_overwritten() -> None:
    with pytest.raises(RequestError, match=r"^text:3:1: "):
        rewrite("a: 1\nb: [\n", {"a": 2})


def test_large_documents_take_no_age() -> None:
    text = "".join(f"- {{name: n{n}, v: [1, 2]}}  # {n}\n" for n in range(1000))
    data = data_of(text)
    for item in data:
        item["v"][0] = 9
    begun = time.perf_counter()
    changed = rewrite(text, data[::-1])
    assert time.perf_counter() - begun < 5.0
    assert [line.split("# ")[1] for line in changed.splitlines()] == [str(n) for n in reversed(range(1000))]
    numbers = rewrite("[" + "1, " * 3000 + "1]", [2] * 3001)
    assert time.perf_counter() - begun < 8.0
    assert data_of(numbers) == [2] * 3001
