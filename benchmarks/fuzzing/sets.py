"""Mutated scenario sets: their numbers, their structure, their YAML."""

from __future__ import annotations

import copy
import json
import math
import random
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from benchmarks.fuzzing.mutations import EXTREMES, USUAL, damaged, hostile, number
from scenarios.files.bundled import bundled_paths
from scenarios.model import ScenarioSet

SEEDS = Path(__file__).parent / "seeds"
Place = tuple[Any, Any]
"""A container and the key, or the index, of a value in it."""


def mutated_set(dice: random.Random) -> bytes:
    """Return a mutated scenario set as a file."""
    data = smaller(dice, copy.deepcopy(dice.choice(seed_sets())))
    for _ in range(dice.choice((0, 1, 1, 1, 2, 2, 3, 5))):
        dice.choice(MUTATIONS)(dice, data)
    text = written(dice, data)
    if dice.random() < 0.12:
        text = dice.choice(YAML_MUTATIONS)(dice, text)
    content = text.encode("utf-8", "surrogatepass")
    if dice.random() < 0.08:
        content = damaged(dice, content)
    return content


@cache
def seed_sets() -> tuple[dict[str, Any], ...]:
    """Return the valid sets that are mutated: the bundled ones, and others that use every feature."""
    bundled = [path for _, path in sorted(bundled_paths().items())]
    own = sorted(SEEDS.glob("*.yaml"))
    # The own ones are smaller and hold more kinds of fields.
    return tuple(yaml.safe_load(path.read_text(encoding="utf-8")) for path in (*bundled, *own, *own))


@cache
def vocabulary() -> tuple[tuple[str, ...], tuple[Any, ...]]:
    """Return the names of all fields of a set, and all words that some field takes."""
    names: set[str] = set()
    words: set[str] = set()

    def walk(part: Any) -> None:
        if isinstance(part, dict):
            names.update(part.get("properties", ()))
            words.update(word for word in [part.get("const"), *part.get("enum", ())] if isinstance(word, str))
        for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
            walk(inner)

    walk(ScenarioSet.model_json_schema())
    return tuple(sorted(names)), tuple(sorted(words))


def smaller(dice: random.Random, data: dict[str, Any]) -> dict[str, Any]:
    """Return a set with one or two of its experiments, so that a case takes little time."""
    experiments = data["experiments"]
    data["experiments"] = dice.sample(experiments, min(len(experiments), dice.randint(1, 2)))
    for experiment in data["experiments"]:
        for part in ("scenarios", "scenes", "initiators", "clusterings"):
            if part in experiment:
                kept = dice.sample(experiment[part], min(len(experiment[part]), 2))
                experiment[part] = kept
    return data


def places(data: Any) -> Iterator[Place]:
    """Yield every place of a tree of data."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in list(entries):
        yield data, key
        yield from places(value)


def chosen(dice: random.Random, data: Any, holds: Callable[[Any], bool] = lambda _: True) -> Place | None:
    """Return a random place whose value is of a kind; None where there is none."""
    fitting = [(box, key) for box, key in places(data) if holds(box[key])]
    return dice.choice(fitting) if fitting else None


def is_number(value: Any) -> bool:
    """Return whether a value is a number."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def change_number(dice: random.Random, data: Any) -> None:
    """Put a number in place of a number."""
    if place := chosen(dice, data, is_number):
        box, key = place
        box[key] = number(dice, box[key])


def change_numbers(dice: random.Random, data: Any) -> None:
    """Scale all numbers of one part alike: another unit, another size of world."""
    if place := chosen(dice, data, lambda value: isinstance(value, dict | list)):
        factor = 10.0 ** dice.randint(-12, 12)
        for box, key in places(place[0][place[1]]):
            if isinstance(box[key], float) or (is_number(box[key]) and dice.random() < 0.3):
                box[key] = box[key] * factor if abs(box[key]) < 1e290 else box[key]


def drop(dice: random.Random, data: Any) -> None:
    """Take a field or an element away."""
    if place := chosen(dice, data):
        del place[0][place[1]]


