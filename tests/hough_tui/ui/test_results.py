"""The Results view in a small application of its own."""

import asyncio
import csv
import json
import time

import pytest
from textual.app import App
from textual.widgets import Button, Input, RadioButton, Static

from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.ui.screens.comparison import ComparisonScreen
from hough_tui.ui.screens.export import ExportScreen
from hough_tui.ui.screens.question import Question
from hough_tui.ui.screens.trials import TrialsScreen
from hough_tui.ui.views.results import ResultsView
from hough_tui.ui.widgets.caption import Caption
from hough_tui.ui.widgets.rate_grid import RateGrid
from hough_tui.ui.widgets.rate_panel import RatePanel
from hough_tui.ui.widgets.run_list import RunList
from hough_tui.ui.widgets.trial_list import TrialList
from scenarios.files.set_files import load_set

pytestmark = pytest.mark.usefixtures("data_home")

PATIENCE = 120.0


@pytest.fixture(scope="module")
def runs():
    """The experiment `tables` twice, with other seeds."""
    given = load_set("course-report")
    found = []
    for seed in (7, 8):
        job = Job(plan_run([given], experiments=["tables"], trials=60, seed=seed), 2)
        assert job.wait()
        found.append(result(job))
    return found


@pytest.fixture
def kept(runs, data_home):
    """Their names in the store, the newer one first, as the view lists them."""
    for run in runs:
        FolderStore().add(run)
    return FolderStore().names()


class Host(App[None]):
    def __init__(self):
        super().__init__()
        self.view, self.opened = ResultsView(), []

    def compose(self):
        yield self.view

    def on_mount(self):
        self.view.show_set(load_set("course-report"))
        self.view.set_runnable(None)
        self.view.take_focus()

    def on_trial_opened(self, event):
        self.opened.append(event)


class Driver:
    def __init__(self, app, pilot):
        self.app, self.pilot, self.view = app, pilot, app.view

    async def until(self, condition):
        limit = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < limit
            await self.pilot.pause(0.01)
        await self.pilot.pause()

    async def listed(self, count):
        await self.until(lambda: self.runs.row_count == count)

    async def screen(self, kind):
        await self.until(lambda: isinstance(self.app.screen, kind))
        return self.app.screen

    async def show(self):
        """Show the run under the cursor."""
        await self.pilot.press("enter")
        await self.until(lambda: self.panel.shown is not None)

    @property
    def runs(self):
        return self.view.query_one(RunList)

    @property
    def panel(self):
        return self.view.query_one(RatePanel)

    @property
    def about(self):
        return str(self.view.query_one("#about", Caption).render())


def drive(journey, size=(160, 48)):
    async def work():
        app = Host()
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await journey(Driver(app, pilot))
        return app

    return asyncio.run(work())


def texts(screen):
    return " ".join(str(static.content) for static in screen.query("Static"))


def test_without_runs_it_says_where_they_come_from():
    async def journey(user):
        await user.until(lambda: "no run has been kept yet" in user.about)
        await user.pilot.press("enter", "space", "e", "delete", "equals_sign")
        await user.pilot.pause()
        assert len(user.app.screen_stack) == 1

    drive(journey)


def test_runs_are_listed_with_what_they_are(kept):
    async def journey(user):
        await user.listed(2)
        assert list(user.runs.known) == kept
        cells = [cell.plain.strip() for cell in user.runs.get_row(kept[0])]
        seed = FolderStore().document(kept[0])["seed"]
        assert cells[2:] == ["course-report", "6", "60", str(seed), "tables"]
        assert cells[1].startswith(f"{kept[0][:4]}-{kept[0][4:6]}-{kept[0][6:8]} ")

    drive(journey)


