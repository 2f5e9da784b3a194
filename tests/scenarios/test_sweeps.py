"""Sweeps: which field a key means, and the points that its values make."""

import math

import pytest

from algorithms.parameters import FieldError
from scenarios.experiments import InitiationExperiment
from scenarios.files.set_files import load_set
from scenarios.model import ScenarioSet
from scenarios.sweeps import MOST_POINTS, parts_of, place, points

SET = {
    "name": "set",
    "scenarios": [
        {
            "name": "one",
            "scans": 5,
            "interval": 4,
            "region": {"x": [0, 100], "y": [0, 50]},
            "sensor": {"sigma": [0.1, 0.2], "detection_probability": 0.9},
            "clutter": [{"rate": 5}],
            "targets": [{"position": [40, 20], "velocity": [0.3, 0.18]}],
        },
        {
            "name": "two",
            "scans": 3,
            "interval": 2,
            "region": {"x": [0, 100], "y": [0, 100]},
            "sensor": {"sigma": 0.1},
            "clutter": [{"rate": 5}, {"rate": 1}],
            "targets": [
                {"position": [40, 20], "velocity": [0.3, 0.18], "birth": 1, "death": 2},
                {"position": [0, 0], "velocity": [1, 1]},
            ],
        },
    ],
    "initiators": [
        {"name": "standard", "fraction": 0.9},
        {"name": "sequential-2", "initiator": "sequential", "maxima": 2},
        {"name": "modified"},
    ],
}
GIVEN = ScenarioSet.model_validate(SET)
ONE, TWO = GIVEN.scenarios
STANDARD, SEQUENTIAL, MODIFIED = GIVEN.initiators


def swept(sweep, scenarios=("one",), initiators=("standard",)):
    """Return the points of an experiment."""
    return list(
        points(
            GIVEN,
            InitiationExperiment.model_validate(
                {
                    "name": "e",
                    "scenarios": list(scenarios),
                    "initiators": list(initiators),
                    "sweep": sweep,
                    "criterion": {"rho": 3},
                }
            ),
        )
    )


def refusal(sweep, **options):
    with pytest.raises(FieldError) as caught:
        swept(sweep, **options)
    return caught.value.problem


# Which field a key means


@pytest.mark.parametrize(
    ("key", "part", "path"),
    [
        ("scans", "scenario", ("scans",)),
        ("scenario.scans", "scenario", ("scans",)),
        ("interval", "scenario", ("interval",)),
        ("rate", "scenario", ("clutter", 0, "rate")),
        ("clutter.rate", "scenario", ("clutter", 0, "rate")),
        ("clutter.0.rate", "scenario", ("clutter", 0, "rate")),
        ("clutter[0].rate", "scenario", ("clutter", 0, "rate")),
        ("scenario.clutter.0.rate", "scenario", ("clutter", 0, "rate")),
        ("scenario.clutter.rate", "scenario", ("clutter", 0, "rate")),
        ("scenario.clutter[0].rate", "scenario", ("clutter", 0, "rate")),
        ("detection_probability", "scenario", ("sensor", "detection_probability")),
        ("sensor.detection_probability", "scenario", ("sensor", "detection_probability")),
        ("region.y.1", "scenario", ("region", "y", 1)),
        ("y.1", "scenario", ("region", "y", 1)),
        ("x[0]", "scenario", ("region", "x", 0)),
        ("position.1", "scenario", ("targets", 0, "position", 1)),
        ("targets[0].velocity[1]", "scenario", ("targets", 0, "velocity", 1)),
        ("birth", "scenario", ("targets", 0, "birth")),
        ("sigma.1", "scenario", ("sensor", "sigma", 1)),
        ("fraction", "initiator", ("fraction",)),
        ("initiator.fraction", "initiator", ("fraction",)),
        ("votes", "initiator", ("votes",)),
        ("theta_bins", "initiator", ("grid", "theta_bins")),
        ("grid.theta_bins", "initiator", ("grid", "theta_bins")),
        ("initiator.grid.theta_bins", "initiator", ("grid", "theta_bins")),
        ("grid.rho_step", "initiator", ("grid", "rho_step")),
    ],
)
def test_a_key_reaches_one_field(key, part, path):
    assert place(key, ONE, [STANDARD]) == (part, path)