def repeat(dice: random.Random, data: Any) -> None:
    """Repeat an element of a list, seldom very often."""
    if place := chosen(dice, data, lambda value: isinstance(value, list) and bool(value)):
        box, key = place
        times = dice.choice((1, 1, 1, 2, 10, 3_000))
        box[key] += [copy.deepcopy(dice.choice(box[key])) for _ in range(times if len(box[key]) < 50 else 1)]


def rename(dice: random.Random, data: Any) -> None:
    """Give a field another name."""
    if place := chosen(dice, data, lambda _: True):
        box, key = place
        if isinstance(box, dict):
            name = dice.choice(
                (key[:-1], key.upper(), key + "s", hostile(dice, key), dice.choice(vocabulary()[0]))
            )
            box[name] = box.pop(key)


def add(dice: random.Random, data: Any) -> None:
    """Add a field that some part of a set has."""
    boxes = [data, *(box[key] for box, key in places(data) if isinstance(box[key], dict))]
    names, words = vocabulary()
    value = dice.choice(
        (dice.choice(USUAL), dice.choice(EXTREMES), dice.choice(words), [], {}, None, [0, 1], "auto")
    )
    dice.choice(boxes)[dice.choice(names)] = value


def say_another_word(dice: random.Random, data: Any) -> None:
    """Put a word that some field takes in place of a word."""
    if place := chosen(dice, data, lambda value: isinstance(value, str)):
        place[0][place[1]] = dice.choice(vocabulary()[1])


def change_text(dice: random.Random, data: Any) -> None:
    """Put something hostile into a text."""
    if place := chosen(dice, data, lambda value: isinstance(value, str)):
        place[0][place[1]] = hostile(dice, place[0][place[1]])


def reshape(dice: random.Random, data: Any) -> None:
    """Put a value of another shape in place of a value."""
    if place := chosen(dice, data):
        box, key = place
        value = box[key]
        shapes: list[Any] = [
            [value],
            {"name": value},
            None,
            True,
            False,
            "auto",
            [],
            {},
            str(value),
            value,
            -1,
        ]
        shapes += [value[0]] if isinstance(value, list) and value else []
        shapes += [value[:-1], [*value, value[-1]]] if isinstance(value, list) and value else []
        shapes += [list(value.values())] if isinstance(value, dict) else []
        box[key] = dice.choice(shapes)


def swap(dice: random.Random, data: Any) -> None:
    """Exchange two values."""
    one, other = chosen(dice, data), chosen(dice, data)
    if one and other:
        value = copy.deepcopy(one[0][one[1]])
        one[0][one[1]] = copy.deepcopy(other[0][other[1]])
        other[0][other[1]] = value


def sweep(dice: random.Random, data: Any) -> None:
    """Sweep some field over some values."""
    experiments = data.get("experiments")
    if isinstance(experiments, list) and experiments and isinstance(experiments[0], dict):
        names = vocabulary()[0]
        path = dice.choice(
            ("", "", "scenario.", "initiator.", "scene.", "clustering.", "scenario.sensor.")
        ) + dice.choice(
            (
                *names,
                "scenario.targets.0.position.0",
                "clutter[0].rate",
                "grid.theta_bins",
                "scans",
                "interval",
            )
        )
        pool = dice.choice((USUAL, EXTREMES))
        values = [dice.choice(pool) for _ in range(dice.choice((1, 2, 3)))]
        if not isinstance(experiments[0].get("sweep"), dict) or dice.random() < 0.5:
            experiments[0]["sweep"] = {}
        experiments[0]["sweep"][path] = values


def nest(dice: random.Random, data: Any) -> None:
    """Put a value deep into lists or mappings."""
    if place := chosen(dice, data):
        box, key = place
        for _ in range(dice.choice((3, 40, 99, 101, 300))):
            box[key] = [box[key]] if dice.random() < 0.5 else {"name": box[key]}


# Numbers come most often: they alone leave a set valid as a rule.
MUTATIONS: tuple[Callable[[random.Random, Any], None], ...] = (
    *(change_number,) * 18,
    *(change_numbers,) * 4,
    *(repeat,) * 2,
    *(sweep, add, say_another_word, drop, rename, change_text, reshape, swap, nest),
)


class _Dumper(yaml.SafeDumper):
    """Writes numbers as YAML 1.2 reads them."""


