"""Text from outside through every command: none of its characters acts on the terminal."""

import csv
import json
import re
from pathlib import Path

import pytest

from hough_tui.reports.documents import csv_text

MARKS = "\u061c\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"
CONTROLS = "".join(map(chr, [*range(1, 10), *range(11, 32), *range(127, 160)])) + MARKS
"""All that acts and that a command line and a file's name can hold, but line feeds."""

NAME = f"[red]\x1b]0;owned\x07{CONTROLS}[bold]"
FILE = f"{NAME}\udcff"
"""With a byte that is no UTF-8, as a file's name may have."""

ACTING = re.compile(f"[{re.escape(CONTROLS)}\x00\ud800-\udfff]")
TEXT = f"{NAME}[/]\x00\n\r\n"
QUOTED = json.dumps(TEXT)
"""The same as YAML writes it, too."""

SET = """\
schema: 1
name: small
scenarios:
  - name: one
    scans: 4
    interval: 4
    region: {x: [0, 100], y: [0, 100]}
    sensor: {sigma: 0.1}
    clutter: [{rate: 5}]
    targets: [{position: [40, 20], velocity: [0.3, 0.18]}]
initiators: [{name: standard}]
experiments:
  - {name: swept, sweep: {sensor.detection_probability: [1, 0.2]}, trials: 4, seed: 3, criterion: {plots: 3}}
"""
PLOTS = [["scan", "x", "y", NAME], *([scan, 10 + scan, 20 + 2 * scan, TEXT] for scan in range(4))]


