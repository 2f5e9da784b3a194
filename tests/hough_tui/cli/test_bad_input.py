"""Wrong requests: each is one message, exit status 2, nothing printed and nothing written."""

import re

import pytest

from hough_tui.cli import run as run_command

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
    clutter: [{kind: poisson, rate: 5}]
    targets:
      - {name: rising, position: [40, 20], velocity: [0.3, 0.18], birth: 1, death: 4}
initiators:
  - name: standard
    votes: 4
    grid: {theta_bins: 90, rho_min: -150, rho_step: 0.6, rho_bins: 1000}
experiments:
  - name: basic
    sweep: {scans: [5, 6]}
    trials: 10
    seed: 3
    criterion: {rho: 3.0, theta_deg: 6}
"""

CSV = "scan,x,y\n" + "".join(f"{scan},{10 + scan},{20 + 2 * scan}\n" for scan in range(5))


def tree(folder):
    return sorted((path, path.stat().st_mtime_ns) for path in folder.rglob("*"))


@pytest.fixture
def ending(data_home, tmp_path, monkeypatch, capsys):
    """Run a command that must fail; return what it says, once all else that is promised is checked."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")

    def run(*arguments: object) -> str:
        before = tree(tmp_path)
        with pytest.raises(SystemExit) as ended:
            run_command([*map(str, arguments)])
        out, err = capsys.readouterr()
        assert ended.value.code == 2, err
        assert out == ""
        assert "Traceback" not in err
        assert tree(tmp_path) == before
        return "".join(
            line for line in err.splitlines(keepends=True) if not line.startswith("hough-tui: compiling")
        )

    return run


@pytest.fixture
def refusal(ending):
    def run(*arguments: object) -> str:
        err = ending(*arguments)
        assert err.startswith("hough-tui: ")
        assert err.endswith("\n")
        assert err.count("hough-tui: ") == 1
        return err.removeprefix("hough-tui: ").rstrip("\n")

    return run


@pytest.fixture
def write(tmp_path):
    def keep(name: str, content: str | bytes):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    return keep


# Scenario sets; ▸ marks the place that the message must name

