"""`hough-tui advise`: from a scenario, from options, confirmed by trials, written into a set."""

import json
import math
import re

import pytest

from algorithms.intervals import wilson
from scenarios.files.set_files import load_set

CROSSING = ("course-report:two-crossing", "--set", "detection_probability=0.9")
SENSOR = {
    "--sigma": 0.1, "--scans": 15, "--interval": 4, "--pd": 0.9, "--clutter": 50,
    "--region": "0,100,0,100", "--speed": 0.35,
}  # fmt: skip
OPTIONS = [part for option in SENSOR.items() for part in option]


def options(**changed: object) -> list[object]:
    """Return the options of the sensor with some changed, or left out where None is given."""
    given = {**SENSOR, **{f"--{name}": value for name, value in changed.items()}}
    return [part for name, value in given.items() if value is not None for part in (name, value)]


@pytest.fixture
def cli(cli, monkeypatch):
    """Run a command at a width of its own."""
    monkeypatch.setenv("COLUMNS", "100")
    return cli


@pytest.fixture
def advised(cli):
    """Run `advise --json`; return the document."""

    def run(*arguments: object) -> dict:
        status, out, err = cli("advise", *arguments, "--json")
        assert status == 0, err
        return json.loads(out)

    return run


def test_a_scenario_is_advised(advised):
    told = advised(*CROSSING)
    assert told["theta_step_deg"] == pytest.approx(180 / told["theta_bins"])
    assert told["expected_false_cells"] <= 1
    assert 0.6 < told["p_detection"] < 0.8
    assert told["unit"] == "km"
    assert [target["name"] for target in told["targets"]] == ["rising", "falling"]
    mean = sum(target["p_detection"] for target in told["targets"]) / 2
    assert told["p_detection"] == pytest.approx(mean)
    assert told["rho_bins"] * told["rho_step"] >= math.hypot(100, 100)
    # The whole search is there, and the pick in it.
    found = told["map"]
    at = found["theta_bins"].index(told["theta_bins"]), found["rho_step"].index(told["rho_step"])
    assert found["allowed"][at[0]][at[1]]
    assert found["p_detection"][at[0]][at[1]] == pytest.approx(told["p_detection"], abs=0.003)
    allowed = [
        rate
        for rates, kept in zip(found["p_detection"], found["allowed"], strict=True)
        for rate, is_kept in zip(rates, kept, strict=True)
        if is_kept
    ]
    assert max(allowed) == pytest.approx(told["p_detection"], abs=0.003)
    bounds = {row["false_cells"]: row["p_detection"] for row in told["trade_off"]}
    assert bounds[1.0] == pytest.approx(max(allowed))


def test_reasons_tell_noise_extent_peak_and_window(advised):
    told = advised(*CROSSING)
    text = " ".join(told["reasons"])
    for word in (
        "95 % of its votes over 0.392 km",
        "19.6 km long",
        f"Δθ = {told['theta_step_deg']:.3g}°",
        f"±{told['suppress_theta']} rows",
        f"±{told['suppress_rho']} in an upright window",
        f"to {told['votes']} votes, within the bound of 1",
        "held apart from",
    ):
        assert word in text
    # Hard cases say that they are.
    assert "allow more false cells" not in text
    assert "allow more false cells" in " ".join(advised(*CROSSING, "--set", "scans=5")["reasons"])


def test_a_greater_bound_finds_more(advised):
    few, many = (advised(*CROSSING, "--false-cells", bound) for bound in (0.1, 10))
    assert few["p_detection"] < many["p_detection"]
    assert few["expected_false_cells"] <= 0.1
    assert many["expected_false_cells"] <= 10


def test_options_describe_what_a_scenario_does(advised):
    told = advised(*OPTIONS)
    assert told["assumed"] == {"unit": "km"}
    scenario = advised(*CROSSING)
    # A target anywhere, and two whose lines are nearly as long and lie in as much clutter.
    assert told["theta_bins"] == pytest.approx(scenario["theta_bins"], abs=3)
    assert told["p_detection"] == pytest.approx(scenario["p_detection"], abs=0.06)
    extent = advised(*options(speed=None, interval=None, extent=0.35 * 4 * 14))
    assert extent["p_detection"] == pytest.approx(told["p_detection"])
    assert extent["targets"][0]["extent"] == pytest.approx(19.6)


