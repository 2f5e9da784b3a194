"""Scenes, clusterings and experiments on them, as a set gives them: what is allowed, and what is said."""

import copy

import pytest

from algorithms.clustering.parameters import MODES
from algorithms.errors import RequestError
from scenarios.experiments import ClusteringExperiment, InitiationExperiment
from scenarios.files.marked_yaml import write
from scenarios.files.set_files import load_set, parse_set, set_data
from scenarios.sweeps import points

SET = {
    "schema": 1,
    "name": "plane",
    "scenes": [
        {
            "name": "pair",
            "region": {"range": [0, 120], "doppler": [0, 90]},
            "interference": 5,
            "targets": [{"range": 30, "doppler": 45}, {"range": 75, "doppler": 45, "points": 12}],
        },
        {"name": "empty", "region": {"range": [0, 120], "doppler": [0, 90]}, "noise": 20},
    ],
    "clusterings": [
        {"name": "recommended", "range_extent": 16, "doppler_extent": 12},
        {"name": "sparse", "mode": "dbscan", "range_extent": 16, "doppler_extent": 12, "eps": 0.2},
        {"name": "k-means", "range_extent": 16, "doppler_extent": 12, "number": "auto"},
    ],
    "experiments": [
        {"name": "all", "kind": "clustering", "clusterings": ["recommended", "sparse"], "trials": 10},
        {"name": "told", "kind": "clustering", "scenes": ["pair"], "clusterings": ["k-means"]},
    ],
}


def parsed(change=None):
    data = copy.deepcopy(SET)
    if change is not None:
        change(data)
    return parse_set(write(data), "plane.yaml")


def refusal(change):
    with pytest.raises(RequestError) as caught:
        parsed(change)
    return str(caught.value)


def test_a_set_of_scenes_alone_holds_what_it_says():
    given = parsed()
    assert given.scenarios == []
    pair, empty = given.scenes
    assert (pair.targets[0].points, pair.targets[1].points) == (24, 12)
    assert pair.expected_points == 24 + 12 + 5
    assert empty.expected_points == 20
    assert [type(found) for found in given.experiments] == [ClusteringExperiment] * 2
    assert [entry.parameters for entry in given.clusterings] == [
        MODES["recommended"](range_extent=16, doppler_extent=12),
        MODES["dbscan"](range_extent=16, doppler_extent=12, eps=0.2),
        MODES["k-means"](range_extent=16, doppler_extent=12, number="auto"),
    ]
    assert parse_set(write(set_data(given)), "again.yaml") == given


def test_an_experiment_without_a_kind_is_of_initiation():
    for experiment in load_set("course-report").experiments:
        assert isinstance(experiment, InitiationExperiment)


def test_points_run_scene_by_scene_with_auto_worked_out():
    given = parsed(lambda data: data["experiments"][1].update(sweep={"scene.interference": [0, 7]}))
    every = list(points(given, given.experiments[0]))
    names = [(found.world.name, found.entry.name) for found in every]
    assert names == [(scene, how) for scene in ("pair", "empty") for how in ("recommended", "sparse")]
    told = list(points(given, given.experiments[1]))
    assert [found.world.interference for found in told] == [0, 7]
    assert [found.parameters.number for found in told] == [2, 2]
    assert [found.swept for found in told] == [{"scene.interference": 0}, {"scene.interference": 7}]


def test_a_parameter_of_all_clusterings_is_swept_by_a_short_name():
    given = parsed(lambda data: data["experiments"][0].update(sweep={"range_extent": [12, 16]}))
    extents = [found.parameters.range_extent for found in points(given, given.experiments[0])]
    assert extents == [12, 16] * 4


REFUSED = {
    "neither scenarios nor scenes": (
        lambda data: data.pop("scenes"),
        ["scenarios: is missing", "or scenes in place of it"],
    ),
    "no bounds": (
        lambda data: data["scenes"][0]["region"].update(range=[5, 5]),
        ["plane.yaml:6:", "scenes[0].region.range", "spans nothing"],
    ),
    "correlation": (
        lambda data: data["scenes"][0]["targets"][0].update(correlation=1.5),
        ["scenes[0].targets[0].correlation", "1.5 is given", "at most 1"],
    ),
    "too many points": (
        lambda data: data["scenes"][1].update(noise=2e6),
        ["scenes[1]", "2,000,000 points", "1,000,000"],
    ),
    "a field of another mode": (
        lambda data: data["clusterings"][0].update(eps=0.4),
        ["clusterings[0].eps", "no field 'eps'"],
    ),
    "no mode": (
        lambda data: data["clusterings"][0].update(name="mine"),
        ["clusterings[0]", "'mine'", "recommended", "dbscan"],
    ),
    "an unknown scene": (
        lambda data: data["experiments"][1].update(scenes=["pare"]),
        ["experiments[1].scenes[0]", "no scene 'pare'", "did you mean 'pair'"],
    ),
    "an unknown kind": (
        lambda data: data["experiments"][0].update(kind="clusterin"),
        ["experiments[0]", "'clusterin'", "did you mean 'clustering'"],
    ),
    "a criterion": (
        lambda data: data["experiments"][0].update(criterion={"plots": 3}),
        ["experiments[0].criterion", "no field 'criterion'", "clusterings"],
    ),
    "initiation without scenarios": (
        lambda data: data["experiments"].append({"name": "tracks", "criterion": {"plots": 3}}),
        ["experiments[2].scenarios", "the set lists no scenarios"],
    ),
    "a parameter that one has alone": (
        lambda data: data["experiments"][0].update(sweep={"clustering.eps": [0.3]}),
        ["experiments[0].sweep.clustering.eps", "must belong to every clustering"],
    ),
    "auto without targets": (
        lambda data: data["experiments"][1].update(scenes=["empty"]),
        ["experiments[1]", "k-means on empty", "it has none"],
    ),
    "a name twice": (
        lambda data: data["scenes"][1].update(name="pair"),
        ["scenes[1].name", "scenes[0]"],
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused(case):
    change, words = REFUSED[case]
    said = refusal(change)
    for word in words:
        assert word in said, said
