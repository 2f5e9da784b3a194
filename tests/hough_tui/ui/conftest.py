"""The application without a terminal, and a user who drives it as people do."""

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from rich.segment import Segment
from textual import events
from textual._context import active_app
from textual.app import App
from textual.css.query import NoMatches
from textual.keys import _character_to_key
from textual.message_pump import MessagePump
from textual.pilot import Pilot
from textual.timer import Timer
from textual.widget import Widget
from textual.widgets import Input, TabbedContent

from hough_tui.ui.app import HoughApp
from hough_tui.ui.config import Config
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.forms.value_field import ValueField

PATIENCE = 240.0
"""Seconds until a wait is given up: kernels may have to be compiled on a busy machine."""

SHORT_PATIENCE = 1.0
"""Seconds after which a pilot goes on though something works in the background, as without us."""

CALM = 4
"""Turns of the event loop without a message: what comes from another thread takes some to arrive."""

SOON = 0.05
"""Seconds of a delay that is waited for: fields and pictures gather what is typed for less than that."""

Place = tuple[str | int, ...]
Condition = Callable[[], Any]


async def dealt_with(app: App[Any], patience: float = PATIENCE) -> None:
    """Wait until every widget waits for its next message, and the screen shows what came of the last one.

    Textual's pilot sends a message through every widget instead, and waits until the process idles:
    that takes tens of milliseconds a key, and does not end while trials run.
    """
    limit = time.monotonic() + patience
    calm = turns = 0
    while calm < CALM and app._exception is None and app.screen_stack:
        screen = app.screen
        await asyncio.sleep(0 if turns < 50 else 0.002)
        turns += 1
        is_calm = all(map(_is_waiting, (app, *screen.walk_children(with_self=True))))
        calm = calm + 1 if is_calm else 0
        if is_calm:
            # The screen draws sixty times a second; nobody has to wait for that.
            screen._on_timer_update()
        if time.monotonic() > limit:
            raise AssertionError("something does not come to an end")


def _is_waiting(pump: MessagePump) -> bool:
    """Return whether a widget has dealt with all messages, is not in the middle of one, and puts none off."""
    if not pump._running:
        return True
    ready = pump._message_queue.ready_event
    if ready.is_set() or all(waiter.done() for waiter in ready._waiters):
        return False
    return not any(map(_is_due_soon, pump._timers))


def _is_due_soon(timer: Timer) -> bool:
    task = timer._task
    return timer._repeat == 0 and timer._interval <= SOON and task is not None and not task.done()


async def idle(min_sleep: float = 0.0, max_sleep: float = SHORT_PATIENCE) -> None:
    """Wait until a message has had its effect, and what was begun by it in the background too."""
    app = active_app.get()
    limit = time.monotonic() + max_sleep
    await dealt_with(app)
    while any(worker.is_running for worker in app.workers) and time.monotonic() < limit:
        await asyncio.sleep(0.01)
        await dealt_with(app)