@pytest.fixture
def hostile(cli, tmp_path, monkeypatch):
    """Run a command on files of hostile names; return what it printed and said, which nothing of acts."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: object, status: int) -> str:
        ended, out, err = cli(*arguments)
        assert ended == status, err
        assert not ACTING.search(out + err), ascii(ACTING.search(out + err))
        assert "Traceback" not in err
        return out + err

    return run


def written(name: str, content: str) -> str:
    Path(name).write_bytes(content.encode("utf-8", "surrogatepass"))
    return name


def plots(rows: list[list[object]] = PLOTS, name: str = f"{FILE}.csv") -> str:
    with open(name, "w", encoding="utf-8", errors="surrogatepass", newline="") as file:
        csv.writer(file).writerows(rows)
    return name


@pytest.mark.parametrize(
    "text",
    [
        f"{QUOTED}: 1\n{SET}",
        SET.replace("small", QUOTED),
        SET.replace("small", f"!{NAME[:5]}%1B x"),
        SET.replace("small", f"!{QUOTED} x"),
        SET.replace("[{name: standard}]", f"[{{name: standard, initiator: {QUOTED}}}]"),
        SET.replace("sensor.detection_probability", QUOTED),
        SET.replace("sigma: 0.1", f"sigma: {QUOTED}"),
        SET.replace("criterion: {plots: 3}", f"criterion: {{{QUOTED}: 3}}"),
        f"{SET}# {CONTROLS}",
        f"{SET}{QUOTED}: 1\n{QUOTED}: 2\n",
        f"<<: &{QUOTED} x\n",
        f"a: *{CONTROLS}\n",
        f"%{CONTROLS}\n---\n",
        f"{CONTROLS}",
    ],
    ids=range(14),
)
def test_wrong_sets_are_told_visibly(hostile, text):
    said = hostile("validate", written(f"{FILE}.yaml", text), status=2)
    assert said.count(r"[red]\x1b]0;owned\x07\x01") >= 1


def test_sets_of_hostile_names_and_descriptions_run(hostile, tmp_path):
    path = written(f"{FILE}.yaml", SET.replace("schema", f"description: {QUOTED}\nschema"))
    assert r"\x1b]0;owned\x07" in hostile("validate", path, status=0)
    hostile("batch", path, "--plot", status=0)
    hostile("batch", path, "--experiment", NAME, status=2)
    hostile("batch", path, "--csv", f"{NAME}/rows.csv", status=1)
    hostile("simulate", path, "--scenario", NAME, status=2)
    hostile("simulate", path, "--set", f"{NAME}=1", status=2)
    hostile("simulate", path, "-o", f"{NAME}/plots.csv", status=1)
    hostile("advise", path, status=0)
    hostile("advise", f"{path}:{NAME}", status=2)
    hostile("advise", path, "--apply", path, status=0)
    hostile("initiate", plots(), "--like", path, status=0)


@pytest.mark.parametrize(
    "arguments",
    [
        [NAME],
        [f"--{NAME}"],
        ["open", NAME],
        ["batch", NAME],
        ["batch", "course-report", f"--metric={NAME}"],
        ["batch", "course-report", f"--trials={NAME}"],
        ["sets", NAME],
        ["sets", "course-report", NAME],
        ["initiators", NAME],
        ["validate", NAME],
        ["schema", NAME],
        ["simulate", NAME],
        ["simulate", "course-report", "--clustering", NAME],
        ["advise", NAME],
        ["advise", "--sigma=1", "--unit", NAME],
        ["advise", "--sigma=1", "--region", NAME],
        ["cluster", NAME],
        ["cluster", NAME, "--mode", NAME],
        ["cluster", NAME, "--result", NAME],
        ["reproduce", NAME],
        ["results", NAME],
        ["results", "show", NAME],
        ["results", "compare", NAME, NAME],
        ["results", "compare", NAME],
        ["results", "export", NAME, f"{NAME}.csv"],
        ["results", "export", NAME, NAME],
        ["initiate", NAME],
        ["initiate", NAME, "-i", NAME],
        ["initiate", NAME, "--scans", NAME],
        ["initiate", NAME, "--set", NAME],
        ["initiate", NAME, "--config", NAME],
        ["initiate", NAME, "--like", NAME],
    ],
    ids=lambda arguments: "-".join(arguments).replace(NAME, "X"),
)
def test_wrong_arguments_are_told_visibly(hostile, arguments):
    hostile(*arguments, status=2)


@pytest.mark.parametrize(
    "rows",
    [
        [["scan", NAME], [0, 1]],
        [["scan", "x", "y", NAME, NAME], [0, 1, 2, 3, 4]],
        [["scan", "x", "y"], [0, 1, TEXT]],
        [["scan", "x", "y"], [NAME, 1, 2]],
        [["scan", "x", "y"], [0, 1, 2, NAME]],
        [["range", "doppler", "amplitude"], [0, 1, TEXT]],
    ],
    ids=range(6),
)
def test_wrong_tables_are_told_visibly(hostile, rows):
    for command in ("initiate", "cluster"):
        hostile(command, plots(rows), status=2)


def test_recorded_plots_of_hostile_columns_are_initiated(hostile):
    assigned = f"{NAME}-tracks.csv"
    hostile("initiate", plots(), "--plot", "--assigned", assigned, "--set", "votes=3", status=0)
    with open(assigned, encoding="utf-8", errors="surrogatepass", newline="") as file:
        header = next(csv.reader(file))
    assert header[:4] == PLOTS[0], "a file that is written keeps the true name"
    points = [["range", "doppler", "amplitude", NAME], *([10 + k, 2, 5, TEXT] for k in range(3))]
    hostile("cluster", plots(points), "--range-extent", 9, "--doppler-extent", 9, "--plot", status=0)


def test_kept_runs_of_hostile_names_are_shown(hostile, data_home):
    name = re.search(r"kept as (\S+)", hostile("batch", written("small.yaml", SET), status=0))[1]
    folder = data_home / "hough-tui" / "runs" / name
    document = json.loads((folder / "result.json").read_text())
    for row in document["rows"]:
        row |= {part: f"{TEXT}\ud800" for part in ("set", "experiment", "scenario", "initiator")}
        (swept,) = row["swept"].values()
        row["swept"] = {TEXT: swept, NAME: NAME}
    (folder / "result.json").write_text(json.dumps(document))
    folder.rename(folder.with_name(FILE))
    hostile("results", "list", status=0)
    hostile("results", "show", FILE, "--plot", status=0)
    printed = hostile("results", "show", FILE, "--json", status=0)
    assert json.loads(printed)["rows"] == document["rows"]
    for ending in ("json", "csv", "md"):
        hostile("results", "export", FILE, f"{FILE}.{ending}", status=0)
    assert json.loads(Path(f"{FILE}.json").read_text())["rows"] == document["rows"]
    assert not ACTING.search(Path(f"{FILE}.md").read_text())
    assert Path(f"{FILE}.csv").read_bytes() == csv_text(document["rows"]).encode("utf-8", "backslashreplace")
