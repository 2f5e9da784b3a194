"""What is wrong across the parts of a set, each with its path."""

import copy

import pytest

from algorithms.errors import RequestError
from scenarios.checks import inconsistencies
from scenarios.files.marked_yaml import write
from scenarios.files.set_files import parse_set
from scenarios.model import ScenarioSet

SET = {
    "schema": 1,
    "name": "set",
    "scenarios": [
        {
            "name": name,
            "scans": 5,
            "interval": 4,
            "region": {"x": [0, 100], "y": [0, 100]},
            "sensor": {"sigma": 0.1},
            "clutter": [{"rate": 5}],
            "targets": [{"position": [40, 20], "velocity": [0.3, 0.18]}],
        }
        for name in ("near", "far")
    ],
    "initiators": [
        {"name": "standard", "votes": 4},
        {"name": "sequential-2", "initiator": "sequential", "maxima": 2},
        {"name": "modified"},
    ],
    "experiments": [
        {"name": "first", "criterion": {"rho": 3}},
        {"name": "second", "scenarios": ["far"], "initiators": ["standard"], "criterion": {"rho": 3}},
    ],
}


def changed(change) -> dict:
    data = copy.deepcopy(SET)
    change(data)
    return data


def found(change):
    """Return the inconsistencies of the set as it is after a change."""
    return list(inconsistencies(ScenarioSet.model_validate(changed(change))))


def test_a_consistent_set_has_none():
    assert found(lambda data: None) == []


@pytest.mark.parametrize(
    ("part", "index"), [("scenarios", 1), ("initiators", 1), ("initiators", 2), ("experiments", 1)]
)
def test_a_repeated_name(part, index):
    def repeat(data):
        if part == "initiators":
            data[part][index].setdefault("initiator", data[part][index]["name"])
        data[part][index]["name"] = data[part][0]["name"]

    (problem,) = found(repeat)
    assert problem.path == (part, index, "name")
    assert problem.field == f"{part}[{index}].name"
    assert f"'{SET[part][0]['name']}'" in problem.message
    assert f"{part}[0]" in problem.message


def test_each_repeated_name_is_told():
    def repeat(data):
        data["scenarios"].append(data["scenarios"][0])
        data["scenarios"].append(data["scenarios"][1])
        data["experiments"].append(data["experiments"][0])

    paths = [problem.path for problem in found(repeat)]
    assert paths == [("scenarios", 2, "name"), ("scenarios", 3, "name"), ("experiments", 2, "name")]


@pytest.mark.parametrize(
    ("part", "names", "index", "words"),
    [
        ("scenarios", ["far", "neer"], 1, ["scenario 'neer'", "did you mean 'near'", "known: near, far"]),
        ("scenarios", ["near", "near"], 1, ["'near'", "already"]),
        ("initiators", ["standrad"], 0, ["initiator 'standrad'", "did you mean 'standard'"]),
        # The name of an initiator is not that of its entry.
        ("initiators", ["standard", "sequential"], 1, ["'sequential'", "did you mean 'sequential-2'"]),
        ("initiators", ["modified", "standard", "modified"], 2, ["'modified'", "already"]),
    ],
)
def test_an_unknown_or_repeated_choice(part, names, index, words):
    (problem,) = found(lambda data: data["experiments"][1].update({part: names}))
    assert problem.path == ("experiments", 1, part, index)
    for word in words:
        assert word in problem.message


def test_every_wrong_choice_of_every_experiment_is_told():
    def spoil(data):
        data["experiments"][0]["scenarios"] = ["a", "near", "b"]
        data["experiments"][1]["initiators"] = ["c"]

    assert [problem.path for problem in found(spoil)] == [
        ("experiments", 0, "scenarios", 0),
        ("experiments", 0, "scenarios", 2),
        ("experiments", 1, "initiators", 0),
    ]


def test_an_experiment_without_initiators_cannot_run():
    problems = found(lambda data: data.update(initiators=[], experiments=[SET["experiments"][0]]))
    (problem,) = problems
    assert problem.path == ("experiments", 0, "initiators")
    assert "no initiators" in problem.message
    assert found(lambda data: data.update(initiators=[], experiments=[])) == []


