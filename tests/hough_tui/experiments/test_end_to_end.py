"""Initiation on points that are clustered first: which plots each row sees, and that nothing else counts."""

import copy
import json

import numpy as np
import pytest

from hough_tui.experiments.chunks.plot_sources import plots_of
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.inspection.trial import look, picture
from hough_tui.reports.rates import rate_sheets
from scenarios.detections import ResolvedWorld, draw_points
from scenarios.files.set_files import load_set
from scenarios.front_end import clustered
from scenarios.selection import chosen_clustering

TRIALS = 24


@pytest.fixture(scope="module")
def plan():
    given = load_set("range-doppler")
    (experiment,) = [found for found in given.experiments if found.name == "end-to-end"]
    update = {"clusterings": ["ideal", "recommended", "corrected-patent", "none"], "initiators": ["standard"]}
    changed = given.model_copy(update={"experiments": [experiment.model_copy(update=update)]})
    return plan_run([changed], trials=TRIALS)


@pytest.fixture(scope="module")
def job(plan):
    job = Job(plan, 2)
    assert job.wait()
    return job


def test_rows_carry_their_clustering(job):
    rows = job.rows()
    assert [row["clustering"] for row in rows] == ["ideal", "recommended", "corrected-patent", "none"]
    assert list(rows[0])[:5] == ["set", "experiment", "scenario", "clustering", "initiator"]
    (sheet,) = rate_sheets(rows)
    assert [column.name for column in sheet.columns[:2]] == ["clustering", "initiator"]


def test_clustering_takes_the_false_tracks_of_interference_away(job):
    false = {row["clustering"]: row["false_tracks_per_trial"] for row in job.rows()}
    success = {row["clustering"]: row["success_rate"] for row in job.rows()}
    assert false["recommended"] < 0.2 * false["ideal"]
    assert false["none"] > 10.0 * false["ideal"]
    assert min(success.values()) > 0.8


def test_the_number_of_workers_changes_no_byte(plan, job):
    one = Job(plan, 1)
    assert one.wait()
    for ours, theirs in zip(one.columns, job.columns, strict=True):
        for name, values in ours.arrays().items():
            np.testing.assert_array_equal(values, theirs.arrays()[name], err_msg=name)
    rows = [copy.deepcopy(found.rows()) for found in (one, job)]
    for row in (*rows[0], *rows[1]):
        del row["seconds_per_trial"]
    assert json.dumps(rows[0]) == json.dumps(rows[1])


def test_draws_are_shared_and_what_is_found_is_found_once(plan):
    (shared,) = plan.draws
    assert [tuple(run.cells) for run in shared.runs] == [(0,), (1,), (2,), (3,)]
    given = load_set("range-doppler")
    twice = [found.model_copy(update={"name": f"{found.name}-2"}) for found in given.clusterings[:1]]
    doubled = given.model_copy(
        update={
            "clusterings": [*given.clusterings, *twice],
            "experiments": [
                plan.cells[0].experiment.model_copy(update={"clusterings": ["recommended", "recommended-2"]})
            ],
        }
    )
    (shared,) = plan_run([doubled]).draws
    assert [tuple(run.cells) for run in shared.runs] == [(0, 1)]


def test_a_trial_can_be_looked_at_as_its_row_saw_it(plan, job):
    for index, cell in enumerate(plan.cells):
        seen = picture(cell.scenario, cell.experiment.seed, 17, cell.clustering)
        found = look(seen, cell.entry, cell.parameters, cell.criterion)
        assert found.total == job.columns[index].tracks[17]


def test_the_plots_of_a_stage_are_those_of_the_front_end():
    given = load_set("range-doppler")
    (scenario,) = given.scenarios
    resolved = ResolvedWorld.of(scenario)
    points = draw_points(resolved, 5, 2)
    stage = chosen_clustering(given, scenario, "recommended")
    plots = plots_of(scenario, 5, 2, stage)
    expected = clustered(resolved, points, given.clusterings[0].parameters)
    np.testing.assert_array_equal(plots.chunk.position, expected.chunk.position)
    assert len(plots_of(scenario, 5, 2).chunk.scan) == len(points.scan)
    ideal = plots_of(scenario, 5, 2, chosen_clustering(given, scenario, "ideal"))
    assert [(ideal.origin == target).sum() for target in (0, 1)] == [8, 8]


def test_the_control_is_clustered_as_the_draw_is(plan, job):
    for index, cell in enumerate(plan.cells):
        bare = cell.scenario.model_copy(update={"targets": []})
        assert not job.columns[index].control_found.all()
        drawn = plots_of(bare, cell.experiment.seed, 3, cell.clustering)
        tracks = cell.entry.algorithm.initiate_chunk(drawn.chunk, cell.scenario.context, cell.parameters)
        if cell.clustering.name == "recommended":
            assert tracks.counts.sum() == 0
            assert not job.columns[index].control_found[3].any()


def test_a_swept_extent_reaches_the_clustering():
    given = load_set("range-doppler")
    (experiment,) = [found for found in given.experiments if found.name == "end-to-end"]
    update = {
        "clusterings": ["recommended"],
        "initiators": ["standard"],
        "sweep": {"clustering.range_extent": [4, 16], "extended.points": [24]},
    }
    with pytest.raises(Exception, match=r"extended\.points"):
        plan_run([given.model_copy(update={"experiments": [experiment.model_copy(update=update)]})])
    update["sweep"] = {"clustering.range_extent": [4, 16], "scenario.targets.0.extended.points": [24]}
    cells = plan_run([given.model_copy(update={"experiments": [experiment.model_copy(update=update)]})]).cells
    assert [cell.clustering.range_extent for cell in cells] == [4, 16]