WRONG_FIELDS = {
    "unknown key": ("scans: 5", "▸scnas: 5", ["scenarios[0].scnas", "did you mean 'scans'"]),
    "unknown key deep": ("rate: 5", "▸rat: 5", ["clutter[0].rat", "did you mean 'rate'"]),
    "unknown parameter": ("votes: 4", "▸vote: 4", ["initiators[0].vote", "did you mean 'votes'"]),
    "missing": ("name: one\n    unit: km\n    scans: 5", "▸name: one", ["scenarios[0].scans", "missing"]),
    "text for a whole number": ("scans: 5", "scans: ▸five", ["scans", "'five'", "whole number"]),
    "a fraction of a scan": ("scans: 5", "scans: ▸5.5", ["scans", "5.5", "whole number"]),
    "a quoted number": ("interval: 4", "interval: ▸'4'", ["interval", "'4'", "a number"]),
    "truth for a number": ("interval: 4", "interval: ▸true", ["interval", "true", "a number"]),
    "yes is text": ("interval: 4", "interval: ▸yes", ["interval", "'yes'", "a number"]),
    "a mapping for a list": ("[{kind: poisson, rate: 5}]", "▸{rate: 5}", ["clutter", "mapping", "a list"]),
    "a number for a region": ("{x: [0, 100], y: [0, 100]}", "▸7", ["region", "7 is given", "a mapping"]),
    "a position of one": ("[40, 20]", "▸[40]", ["targets[0].position", "a list of 1", "a list of 2"]),
    "unknown unit": ("unit: km", "unit: ▸feet", ["unit", "'feet'", "'km', 'm' or 'nmi'"]),
    "negative noise": ("sigma: 0.1", "sigma: ▸-0.1", ["sensor.sigma", "-0.1", "at least 0"]),
    "noise on one axis": ("sigma: 0.1", "sigma: [0.1, ▸-2]", ["sensor.sigma[1]", "-2", "at least 0"]),
    "Pd above 1": ("0.9", "▸1.2", ["sensor.detection_probability", "1.2", "at most 1"]),
    "Pd below 0": ("0.9", "▸-0.2", ["sensor.detection_probability", "-0.2", "at least 0"]),
    "Pd not a number": ("0.9", "▸.nan", ["sensor.detection_probability", "nan", "finite"]),
    "infinite interval": ("interval: 4", "interval: ▸.inf", ["interval", "inf", "finite"]),
    "past the floats": ("interval: 4", "interval: ▸1e999", ["interval", "inf", "finite"]),
    "past any radar": ("interval: 4", "interval: ▸1e13", ["interval", "10000000000000.0", "at most 1e+12"]),
    "hardly any time": ("interval: 4", "interval: ▸1e-300", ["interval", "1e-300", "at least 1e-12"]),
    "a place past any radar": ("[40, 20]", "[40, ▸-1e300]", ["position[1]", "-1e+300", "at least -1e+12"]),
    "NaN in a list": ("[40, 20]", "[40, ▸.nan]", ["position[1]", "nan", "finite"]),
    "infinite bound": ("y: [0, 100]", "y: [0, ▸.inf]", ["region.y[1]", "inf", "finite"]),
    "NaN swept": ("[5, 6]", "[5, ▸.nan]", ["experiments[0].sweep.scans[1]", "nan", "finite"]),
    "zero scans": ("scans: 5", "scans: ▸0", ["scenarios[0].scans", "0 is given", "at least 1"]),
    "zero scans swept": ("[5, 6]", "[5, ▸0]", ["sweep.scans[1]", "0 is given", "at least 1"]),
    "no time between scans": ("interval: 4", "interval: ▸0", ["interval", "0 is given", "greater than 0"]),
    "no trials": ("trials: 10", "trials: ▸0", ["experiments[0].trials", "0 is given", "at least 1"]),
    "too many trials": ("trials: 10", "trials: ▸10000001", ["trials", "10000001", "at most 10000000"]),
    "too many scans": ("scans: 5", "scans: ▸100001", ["scenarios[0].scans", "100001", "at most 100000"]),
    "past any whole number": ("scans: 5", f"scans: ▸{10**30}", ["scenarios[0].scans", "at most"]),
    "too many rows": ("theta_bins: 90", "theta_bins: ▸100001", ["grid.theta_bins", "at most 100000"]),
    "a parameter of another": ("votes: 4", "▸mode: sound", ["initiators[0].mode", "known: grid, votes"]),
    "text for truth": ("trials: 10", "control: ▸no", ["experiments[0].control", "'no'", "true or false"]),
    "negative seed": ("seed: 3", "seed: ▸-1", ["experiments[0].seed", "-1", "at least 0"]),
    "no area": ("x: [0, 100]", "x: ▸[5, 5]", ["region.x", "[5, 5]", "less than"]),
    "bounds in the wrong order": ("y: [0, 100]", "y: ▸[9, 1]", ["region.y", "[9, 1]", "less than"]),
    "clutter of no area": ("rate: 5", "rate: 5, region: {x: ▸[1, 1], y: [0, 1]}", ["region.x", "[1, 1]"]),
    "too much clutter": ("rate: 5", "rate: ▸1e7", ["clutter[0].rate", "10000000", "at most 1"]),
    "dead before born": (
        "{name: rising, position: [40, 20], velocity: [0.3, 0.18], birth: 1, death: 4}",
        "▸{position: [40, 20], velocity: [0.3, 0.18], birth: 1, death: 0}",
        ["targets[0]", "death 0", "birth 1"],
    ),
    "unknown initiator": ("name: standard", "▸name: standrad", ["standrad", "did you mean 'standard'"]),
    "unknown initiator under a name": (
        "name: standard",
        "▸name: a\n    initiator: sequentail",
        ["initiators[0]", "sequentail", "did you mean 'sequential'"],
    ),
    "unknown scenario": (
        "trials: 10",
        "scenarios: [▸won]",
        ["experiments[0].scenarios[0]", "'won'", "did you mean 'one'"],
    ),
    "unknown entry": (
        "trials: 10",
        "initiators: [▸standart]",
        ["experiments[0].initiators[0]", "'standart'", "did you mean 'standard'"],
    ),
    "sweep of no field": (
        "scans: [5",
        "▸sensor.sigmo: [5",
        ["experiments[0].sweep.sensor.sigmo", "did you mean 'scenario.sensor.sigma'"],
    ),
    "no criterion": ("{rho: 3.0, theta_deg: 6}", "▸{}", ["criterion", "rho", "plots"]),
    "two criteria": ("{rho: 3.0, theta_deg: 6}", "▸{rho: 3, plots: 3}", ["criterion", "rho", "plots"]),
    "another layout": ("schema: 1", "schema: ▸2", ["schema", "2 is given", "it must be 1"]),
    "a name with a slash": ("name: small", "name: ▸../up", ["name", "'../up'", "of the form"]),
}


