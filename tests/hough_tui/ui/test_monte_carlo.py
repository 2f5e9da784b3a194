"""The Monte Carlo view in a small application of its own."""

import asyncio
import time

import numpy as np
import pytest
from textual.app import App
from textual.widgets import Input, Select, SelectionList

from hough_tui.experiments.chunks import initiation as chunks
from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.ui.messages import TrialOpened
from hough_tui.ui.screens.columns import ColumnsScreen
from hough_tui.ui.screens.question import Question
from hough_tui.ui.screens.trials import TrialsScreen
from hough_tui.ui.views.monte_carlo import MonteCarloView
from hough_tui.ui.widgets.rate_grid import RateGrid
from hough_tui.ui.widgets.rate_panel import RatePanel
from hough_tui.ui.widgets.rate_plot import RatePlot
from hough_tui.ui.widgets.run_line import RunLine
from hough_tui.ui.widgets.trial_list import TrialList
from scenarios.files.set_files import load_set

pytestmark = pytest.mark.usefixtures("data_home")

PATIENCE = 120.0


class Host(App[None]):
    """An application that has the view alone, and keeps what it says."""

    def __init__(self, given):
        super().__init__()
        self.view, self._given = MonteCarloView(), given
        self.progress, self.finished, self.opened = [], [], []

    def compose(self):
        yield self.view

    def on_mount(self):
        self.view.show_set(self._given)
        self.view.set_runnable(None)
        self.view.take_focus()

    def on_monte_carlo_view_progress(self, event):
        self.progress.append(event.text)

    def on_monte_carlo_view_finished(self, event):
        self.finished.append(event.name)

    def on_trial_opened(self, event: TrialOpened):
        self.opened.append(event)


class Driver:
    def __init__(self, app, pilot):
        self.app, self.pilot, self.view = app, pilot, app.view

    async def until(self, condition):
        limit = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < limit, self.line
            await self.pilot.pause(0.01)
        await self.pilot.pause()

    async def run(self, trials="60", key="r"):
        """Run with so many trials, to the end."""
        self.view.query_one("#run-trials", Input).value = trials
        await self.pilot.pause()
        await self.pilot.press(key)
        await self.until(lambda: not self.view.is_at_work)

    async def begin(self, trials="200000"):
        """Begin a run that takes long, and wait until trials are finished."""
        self.view.query_one("#run-trials", Input).value = trials
        await self.pilot.press("r")
        await self.until(lambda: self.view._live is not None and self.view._live.job.progress.done.any())

    async def screen(self, kind):
        await self.until(lambda: isinstance(self.app.screen, kind))
        return self.app.screen

    @property
    def line(self):
        return self.view.query_one(RunLine).text

    @property
    def grid(self):
        return self.view.query_one(RateGrid)

    @property
    def panel(self):
        return self.view.query_one(RatePanel)

    def column(self, heading):
        """Return the cells of a column, from above to below."""
        names = [column.name for column in self.grid._shown]
        return [cell.plain.strip() for cell in self.grid.get_column_at(names.index(heading))]


def drive(journey, given=None, size=(160, 48)):
    async def work():
        app = Host(given or load_set("course-report"))
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await journey(Driver(app, pilot))
        return app

    return asyncio.run(work())


def texts(screen):
    return " ".join(str(static.content) for static in screen.query("Static"))


def test_a_run_fills_the_table_and_is_kept():
    async def journey(user):
        assert "6 cells, 6,000 trials" in user.line
        await user.run("60")
        assert user.grid.row_count == 6
        assert "trials" not in [column.name for column in user.grid._shown]
        (name,) = FolderStore().names()
        assert user.app.finished == [name]
        assert "360 trials in" in user.line
        assert name in user.line
        rows = FolderStore().document(name)["rows"]
        assert user.column("success %") == [f"{100 * row['success_rate']:.1f}" for row in rows]
        assert user.column("false %") == [f"{100 * row['false_track_ratio']:.1f}" for row in rows]
        assert user.app.progress[-1] is None
        assert all(text.startswith("tables: ") for text in user.app.progress[:-1])

    drive(journey)