@pytest.fixture(autouse=True)
def quick_pilot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let pilots wait for messages rather than for an idle processor."""
    monkeypatch.setattr("textual.app.wait_for_idle", idle)
    monkeypatch.setattr("textual.pilot.wait_for_idle", idle)


class User:
    """Someone at the keyboard and the mouse."""

    def __init__(self, app: HoughApp, pilot: Pilot[None]) -> None:
        self.app, self.pilot = app, pilot

    async def until(self, condition: Condition, patience: float = PATIENCE) -> Any:
        """Wait until something holds, and return it; what is not there yet does not hold."""
        limit = time.monotonic() + patience
        while True:
            try:
                if found := condition():
                    return found
            except (NoMatches, AttributeError, IndexError):
                pass
            if self.app._exception is not None:
                raise self.app._exception
            if time.monotonic() > limit:
                raise AssertionError(f"in vain, before this screen:\n{self.text}")
            await asyncio.sleep(0.02)
            await dealt_with(self.app)

    async def sees(self, *words: str) -> None:
        """Wait until words are on the screen."""
        await self.until(lambda: all(word in self.text for word in words))

    async def screen(self, name: str) -> None:
        """Wait until a screen lies on top."""
        await self.until(lambda: type(self.app.screen).__name__ == name)
        await self.settle()

    async def settle(self) -> None:
        """Wait until what was sent has been dealt with, and what came of it too."""
        await dealt_with(self.app)

    async def still(self) -> str:
        """Wait until nothing works behind the screen and it stays as it is; return what is on it."""
        seen, times = "", 0
        while times < 3:
            await self.until(lambda: not [worker for worker in self.app.workers if worker.is_running])
            await self.settle()
            await asyncio.sleep(0.05)
            await self.settle()
            times = times + 1 if self.text == seen else 0
            seen = self.text
        return seen

    async def press(self, *keys: str) -> None:
        """Press keys one after the other, each when what came of the one before is done."""
        for key in keys:
            self._send(key)
            await self.settle()

    async def click(self, selector: str) -> None:
        """Click on a widget of the screen on top."""
        await self.pilot.click(selector)
        await self.settle()

    async def type(self, text: str) -> None:
        """Type text faster than anyone does."""
        for character in text:
            self._send(character)
        await self.settle()

    def _send(self, key: str) -> None:
        name = _character_to_key(key) if len(key) == 1 and not key.isalnum() else key
        event = events.Key(name, key if len(key) == 1 else None)
        event.set_sender(self.app)
        assert self.app._driver is not None
        self.app._driver.send_message(event)

    async def go(self, key: str) -> Any:
        """Go to a view by its key, and return it when it is ready."""
        await self.press(key)
        await self.until(lambda: self.tab in self.app.screen._views)
        await self.settle()
        return self.view

    async def warm(self) -> None:
        """Wait until a set is open and what the application prepares behind it is done."""
        await self.until(lambda: self.app.workspace)
        await self.until(lambda: self.app._is_warming)
        await self.until(lambda: "warm" not in (thread.name for thread in threading.enumerate()))
        await self.until(lambda: not [worker for worker in self.app.workers if worker.is_running])
        await self.settle()

    @property
    def main(self) -> Any:
        return self.app.screen_stack[0]

    @property
    def tab(self) -> str:
        return self.main.query_one("#tabs", TabbedContent).active

    @property
    def view(self) -> Any:
        return self.main._views[self.tab]

    @property
    def form(self) -> ModelForm:
        return self.view.query_one(ModelForm)

    def field(self, *path: str | int) -> ValueField:
        found = self.form.field(path)
        assert found is not None, path
        return found

    async def fill(self, path: Place, text: str) -> ValueField:
        """Type text into a field of the form that is seen, in place of what is there."""
        self.form.focus_field(path)
        line = self.field(*path).query_one(Input)
        await self.until(lambda: line.has_focus)
        await self.press("home", "shift+end", "delete")
        await self.type(text)
        await self.until(lambda: line.value == text)
        return self.field(*path)

    def value(self, *path: str | int) -> Any:
        """Return what stands in the set."""
        assert self.app.workspace is not None
        return self.app.workspace.value(path)

    @property
    def text(self) -> str:
        """What is on the screen."""
        return "\n".join(line.text for line in self.app.screen._compositor.render_strips())

    def drawn(self, widget: Widget) -> list[list[Segment]]:
        """Return what is on the screen at the place of a widget, with its colours."""
        place = widget.region
        lines = self.app.screen._compositor.render_strips()[place.y : place.bottom]
        return [list(line.crop(place.x, place.right).simplify()) for line in lines]

    @property
    def notes(self) -> list[str]:
        """What the application has told in passing."""
        return [note.message for note in self.app._notifications]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An account of a user who has never used the application; the process works in it."""
    for name in ("data", "config", "state"):
        monkeypatch.setenv(f"XDG_{name.upper()}_HOME", str(tmp_path / name))
    monkeypatch.delenv("NO_COLOR", raising=False)
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    return tmp_path


@pytest.fixture
def make_user() -> Callable[[Pilot[None]], User]:
    """Return a function that puts a user before an application that runs already."""
    return lambda pilot: User(pilot.app, pilot)


@pytest.fixture
def drive(home: Path) -> Callable[..., HoughApp]:
    """Return a function that opens the application, lets a user go through a journey, and returns it."""

    def run(
        journey: Callable[[User], Awaitable[None]],
        set_name: str | None = None,
        *,
        size: tuple[int, int] = (120, 40),
        config: Config | None = None,
        opens: bool = True,
    ) -> HoughApp:
        async def work() -> HoughApp:
            app = HoughApp(set_name, config or Config())
            async with app.run_test(size=size, notifications=True) as pilot:
                user = User(app, pilot)
                if set_name is not None and opens:
                    await user.warm()
                await journey(user)
            return app

        return asyncio.run(work())

    return run
