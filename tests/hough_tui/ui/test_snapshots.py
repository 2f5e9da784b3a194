"""How the views look, at 80 × 24 and at 160 × 48.

After a change that is meant, look at the report and write the pictures anew: pytest --snapshot-update.
"""

import re
from types import SimpleNamespace

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from hough_tui.experiments import look
from hough_tui.experiments.engine import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from hough_tui.experiments.store import FolderStore
from hough_tui.experiments.tallies import tally
from hough_tui.ui.app import HoughApp
from hough_tui.ui.config import Config
from hough_tui.ui.views import shown_run
from scenarios.files import load_set

SIZES = {"narrow": (80, 24), "wide": (160, 48)}
NAME = "20250102-030405-course-report-0a1b"
SECONDS = 0.000123
"""A trial takes as long on every machine."""


@pytest.fixture(params=SIZES)
def size(request):
    return SIZES[request.param]


@pytest.fixture(autouse=True)
def steady(home, monkeypatch):
    """Let clocks stand, and nothing blink."""
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setattr(look, "time", SimpleNamespace(perf_counter=lambda: 0.0))


@pytest.fixture
def kept(home):
    """One run in the store."""
    job = Job(plan_run([load_set("course-report")], experiments=("tables",), trials=20))
    assert job.wait(60.0)
    run = result(job)
    for row in run.document["rows"]:
        row["seconds_per_trial"] = SECONDS
    store = FolderStore()
    (store.folder / store.add(run)).rename(store.folder / NAME)


@pytest.fixture
def looks(snap_compare, size, make_user):
    """Return a function that tells whether the application looks as it did, after a journey."""

    def compare(journey, set_name="course-report"):
        async def before(pilot: Pilot) -> None:
            user = make_user(pilot)
            await journey(user)
            await user.still()
            pilot.app.clear_notifications()
            for line in pilot.app.screen.query(Input):
                line.cursor_blink = False
            await user.settle()

        app = HoughApp(set_name, Config())
        return snap_compare(app, terminal_size=size, run_before=before)

    return compare


def test_first_run(looks):
    async def journey(user):
        await user.screen("Welcome")

    assert looks(journey, None)


def test_scenario(looks):
    async def journey(user):
        await user.warm()
        await user.go("f2")
        await user.sees("trial 0 of seed 7")

    assert looks(journey)


def test_initiator(looks):
    async def journey(user):
        await user.warm()
        await user.go("f3")

    assert looks(journey)


def test_look(looks):
    async def journey(user):
        await user.warm()
        await user.go("f4")
        await user.sees("standard on two-crossing, trial 0")

    assert looks(journey)


def test_monte_carlo_after_a_run(looks, size, monkeypatch):
    monkeypatch.setattr(shown_run, "tally", lambda *cell: {**tally(*cell), "seconds_per_trial": SECONDS})

    async def journey(user):
        await user.warm()
        view = await user.go("f6")
        await user.click("#run-trials")
        await user.type("20")
        await user.press("enter")
        await user.until(lambda: view._live is not None and not view.is_at_work)
        await user.sees("120 trials in")
        view._result = re.sub(r"in .* · kept as .*", f"in 1 s · kept as {NAME}", view._result)
        view._tell_idle()
        if size == SIZES["wide"]:
            await user.sees("bars: 95 % interval")

    assert looks(journey)


def test_results(looks, size, kept):
    async def journey(user):
        await user.warm()
        await user.go("f7")
        await user.sees("1 run")
        await user.press("enter")
        await user.sees(NAME)
        if size == SIZES["wide"]:
            await user.sees("bars: 95 % interval")

    assert looks(journey)