def test_trials_and_seed_of_the_experiment_unless_others_are_given():
    async def journey(user):
        trials, seed = user.view.query_one("#run-trials", Input), user.view.query_one("#run-seed", Input)
        assert (trials.placeholder, seed.placeholder) == ("1000", "7")
        seed.value = "18446744073709551615"
        await user.run("5")
        document = FolderStore().document(FolderStore().names()[0])
        assert document["seed"] == 2**64 - 1
        assert {row["trials"] for row in document["rows"]} == {5}

    drive(journey)


@pytest.mark.parametrize("size", [(80, 24), (160, 30), (160, 48)])
def test_a_long_table_leaves_room_for_its_notes(size):
    async def journey(user):
        user.view.query_one("#experiment", Select).value = ""
        await user.run("4")
        assert len(user.column("initiator")) == 15
        rates, notes = user.panel.query_one("#rates"), user.panel.query_one("#notes")
        await user.until(lambda: notes.region.bottom <= rates.region.bottom and notes.size.height >= 3)
        seen = [strip.text for strip in user.app.screen._compositor.render_strips()]
        below = " ".join(line[rates.region.x : rates.region.right] for line in seen[notes.region.y :])
        assert "A track matches a target" in below
        # The table keeps the greater part, and no line between the two is lost.
        assert user.panel.grid.region.bottom == notes.region.y
        assert user.panel.grid.size.height > notes.size.height

    drive(journey, size=size)


def test_all_experiments_stand_in_one_table():
    async def journey(user):
        select = user.view.query_one("#experiment", Select)
        user.view.choose(2)
        await user.pilot.pause()
        assert select.value == "modified"
        select.value = ""
        await user.run("4")
        assert user.column("experiment") == ["tables"] * 6 + ["tables-sound"] * 6 + ["modified"] * 3
        notes = user.panel.query_one("#notes Static")
        assert "θ not compared" in str(notes.content)
        await user.pilot.press("G")
        await user.pilot.pause()
        assert "at least 3 of its plots" in str(notes.content)

    drive(journey)


@pytest.mark.parametrize("text", ["abc", "1.5", "0", "-3", "1,000", "1e9", "12 trials"])
def test_a_wrong_number_runs_nothing(text):
    async def journey(user):
        user.view.query_one("#run-trials", Input).value = text
        await user.pilot.pause()
        assert user.line.startswith("trials: ")
        assert user.view.query_one(RunLine).has_class("-problem")
        await user.pilot.press("r")
        await user.pilot.pause()
        assert not user.view.is_at_work
        assert user.view._live is None
        await user.run("3")
        assert user.grid.row_count == 6

    drive(journey)


def test_a_wrong_form_runs_nothing():
    async def journey(user):
        user.view.set_runnable("scans: 0 is given")
        await user.pilot.press("r")
        await user.pilot.pause()
        assert not user.view.is_at_work
        assert "scans: 0 is given" in user.line
        user.view.set_runnable(None)
        await user.pilot.pause()
        assert "r runs it" in user.line

    drive(journey)


def test_a_set_without_experiments_says_so():
    async def journey(user):
        await user.pilot.press("r")
        await user.pilot.pause()
        assert "no experiments" in user.line
        assert not user.view.is_at_work

    drive(journey, load_set("course-report").model_copy(update={"experiments": []}))


def test_a_question_mark_explains_the_field():
    async def journey(user):
        field = user.view.query_one("#run-trials", Input)
        field.focus()
        await user.pilot.press("5", "?", "0")
        assert field.value == "50"
        (note,) = user.app._notifications
        assert "draws of each scenario" in note.message

    drive(journey)