def test_a_target_that_stands_still_has_no_line_to_match():
    def stop(data):
        data["scenarios"][1]["targets"].append({"position": [1, 2], "velocity": [0, 0]})

    problems = found(stop)
    assert [problem.path for problem in problems] == [
        ("experiments", 0, "criterion"),
        ("experiments", 1, "criterion"),
    ]
    for problem in problems:
        assert "target 1 of far" in problem.message
        assert "plots: 3" in problem.message

    def by_plots(data):
        stop(data)
        for experiment in data["experiments"]:
            experiment["criterion"] = {"plots": 3}

    assert found(by_plots) == []

    def elsewhere(data):
        stop(data)
        data["experiments"] = [{**SET["experiments"][0], "scenarios": ["near"]}]

    assert found(elsewhere) == []


@pytest.mark.parametrize(
    ("sweep", "path", "on_key", "words"),
    [
        ({"scnas": [1]}, ("sweep", "scnas"), True, ["'scnas'"]),
        ({"scans": [5, 0]}, ("sweep", "scans", 1), False, ["0 is given", "at least 1"]),
        ({"scenario.maxima": [1]}, ("sweep", "scenario.maxima"), True, ["'scenario.maxima'"]),
        ({"scans": list(range(1, 300)), "interval": list(range(1, 300))}, ("sweep",), False, ["20,000"]),
    ],
)
def test_a_sweep_that_reaches_nothing_or_too_far(sweep, path, on_key, words):
    (problem,) = found(lambda data: data["experiments"][1].update(sweep=sweep))
    assert problem.path == ("experiments", 1, *path)
    assert problem.on_key is on_key
    for word in words:
        assert word in problem.message


def test_a_parameter_of_some_initiators_is_no_field_of_all():
    (problem,) = found(lambda data: data["experiments"][0].update(sweep={"maxima": [1]}))
    assert problem.path == ("experiments", 0, "sweep", "maxima")
    assert "must belong to every initiator of the experiment" in problem.message


def test_a_grid_that_does_not_fit_into_memory():
    def enlarge(data):
        data["initiators"][0]["grid"] = {"rho_bins": 10**9, "rho_step": 1, "rho_min": 0}

    problems = found(enlarge)
    assert [problem.path for problem in problems] == [("experiments", 0), ("experiments", 1)]
    for problem in problems:
        assert "standard" in problem.message
        assert "335.3 GiB" in problem.message
        assert "the limit is 1 GiB" in problem.message


def test_speeds_that_contradict_a_default():
    (problem,) = found(lambda data: data["initiators"][2].update(speed_min=5))
    assert problem.path == ("experiments", 0)
    assert "speed_min is 5 and speed_max 0.7 km/s" in problem.message


def test_one_wrong_experiment_does_not_hide_the_next():
    def spoil(data):
        data["experiments"][0]["sweep"] = {"scans": [0]}
        data["experiments"][1]["scenarios"] = ["fra"]

    assert [problem.path for problem in found(spoil)] == [
        ("experiments", 0, "sweep", "scans", 0),
        ("experiments", 1, "scenarios", 0),
    ]


def test_in_a_file_each_has_its_line_and_column():
    def spoil(data):
        data["experiments"][0]["sweep"] = {"scans": [5, 0], "rate": [1]}
        data["experiments"][1]["scenarios"] = ["fra"]

    text = write(changed(spoil))
    with pytest.raises(RequestError) as caught:
        parse_set(text, "set.yaml")
    first, second = str(caught.value).splitlines()
    lines = text.splitlines()
    for message, word in ((first, "0]"), (second, "fra")):
        source, line, column, _ = message.split(":", 3)
        assert source == "set.yaml"
        assert lines[int(line) - 1][int(column) - 1 :].startswith(word)
    assert "experiments[0].sweep.scans[1]: " in first
    assert "experiments[1].scenarios[0]: there is no scenario 'fra'; did you mean 'far'?" in second
