import json

import numpy as np
import pytest

from algorithms.initiators.registry import initiator
from hough_tui.experiments.chunks import initiation as chunks
from hough_tui.experiments.engines import threads as engine
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from scenarios.files.set_files import load_set
from scenarios.simulate import draw
from scenarios.world import World

TRIALS = 600


@pytest.fixture(scope="module")
def plan():
    return plan_run([load_set("course-report")], trials=TRIALS)


def finished(plan, workers):
    job = Job(plan, workers)
    assert job.wait()
    return job


def without_times(job):
    document = result(job).document
    for row in document["rows"]:
        del row["seconds_per_trial"]
    return json.dumps(document)


def test_the_number_of_workers_changes_no_byte(plan):
    one, three = finished(plan, 1), finished(plan, 3)
    assert without_times(one) == without_times(three)
    for ours, theirs in zip(one.columns, three.columns, strict=True):
        for name, values in ours.arrays().items():
            np.testing.assert_array_equal(values, theirs.arrays()[name], err_msg=name)


def test_a_trial_of_the_batch_can_be_found_again_alone(plan):
    job = finished(plan, 2)
    index = next(i for i, cell in enumerate(plan.cells) if cell.swept == {"scans": 10})
    cell = plan.cells[index]
    world = World.of(cell.scenario)
    for trial in (0, 255, TRIALS - 1):
        alone = draw(world, cell.experiment.seed, trial)
        tracks = initiator("standard").initiate_chunk(alone.chunk, cell.scenario.context, cell.parameters)
        assert tracks.counts[0] == job.columns[index].tracks[trial]


def test_the_control_is_the_same_clutter_without_targets(plan):
    job = finished(plan, 2)
    cell, columns = plan.cells[2], job.columns[2]
    assert cell.swept == {"scans": 15}
    drawn = draw(World.of(cell.scenario), cell.experiment.seed, 0, 40).without_targets()
    tracks = initiator("standard").initiate_chunk(drawn.chunk, cell.scenario.context, cell.parameters)
    for trial in range(40):
        rho = tracks.rho[tracks.offsets[trial] : tracks.offsets[trial + 1]]
        expected = [bool((abs(rho - true) <= 3.0).any()) for true in (-3.4300, 78.8892)]
        assert columns.control_found[trial].tolist() == expected


def test_sound_and_plain_criterion_score_the_same_tracks(plan):
    job = finished(plan, 2)
    by_name = {(c.experiment.name, c.entry.name, *c.swept.values()): i for i, c in enumerate(plan.cells)}
    for name in ("standard", "sequential"):
        plain = job.columns[by_name["tables", name, 15]]
        sound = job.columns[by_name["tables-sound", name, 15]]
        np.testing.assert_array_equal(plain.tracks, sound.tracks)
        assert not (sound.found & ~plain.found).any()


def test_a_cancelled_run_tells_what_it_finished():
    job = Job(plan_run([load_set("course-report")], trials=200_000), 2)
    while not job.progress.done.any():
        job.wait(0.01)
    job.cancel()
    assert job.wait(30)
    assert not job.is_complete
    rows = job.rows()
    done = job.progress.done[job.progress.done > 0]
    assert [row["trials"] for row in rows] == done.tolist()
    assert result(job).document["complete"] is False


def test_a_chunk_whose_trials_take_long_is_done_in_parts(monkeypatch):
    # Time passes by the trials alone here.
    now, parts = [0.0], []
    plan = plan_run([load_set("course-report")], experiments=["modified"], trials=25)
    draws = type(plan.draws[0])
    run = draws.run

    def slow(shared, world, first, trials, plain):
        yield from run(shared, world, first, trials, plain)
        now[0] += 0.02 * trials
        parts.append((first, trials))

    monkeypatch.setattr(draws, "run", slow)
    monkeypatch.setattr(engine.time, "monotonic", lambda: now[0])
    job = Job(plan, workers=1)
    assert job.wait()
    assert job.is_complete
    assert max(trials for _, trials in parts) == 2
    # Each trial of each of the three draws is done once, the one that loads the kernels aside.
    done = [first + number for first, trials in parts[3:] for number in range(trials)]
    assert done == [*range(25)] * 3


def test_a_worker_that_fails_stops_the_run_and_says_why(monkeypatch):
    def broken(*args):
        raise RuntimeError("no such luck")

    monkeypatch.setattr(chunks, "score", broken)
    job = Job(plan_run([load_set("course-report")], trials=2000), 2)
    with pytest.raises(RuntimeError, match="no such luck"):
        job.wait()
    assert not job.is_complete