@pytest.mark.parametrize("key", ["x", "escape"])
def test_cancelling_leaves_what_was_found(key):
    async def journey(user):
        await user.begin()
        await user.pilot.press(key)
        await user.until(lambda: not user.view.is_at_work)
        assert "cancelled after" in user.line
        assert user.grid.row_count == 6
        assert user.column("trials")[-1] == "0"
        assert user.column("success %")[-1] == "–"
        assert FolderStore().names() == []
        assert user.app.finished == []
        assert user.app.progress[-1] is None
        await user.pilot.press("w")
        await user.until(lambda: user.app.finished)
        assert FolderStore().document(user.app.finished[0])["complete"] is False
        await user.run("3")
        assert len(FolderStore().names()) == 2

    drive(journey)


def test_cancelling_at_once_is_no_error():
    async def journey(user):
        user.view.action_run()
        user.view.action_cancel()
        await user.until(lambda: not user.view.is_at_work)
        assert "cancelled" in user.line
        assert not isinstance(user.app.screen, Question)

    drive(journey)


def test_quitting_stops_the_run():
    jobs = []

    async def journey(user):
        await user.begin("100000")
        jobs.append(user.view._live.job)
        user.app.exit()

    drive(journey)
    (job,) = jobs
    assert job.wait(PATIENCE)
    assert not job.is_complete


def test_what_a_small_run_has_found_survives_the_end_of_the_application():
    async def journey(user):
        await user.begin("10000")
        user.app.exit()

    drive(journey)
    (name,) = FolderStore().names()
    assert FolderStore().document(name)["complete"] is False


def test_rows_keep_their_identity_when_they_are_sorted_and_while_they_fill():
    async def journey(user):
        await user.run("40")
        success = user.column("success %")
        await user.pilot.press("j", "j", "j")  # sequential at 5 scans, the worst
        assert user.grid.chosen_index == 3
        await user.pilot.press("s", "s", "s")
        assert user.grid.sorted_by == ("success %", False)
        assert user.column("success %") == sorted(success, key=float)
        assert (user.grid.chosen_index, user.grid.cursor_row) == (3, 0)
        await user.pilot.press("S")
        assert user.column("success %") == sorted(success, key=float, reverse=True)
        assert (user.grid.chosen_index, user.grid.cursor_row) == (3, 5)
        rows = [
            {**row, "success_rate": 0.5 if index == 3 else row["success_rate"]}
            for index, row in enumerate(user.view._live.rows)
        ]
        user.panel.fill(rows)
        await user.pilot.pause()
        assert user.grid.chosen_index == 3
        assert user.column("success %")[user.grid.cursor_row] == "50.0"
        assert user.grid.sorted_by == ("success %", True)

    drive(journey)


def test_columns_are_chosen_by_key_and_come_back():
    async def journey(user):
        await user.run("20")
        before = user.grid.shown_keys
        await user.pilot.press("C")
        screen = await user.screen(ColumnsScreen)
        offered = screen.query_one(SelectionList)
        assert "matches" in texts(screen)
        assert set(offered.selected) == set(before)
        offered.deselect_all()
        await user.pilot.press("j", "space", "enter")
        await user.until(lambda: user.grid.shown_keys == ("success_rate_ci95",))
        assert "success 95 %" in [column.name for column in user.grid._shown]
        await user.pilot.press("y")
        await user.until(lambda: user.app.clipboard)
        assert "| success 95 % |" in user.app.clipboard
        await user.pilot.press("C")
        await user.screen(ColumnsScreen)
        await user.pilot.press("d")
        await user.until(lambda: user.grid.shown_keys == before)
        await user.pilot.press("C")
        await user.screen(ColumnsScreen)
        await user.pilot.press("a", "escape")
        await user.pilot.pause()
        assert user.grid.shown_keys == before

    drive(journey)


