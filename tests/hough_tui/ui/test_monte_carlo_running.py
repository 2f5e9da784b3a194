"""Runs and their rows, without a screen."""

import numpy as np
import pytest

from algorithms.errors import RequestError
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from hough_tui.experiments.stores.folder import FolderStore, Run
from hough_tui.ui.runs.pace import Pace, duration
from hough_tui.ui.runs.run_controller import Ended, Filled, Running, RunRequest, Started
from hough_tui.ui.runs.shown_run import KeptRun, LiveRun
from scenarios.files.set_files import load_set

pytestmark = pytest.mark.usefixtures("data_home")

TRIALS = 20_000


@pytest.fixture(scope="module")
def given():
    return load_set("course-report")


def test_a_run_tells_its_beginning_its_rows_and_its_end(given):
    told = []
    Running(RunRequest(given, ("modified",), trials=300), told.append).work()
    assert isinstance(told[0], Started)
    assert isinstance(told[-1], Ended)
    assert all(isinstance(event, Filled) for event in told[1:-1])
    ended = told[-1]
    assert ended.is_complete
    assert ended.problem is None
    assert FolderStore().names() == [ended.kept_as]
    assert [row["trials"] for row in ended.rows] == [300] * 3
    assert list(ended.rows) == FolderStore().document(ended.kept_as)["rows"]


def test_a_run_that_is_cancelled_before_it_begins_does_nothing(given):
    told = []
    running = Running(RunRequest(given), told.append)
    running.cancel()
    running.work()
    assert told == [Ended()]
    assert FolderStore().names() == []


def test_a_wrong_request_is_told(given):
    told = []
    Running(RunRequest(given, ("no such",)), told.append).work()
    (ended,) = told
    assert "there is no experiment 'no such'" in ended.problem


def test_trials_of_a_row_that_is_not_finished_keep_their_numbers(given):
    plan = plan_run([given], experiments=["modified"], trials=TRIALS)
    job = Job(plan, 2)
    while not job.progress.done.any():
        job.wait(0.001)
    job.cancel()
    assert job.wait(60)
    live = LiveRun(job)
    with pytest.raises(RequestError, match="under way"):
        live.document()
    whole = Job(plan, 2)
    assert whole.wait()
    rows = live.snapshot()
    for index, row in enumerate(rows):
        assert row["trials"] == job.progress.done[index]
        if not row["trials"]:
            with pytest.raises(RequestError, match="no trial"):
                live.trials(index)
            continue
        trials = live.trials(index)
        assert len(trials.numbers) == row["trials"] == len(trials.columns.tracks)
        np.testing.assert_array_equal(trials.columns.tracks, whole.columns[index].tracks[trials.numbers])


def test_rows_are_worked_out_anew_only_where_there_is_more(given):
    job = Job(plan_run([given], experiments=["modified"], trials=50), 2)
    live = LiveRun(job)
    assert [row["trials"] for row in live.rows] == [0, 0, 0]
    assert job.wait()
    live.rows = live.snapshot()
    again = live.snapshot()
    assert all(before is after for before, after in zip(live.rows, again, strict=True))
    assert [row["success_rate"] for row in again] == [row["success_rate"] for row in job.rows()]


def test_a_kept_run_opens_its_trials(given):
    job = Job(plan_run([given], trials=30, seed=5), 2)
    assert job.wait()
    name = FolderStore().add(result(job))
    kept = KeptRun(name, FolderStore().load(name))
    for index, cell in enumerate(job.plan.cells):
        trials = kept.trials(index)
        assert trials.cell == cell
        np.testing.assert_array_equal(trials.columns.found, job.columns[index].found)
        assert trials.numbers.tolist() == list(range(30))


@pytest.fixture
def in_part(given):
    """A run of which every second chunk of trials is finished, as the run that was finished, and as kept."""
    whole = Job(plan_run([given], experiments=["modified"], trials=TRIALS), 2)
    assert whole.wait()
    for finished in whole._finished:
        finished[: TRIALS // 3] = False
        finished[TRIALS // 2 : TRIALS // 2 + 5] = False
    whole.progress.done[:] = [finished.sum() for finished in whole._finished]
    name = FolderStore().add(result(whole))
    return whole, FolderStore().load(name)


def test_a_run_kept_in_part_opens_the_trials_that_it_has(in_part):
    whole, run = in_part
    assert run.document["complete"] is False
    kept = KeptRun("part", run)
    for index, finished in enumerate(whole._finished):
        trials = kept.trials(index)
        assert trials.numbers.tolist() == np.flatnonzero(finished).tolist()
        np.testing.assert_array_equal(trials.columns.tracks, whole.columns[index].tracks[trials.numbers])
        assert trials.numbers[0] == TRIALS // 3


def test_a_run_in_part_of_the_first_versions_says_why_its_trials_stay_closed(in_part):
    _, run = in_part
    old = tuple({key: values for key, values in row.items() if key != "trial"} for row in run.columns)
    kept = KeptRun("part", Run(run.sets, run.document, old))
    with pytest.raises(RequestError, match="cancelled after"):
        kept.trials(0)


def test_a_whole_run_of_the_first_versions_opens(given):
    job = Job(plan_run([given], experiments=["modified"], trials=7), 2)
    assert job.wait()
    run = result(job)
    old = tuple({key: values for key, values in row.items() if key != "trial"} for row in run.columns)
    kept = KeptRun("old", Run(run.sets, run.document, old))
    assert kept.trials(0).numbers.tolist() == list(range(7))


def test_a_row_that_the_sets_do_not_hold_stays_closed(given):
    job = Job(plan_run([given], experiments=["modified"], trials=3), 2)
    assert job.wait()
    run = result(job)
    run.document["rows"][0]["initiator"] = "another"
    kept = KeptRun("odd", run)
    with pytest.raises(RequestError, match="cannot be told"):
        kept.trials(0)


def test_the_pace_is_that_of_the_last_seconds():
    pace = Pace(10_000)
    pace.look(0.0, 0)
    assert pace.speed is None
    assert "preparing" in pace.words(0, 2)
    pace.look(20.0, 0)
    pace.look(21.0, 500)  # what came before was loading
    assert pace.speed is None
    pace.look(22.0, 1000)
    assert pace.speed == pytest.approx(500.0)
    for second in range(23, 33):
        pace.look(float(second), 1000 + (second - 22) * 300)
    assert pace.speed == pytest.approx(300.0)
    assert pace.left == pytest.approx(20.0)
    assert pace.words(0, 2) == "0/2 cells · 4,000 of 10,000 trials · 300/s · 20 s left"


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.04, "0.0 s"), (0.5, "0.5 s"), (0.96, "1 s"), (9.7, "10 s"), (59.6, "1 min 0 s"), (125, "2 min 5 s"),
     (3 * 3600 + 190, "3 h 3 min")],
)  # fmt: skip
def test_durations_read_as_people_say_them(seconds, text):
    assert duration(seconds) == text
