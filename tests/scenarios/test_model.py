"""Scenarios and sets as models: defaults, bounds, and what is derived from the fields."""

import math

import pytest
from pydantic import ValidationError

from algorithms.clustering.parameters import MODES
from algorithms.context import Context, Unit
from algorithms.errors import RequestError
from algorithms.initiators.registry import initiators
from algorithms.parameters import FieldError, numeric_paths, replaced, validated
from algorithms.scoring.matching import Criterion
from scenarios.clutter import MOST_PLOTS, PoissonClutter, Region
from scenarios.experiments import LARGEST_SEED, MOST_TRIALS, InitiationExperiment, MatchCriterion
from scenarios.model import Scenario, ScenarioSet
from scenarios.scenes import Scene
from scenarios.sensors import CartesianSensor
from scenarios.targets import Target

SCENARIO = {
    "name": "one",
    "scans": 5,
    "interval": 4,
    "region": {"x": [0, 100], "y": [-50, 50]},
    "sensor": {"sigma": 0.1},
}


def scenario(**changes) -> Scenario:
    return Scenario.model_validate({**SCENARIO, **changes})


def scenario_set(**changes) -> ScenarioSet:
    return ScenarioSet.model_validate({"name": "set", "scenarios": [SCENARIO], **changes})


# Defaults


def test_defaults_of_a_scenario():
    given = scenario()
    assert given.unit is Unit.KILOMETRE
    assert given.description == ""
    assert (given.clutter, given.targets) == ([], [])
    assert given.sensor.kind == "cartesian"
    assert given.sensor.detection_probability == 1.0


def test_defaults_of_targets_and_clutter():
    target = Target.model_validate({"position": [1, 2], "velocity": [3, 4]})
    assert (target.name, target.birth, target.death) == (None, 0, None)
    assert not target.stands_still
    assert Target.model_validate({"position": [1, 2], "velocity": [0, 0]}).stands_still
    clutter = PoissonClutter.model_validate({"rate": 0})
    assert (clutter.kind, clutter.region) == ("poisson", None)


def test_defaults_of_an_experiment_and_a_set():
    experiment = InitiationExperiment.model_validate({"name": "e", "criterion": {"rho": 3}})
    assert (experiment.trials, experiment.seed, experiment.control) == (1000, 1, True)
    assert (experiment.scenarios, experiment.initiators, experiment.sweep) == (None, None, {})
    given = scenario_set()
    assert (given.version, given.description, given.initiators, given.experiments) == (1, "", [], [])


def test_lists_of_models_are_not_shared():
    assert scenario().clutter is not scenario().clutter


def test_models_are_frozen():
    with pytest.raises(ValidationError, match="frozen"):
        scenario().scans = 6


# Values


def test_one_sigma_is_that_of_both_axes():
    assert CartesianSensor.model_validate({"sigma": 2}).axes(2) == (2.0, 2.0)
    assert CartesianSensor.model_validate({"sigma": [2, 3]}).axes(2) == (2.0, 3.0)
    assert CartesianSensor.model_validate({"sigma": 0}).axes(3) == (0.0, 0.0, 0.0)


def test_the_context_is_what_an_initiator_is_told():
    given = scenario(unit="m", sensor={"sigma": [1, 2], "detection_probability": 0.8})
    assert given.context == Context(5, 4.0, 0.8, (1.0, 2.0), given.region.box, Unit.METRE)
    assert (given.region.box.lower, given.region.box.upper) == ((0.0, -50.0), (100.0, 50.0))
    assert given.context.expected_votes == 4.0


@pytest.mark.parametrize(
    ("given", "value", "document"),
    [
        ({"rho": 3}, Criterion(3.0, None, None), {"rho": 3.0, "theta_deg": None}),
        ({"rho": 3, "theta_deg": 90}, Criterion(3.0, math.pi / 2, None), {"rho": 3.0, "theta_deg": 90.0}),
        ({"plots": 2}, Criterion(None, None, 2), {"plots": 2}),
    ],
)
def test_a_criterion(given, value, document):
    criterion = MatchCriterion.model_validate(given)
    assert criterion.value == value
    assert criterion.document == document


