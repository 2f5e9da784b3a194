from __future__ import annotations

import csv
import io
import json
import re

import numpy as np
import pytest

from hough_tui.reports.documents import csv_text, document_text, json_text, markdown_text


def read_csv(text):
    return list(csv.DictReader(io.StringIO(text)))


def read_markdown(text):
    tables = []
    for block in re.split(r"\n\n+", text):
        if block.startswith("|"):
            lines = [re.split(r"(?<!\\)\|", line)[1:-1] for line in block.strip().split("\n")]
            tables.append([[cell.strip().replace("\\|", "|") for cell in line] for line in lines])
    return tables


def test_csv_keeps_every_number(rows):
    read = read_csv(csv_text(rows))
    assert len(read) == len(rows)
    for found, row in zip(read, rows, strict=True):
        assert found["initiator"] == row["initiator"]
        for key, value in row["swept"].items():
            assert float(found[f"swept.{key}"]) == value
        if row["success_rate_ci95"]:
            low, high = row["success_rate_ci95"]
            assert float(found["success_rate_ci95_low"]) == low
            assert float(found["success_rate_ci95_high"]) == high
            assert float(found["success_by_target.1"]) == row["success_by_target"][1]
            assert float(found["duplicates_per_trial"]) == row["duplicates_per_trial"]
        else:
            assert found["success_rate"] == found["success_rate_ci95_low"] == ""


def test_csv_columns_of_one_key_stay_together(rows):
    header = csv_text(rows).split("\n")[0].split(",")
    places = [index for index, name in enumerate(header) if name.startswith("swept.")]
    assert places == list(range(places[0], places[0] + 4))
    assert header.index("initiator") < places[0] < header.index("trials")


def test_csv_of_awkward_values():
    text = csv_text([{"set": 'a, "b"\nc', "success_rate": float("inf"), "ok": True, "n": np.int64(3)}])
    assert read_csv(text) == [{"set": 'a, "b"\nc', "success_rate": "", "ok": "true", "n": "3"}]
    assert csv_text([]) == "\n"


def test_markdown_has_a_table_an_experiment(rows):
    text = markdown_text(rows)
    tables = read_markdown(text)
    assert text.count("### ") == len(tables) == 3
    for table in tables:
        assert len({len(line) for line in table}) == 1
        assert set("".join(table[1])) <= set("-:")
    head, _, first, *_ = tables[1]
    found = dict(zip(head, first, strict=True))
    assert found["scenario"] == "two-crossing"
    assert found["grid.theta_bins"] == "90"
    assert found["clutter.0.rate"] == "12.5"
    assert found["success %"] == "90.0"
    assert "88.0–91.0" in first
    assert "A track matches a target when |Δρ| ≤ 3 km, θ not compared." in text


def test_markdown_escapes_bars(row):
    (table,) = read_markdown(markdown_text([row("a|b")]))
    assert table[2][0] == "a|b"


def test_json_round_trip(rows, tracks):
    document = {"sets": ["course-report"], "seed": 7, "rows": rows, "tracks": tracks}
    text = json_text(document)
    assert json.loads(text) == document
    assert text.endswith("}\n")
    assert list(json.loads(text)) == list(document)
    assert '"swept": {"scans": 5}' in text


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf"), np.float64("nan")])
def test_json_knows_no_nan(value):
    assert json.loads(json_text({"a": value, "b": [value, 1]}), parse_constant=pytest.fail) == {
        "a": None,
        "b": [None, 1],
    }


def test_json_of_arrays_and_long_lists():
    plots = list(range(5000))
    text = json_text({"plots": np.arange(5000), "xy": np.eye(2), "empty": [], "none": {}, "σ": (1.5, "µ")})
    assert json.loads(text) == {
        "plots": plots,
        "xy": [[1.0, 0.0], [0.0, 1.0]],
        "empty": [],
        "none": {},
        "σ": [1.5, "µ"],
    }
    assert text.count("\n") < 12


def test_json_refuses_what_it_does_not_know():
    with pytest.raises(TypeError, match="object"):
        json_text({"a": object()})


def test_documents_say_their_format_and_version_first():
    document = json.loads(document_text({"sets": []}))
    assert list(document) == ["format", "version", "sets"]
    assert document["format"] == 2
    assert json.loads(document_text({"version": "0.0.1", "rows": []}))["version"] == "0.0.1"