@pytest.mark.parametrize("given", [CROSSING, OPTIONS], ids=["scenario", "options"])
def test_a_check_confirms_the_prediction(advised, given):
    trials = 1200
    told = advised(*given, "--check", trials)
    check = told["check"]
    assert check["trials"] == trials
    for target, measured in zip(told["targets"], check["targets"], strict=True):
        # Four standard deviations of a rate, beside what the prediction may be off by.
        error = 2 * math.sqrt(0.25 / trials)
        assert measured["home_cell_rate"] == pytest.approx(target["p_detection"], abs=2 * error + 0.02)
        assert measured["home_cell_ci95"] == pytest.approx(wilson(measured["home_cell_rate"], trials))
        assert measured["success_rate"] > measured["home_cell_rate"] + 0.05
    low, high = check["false_cells_ci95"]
    assert low < check["false_cells"] < high
    assert check["false_cells"] == pytest.approx(
        told["expected_false_cells"], abs=2 * (high - low) / 2 + 0.05
    )


def test_a_check_repeats_with_its_seed(advised):
    first, again, other = (advised(*OPTIONS, "--check", 100, "--seed", seed)["check"] for seed in (1, 1, 2))
    assert first == again
    assert first["targets"] != other["targets"]


def test_tables_show_recommendation_trade_off_map_and_check(cli):
    status, out, _ = cli("advise", *CROSSING, "--map", "--check", 50)
    assert status == 0
    for word in ("θ bins", "Δρ", "false cells", "what false cells buy", "P_D over Δθ and Δρ", "rising", "all",
                 "home cell", "3 × 3", "50 trials, seed 1", "In brackets"):  # fmt: skip
        assert word in out
    assert all(len(line) <= 100 for line in out.splitlines())
    _, out, _ = cli("advise", *CROSSING)
    assert "P_D over" not in out
    assert "predicted and measured" not in out
    _, out, _ = cli("advise", *OPTIONS)
    assert "Assumed unit: km." in out


# Writing into a set

MINE = """\
# My own set.
schema: 1
name: mine
scenarios:
  - name: one
    scans: 15
    interval: 4   # s
    region: {x: [0, 100], y: [0, 100]}
    sensor: {sigma: 0.1, detection_probability: 0.9}
    clutter: [{rate: 50}]
    targets: [{position: [40, 20], velocity: [0.3, 0.18]}]
initiators:
  # The first one.
  - name: standard
    fraction: 0.9   # of 13.5
    grid: {theta_bins: 90, rho_min: -150, rho_step: 0.6, rho_bins: 1000}   # as ever
  - name: mine
    initiator: sequential
    suppress_rho: 2
    maxima: 2
  - name: weighted
    fraction: 0.5   # of weighted votes
  - name: modified
    speed_min: 0.1
    speed_max: 0.5
experiments:
  - name: basic
    sweep: {votes: [9, 10]}
    initiators: [standard]
    criterion: {rho: 3.0, theta_deg: 6}
"""