def test_a_run_that_comes_is_listed_and_one_that_is_damaged_stays_harmless(kept, runs):
    async def journey(user):
        await user.listed(2)
        await user.pilot.press("j")
        chosen = user.runs.chosen
        FolderStore().add(runs[0])
        (FolderStore().folder / kept[0] / "result.json").write_text("{")
        user.runs.known.pop(kept[0])
        await user.pilot.press("u")
        await user.listed(3)
        assert user.runs.chosen == chosen
        assert "damaged" in user.runs.get_row(kept[0])[-1].plain
        user.runs.move_to(kept[0])
        await user.pilot.press("enter")
        assert "no JSON" in texts(await user.screen(Question))

    drive(journey)


def test_a_run_is_shown_again_and_its_trials_open(kept, runs):
    async def journey(user):
        await user.listed(2)
        await user.show()
        grid = user.panel.query_one(RateGrid)
        await user.until(lambda: grid.has_focus)
        assert grid.row_count == 6
        document = FolderStore().document(kept[0])
        shown = [cell.plain.strip() for cell in grid.get_column_at(2)]
        assert shown == [f"{100 * row['success_rate']:.1f}" for row in document["rows"]]
        await user.pilot.press("j", "j", "j", "enter")
        screen = await user.screen(TrialsScreen)
        trial = screen.query_one(TrialList).trial
        run = next(run for run in runs if run.document["seed"] == document["seed"])
        found = run.columns[3]["found"].sum(axis=1)
        assert found[trial] == found.min()
        await user.pilot.press("enter")
        await user.until(lambda: user.app.opened)
        (opened,) = user.app.opened
        assert (opened.trial, opened.cell.experiment.seed) == (trial, document["seed"])
        assert (opened.cell.scenario.scans, opened.cell.entry.name) == (5, "sequential")

    drive(journey)


def test_narrow_list_and_run_take_turns(kept):
    async def journey(user):
        await user.listed(2)
        both = user.view.query_one("#list"), user.view.query_one("#run")
        assert [part.display for part in both] == [True, True]
        await user.pilot.resize_terminal(80, 24)
        await user.pilot.pause()
        assert [part.display for part in both] == [True, False]
        await user.show()
        await user.pilot.pause()
        assert [part.display for part in both] == [False, True]
        await user.pilot.press("escape")
        await user.pilot.pause()
        assert [part.display for part in both] == [True, False]
        assert user.runs.has_focus

    drive(journey, size=(200, 60))


def test_marked_runs_are_compared(kept):
    async def journey(user):
        await user.listed(2)
        await user.pilot.press("equals_sign")
        await user.until(lambda: user.app._notifications)
        await user.pilot.press("space")
        assert "1 marked" in user.about
        await user.pilot.press("space", "equals_sign")
        screen = await user.screen(ComparisonScreen)
        grid = screen.query_one(RateGrid)
        names = [column.name for column in grid._shown]
        assert names[:3] == ["initiator", "scans", "A success %"]
        assert "B − A points" in names
        older, newer = (FolderStore().document(name)["rows"] for name in reversed(kept))
        differences = [cell.plain.strip() for cell in grid.get_column_at(names.index("B − A points"))]
        for text, before, after in zip(differences, older, newer, strict=True):
            assert float(text) == pytest.approx(
                100 * (after["success_rate"] - before["success_rate"]), abs=0.051
            )
        assert "differences" in texts(screen)
        assert kept[0] in texts(screen)
        await user.pilot.press("m", "m")
        assert "A false %" in [column.name for column in grid._shown]
        await user.pilot.press("y")
        await user.until(lambda: user.app.clipboard)
        assert "| A false %" in user.app.clipboard
        await user.pilot.press("escape")
        await user.until(lambda: not isinstance(user.app.screen, ComparisonScreen))

    drive(journey)