def marked(text: str) -> tuple[str, str]:
    """Return a text without its mark, and where the mark stood as `line:column`."""
    before = text[: text.index("▸")]
    return text.replace("▸", ""), f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"


@pytest.mark.parametrize(("given", "instead", "words"), WRONG_FIELDS.values(), ids=WRONG_FIELDS)
def test_a_wrong_field_is_named_with_its_place(refusal, write, given, instead, words):
    assert SET.count(given) == 1
    text, place = marked(SET.replace(given, instead))
    write("small.yaml", text)
    message = refusal("batch", "small.yaml", "--csv", "rates.csv")
    # Where there are several problems, each line has its own place.
    told = [line for line in message.splitlines() if line.startswith(f"small.yaml:{place}: ")]
    assert any(all(word in line for word in words) for line in told), message


def test_the_set_of_these_tests_is_right(write, data_home, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    write("small.yaml", SET)
    with pytest.raises(SystemExit) as ended:
        run_command(["validate", "small.yaml"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == "small.yaml: valid: 1 scenario, 1 initiator, 1 experiment\n"


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        (SET.replace("x: [0, 100]", "x: [0, 100"), "", ["not valid YAML"]),
        (SET.replace("    interval: 4", "   interval: 4"), "7:4", ["not valid YAML"]),
        (SET.replace("name: small", "name: 'small"), "", ["not valid YAML"]),
        (SET.replace("scans: 5", "scans: *five"), "6:12", ["*five", "anchor"]),
        (SET.replace("scans: 5", "scans: !!python/name:os.system 5"), "6:12", ["the tag"]),
        (SET.replace("interval: 4", "interval: 4\n    scans: 6"), "8:5", ["'scans'", "line 6", "line 8"]),
        (SET.replace("y: [0, 100]", "x: [0, 100]"), "8:27", ["'x'", "line 8"]),
        (SET + "---\n" + SET, "23:1", ["second document"]),
        ("", "", ["empty", "hough-tui schema"]),
        ("# nothing but a comment\n", "", ["empty"]),
        ("just text\n", "1:1", ["'just text'", "a mapping"]),
        ("- 1\n- 2\n", "1:1", ["a list of 2", "a mapping"]),
    ],
    ids=["bracket", "indent", "quote", "alias", "tag", "key twice", "key twice in braces", "two documents",
         "empty", "comment", "text", "list"],
)  # fmt: skip
def test_text_that_is_no_set_is_refused_with_line_and_column(refusal, write, text, place, words):
    write("small.yaml", text)
    message = refusal("batch", "small.yaml", "--csv", "rates.csv")
    assert re.match(r"small\.yaml:\d+:\d+: |small\.yaml: the file is empty", message)
    if place:
        assert message.startswith(f"small.yaml:{place}: ")
    for word in words:
        assert word in message


def test_one_fault_is_one_line(refusal, write):
    for given, instead in (("sigma: 0.1", "sigma: [0.1, -2]"), ("[5, 6]", "[5, .nan]"), ("[40, 20]", "[40]")):
        write("small.yaml", SET.replace(given, instead))
        assert "\n" not in refusal("validate", "small.yaml")


@pytest.mark.parametrize(
    ("part", "following", "entry"),
    [
        (
            "scenarios",
            "initiators:\n",
            "{name: ▸one, scans: 1, interval: 1, region: {x: [0, 1], y: [0, 1]}, sensor: {sigma: 1}}",
        ),
        ("initiators", "experiments:\n", "{name: ▸standard, votes: 9}"),
        ("experiments", "", "{name: ▸basic, criterion: {plots: 3}}"),
    ],
)
def test_a_name_given_twice_is_refused(refusal, write, part, following, entry):
    above, below = SET.split(following) if following else (SET, "")
    text, place = marked(f"{above}  - {entry}\n{following}{below}")
    write("small.yaml", text)
    message = refusal("validate", "small.yaml")
    assert message.startswith(f"small.yaml:{place}: {part}[1].name: '")
    assert f"{part}[0]" in message


def test_more_plots_than_a_trial_may_have_are_refused(refusal, write):
    write("small.yaml", SET.replace("scans: 5", "scans: 50").replace("rate: 5", "rate: 1e6"))
    message = refusal("batch", "small.yaml")
    assert message.startswith("small.yaml:4:5: scenarios[0]: a trial would hold about 50,000,050 plots")
    assert "the limit is 20,000,000" in message


def test_every_problem_of_a_file_is_told_at_once(refusal, write):
    text = SET.replace("scans: 5", "scans: 0").replace("0.9", "2").replace("votes: 4", "vtes: 4")
    write("small.yaml", text)
    message = refusal("validate", "small.yaml")
    assert [line.split(": ")[:2] for line in message.splitlines()] == [
        ["small.yaml:6:12", "scenarios[0].scans"],
        ["small.yaml:9:49", "scenarios[0].sensor.detection_probability"],
        ["small.yaml:15:5", "initiators[0].vtes"],
    ]


@pytest.mark.parametrize(
    ("given", "instead", "cells", "size"),
    [
        ("rho_bins: 1000", "rho_bins: 1000000000", "90 × 1,000,000,000", "335.3 GiB"),
        ("rho_min: -150, rho_step: 0.6, rho_bins: 1000", "rho_step: 1e-7", "90 × 1,414,213,563", "474.2 GiB"),
        ("scans: [5, 6]", "rho_bins: [5, 4000000]", "90 × 4,000,000", "1.3 GiB"),
    ],
)
def test_a_grid_too_large_for_memory_is_refused_with_its_size(refusal, write, given, instead, cells, size):
    assert given in SET
    write("small.yaml", SET.replace(given, instead))
    message = refusal("batch", "small.yaml")
    assert re.match(r"small\.yaml:\d+:\d+: experiments\[0\]", message)
    for word in ("standard", "one", cells, size, "the limit is 1 GiB"):
        assert word in message


SET_COMMANDS = {
    "batch": ("batch", "{}", "--csv", "rates.csv"),
    "simulate": ("simulate", "{}", "--output", "plots.csv"),
    "advise": ("advise", "{}"),
    "advise apply": ("advise", "course-report:two-crossing", "--apply", "{}"),
    "validate": ("validate", "{}"),
    "initiate": ("initiate", "plots-in.csv", "--like", "{}", "--assigned", "out.csv"),
}


@pytest.mark.parametrize("command", SET_COMMANDS)
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("nowhere.yaml", ["nowhere.yaml: there is no such file"]),
        ("folder", ["folder: this is a folder"]),
        ("latin.yaml", ["latin.yaml:2: ", "not UTF-8", "0xe9"]),
        ("course-reprot", ["'course-reprot'", "did you mean 'course-report'?", "course-text"]),
        ("broken.yaml", ["broken.yaml:2:7: "]),
    ],
)
def test_every_command_refuses_what_is_no_set(refusal, write, tmp_path, command, name, words):
    (tmp_path / "folder").mkdir()
    write("latin.yaml", b"schema: 1\nname: caf\xe9\n")
    write("broken.yaml", "schema: 1\nname: [\n".replace("[", "}"))
    write("plots-in.csv", CSV)
    message = refusal(*(part.format(name) for part in SET_COMMANDS[command]))
    for word in words:
        assert word in message


