"""Messages about files with very long texts and very many faults stay readable."""

import pytest

from algorithms.errors import RequestError
from scenarios.files.point_files import parse_points
from scenarios.files.set_files import parse_set
from scenarios.recordings.csv_plots import parse_plots

LONG = "a" * 50_000
SET = """\
schema: 1
name: small
scenarios:
  - name: one
    unit: km
    scans: 5
    interval: 4
    region: {x: [0, 100], y: [0, 100]}
    sensor: {sigma: 0.1, detection_probability: 0.9}
    clutter: [{rate: 5}]
    targets:
      - {position: [40, 20], velocity: [0.3, 0.18]}
initiators:
  - {name: standard, votes: 4}
experiments:
  - {name: basic, sweep: {scans: [5, 6]}, trials: 10, criterion: {rho: 3.0}}
"""
TARGET = "      - {position: [40, 20], velocity: [0.3, 0.18]}\n"

LONG_SETS = {
    "name": SET.replace("name: one", f"name: {LONG}"),
    "name that is no name": SET.replace("name: one", f"name: '{LONG}!'"),
    "word": SET.replace("unit: km", f"unit: {LONG}"),
    "kind": SET.replace("{sigma", f"{{kind: {LONG}, sigma"),
    "text for a number": SET.replace("scans: 5\n", f"scans: {LONG}\n"),
    "number of many digits": SET.replace("scans: 5\n", f"scans: {'9' * 4_000}\n"),
    "unknown key": SET.replace("unit: km", f"? {LONG}\n    : km"),
    "key twice": f"? {LONG}\n: 1\n" * 2,
    "key that is no text": f"? [{LONG}]\n: 1\n",
    "tag": SET.replace("unit: km", f"unit: !{LONG} km"),
    "alias": SET.replace("unit: km", f"unit: *{LONG}"),
    "directive": f"%TAG {LONG}\n---\n{SET}",
    "swept key": SET.replace("{scans: [5", f"{{? {LONG} : [5"),
    "swept index": SET.replace("{scans: [5", f"{{targets.{'9' * 5_000}.birth: [5"),
    "swept key among many": SET.replace("{scans: [5", "{nothing: [5").replace(TARGET, TARGET * 100),
    "swept key of many": SET.replace("{scans: [5", "{birth: [5").replace(TARGET, TARGET * 100),
    "unknown name": SET.replace("trials: 10", f"scenarios: [{LONG}]"),
    "deep path": SET.replace("unit: km", f"unit: {'[' * 90}1{']' * 90}"),
    "many faults": SET.replace(TARGET, TARGET.replace("40", "x") * 100),
    "many repeated names": SET.replace(TARGET, TARGET) + "  - {name: basic, criterion: {rho: 1}}\n" * 100,
}

LONG_TABLES = {
    "column": f"scan,x,{LONG}\n0,1,2\n",
    "near column": f"scan,x,{LONG} y\n0,1,2\n",
    "column twice": f"scan,x,{LONG},{LONG}\n0,1,2,3\n",
    "many columns": ",".join(f"column {index}" for index in range(20_000)) + "\n",
    "cell": f"scan,x,y\n0,{LONG},2\n",
    "digits": f"scan,x,y\n0,{'9' * 50_000},2\n",
}


def assert_readable(error):
    lines = str(error.value).splitlines()
    assert len(lines) <= 51
    assert max(map(len, lines)) <= 2_000


@pytest.mark.parametrize("text", LONG_SETS.values(), ids=LONG_SETS)
def test_message_about_a_long_set_is_short(text):
    with pytest.raises(RequestError) as error:
        parse_set(text, "set.yaml")
    assert_readable(error)


@pytest.mark.parametrize("parse", [parse_plots, parse_points])
@pytest.mark.parametrize("text", LONG_TABLES.values(), ids=LONG_TABLES)
def test_message_about_a_long_table_is_short(parse, text):
    with pytest.raises(RequestError) as error:
        parse(text, "plots.csv")
    assert_readable(error)


def test_message_counts_the_faults_left_out():
    with pytest.raises(RequestError, match=r"set\.yaml: … 50 more\Z"):
        parse_set(LONG_SETS["many faults"], "set.yaml")