@pytest.mark.parametrize(
    ("key", "meanings"),
    [
        ("birth", ["scenario.targets.0.birth", "scenario.targets.1.birth"]),
        ("rate", ["scenario.clutter.0.rate", "scenario.clutter.1.rate"]),
        ("clutter.rate", ["scenario.clutter.0.rate", "scenario.clutter.1.rate"]),
        ("scenario.clutter.rate", ["scenario.clutter.0.rate", "scenario.clutter.1.rate"]),
        ("position.0", ["scenario.targets.0.position.0", "scenario.targets.1.position.0"]),
        ("x", ["scenario.region.x.0", "scenario.region.x.1"]),
    ],
)
def test_a_key_of_several_meanings_is_refused_with_all_of_them(key, meanings):
    with pytest.raises(FieldError) as caught:
        place(key, TWO, [STANDARD])
    problem = caught.value.problem
    assert problem.path == ("sweep", key)
    assert problem.on_key
    assert f"'{key}' may mean {', '.join(meanings)}; write one of them" == problem.message


def test_an_index_makes_it_clear():
    assert place("clutter.1.rate", TWO, [STANDARD]) == ("scenario", ("clutter", 1, "rate"))
    assert place("1.rate", TWO, [STANDARD]) == ("scenario", ("clutter", 1, "rate"))
    assert place("targets.1.birth", TWO, [STANDARD]) == ("scenario", ("targets", 1, "birth"))


@pytest.mark.parametrize(
    "key",
    ["scnas", "scenario.fraction", "initiator.scans", "scenario.clutter.2.rate", "name", "unit", "scenario",
     "region", "targets.2.birth", "kind", "", ".", "scans.0", "ties", "lutter.rate"],
)  # fmt: skip
def test_a_key_of_no_numeric_field_is_refused_with_the_known_ones(key):
    with pytest.raises(FieldError) as caught:
        place(key, TWO, [SEQUENTIAL])
    problem = caught.value.problem
    assert problem.path == ("sweep", key)
    assert problem.on_key
    assert f"there is no numeric field '{key}'" in problem.message
    assert "scenario.scans" in problem.message
    assert "initiator.maxima" in problem.message


def test_the_nearest_field_is_named():
    with pytest.raises(FieldError, match=r"did you mean 'scenario\.sensor\.sigma'\?"):
        place("scenario.sensor.sigmo", TWO, [STANDARD])


def test_a_swept_parameter_must_belong_to_every_initiator():
    assert place("maxima", ONE, [SEQUENTIAL]) == ("initiator", ("maxima",))
    assert place("theta_bins", ONE, [STANDARD, SEQUENTIAL]) == ("initiator", ("grid", "theta_bins"))
    for key, entries in (("mode", [STANDARD, SEQUENTIAL]), ("grid.theta_bins", [STANDARD, MODIFIED])):
        with pytest.raises(FieldError, match="must belong to every initiator of the experiment"):
            place(key, ONE, entries)


@pytest.mark.parametrize(
    ("key", "parts"),
    [
        ("scans", ("scans",)),
        ("clutter.0.rate", ("clutter", 0, "rate")),
        ("clutter[10].rate", ("clutter", 10, "rate")),
        ("a[0][1]", ("a", 0, 1)),
    ],
)
def test_the_parts_of_a_key(key, parts):
    assert parts_of(key) == parts


# The points


def test_without_a_sweep_each_initiator_on_each_scenario_is_a_point():
    found = swept({}, ["one", "two"], ["modified", "standard"])
    assert [(point.world.name, point.entry.name, point.swept) for point in found] == [
        ("one", "modified", {}),
        ("one", "standard", {}),
        ("two", "modified", {}),
        ("two", "standard", {}),
    ]
    assert found[0].world == ONE
    assert found[1].entry == STANDARD


def test_values_are_put_in_and_all_else_stays():
    five, six = swept({"clutter[0].rate": [5.5, 6]})
    assert (five.world.clutter[0].rate, six.world.clutter[0].rate) == (5.5, 6.0)
    assert five.swept == {"clutter[0].rate": 5.5}
    assert six.world.model_copy(update={"clutter": ONE.clutter}) == ONE
    assert ONE.clutter[0].rate == 5.0


def test_several_fields_make_a_grid_whose_last_key_runs_fastest():
    found = swept({"scans": [2, 3], "fraction": [0.5, 1], "x.1": [60, 70]})
    assert [tuple(point.swept.values()) for point in found] == [
        (scans, fraction, bound) for scans in (2, 3) for fraction in (0.5, 1) for bound in (60, 70)
    ]
    for point in found:
        assert list(point.swept) == ["scans", "fraction", "x.1"]
        assert point.world.scans == point.swept["scans"]
        assert point.world.region.x == (0.0, point.swept["x.1"])
        assert point.parameters.votes == math.ceil(point.swept["scans"] * 0.9 * point.swept["fraction"])
        # The entry stays the one that the set lists.
        assert point.entry.name == "standard"