def _float(dumper: _Dumper, value: float) -> Any:
    text = (
        repr(value) if math.isfinite(value) else {"nan": ".nan", "inf": ".inf", "-inf": "-.inf"}[str(value)]
    )
    # PyYAML would put a tag before a number that it takes for text itself.
    text = text.replace("e", ".0e") if "e" in text and "." not in text else text
    return dumper.represent_scalar("tag:yaml.org,2002:float", text)


_Dumper.add_representer(float, _float)


def written(dice: random.Random, data: Any) -> str:
    """Return data as YAML of some layout."""
    layout = dice.randrange(6)
    if layout == 0:
        return json.dumps(
            data, indent=dice.choice((None, 2)), ensure_ascii=dice.random() < 0.5, allow_nan=True
        )
    is_plain = layout < 4
    text: str = yaml.dump(
        copy.deepcopy(json.loads(json.dumps(data))) if is_plain else data,
        Dumper=_Dumper,
        sort_keys=False,
        allow_unicode=dice.random() < 0.5,
        default_flow_style=dice.choice((None, False, False, True)),
        width=dice.choice((80, 10_000)),
    )
    return text


def _with_merge_key(dice: random.Random, text: str) -> str:
    return _after_a_line(dice, text, dice.choice(("<<: {name: a}", "<<: *base", "<<: [*a, *b]", "? <<\n: 1")))


def _with_anchor(dice: random.Random, text: str) -> str:
    parts = ("&a a: 1", "b: *a", "a: &a [*a]", "x: &x {y: &y [1, 2], z: *y}", "k: &k 1\nl: *k")
    return _after_a_line(dice, text, dice.choice(parts))


def _exploding(_: random.Random, text: str) -> str:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 9)}]" for level in range(1, 12)]
    return "\n".join(lines) + "\n" + text


def _tagged(dice: random.Random, text: str) -> str:
    tags = (
        "!!python/object/apply:os.system ['true']",
        "!!binary aGk=",
        "!!set {a, b}",
        "!tag 1",
        "!!float 1",
        "! 5",
    )
    return (
        text.replace(": ", f": {dice.choice(tags)} ", 1)
        if dice.random() < 0.5
        else f"{dice.choice(tags)}\n{text}"
    )


def _directed(dice: random.Random, text: str) -> str:
    return (
        dice.choice(
            ("%YAML 1.1\n---\n", "%YAML 3.0\n---\n", "%TAG ! tag:x,2000:\n---\n", "--- ", "---\n---\n")
        )
        + text
    )


def _two_documents(dice: random.Random, text: str) -> str:
    return text + dice.choice(("\n---\n", "\n...\n", "\n---\nname: two\n", "\n...\nrest"))


def _deep(dice: random.Random, text: str) -> str:
    depth = dice.choice((50, 99, 101, 2_000, 100_000))
    return dice.choice(
        ("[" * depth, "x: " + "{a: " * depth, "- " * depth, "? " * depth, text + "\nx: " + "[" * depth)
    )


def _repeated_key(dice: random.Random, text: str) -> str:
    lines = [line for line in text.split("\n") if ":" in line] or [text]
    return _after_a_line(dice, text, dice.choice(lines).strip())


def _with_odd_number(dice: random.Random, text: str) -> str:
    odd = (
        "0x1F",
        "0o17",
        "1_000",
        "1e999",
        "-1e999",
        "1" * 5_000,
        "+.inf",
        ".NaN",
        "0b11",
        "1:30",
        "٣",
        "1e-400",
        "--1",
        "0777",
    )
    places = [at for at, character in enumerate(text) if character.isdigit()] or [0]
    at = dice.choice(places)
    return text[:at] + dice.choice(odd) + text[at + 1 :]


def _after_a_line(dice: random.Random, text: str, addition: str) -> str:
    lines = text.split("\n")
    at = dice.randrange(len(lines))
    blank = lines[at][: len(lines[at]) - len(lines[at].lstrip())]
    lines[at + 1 : at + 1] = [blank + line for line in addition.split("\n")]
    return "\n".join(lines)


YAML_MUTATIONS: tuple[Callable[[random.Random, str], str], ...] = (
    _with_merge_key,
    _with_anchor,
    _exploding,
    _tagged,
    _directed,
    _two_documents,
    _deep,
    _repeated_key,
    _with_odd_number,
)