def test_the_sets_command_names_the_nearest_set_too(refusal):
    assert "did you mean 'course-text'?" in refusal("sets", "course-txet")
    assert "--json" in refusal("sets", "course-text", "--json")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["bacth"], ["'bacth'", "did you mean 'batch'?"]),
        (["course-reprot"], ["'course-reprot'", "did you mean 'course-report'?"]),
        (["batch", "course-report", "--experiment", "tabels"], ["'tabels'", "did you mean 'tables'?"]),
        (["batch", "course-report", "--json", "--plot"], ["--json", "--plot"]),
        (["batch", "course-report", "--json", "--csv", "-"], ["--json", "--csv -"]),
        (["reproduce", "course-21"], ["'course-21'", "did you mean 'course-2-1'?"]),
        (["initiators", "sequental"], ["'sequental'", "did you mean 'sequential'?"]),
        (["results", "show", "none-of-these"], ["'none-of-these'"]),
        (["results", "show", "x", "--json", "--plot"], ["--json", "--plot"]),
        (["simulate", "course-report"], ["two-crossing", "three-scans"]),
        (["simulate", "course-report", "--scenario", "two-crosing"], ["did you mean 'two-crossing'?"]),
    ],
    ids=lambda value: " ".join(value[:4]) if isinstance(value, list) else None,
)
def test_names_and_options_that_do_not_go(refusal, arguments, words):
    message = refusal(*arguments)
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("arguments", "option"),
    [
        (["batch", "course-report", "--trials", "0"], "--trials"),
        (["batch", "course-report", "--trials", "10000001"], "--trials"),
        (["batch", "course-report", "--trials", "many"], "--trials"),
        (["batch", "course-report", "--seed", "-1"], "--seed"),
        (["batch", "course-report", "--seed", str(2**64)], "--seed"),
        (["batch", "course-report", "--workers", "0"], "--workers"),
        (["batch", "course-report", "--metric", "speed"], "--metric"),
        (["batch", "course-report", "--trails", "5"], "--trails"),
        (["simulate", "course-report", "--trial", "-1"], "--trial"),
        (["simulate", "course-report", "--trial", str(2**32)], "--trial"),
        (["initiate", "plots.csv", "--most", "0"], "--most"),
        (["initiate", "plots.csv", "--sigma", "x"], "--sigma"),
        (["reproduce", "course-2-1", "--trials", "1"], "--trials"),
        (["batch"], "SET"),
    ],
    ids=" ".join,
)
def test_an_option_out_of_bounds_is_named(ending, arguments, option):
    assert option in ending(*arguments)