def test_auto_is_worked_out_for_each_point():
    found = swept({"sigma.0": [0.3, 0.5]})
    assert [point.parameters.grid.rho_step for point in found] == pytest.approx([1.8, 3.0])
    assert STANDARD.parameters.grid.rho_step == "auto"


def test_whole_numbers_stay_whole_and_others_are_not_rounded():
    (point,) = swept({"scans": [7], "interval": [7]})
    assert type(point.world.scans) is int
    assert type(point.world.interval) is float
    assert refusal({"scans": [7.5]}).path == ("sweep", "scans", 0)


def test_a_key_is_looked_up_in_each_scenario():
    found = swept({"targets.0.birth": [0, 1]}, ["one", "two"])
    assert [point.world.targets[0].birth for point in found] == [0, 1, 0, 1]
    # Clear in the first scenario, and not in the second.
    problem = refusal({"rate": [1]}, scenarios=["one", "two"])
    assert problem.path == ("sweep", "rate")
    assert problem.on_key


@pytest.mark.parametrize(
    ("sweep", "path", "words"),
    [
        ({"scans": [3, 0]}, ("sweep", "scans", 1), ["0 is given", "at least 1"]),
        ({"scans": [3], "sigma.1": [0.1, 0.2, -1]}, ("sweep", "sigma.1", 2), ["-1 is given", "at least 0"]),
        ({"detection_probability": [1.5]}, ("sweep", "detection_probability", 0), ["1.5", "at most 1"]),
        ({"fraction": [0.5, 2]}, ("sweep", "fraction", 1), ["2 is given", "at most 1"]),
        ({"grid.theta_offset": [0, 1]}, ("sweep", "grid.theta_offset", 1), ["1 is given", "less than 1"]),
        ({"x.0": [0, 100]}, ("sweep", "x.0", 1), ["[100, 100]", "less than"]),
        ({"rate": [1, 1e7]}, ("sweep", "rate", 1), ["10000000", "at most"]),
    ],
)
def test_a_value_out_of_bounds_is_named_with_its_place(sweep, path, words):
    problem = refusal(sweep)
    assert problem.path == path
    assert not problem.on_key
    for word in words:
        assert word in problem.message


def test_a_value_that_contradicts_another_field_is_named():
    problem = refusal({"targets.0.death": [3, 0]}, scenarios=["two"])
    assert problem.path == ("sweep", "targets.0.death", 1)
    assert "death 0 is given with birth 1" in problem.message


def test_more_points_than_the_limit_are_refused_before_any_is_made():
    values = list(range(1, 201))
    problem = refusal({"scans": values, "interval": values})
    assert problem.path == ("sweep",)
    assert f"40,000 points are given; the limit is {MOST_POINTS:,}" in problem.message


def test_fields_that_depend_on_one_another_are_put_in_together():
    given = load_set("course-text")
    scenario = given.scenarios[0].name
    experiment = given.experiments[0].model_copy(
        update={"sweep": {"region.x.0": [200], "region.x.1": [300]}, "scenarios": [scenario]}
    )
    assert {point.world.region.x for point in points(given, experiment)} == {(200.0, 300.0)}


def test_one_field_by_two_keys_is_refused():
    given = load_set("course-text")
    experiment = given.experiments[0].model_copy(update={"sweep": {"scans": [5], "scenario.scans": [6]}})
    with pytest.raises(FieldError, match=r"'scenario\.scans' is the field that 'scans' is"):
        list(points(given, experiment))


def test_the_noise_of_both_axes_can_be_swept_where_each_has_its_own():
    given = load_set("course-text")
    sensor = given.scenarios[0].sensor.model_copy(update={"sigma": (0.1, 0.2)})
    scenario = given.scenarios[0].model_copy(update={"sensor": sensor})
    assert place("scenario.sensor.sigma", scenario, []) == ("scenario", ("sensor", "sigma"))
    assert place("sigma", scenario, []) == ("scenario", ("sensor", "sigma"))
    assert place("sigma.1", scenario, []) == ("scenario", ("sensor", "sigma", 1))


def test_a_short_key_with_a_slip_is_shown_its_neighbour():
    given = load_set("course-text")
    with pytest.raises(FieldError, match="did you mean 'scans'"):
        place("sacns", given.scenarios[0], [])
