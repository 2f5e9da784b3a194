import pytest

from algorithms.errors import RequestError
from hough_tui.experiments.cases import LARGEST_CHUNK
from hough_tui.experiments.plan import plan_run
from scenarios.files.set_files import load_set, parse_set


def test_cells_stand_in_the_order_of_the_set_with_the_swept_key_as_written():
    plan = plan_run([load_set("course-report")])
    told = [(cell.experiment.name, cell.entry.name, cell.swept) for cell in plan.cells]
    assert told[:4] == [
        ("tables", "standard", {"scans": 5}),
        ("tables", "standard", {"scans": 10}),
        ("tables", "standard", {"scans": 15}),
        ("tables", "sequential", {"scans": 5}),
    ]
    assert told[-1] == ("modified", "modified", {"detection_probability": 0.8})
    assert [cell.scenario.scans for cell in plan.cells[:3]] == [5, 10, 15]


def test_equal_draws_and_equal_tracks_are_work_once():
    plan = plan_run([load_set("course-report")], experiments=["tables", "tables-sound"])
    assert len(plan.draws) == 3
    assert all(len(shared.runs) == 2 for shared in plan.draws)
    assert sorted(cell for shared in plan.draws for run in shared.runs for cell in run.cells) == list(
        range(12)
    )
    for shared in plan.draws:
        for run in shared.runs:
            assert {plan.cells[cell].entry.name for cell in run.cells} == {run.first.entry.name}
            assert {plan.cells[cell].scenario.scans for cell in run.cells} == {shared.scenario.scans}


def test_other_seeds_and_other_parameters_share_nothing():
    text = """
schema: 1
name: apart
scenarios:
  - {name: a, scans: 3, interval: 1, region: {x: [0, 1], y: [0, 1]}, sensor: {sigma: 0.1}}
initiators: [{name: standard, votes: 2}, {name: other, initiator: standard, votes: 3}]
experiments:
  - {name: one, seed: 1, criterion: {rho: 1}}
  - {name: two, seed: 2, criterion: {rho: 1}}
"""
    plan = plan_run([parse_set(text, "apart.yaml")])
    assert [(shared.seed, len(shared.runs)) for shared in plan.draws] == [(1, 2), (2, 2)]


def test_overrides_reach_every_experiment_and_the_sets_that_are_kept():
    plan = plan_run([load_set("course-report")], trials=17, seed=99)
    assert {(cell.experiment.trials, cell.experiment.seed) for cell in plan.cells} == {(17, 99)}
    assert {experiment.trials for experiment in plan.sets[0].experiments} == {17}


def test_a_chunk_depends_on_the_scenario_alone():
    (crowded, _, small, *_) = plan_run([load_set("course-report")]).draws[::-1]
    assert 1 <= crowded.chunk <= LARGEST_CHUNK
    assert 1 <= small.chunk <= LARGEST_CHUNK


@pytest.mark.parametrize(
    ("names", "message"), [(["tabels"], "did you mean 'tables'"), (["nothing at all"], "known: tables")]
)
def test_an_unknown_experiment_is_named_with_those_known(names, message):
    with pytest.raises(RequestError, match=message):
        plan_run([load_set("course-report")], experiments=names)


def test_more_memory_than_the_columns_may_take_is_refused():
    with pytest.raises(RequestError, match="GiB"):
        plan_run([load_set("course-report")], trials=10_000_000)


def test_two_sets_of_one_name_are_refused():
    given = load_set("course-report")
    with pytest.raises(RequestError, match="two sets are named 'course-report'"):
        plan_run([given, given])