# Recorded plots

WRITTEN = ["--json", "--accumulator", "votes.npz", "--assigned", "out.csv"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "plots.csv: the file is empty"),
        ("\n \n", "plots.csv: the file is empty"),
        ("scan,x,y\n", "plots.csv: the file has a header and no rows"),
        ("scan,x\n0,1\n", "plots.csv:1: there is no column 'y'; the header has 'scan', 'x'"),
        ("x,y\n0,1\n", "plots.csv:1: there is neither 'scan' nor 'time'"),
        ("scan,x_km,y\n0,1,2\n", "plots.csv:1: there is no column 'x'; the header has 'scan', 'x_km', 'y'; "
         "rename 'x_km'"),
        ("scan,x,y\n0,1,2\n1,1,two\n", "plots.csv:3: column 'y': 'two' is given; it must be a number"),
        ("note,scan,x,y\na,0,1,2\n\nb,0,,2\n", "plots.csv:4: column 'x': nothing is given"),
        ("scan,x,y\n0,nan,2\n", "plots.csv:2: column 'x': 'nan' is given; it must be a number from -1e+12"),
        ("scan,x,y\n0,1,-inf\n", "plots.csv:2: column 'y': '-inf' is given; it must be a number from -1"),
        ("scan,x,y\n0.5,1,2\n", "plots.csv:2: column 'scan': '0.5' is given; it must be a whole number"),
        ("scan,x,y\n-1,1,2\n", "plots.csv:2: column 'scan': '-1' is given; it must be a whole number"),
        ("scan,time,x,y\n0,soon,1,2\n", "plots.csv:2: column 'time': 'soon' is given"),
        ("scan,x,y\n0,1,2\n0,1\n", "plots.csv:3: the header has 3 columns, this row 2"),
        ("scan,x,y,X\n0,1,2,3\n", "plots.csv:1: columns 2 and 4 are both called"),
        ("scan;x;y\n0;1;2\n", "plots.csv:1: the delimiter is ';'"),
        (b"scan,x,y\n0,1,2\n0,\xff,2\n", "plots.csv:3: the file is not UTF-8 text (byte 0xff)"),
    ],
    ids=["empty", "blank", "header alone", "no y", "no scan", "nearest", "text", "nothing", "NaN", "infinite",
         "half a scan", "scan -1", "time", "short row", "column twice", "semicolons", "not UTF-8"],
)  # fmt: skip
def test_wrong_plots_are_named_with_row_and_column(refusal, write, text, message):
    write("plots.csv", text)
    assert refusal("initiate", "plots.csv", *WRITTEN).startswith(message)


