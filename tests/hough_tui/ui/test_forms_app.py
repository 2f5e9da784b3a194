"""A form on a real set, for the tests of forms: it does with what is posted what the application does."""

import asyncio
from collections.abc import Awaitable, Callable

import pytest
from textual.app import App, ComposeResult
from textual.pilot import Pilot

from algorithms.parameters import FieldError, Path
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.messages import ElementAdded, ElementRemoved, FieldEdited, FieldUnreadable
from hough_tui.ui.workspace import Workspace
from scenarios.files.set_files import load_set

SCENARIO, SEQUENTIAL, MODIFIED = ("scenarios", 0), ("initiators", 1), ("initiators", 2)
EXPERIMENT = ("experiments", 0)


class FormApp(App[None]):
    """A form on a real set: what is posted is asked of the set, and answered as the form expects it."""

    AUTO_FOCUS = None

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.workspace = Workspace(load_set("course-report"), None)
        self.path = path
        self.form = ModelForm()
        self.posted: list[tuple[str, object]] = []
        self.unreadable: list[str] = []

    def compose(self) -> ComposeResult:
        yield self.form

    def on_mount(self) -> None:
        self.show()

    def show(self) -> None:
        model, scenario = self.workspace.value(self.path), self.workspace.given.scenarios[0]
        resolved = model.parameters.resolved(scenario.context) if self.path[0] == "initiators" else None
        self.form.load(model, self.path, unit=scenario.unit, resolved=resolved)

    def answer(self, action: Callable[..., None], *arguments: object) -> None:
        self.posted.append((action.__name__, arguments[-1]))
        try:
            action(*arguments)
        except FieldError as error:
            self.form.problems([error.problem])
        else:
            self.show()

    def on_field_edited(self, event: FieldEdited) -> None:
        self.answer(self.workspace.set, event.path, event.value)

    def on_field_unreadable(self, event: FieldUnreadable) -> None:
        self.unreadable.append(event.message)

    def on_element_added(self, event: ElementAdded) -> None:
        self.answer(self.workspace.insert, event.path, event.value)

    def on_element_removed(self, event: ElementRemoved) -> None:
        self.answer(self.workspace.remove, event.path)


Journey = Callable[[FormApp, Pilot[None]], Awaitable[None]]


def drive(path: Path, journey: Journey, size: tuple[int, int] = (120, 40)) -> FormApp:
    async def run() -> FormApp:
        app = FormApp(path)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            await journey(app, pilot)
        return app

    return asyncio.run(run())


@pytest.mark.parametrize("size", [(160, 48), (80, 24), (36, 20)])
def test_mounting_and_loading_again_post_nothing(size):
    async def journey(app, pilot):
        for path in (("initiators", 0), SEQUENTIAL, MODIFIED, EXPERIMENT, SCENARIO, SCENARIO):
            app.path = path
            app.show()
            await pilot.pause()
            assert app.form.is_sound

    app = drive(SCENARIO, journey, size)
    assert (app.posted, app.unreadable) == ([], [])