def test_scenarios_and_entries_are_found_by_name_and_all_where_none_is_named():
    given = scenario_set(
        scenarios=[SCENARIO, {**SCENARIO, "name": "two"}],
        initiators=[{"name": "standard"}, {"name": "other", "initiator": "standard"}],
        experiments=[
            {"name": "all", "criterion": {"rho": 1}},
            {"name": "some", "scenarios": ["two"], "initiators": ["other"], "criterion": {"rho": 1}},
        ],
    )
    every, some = given.experiments
    assert [found.name for found in given.chosen_scenarios(every)] == ["one", "two"]
    assert [found.name for found in given.chosen_entries(every)] == ["standard", "other"]
    assert given.chosen_scenarios(some) == [given.scenario("two")]
    assert given.chosen_entries(some) == [given.entry("other")]


# Initiator entries


@pytest.mark.parametrize("name", sorted(initiators()))
def test_an_entry_has_the_defaults_of_its_initiator(name):
    (entry,) = scenario_set(initiators=[{"name": name}]).initiators
    assert entry.initiator == name
    assert entry.algorithm is initiators()[name]
    assert entry.parameters == initiators()[name].parameters()
    assert entry.parameters.model_fields_set == set()


def test_an_entry_under_a_name_of_its_own():
    given = {"name": "mine", "initiator": "sequential", "maxima": 4, "grid": {"theta_bins": 60}}
    (entry,) = scenario_set(initiators=[given]).initiators
    assert (entry.name, entry.initiator) == ("mine", "sequential")
    assert (entry.parameters.maxima, entry.parameters.grid.theta_bins) == (4, 60)
    assert entry.parameters.model_fields_set == {"maxima", "grid"}
    assert entry.parameters.ties == "last"
    assert not hasattr(entry.parameters, "name")


def test_clutter_without_a_kind_is_poisson_and_another_kind_says_so():
    given = scenario(
        targets=[{"position": [1, 2], "velocity": [3, 4]}],
        clutter=[{"rate": 2}, {"kind": "exact", "count": 7}, {"kind": "exact", "count": 90, "per": "batch"}],
    )
    assert [source.kind for source in given.clutter] == ["poisson", "exact", "exact"]
    n = given.scans
    assert given.expected_clutter == 2 * n + 7 * n + 90
    assert given.expected_plots == given.expected_clutter + n


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ({"count": 5}, r"there is no field 'count' \(known: kind, over, region, rate\)"),
        ({"kind": "exakt", "count": 5}, "there is no kind 'exakt'; did you mean 'exact'"),
        ({"kind": "exact", "count": 2.5}, "2.5 is given; it must be a whole number"),
        ({"rate": 1, "over": "targets"}, "there is no target"),
        (
            {"rate": 1, "over": "targets", "region": {"x": [0, 1], "y": [0, 1]}},
            "region is given with over: targets",
        ),
    ],
)
def test_wrong_clutter_is_refused_in_words(source, message):
    with pytest.raises(RequestError, match=message):
        validated(Scenario, {**SCENARIO, "clutter": [source]}, "scenario")


@pytest.mark.parametrize(
    ("criterion", "message"),
    [
        ({"plots": 3, "nearest": True}, "nearest is given with plots"),
        ({"plots": 3, "at": "mid-track"}, "at: mid-track is given with plots"),
        ({"rho": 1.0, "at": "mid-track"}, "give theta_deg too"),
    ],
)
def test_a_criterion_that_says_too_much_is_refused(criterion, message):
    with pytest.raises(RequestError, match=message):
        validated(MatchCriterion, criterion, "criterion")


def test_a_criterion_tells_only_what_was_chosen():
    assert MatchCriterion(rho=3.0).document == {"rho": 3.0, "theta_deg": None}
    chosen = MatchCriterion(rho=0.6, theta_deg=3.0, at="mid-track", nearest=True)
    assert chosen.document == {"rho": 0.6, "theta_deg": 3.0, "at": "mid-track", "nearest": True}


