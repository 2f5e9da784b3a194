"""Runs that are cancelled, or left."""

from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.ui.widgets.rate_grid import RateGrid

MANY = "200000"


async def begin(user, trials=MANY):
    """Begin a run that takes minutes, and wait until trials are finished."""
    view = await user.go("f6")
    await user.click("#run-trials")
    await user.press("home", "shift+end", "delete")
    await user.type(trials)
    await user.press("enter")
    await user.until(lambda: view._live.job.progress.done.sum() > 0)
    return view


def test_a_run_is_cancelled_and_what_it_has_found_can_be_kept(drive):
    async def journey(user):
        view = await begin(user)
        await user.sees("trials ·", "left")
        assert view.is_at_work
        await user.press("x")
        await user.until(lambda: not view.is_at_work)
        done = int(view._live.job.progress.done.sum())
        assert 0 < done < 6 * int(MANY)
        await user.sees(f"cancelled after {done:,} of {6 * int(MANY):,} trials")
        rows = [row for row in view._live.rows if row["trials"]]
        assert sum(row["trials"] for row in rows) == done
        assert view.query_one(RateGrid).row_count == 6
        assert FolderStore().names() == []
        await user.press("w")
        await user.until(lambda: FolderStore().names())
        await user.sees("kept as")
        (name,) = FolderStore().names()
        assert FolderStore().document(name)["complete"] is False
        # Another one can be run at once.
        await user.click("#run-trials")
        await user.press("home", "shift+end", "delete")
        await user.type("3")
        await user.press("enter")
        await user.sees("18 trials in")

    drive(journey, "course-report")


def test_quitting_stops_a_run(drive):
    jobs = []

    async def journey(user):
        view = await begin(user)
        jobs.append(view._live.job)
        await user.press("ctrl+q")
        await user.until(lambda: user.app._exit)

    ended = drive(journey, "course-report")
    assert ended.return_code == 0
    (job,) = jobs
    assert job.wait(60.0)
    assert not job.is_complete


def test_forms_answer_while_a_run_goes_on(drive):
    async def journey(user):
        view = await begin(user)
        await user.go("f3")
        await user.fill(("initiators", 0, "grid", "rho_step"), "0.5")
        await user.until(lambda: user.value("initiators", 0, "grid", "rho_step") == 0.5)
        assert view.is_at_work
        await user.go("f6")
        await user.press("escape")
        await user.until(lambda: not view.is_at_work)
        # The rates are those of the set as it was.
        await user.sees("the set has changed since")

    drive(journey, "course-report")


def test_a_number_of_trials_that_is_none_runs_nothing(drive):
    async def journey(user):
        view = await user.go("f6")
        await user.click("#run-trials")
        await user.type("1,5")
        await user.sees("trials: '1,5' is given; it must be a whole number")
        await user.press("enter")
        assert not view.is_at_work
        assert view._live is None

    drive(journey, "course-report")