def test_the_worst_trial_of_a_row_is_opened():
    async def journey(user):
        await user.run("200")
        await user.pilot.press("j", "j", "j", "enter")
        screen = await user.screen(TrialsScreen)
        columns = user.view._live.job.columns[3]
        found = columns.found.sum(axis=1)
        worst = screen.query_one(TrialList).trial
        assert found[worst] == found.min() < 2
        assert columns.false[worst] == columns.false[found == found.min()].max()
        assert "miss a target" in texts(screen)
        await user.pilot.press("enter")
        await user.until(lambda: user.app.opened)
        (opened,) = user.app.opened
        cell = user.view._live.job.plan.cells[3]
        assert (opened.cell.scenario, opened.cell.entry, opened.cell.parameters) == (
            cell.scenario,
            cell.entry,
            cell.parameters,
        )
        assert (opened.cell.experiment.seed, opened.trial, opened.cell.scenario.scans) == (7, int(worst), 5)
        assert not isinstance(user.app.screen, TrialsScreen)

    drive(journey)


def test_a_full_disk_is_said_and_the_results_stay(monkeypatch):
    write = np.savez_compressed

    def full(*args, **kwargs):
        raise OSError(28, "No space left on device")

    async def journey(user):
        monkeypatch.setattr(np, "savez_compressed", full)
        await user.run("5")
        screen = await user.screen(Question)
        assert "No space left on device" in texts(screen)
        await user.pilot.press("escape")
        assert user.grid.row_count == 6
        assert user.app.finished == []
        monkeypatch.setattr(np, "savez_compressed", write)
        await user.pilot.press("w")
        await user.until(lambda: user.app.finished == FolderStore().names() != [])

    drive(journey)


def test_what_cannot_be_run_is_said():
    async def journey(user):
        user.view.query_one("#experiment", Select).value = ""
        await user.run("10000000")
        screen = await user.screen(Question)
        assert "GiB" in texts(screen)
        assert user.grid.row_count == 0

    drive(journey)


def test_a_defect_of_the_engine_is_said(monkeypatch):
    def broken(*args):
        raise RuntimeError("no such luck")

    async def journey(user):
        monkeypatch.setattr(chunks, "score", broken)
        await user.run("5")
        assert "RuntimeError: no such luck" in texts(await user.screen(Question))
        await user.pilot.press("escape")
        monkeypatch.undo()
        assert not user.view.is_at_work
        assert user.app.progress[-1] is None

    drive(journey)


def test_results_tell_when_the_set_has_changed_since():
    async def journey(user):
        given = load_set("course-report")
        await user.run("5")
        user.view.show_set(given.model_copy(update={"description": "another"}))
        assert "the set has changed since" in user.line
        user.view.show_set(given)
        assert "the set has changed since" not in user.line

    drive(journey)


def test_wide_and_narrow_show_all():
    async def journey(user):
        await user.run("20")
        rates, chart = user.panel.query_one("#rates"), user.panel.query_one("#chart")
        assert rates.display
        assert chart.display
        await user.pilot.resize_terminal(80, 24)
        await user.pilot.pause()
        assert rates.display
        assert not chart.display
        await user.pilot.press("c")
        await user.pilot.pause()
        assert chart.display
        assert not rates.display
        plot = user.panel.query_one(RatePlot)
        assert plot.has_focus
        await user.until(lambda: any("standard" in line.text for line in plot._drawn))
        assert plot.size.width >= 70
        assert plot.size.height >= 15
        await user.pilot.press("c")
        await user.pilot.pause()
        assert user.grid.has_focus
        await user.pilot.resize_terminal(140, 24)
        await user.pilot.pause()
        assert rates.display
        assert chart.display
        assert chart.region.x >= rates.region.right
        await user.pilot.resize_terminal(200, 60)
        await user.pilot.pause()
        assert chart.region.y >= rates.region.bottom

    drive(journey, size=(200, 60))


def test_the_table_is_copied_to_the_clipboard_and_to_a_file(data_home):
    async def journey(user):
        await user.run("5")
        await user.pilot.press("y")
        folder = data_home / "hough-tui" / "exports"
        await user.until(lambda: folder.is_dir() and [p for p in folder.iterdir() if p.suffix == ".md"])
        (file,) = folder.glob("*.md")
        assert file.read_text() == user.app.clipboard
        assert "| sequential |" in user.app.clipboard
        await user.until(lambda: any(str(file) in note.message for note in user.app._notifications))

    drive(journey)