def test_the_numeric_fields_of_a_scenario_can_be_swept():
    given = scenario(
        sensor={"sigma": [1, 2]},
        clutter=[{"rate": 1}],
        targets=[{"position": [1, 2], "velocity": [3, 4]}],
    )
    paths = {".".join(map(str, path)) for path in numeric_paths(given)}
    assert paths == {
        "scans", "interval", "sensor.period", "sensor.first_scan",
        "region.x.0", "region.x.1", "region.y.0", "region.y.1", "clutter.0.rate",
        "sensor.sigma", "sensor.sigma.0", "sensor.sigma.1", "sensor.detection_probability",
        "targets.0.position.0", "targets.0.position.1", "targets.0.velocity.0", "targets.0.velocity.1",
        "targets.0.motion.process_noise", "targets.0.spread",
        "targets.0.birth", "targets.0.death",
    }  # fmt: skip


# Bounds


RADAR = {"kind": "polar", "sigma_range": 0.1, "sigma_azimuth_deg": 1.0, "range": [0, 100]}
CELLS = {"range_cell": 0.1, "beam_width_deg": 1.0, "doppler_cell": 0.01, "doppler_cells": 100}
EXTENDED = {"range_spread": 0.1, "doppler_spread": 0.1}


SCENE = {
    "name": "scene",
    "region": {"range": [0, 9], "doppler": [0, 9]},
    "targets": [{"range": 1, "doppler": 1}],
}
BOUNDED = {
    "scenario": Scenario.model_validate(
        {
            **SCENARIO,
            "sensor": {**RADAR, "period": 2, "resolution": CELLS},
            "targets": [{"position": [1, 2], "velocity": [3, 4], "spread": [1, 1], "extended": EXTENDED}],
            "clutter": [{"rate": 1, "over": "sector"}],
        }
    ),
    "scene": Scene.model_validate(SCENE),
    "criterion": MatchCriterion(rho=1.0, theta_deg=1.0),
    **{name: MODES[name](range_extent=1.0) for name in ("corrected-patent",)},
    **{name: found.parameters.model_validate({}) for name, found in initiators().items()},
}


@pytest.mark.parametrize("name", BOUNDED)
@pytest.mark.parametrize("beyond", [1e300, -1e300, 1.001e12])
def test_every_number_has_bounds(name, beyond):
    for path in numeric_paths(BOUNDED[name]):
        with pytest.raises(FieldError) as refused:
            replaced(BOUNDED[name], {path: beyond})
        assert refused.value.problem.path == path


