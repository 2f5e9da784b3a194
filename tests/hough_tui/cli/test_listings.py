"""`sets`, `initiators`, `validate`, `schema`, `reproduce`: what there is, and what goes into a set."""

import copy
import json
from pathlib import Path

import pytest
from pydantic import BaseModel

from algorithms.initiators.registry import initiators
from hough_tui.cli import run as run_command
from hough_tui.published.comparison import TABLES
from scenarios.files.bundled import bundled_paths
from scenarios.files.marked_yaml import read
from scenarios.files.set_files import load_set

PROJECT = Path(__file__).parents[3]


@pytest.fixture
def cli(data_home, monkeypatch, capsys):
    """Run a command that must succeed; return what it printed."""
    monkeypatch.setenv("COLUMNS", "600")  # so that no cell is broken over lines

    def run(*arguments: object) -> str:
        with pytest.raises(SystemExit) as ended:
            run_command([*map(str, arguments)])
        out, err = capsys.readouterr()
        assert not ended.value.code, err
        assert "\x1b" not in out
        return out

    return run


# Sets


def test_the_bundled_sets_are_listed(cli):
    listed = json.loads(cli("sets", "--json"))["sets"]
    assert [found["name"] for found in listed] == sorted(bundled_paths())
    assert {"course-report", "course-text"} <= {found["name"] for found in listed}
    table = cli("sets")
    for found in listed:
        assert found["description"]
        assert found["name"] in table
        assert found["description"] in table


@pytest.mark.parametrize("name", sorted(bundled_paths()))
def test_a_set_is_printed_as_it_is_and_valid(cli, name, tmp_path):
    text = cli("sets", name)
    assert text == bundled_paths()[name].read_text(encoding="utf-8")
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    assert load_set(path) == load_set(name)
    assert cli("validate", path, name).splitlines()[0].startswith(f"{path}: valid: ")


def test_validate_counts_what_a_set_has(cli):
    found = load_set("course-report")
    name, _, counts = cli("validate", "course-report").partition(": valid: ")
    assert name == "course-report"
    numbers = [int(word) for word in counts.split() if word.isdecimal()]
    assert numbers == [len(found.scenarios), len(found.initiators), len(found.experiments)]


def test_validate_tells_the_wrong_and_the_right(monkeypatch, capsys, tmp_path):
    path = tmp_path / "wrong.yaml"
    path.write_text("schema: 1\n")
    with pytest.raises(SystemExit) as ended:
        run_command(["validate", str(path), "course-text"])
    out, err = capsys.readouterr()
    assert ended.value.code == 2
    assert out.startswith("course-text: valid")
    assert f"{path}:1:1: name: is missing" in err
    assert f"{path}:1:1: scenarios: is missing" in err


# Initiators


def declared(model: type[BaseModel], prefix: str = ""):
    """Yield the dotted names of the parameters of a model, with their help."""
    for name, field in model.model_fields.items():
        if isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel):
            yield from declared(field.annotation, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", field.description


def test_the_initiators_are_listed(cli):
    told = json.loads(cli("initiators", "--json"))["initiators"]
    assert [found["name"] for found in told] == list(initiators())
    table = cli("initiators")
    for found in told:
        assert found["name"] in table
        assert found["summary"] in table


@pytest.mark.parametrize("name", sorted(initiators()))
def test_an_initiator_names_every_parameter_with_its_help(cli, name):
    expected = dict(declared(initiators()[name].parameters))
    assert expected
    (told,) = json.loads(cli("initiators", name, "--json"))["initiators"]
    assert {found["name"]: found["help"] for found in told["parameters"]} == expected
    lines = cli("initiators", name).splitlines()
    for parameter, text in expected.items():
        assert text
        (line,) = [line for line in lines if line.split(" ")[0] == parameter]
        assert text in line


def test_a_parameter_tells_its_default_and_what_is_allowed(cli):
    (declared,) = json.loads(cli("initiators", "sequential", "--json"))["initiators"]
    told = {parameter["name"]: parameter for parameter in declared["parameters"]}
    assert told["maxima"]["default"] == 2
    assert told["ties"]["allowed"] == "last, first"
    assert told["fraction"]["allowed"] == "number ≥ 0, ≤ 1"
    assert told["grid.rho_step"]["default"] == "auto"
    assert told["grid.rho_step"]["auto"]
    assert told["grid.rho_step"]["dimension"] == "length"


# The schema

TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "number": (int, float),
    "integer": int,
    "boolean": bool,
    "null": type(None),
}