@pytest.fixture
def mine(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(MINE)
    return path


def test_a_recommendation_is_written_into_a_set(advised, mine):
    told = advised(mine, "--apply", mine)
    assert told["applied"] == {"set": str(mine), "initiators": ["standard", "mine", "weighted"]}
    text = mine.read_text()
    for comment in ("# My own set.", "interval: 4   # s", "  # The first one.", "# as ever"):
        assert comment in text
    after = load_set(mine)
    for name in ("standard", "mine"):
        entry = after.entry(name)
        assert entry.grid.theta_bins == told["theta_bins"]
        assert entry.grid.rho_step == told["rho_step"]
        assert entry.votes == told["votes"]
        resolved = entry.parameters.resolved(after.scenarios[0].context)
        grid = resolved.grid.grid(after.scenarios[0].context)
        assert (grid.rho_bins, grid.rho_min) == (told["rho_bins"], told["rho_min"])
    # A threshold on weighted votes stays what it is.
    weighted = after.entry("weighted")
    assert (weighted.grid.rho_step, weighted.votes, weighted.fraction) == (told["rho_step"], None, 0.5)
    assert weighted.least_votes == told["votes"] - 1
    assert "fraction" not in after.entry("standard").model_fields_set
    # A window is changed where the entry has one.
    assert after.entry("mine").suppress_rho == told["suppress_rho"]
    assert "suppress_theta" not in after.entry("mine").model_fields_set
    changed = re.compile(r"fraction: 0\.9|grid|theta_bins|rho_step|suppress|votes: \d")
    kept = [[line for line in part.splitlines() if not changed.search(line)] for part in (MINE, text)]
    assert kept[0] == kept[1]


def test_one_entry_alone_is_written(cli, mine):
    status, _, err = cli("advise", mine, "--apply", mine, "--initiator", "mine")
    assert status == 0
    assert f"written to {mine}: mine\n" in err
    assert "experiment basic sweeps votes" in err
    after, before = load_set(mine), MINE.splitlines()
    assert after.entry("standard").fraction == 0.9
    assert after.entry("mine").votes > 1
    assert mine.read_text().splitlines()[:16] == before[:16]


def test_the_application_to_another_set_leaves_the_scenario_alone(cli, mine):
    status, _, err = cli("advise", *OPTIONS, "--apply", mine)
    assert status == 0, err
    assert load_set(mine).scenarios[0].sensor.detection_probability == 0.9


# Sensors with a sector, in space


def test_a_scene_in_space_is_checked_in_the_plane_and_what_is_taken_for_simpler_is_said(advised):
    told = advised("par-table-2:T1", "--check", 200)
    assert len(told["check"]["targets"]) == 1
    assert 0 < told["check"]["home_cell_rate"] < 1
    assert told["assumed"]["noise"].endswith("the middle of the sensor's sector")
    assert "sector fills part of it only" in told["assumed"]["clutter"]
    assert advised(*CROSSING)["assumed"] == {}


# Wrong requests


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], ["missing: --sigma, --scans, --clutter, --region, --speed (or --extent), --interval"]),
        (options(speed=None), ["missing: --speed"]),
        (options(speed=-1), ["--speed -1", "greater than 0"]),
        (options(extent=10), ["--speed and --extent"]),
        (options(speed=None, extent=10, scans=1), ["--extent", "more --scans"]),
        (options(sigma=0), ["noise is 0"]),
        (options(sigma=120), ["noise of σ = 120", "the whole region, 100 from side to side"]),
        (["course-report:two-crossing", "--set", "detection_probability=0"], ["detection probability is 0"]),
        ([*CROSSING, "--set", "scans=1"], ["one scan alone", "2 scans or more"]),
        (options(clutter=-3), ["--clutter -3", "at least 0"]),
        (options(clutter=1e9), ["clutter[0].rate", "at most"]),
        (options(region="5,1,0,3"), ["--region", "X0 must be less"]),
        (options(scans=2000), ["2,000 scans", "1,000 at most"]),
        ([*CROSSING, "--sigma", 0.2, "--pd", 0.5], ["--sigma, --pd", "--set KEY=VALUE"]),
        ([*OPTIONS, "--set", "scans=5"], ["--set", "SET:SCENARIO"]),
        (["course-report"], ["two-crossing, three-scans"]),
        (["course-report:two-crossng"], ["did you mean 'two-crossing'"]),
        ([*CROSSING, "--false-cells", 0], ["--false-cells 0", "greater than 0"]),
        ([*CROSSING, "--kappa", "nan"], ["--kappa nan"]),
        ([*CROSSING, "--confidence", 1], ["--confidence 1", "between 0 and 1"]),
        ([*CROSSING, "--separation", 0.3], ["0.3 apart cannot be held apart"]),
        ([*CROSSING, "--map", "--json"], ["leave out --map"]),
        ([*CROSSING, "--initiator", "standard"], ["give --apply"]),
        ([*CROSSING, "--apply", "course-report"], ["bundled set is not written to"]),
        ([*CROSSING, "--apply", "mine.yaml", "--initiator", "standrad"], ["did you mean 'standard'"]),
        ([*CROSSING, "--apply", "mine.yaml", "--initiator", "modified"], ["modified: it has no accumulator"]),
    ],
)  # fmt: skip
def test_what_cannot_be_advised_is_refused(cli, mine, monkeypatch, arguments, words):
    monkeypatch.chdir(mine.parent)
    status, out, err = cli("advise", *arguments)
    assert (status, out) == (2, "")
    assert "Traceback" not in err
    for word in words:
        assert word in err
    assert mine.read_text() == MINE


def test_a_scenario_without_a_moving_target_is_refused(cli, mine):
    mine.write_text(
        MINE.replace("velocity: [0.3, 0.18]", "velocity: [0, 0]").replace(
            "{rho: 3.0, theta_deg: 6}", "{plots: 3}"
        )
    )
    status, _, err = cli("advise", mine)
    assert status == 2
    assert "no target that moves" in err


def test_a_line_along_the_axis_without_noise_goes_beside_others(cli, mine):
    # It has no noise across; the other one is there in one scan, and has no length.
    target = "{position: [20, 20], velocity: [0.3, 0]}, {position: [30, 30], velocity: [0, 0.2], death: 0}"
    text = MINE.replace("{position: [40, 20], velocity: [0.3, 0.18]}", target)
    mine.write_text(text.replace("sigma: 0.1", "sigma: [0.1, 0]"))
    status, out, err = cli("advise", mine)
    assert status == 0, err
    assert "P_D" in out