@pytest.mark.parametrize(
    "path", [("interval",), ("sensor", "resolution", "range_cell"), ("sensor", "sigma_range")]
)
@pytest.mark.parametrize("tiny", [1e-300, 5e-324, 0.999e-12])
def test_positive_numbers_next_to_0_are_refused(path, tiny):
    with pytest.raises(FieldError, match="at least 1e-12"):
        replaced(BOUNDED["scenario"], {path: tiny})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"targets": [{"position": [1e12, 0], "velocity": [1, 0]}]}, "targets[0] has a coordinate of 1e+12"),
        ({"targets": [{"position": [0, 0], "velocity": [0, -1e12]}]}, "a coordinate of 1.6e+13 in its"),
        ({"interval": 1e12}, "the last scan is at 4e+12 s; no time"),
        ({"sensor": {**RADAR, "position": [-1e12, 0]}}, "position and range reach 1e+12 far"),
        ({"sensor": {**RADAR, "resolution": {**CELLS, "range_cell": 1e-12}}, "targets": [
            {"position": [1, 2], "velocity": [3, 4], "extended": {"range_spread": 1e6}}]},
         "range_cell 1e-12 is given, and points lie up to 1e+07 far; the limit is 1e+15 cells"),
    ],
)  # fmt: skip
def test_what_follows_from_numbers_is_bounded_too(changes, message):
    with pytest.raises(RequestError) as refused:
        validated(Scenario, {**SCENARIO, **changes}, "scenario")
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("model", "given"),
    [
        (Region, {"x": [0, 0], "y": [0, 1]}),
        (Region, {"x": [1, 0], "y": [0, 1]}),
        (Region, {"x": [0, 1], "y": [0, math.inf]}),
        (Region, {"x": [0, 1, 2], "y": [0, 1]}),
        (CartesianSensor, {}),
        (CartesianSensor, {"sigma": -1}),
        (CartesianSensor, {"sigma": [1, -1]}),
        (CartesianSensor, {"sigma": [1, 1, 1, 1]}),
        (CartesianSensor, {"sigma": "1"}),
        (CartesianSensor, {"sigma": 1, "detection_probability": 1.01}),
        (CartesianSensor, {"sigma": 1, "detection_probability": -0.01}),
        (CartesianSensor, {"sigma": 1, "detection_probability": math.nan}),
        (CartesianSensor, {"sigma": 1, "kind": "polar"}),
        (PoissonClutter, {"rate": -1}),
        (PoissonClutter, {"rate": 1e7}),
        (PoissonClutter, {}),
        (Target, {"position": [1, 2]}),
        (Target, {"position": [1, 2], "velocity": [1, 2], "birth": -1}),
        (Target, {"position": [1, 2], "velocity": [1, 2], "birth": 0.5}),
        (Target, {"position": [1, 2], "velocity": [1, 2], "birth": 3, "death": 2}),
        (Target, {"position": [1, 2], "velocity": [1, True]}),
        (Target, {"position": [1, 2], "velocity": [1, 2], "heading": 3}),
        (MatchCriterion, {}),
        (MatchCriterion, {"theta_deg": 3}),
        (MatchCriterion, {"rho": 3, "plots": 3}),
        (MatchCriterion, {"theta_deg": 3, "plots": 3}),
        (MatchCriterion, {"rho": 0}),
        (MatchCriterion, {"plots": 0}),
        (MatchCriterion, {"rho": 1, "theta_deg": 91}),
        (InitiationExperiment, {"name": "e"}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "trials": 0}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "trials": MOST_TRIALS + 1}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "control": "no"}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "seed": LARGEST_SEED + 1}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "seed": -1}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "scenarios": []}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "sweep": {"scans": []}}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "sweep": {"scans": 5}}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "sweep": {"scans": [True]}}),
        (InitiationExperiment, {"name": "e", "criterion": {"rho": 1}, "sweep": {"scans": ["5"]}}),
        (ScenarioSet, {"name": "s", "scenarios": []}),
        (ScenarioSet, {"name": "s"}),
        (ScenarioSet, {"name": "", "scenarios": [SCENARIO]}),
        (ScenarioSet, {"name": "a b", "scenarios": [SCENARIO]}),
        (ScenarioSet, {"name": "../a", "scenarios": [SCENARIO]}),
        (ScenarioSet, {"name": "s", "scenarios": [SCENARIO], "schema": 2}),
        (ScenarioSet, {"name": "s", "scenarios": [SCENARIO], "initiators": [{"name": "nothing"}]}),
        (ScenarioSet, {"name": "s", "scenarios": [SCENARIO], "initiators": [{"name": "standard", "x": 2}]}),
    ],
)  # fmt: skip
def test_what_is_not_allowed(model, given):
    with pytest.raises(ValidationError):
        model.model_validate(given)


@pytest.mark.parametrize(
    "changes",
    [
        {"scans": 0},
        {"scans": 5.0},
        {"scans": 100_001},
        {"interval": 0},
        {"interval": -4},
        {"interval": math.nan},
        {"interval": math.inf},
        {"unit": "feet"},
        {"name": "-"},
        {"extra": 1},
        {"scans": 100, "clutter": [{"rate": MOST_PLOTS / 100}, {"rate": 1}]},
    ],
)
def test_a_scenario_that_is_not_allowed(changes):
    with pytest.raises(ValidationError):
        scenario(**changes)


def test_what_is_just_allowed():
    scenario(scans=20, clutter=[{"rate": 1_000_000}])
    CartesianSensor.model_validate({"sigma": 0, "detection_probability": 0})
    CartesianSensor.model_validate({"sigma": 0, "detection_probability": 1})
    Target.model_validate({"position": [1, 2], "velocity": [1, 2], "birth": 3, "death": 3})
    MatchCriterion.model_validate({"rho": 1e-9, "theta_deg": 90})
    given = {"name": "e", "criterion": {"plots": 1}, "seed": LARGEST_SEED, "trials": 1}
    assert InitiationExperiment.model_validate(given).seed == 2**64 - 1