def test_a_run_is_exported_in_each_format(kept, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    async def journey(user):
        await user.listed(2)
        document = FolderStore().document(kept[0])
        await user.pilot.press("e")
        screen = await user.screen(ExportScreen)
        assert screen.query_one(Input).value == f"{kept[0]}.csv"
        await user.pilot.press("enter")
        await user.until(lambda: (tmp_path / f"{kept[0]}.csv").exists())
        rows = list(csv.DictReader((tmp_path / f"{kept[0]}.csv").read_text().splitlines()))
        assert [float(row["success_rate"]) for row in rows] == [
            row["success_rate"] for row in document["rows"]
        ]
        await user.until(lambda: any(f"{kept[0]}.csv" in note.message for note in user.app._notifications))

        await user.pilot.press("e")
        screen = await user.screen(ExportScreen)
        screen.query_one("#as-json", RadioButton).value = True
        await user.pilot.pause()
        assert screen.query_one(Input).value == f"{kept[0]}.json"
        await user.pilot.press("enter")
        await user.until(lambda: (tmp_path / f"{kept[0]}.json").exists())
        assert json.loads((tmp_path / f"{kept[0]}.json").read_text()) == document

        await user.pilot.press("e")
        screen = await user.screen(ExportScreen)
        screen.query_one(Input).value = "table.md"
        await user.pilot.pause()
        assert screen.query_one("#as-md", RadioButton).value
        screen.query_one("#write", Button).press()
        await user.until(lambda: (tmp_path / "table.md").exists())
        assert (tmp_path / "table.md").read_text().startswith("### course-report · tables")

    drive(journey)


def test_a_file_that_exists_is_asked_about(kept, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "old.csv").write_text("old")

    async def journey(user):
        await user.listed(2)
        await user.pilot.press("e")
        screen = await user.screen(ExportScreen)
        field, note = screen.query_one(Input), screen.query_one(".note", Static)
        for given, said in (
            ("", "give the path"),
            ("nowhere/x.csv", "no folder"),
            (str(tmp_path), "is a folder"),
            ("old.csv", "exists"),
        ):
            field.value = given
            await user.pilot.press("enter")
            assert said in str(note.content)
            assert (tmp_path / "old.csv").read_text() == "old"
        await user.pilot.press("enter")
        await user.until(lambda: not isinstance(user.app.screen, ExportScreen))
        assert (tmp_path / "old.csv").read_text().startswith("set,")

    drive(journey)


def test_a_file_that_cannot_be_written_is_said_and_the_question_stays(kept, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def full(*args):
        raise OSError(28, "No space left on device")

    async def journey(user):
        await user.listed(2)
        await user.pilot.press("e")
        screen = await user.screen(ExportScreen)
        monkeypatch.setattr("hough_tui.ui.screens.export.replace_file", full)
        await user.pilot.press("enter")
        note = screen.query_one(".note", Static)
        await user.until(lambda: "No space left on device" in str(note.content))
        await user.pilot.press("escape")
        await user.until(lambda: not isinstance(user.app.screen, ExportScreen))

    drive(journey)


def test_deleting_is_asked_about(kept):
    async def journey(user):
        await user.listed(2)
        await user.pilot.press("delete")
        screen = await user.screen(Question)
        assert kept[0] in texts(screen)
        await user.pilot.press("enter")  # the first answer keeps it
        await user.until(lambda: not isinstance(user.app.screen, Question))
        assert FolderStore().names() == kept
        await user.pilot.press("delete")
        screen = await user.screen(Question)
        screen.query_one("#delete", Button).press()
        await user.listed(1)
        assert FolderStore().names() == kept[1:]
        assert user.runs.chosen == kept[1]

    drive(journey)


def test_marked_runs_are_deleted_together(kept):
    async def journey(user):
        await user.listed(2)
        await user.pilot.press("space", "space", "delete")
        screen = await user.screen(Question)
        assert "2 runs" in texts(screen)
        screen.query_one("#delete", Button).press()
        await user.listed(0)
        assert FolderStore().names() == []
        assert not user.runs.marked
        assert "no run has been kept yet" in user.about

    drive(journey)
