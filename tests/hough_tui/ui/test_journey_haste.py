"""People who are faster than the screen: edits, other sets and leaving while a view is on its way."""

import asyncio

import pytest

from hough_tui.ui.messages import FieldEdited
from hough_tui.ui.screens import main
from hough_tui.ui.widgets.status_line import StatusLine

SCANS = ("scenarios", 0, "scans")


async def soon(condition):
    """Wait until something holds, with no regard to messages that are not dealt with."""
    async with asyncio.timeout(5):
        while not condition():
            await asyncio.sleep(0.01)


class Gate:
    """Holds a view back in the middle of being mounted, until it is opened."""

    def __init__(self, monkeypatch):
        self.is_reached, self.opened = asyncio.Event(), asyncio.Event()
        made = main._view

        def held_back(name):
            view = made(name)
            whole = view._compose

            async def compose():
                self.is_reached.set()
                await self.opened.wait()
                await whole()

            view._compose = compose
            return view

        monkeypatch.setattr(main, "_view", held_back)


@pytest.mark.parametrize("key", ["f3", "f4", "f6", "f7", "f11"])
def test_an_edit_that_comes_while_a_view_is_mounted_is_shown_there(drive, monkeypatch, key):
    async def journey(user):
        gate = Gate(monkeypatch)
        user._send(key)
        await asyncio.wait_for(gate.is_reached.wait(), 5)
        user.app.post_message(FieldEdited(SCANS, 9))
        await soon(lambda: user.value(*SCANS) == 9 or user.app._exception)
        error = user.app._exception
        gate.opened.set()
        assert error is None
        await user.until(lambda: user.tab in user.main._views)
        await user.settle()
        if key != "f7":
            assert user.view._given.scenarios[0].scans == 9
        await user.go("f2")
        assert user.field(*SCANS).text == "9"

    drive(journey, "course-report")


@pytest.mark.parametrize("key", ["f3", "f6"])
def test_who_leaves_while_a_view_is_mounted_leaves_cleanly(drive, monkeypatch, key):
    async def journey(user):
        gate = Gate(monkeypatch)
        user._send(key)
        await asyncio.wait_for(gate.is_reached.wait(), 5)
        user._send("ctrl+q")
        await soon(lambda: getattr(user.main, "_is_leaving", False) or user.app._exit)
        # What is half there is not taken down.
        is_early = user.app._exit
        gate.opened.set()
        assert not is_early
        await soon(lambda: user.app._exit)

    ended = drive(journey, "course-report")
    assert ended.return_code == 0
    assert ended._exception is None


def test_an_edit_that_is_refused_when_another_view_is_seen_is_marked_in_its_own(drive):
    async def journey(user):
        view = await user.go("f2")
        await user.go("f3")
        view.query_one("ModelForm").field(SCANS).query_one("Input").value = "0"
        await user.settle()
        await user.go("f2")
        assert user.field(*SCANS).text == "0"
        assert "at least" in (user.field(*SCANS).problem or "")

    drive(journey, "course-report")


def test_another_set_opened_during_a_run_leaves_no_word_of_the_run(drive):
    async def journey(user):
        view = await user.go("f6")
        await user.click("#run-trials")
        await user.type("200000")
        await user.press("enter")
        await user.until(lambda: "trials" in user.main.query_one(StatusLine).job)
        job = view._live.job
        await user.press("ctrl+o")
        await user.screen("Welcome")
        assert view.is_at_work
        await user.press("down", "enter")
        await user.screen("MainScreen")
        await user.until(
            lambda: user.app.workspace.given.name == "course-text" and view not in user.main.query("*")
        )
        await user.until(lambda: job.wait(0))
        await user.settle()
        assert user.main.query_one(StatusLine).job == ""
        assert not (await user.go("f6")).is_at_work

    drive(journey, "course-report")