def test_plots_that_are_no_file(refusal, tmp_path):
    (tmp_path / "folder").mkdir()
    assert refusal("initiate", "nowhere.csv", *WRITTEN) == "nowhere.csv: there is no such file"
    assert refusal("initiate", "folder", *WRITTEN).startswith("folder: this is a folder")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--initiator", "standrad"], ["'standrad'", "did you mean 'standard'?", "sequential"]),
        (["--set", "votes"], ["--set votes", "key=value"]),
        (["--set", "=4"], ["--set =4", "key=value"]),
        (["--set", "vots=4"], ["vots", "did you mean 'votes'?"]),
        (["--set", "votes=four"], ["votes", "'four'", "a whole number"]),
        (["--set", "votes=0"], ["votes", "0 is given", "at least 1"]),
        (["--set", "votes=4.5"], ["votes", "4.5", "a whole number"]),
        (["--set", "fraction=1.5"], ["fraction", "1.5", "at most 1"]),
        (["--set", "fraction=.nan"], ["fraction", "nan", "finite"]),
        (["--set", "grid=3"], ["grid", "3 is given", "a mapping"]),
        (["--set", "grid.theta_bin=9"], ["grid.theta_bin", "did you mean 'theta_bins'?"]),
        (["--set", "grid.rho_step=-1"], ["grid.rho_step", "-1 is given", "greater than 0"]),
        (["--set", "votes=4", "--set", "votes.x=3"], ["--set votes.x=3", "'votes'"]),
        (["--set", "votes=[4"], ["--set votes", "not valid YAML"]),
        (["--set", "grid.rho_bins=1000000000"], ["90 × 1,000,000,000", "335.3 GiB", "the limit is 1 GiB"]),
        (["-i", "modified", "--set", "speed_min=2", "--set", "speed_max=1"], ["speed_min 2", "speed_max 1"]),
        (["--scans", "3"], ["--scans 3", "A:B", "0:15"]),
        (["--scans", "3:3"], ["--scans 3:3", "A less than B"]),
        (["--scans", "4:2"], ["--scans 4:2", "A less than B"]),
        (["--scans", "a:b"], ["--scans a:b", "whole numbers"]),
        (["--scans", "0:2:4"], ["--scans 0:2:4"]),
        (["--scans", "-1:3"], ["--scans -1:3"]),
        (["--scans", "7:9"], ["plots.csv", "7", "9", "scans 0 to 4"]),
        (["--sigma", "-1"], ["--sigma -1", "at least 0"]),
        (["--sigma", "inf"], ["--sigma inf"]),
        (["--pd", "1.5"], ["--detection-probability 1.5", "at most 1"]),
        (["--pd", "0"], ["--detection-probability 0", "greater than 0"]),
        (["--pd", "nan"], ["--detection-probability nan"]),
        (["--interval", "0"], ["--interval 0", "greater than 0"]),
        (["--interval", "nan"], ["--interval nan"]),
        (["--unit", "ft"], ["--unit", "'ft'", "km, m, nmi"]),
        (["--region", "0,1,2"], ["--region 0,1,2", "X0,X1,Y0,Y1"]),
        (["--region", "0,0,0,1"], ["--region 0,0,0,1", "X0 must be less than X1"]),
        (["--region", "0,1,0,nan"], ["--region 0,1,0,nan"]),
        (["--like", "course-report"], ["two-crossing, three-scans"]),
        (["--like", "course-report:two-crosing"], ["did you mean 'two-crossing'?"]),
        (["--plot"], ["--json", "--plot"]),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) and value[0][0] == "-" else "",
)
def test_wrong_options_of_initiate(refusal, write, arguments, words):
    write("plots.csv", CSV)
    message = refusal("initiate", "plots.csv", *WRITTEN, *arguments)
    for word in words:
        assert word in message


