"""YAML with marks: what a rewrite changes, and what it leaves alone."""

from __future__ import annotations

import copy
import math
import time
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from algorithms.errors import RequestError
from scenarios.files.marked_yaml import rewrite, rewriting, write
from tests.scenarios.files.test_marked_yaml import MARKED, data_of, same, values


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