def is_valid(value, schema, root) -> bool:
    """Return whether a value is as a JSON Schema says, as far as this one goes."""
    if "$ref" in schema:
        return is_valid(value, root["$defs"][schema["$ref"].removeprefix("#/$defs/")], root)
    for key in ("anyOf", "oneOf"):
        if key in schema and not any(is_valid(value, part, root) for part in schema[key]):
            return False
    if "type" in schema:
        if not isinstance(value, TYPES[schema["type"]]):
            return False
        if isinstance(value, bool) and schema["type"] != "boolean":
            return False
    if ("const" in schema and value != schema["const"]) or ("enum" in schema and value not in schema["enum"]):
        return False
    if isinstance(value, dict):
        fields, further = schema.get("properties", {}), schema.get("additionalProperties", {})
        if not set(schema.get("required", ())) <= set(value):
            return False
        for key, part in value.items():
            rule = fields.get(key, further)
            if rule is False or not (rule is True or is_valid(part, rule, root)):
                return False
    elif isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
            return False
        first = schema.get("prefixItems", [])
        rules = [*first, *[schema.get("items", {})] * (len(value) - len(first))]
        return all(is_valid(part, rule, root) for part, rule in zip(value, rules, strict=False))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        return (
            schema.get("minimum", value) <= value <= schema.get("maximum", value)
            and ("exclusiveMinimum" not in schema or value > schema["exclusiveMinimum"])
            and ("exclusiveMaximum" not in schema or value < schema["exclusiveMaximum"])
        )
    return True


@pytest.fixture
def schema(cli):
    return json.loads(cli("schema"))


@pytest.mark.parametrize("name", sorted(bundled_paths()))
def test_the_bundled_sets_are_as_the_schema_says(schema, name):
    path = bundled_paths()[name]
    data = read(path.read_text(encoding="utf-8"), str(path)).data
    assert is_valid(data, schema, schema)
    spoils = [
        lambda wrong: wrong.pop("name"),
        lambda wrong: wrong.update(schema=2),
        lambda wrong: wrong.update(extra=1),
        lambda wrong: wrong.update(scenarios=[], scenes=[]),
    ]
    if "scenarios" in data:
        spoils += [
            lambda wrong: wrong["scenarios"][0].update(scans=0),
            lambda wrong: wrong["scenarios"][0].update(scans="5"),
            lambda wrong: wrong["scenarios"][0].update(unit="feet"),
            lambda wrong: wrong["scenarios"][0]["sensor"].update(detection_probability=1.5),
            lambda wrong: wrong["scenarios"][0]["targets"][0].update(position=[1]),
            lambda wrong: wrong["initiators"][0].update(fraction=-1),
            lambda wrong: wrong["experiments"][-1].pop("criterion"),
        ]
    if "scenes" in data:
        spoils += [
            lambda wrong: wrong["scenes"][0].update(noise=-1),
            lambda wrong: wrong["scenes"][0]["targets"][0].update(points=0),
            lambda wrong: wrong["clusterings"][0].update(eps=1),
            lambda wrong: wrong["clusterings"][0].update(name="other"),
            lambda wrong: wrong["experiments"][0].pop("kind"),
        ]
    for spoil in spoils:
        wrong = copy.deepcopy(data)
        spoil(wrong)
        assert not is_valid(wrong, schema, schema)


def test_every_field_of_the_schema_has_a_description(schema):
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert schema["properties"].keys() >= {"schema", "name", "scenarios", "initiators", "experiments"}
    models = {"the set": schema, **schema["$defs"]}
    fields = {
        f"{model}.{name}": field
        for model, found in models.items()
        for name, field in found.get("properties", {}).items()
    }
    assert len(fields) > 40
    assert {name for name, field in fields.items() if not field.get("description")} == set()


def test_the_schema_knows_every_initiator_and_its_parameters(schema):
    entries = {
        found["properties"]["initiator"].get("const"): found["properties"]
        for found in schema["$defs"].values()
        if "initiator" in found.get("properties", {})
    }
    assert entries.keys() == initiators().keys()
    for name, algorithm in initiators().items():
        assert entries[name].keys() == {"name", "initiator", *algorithm.parameters.model_fields}


# Published tables


def test_a_published_table_stands_beside_what_is_measured(cli):
    (told,) = json.loads(cli("reproduce", "course-2-1", "--trials", 200, "--json"))["tables"]
    assert (told["table"], told["trials"]) == ("course-2-1", 200)
    row = told["rows"][0]
    assert row.keys() >= {"case", "metric", "published", "measured", "ci95", "consistent", "note"}
    assert (row["case"], row["metric"], row["published"]) == ("standard, 5 scans", "success_rate", 1.0)
    assert row["ci95"][0] <= row["measured"] <= row["ci95"][1]
    assert row["consistent"] is True
    every = json.loads(cli("reproduce", "--trials", 2, "--json"))
    assert [table["table"] for table in every["tables"]] == list(TABLES)
    assert "standard, 15 scans" in cli("reproduce", "course-2-1", "--trials", 20)