def test_an_initiator_without_an_accumulator_has_none_to_write(refusal, write):
    write("plots.csv", CSV)
    message = refusal("initiate", "plots.csv", "--initiator", "modified", *WRITTEN)
    assert message == "--accumulator: modified has no accumulator"


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ("votes: 0\n", "initiator.yaml:1:8: votes: 0 is given; it must be at least 1"),
        (
            "fraction: 0.5\nvots: 3\n",
            "initiator.yaml:2:1: vots: there is no field 'vots'; did you mean 'votes'",
        ),
        (
            "grid:\n  theta_bins: 90\n  rho_step: wide\n",
            "initiator.yaml:3:13: grid.rho_step: 'wide' is given",
        ),
        ("grid: {theta_bins: .nan}\n", "initiator.yaml:1:20: grid.theta_bins: nan is given"),
        ("votes: 3\nvotes: 4\n", "initiator.yaml:2:1: the key 'votes'"),
        ("votes: [3\n", "initiator.yaml:2:1: not valid YAML"),
        ("- 3\n", "initiator.yaml: a mapping"),
        ("name: sequential\n", "initiator.yaml: this is for the initiator 'sequential', and 'standard'"),
        (b"votes: \xff\n", "initiator.yaml:1: the file is not UTF-8"),
    ],
    ids=["bounds", "unknown", "type", "NaN", "twice", "YAML", "list", "another", "not UTF-8"],
)
def test_a_wrong_config_is_named_with_its_place(refusal, write, config, message):
    write("plots.csv", CSV)
    write("initiator.yaml", config)
    assert refusal("initiate", "plots.csv", "--config", "initiator.yaml", *WRITTEN).startswith(message)


def test_a_config_that_is_no_file(refusal, write, tmp_path):
    write("plots.csv", CSV)
    (tmp_path / "folder").mkdir()
    given = ("initiate", "plots.csv", *WRITTEN, "--config")
    assert refusal(*given, "nowhere.yaml") == "nowhere.yaml: there is no such file"
    assert refusal(*given, "folder").startswith("folder: this is a folder")


# Changes of a scenario


@pytest.mark.parametrize(
    ("assignment", "words"),
    [
        ("scans", ["--set scans", "key=value"]),
        ("scans=0", ["scans", "0 is given", "at least 1"]),
        ("scans=x", ["scans", "'x'", "a whole number"]),
        ("sensor.sigmo=1", ["sensor.sigmo", "did you mean 'scenario.sensor.sigma'?"]),
        ("rate=.nan", ["clutter[0].rate", "nan", "finite"]),
        ("detection_probability=2", ["sensor.detection_probability", "2 is given", "at most 1"]),
        ("position.0=1", ["scenario.targets.0.position.0", "scenario.targets.1.position.0"]),
        ("region.x.0=100", ["region.x", "[100, 100]"]),
        ("name=1", ["name"]),
        ("=1", ["--set =1"]),
    ],
)
def test_wrong_changes_of_a_scenario(refusal, assignment, words):
    given = ("simulate", "course-report", "--scenario", "two-crossing", "--output", "plots.csv")
    message = refusal(*given, "--set", assignment)
    for word in words:
        assert word in message
