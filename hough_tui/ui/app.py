"""The application: it owns the workspace, hands changes round, and ends cleanly."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on, work
from textual.app import App, SystemCommand
from textual.binding import Binding, BindingType
from textual.filter import LineFilter
from textual.screen import Screen
from textual.worker import Worker, WorkerState

from hough_tui import ending
from hough_tui.ui import interpreter
from hough_tui.ui.config import Config
from hough_tui.ui.drawing.safe_text import Gate, show_what_acts
from hough_tui.ui.messages import (
    ElementAdded,
    ElementRemoved,
    FieldEdited,
    FieldUnreadable,
    Prepared,
    SetShown,
    TrialOpened,
)
from hough_tui.ui.screens.main import MainScreen
from hough_tui.ui.screens.question import Question, telling
from hough_tui.ui.widgets.key_line import PALETTE

if TYPE_CHECKING:
    from algorithms.errors import RequestError
    from algorithms.parameters import Path as FieldPath
    from hough_tui.ui.autosave import Autosave, Unsaved
    from hough_tui.ui.workspace import Workspace
    from scenarios.model import ScenarioSet

AUTOSAVE_DELAY = 0.8
"""Seconds after a change until the set is kept aside."""

NOTICE_SECONDS = 15.0
"""Seconds that a notice stays on the screen."""

QUITTING_SECONDS = 0.6
"""Seconds after a quit until the process is ended, if it has not come to its end."""

WARM_AT_LATEST = 1.5
"""Seconds after a set is opened until kernels are loaded, even if it shows no draw for which they are."""


class HoughApp(App[None]):
    """Design and judge track initiation."""

    CSS_PATH = "hough_tui.tcss"
    TITLE = "hough-tui"
    ENABLE_COMMAND_PALETTE = True
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f1", "explain", "Help", id="app.help", priority=True),
        Binding("ctrl+q", "leave", "Quit", id="app.quit", priority=True),
        Binding("ctrl+o", "open", "Open", id="app.open", priority=True, show=False),
        Binding("ctrl+s", "save", "Save", id="app.save", priority=True),
        Binding("f12", "save_as", "Save as", id="app.save-as", priority=True, show=False),
        Binding("ctrl+z", "undo", "Undo", id="app.undo", priority=True),
        Binding("ctrl+y", "redo", "Redo", id="app.redo", priority=True, show=False),
        Binding("f5", "run", "Run", id="app.run", priority=True),
        Binding("ctrl+p", "command_palette", "Actions", id=PALETTE, priority=True, show=False, system=True),
    ]

    def __init__(self, set_name: str | None, config: Config) -> None:
        super().__init__()
        show_what_acts()
        self._gate = Gate()
        self._set_name, self._config = set_name, config
        self._autosave: Autosave | None = None
        self.is_leaving = False
        self.wrong_setting: RequestError | None = None
        self._compiling: str | None = None
        self._is_warming = False
        self._main = MainScreen()

    @property
    def workspace(self) -> Workspace | None:
        """The set under edit; None before one is opened."""
        return None if self._autosave is None else self._autosave.workspace

    def get_default_screen(self) -> Screen[Any]:
        """Return the main screen: its frame is painted before anything heavy is loaded."""
        return self._main

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Return what every line passes on its way to the terminal."""
        return [*super().get_line_filters(), self._gate]

    def on_mount(self) -> None:
        """Apply the settings, and begin to load what is heavy once the frame is painted."""
        from algorithms.notices import listen

        listen(self._notice)
        if self._config.theme in self.available_themes:
            self.theme = self._config.theme
        elif self._config.theme is not None:
            self.notify(f"There is no theme '{self._config.theme}'", severity="warning", markup=False)
        self.set_keymap(self._config.keys)
        self.call_after_refresh(self._begin)

    def _notice(self, message: str) -> None:
        """Show a notice; it may come from any thread."""
        self.call_later(
            partial(self.notify, message, severity="warning", markup=False, timeout=NOTICE_SECONDS)
        )

    def _begin(self) -> None:
        self._main.tell_state("loading")
        self._load(self._set_name)

    # Opening

    @work(thread=True, exclusive=True, exit_on_error=False, group="load", name="load")
    def _load(self, name: str | None) -> None:
        """Import what is heavy, read a set, and look for unsaved work."""
        from algorithms.errors import RequestError
        from algorithms.kernel_cache.folder import can_keep, is_cold
        from hough_tui.ui.autosave import aside_file, read_aside, unsaved_work
        from scenarios.files.bundled import bundled_paths
        from scenarios.files.set_files import bundled_sets, load_set, locate

        if self._config.keys:
            from hough_tui.ui.key_bindings import require_known

            try:
                require_known(self._config.places)
            except RequestError as error:
                self.call_from_thread(self._refuse_settings, error)
                return
        if is_cold():
            self._compiling = f"compiling kernels{', once' if can_keep() else ''}, up to two minutes"
        if name is None:
            self.call_from_thread(self._welcome, bundled_sets(), unsaved_work())
            return
        try:
            given, path = load_set(name), locate(name)
        except RequestError as error:
            self.call_from_thread(self._cannot_open, str(error))
            return
        own = None if path in bundled_paths().values() else path
        kept = read_aside(aside_file(given.name, own))
        self.call_from_thread(self._opened, given, own, kept if kept and kept.given != given else None)

    def _refuse_settings(self, error: RequestError) -> None:
        self.wrong_setting = error
        self.exit()

    def _welcome(self, bundled: list[Any], kept: list[Unsaved]) -> None:
        from hough_tui.ui.screens.welcome import Welcome

        self._main.tell_state(None)
        self.push_screen(Welcome(bundled, kept), self._chosen_at_start)

    def _chosen_at_start(self, chosen: str | Unsaved | None) -> None:
        if isinstance(chosen, str):
            self._main.tell_state("loading")
            self._load(chosen)
        elif chosen is not None:
            from hough_tui.ui.autosave import put_back

            with suppress(OSError):  # it stays where it is, then, and is offered again
                put_back(chosen)
            self._opened(chosen.given, chosen.path, None, is_recovered=True)
        elif self.workspace is None:
            self.exit()

    def _cannot_open(self, message: str) -> None:
        def go_on(_: str | None) -> None:
            if self.workspace is None:
                self._load(None)

        self._main.tell_state(None)
        self.push_screen(telling("This set cannot be opened", message), go_on)

    def _opened(
        self, given: ScenarioSet, path: Path | None, kept: Unsaved | None, *, is_recovered: bool = False
    ) -> None:
        from hough_tui.ui.autosave import Autosave
        from hough_tui.ui.workspace import Workspace

        workspace = Workspace(given, path)
        if is_recovered:
            workspace.forget_saved()
        autosave = self._autosave = Autosave(workspace, kept)
        # The first draw compiles some already.
        self._main.tell_state(self._compiling)
        self._main.show_workspace(workspace)
        self.set_timer(WARM_AT_LATEST, self._warm_once)
        if kept is not None:

            def answer(key: str | None) -> None:
                if key is None:
                    self.notify("They stay kept: Ctrl+O offers them again", markup=False)
                    return
                autosave.undecided = None
                if key == "recover":
                    autosave.workspace = autosave.workspace.recovered(kept.given)
                    self._main.show_workspace(autosave.workspace)
                elif key == "forget":
                    kept.file.unlink(missing_ok=True)

            self.push_screen(
                Question(
                    "There are unsaved changes",
                    f"Changes to {given.name} of {kept.when} were never saved.",
                    {"recover": "Recover them", "forget": "Forget them"},
                ),
                answer,
            )

    @on(SetShown)
    def _warm_once(self) -> None:
        # Not sooner: what loads in the background would take its time from the first form and the first draw.
        if not self._is_warming and self.workspace is not None:
            self._is_warming = True
            # No worker of Textual's: the application would wait for its end, and a compilation takes long.
            work = partial(self._warm, self.workspace.given)
            threading.Thread(target=work, name="warm", daemon=True).start()

    def _warm(self, given: ScenarioSet) -> None:
        """Load the kernels, or compile them, before they are first wanted."""
        from hough_tui.ui.warming import warm

        try:
            warm(given)
        except Exception as error:
            self.post_message(Prepared(error))
        else:
            self.post_message(Prepared())

    @on(Prepared)
    def _end_preparing(self, event: Prepared) -> None:
        interpreter.settle()
        self._compiling = None
        self._main.tell_state(None)
        if event.error is not None:
            self._tell_error(event.error)

    # Editing

    @on(FieldEdited)
    def _edit_field(self, event: FieldEdited) -> None:
        self._edit(event.path, lambda workspace: workspace.set(event.path, event.value))

    @on(ElementAdded)
    def _add_element(self, event: ElementAdded) -> None:
        self._edit(event.path, lambda workspace: workspace.insert(event.path, event.value))

    @on(ElementRemoved)
    def _remove_element(self, event: ElementRemoved) -> None:
        self._edit(event.path, lambda workspace: workspace.remove(event.path))

    @on(FieldUnreadable)
    def _note_unreadable(self) -> None:
        self._main.show_soundness()

    def _edit(self, path: FieldPath, change: Callable[[Workspace], None]) -> None:
        from algorithms.parameters import FieldError

        if self.workspace is None:
            return
        try:
            change(self.workspace)
        except FieldError as error:
            self._main.refuse(error.problem, str(path[0]))
            return
        self._changed(str(path[0]))

    def _changed(self, part: str | None = None) -> None:
        assert self.workspace is not None
        self._main.show_set(self.workspace, part)
        self._autosave_timer = self.set_timer(AUTOSAVE_DELAY, self._keep_aside)

    def keep_aside(self) -> None:
        """Keep unsaved work aside, from any thread.

        Raises
        ------
        OSError
            Where it cannot be written.
        """
        if self._autosave is not None:
            self._autosave.keep()

    def _keep_aside(self) -> None:
        try:
            self.keep_aside()
        except OSError as error:
            self.notify(
                f"Unsaved work cannot be kept aside: {error.strerror}", severity="warning", markup=False
            )

    def _forget(self, name: str, path: Path | None) -> None:
        assert self._autosave is not None
        try:
            self._autosave.forget(name, path)
        except OSError as error:
            self.notify(f"Work kept aside stays there: {error.strerror}", severity="warning", markup=False)

    def action_undo(self) -> None:
        """Take back the last edit."""
        self._step("undo")

    def action_redo(self) -> None:
        """Do the last undone edit again."""
        self._step("redo")

    def _step(self, which: str) -> None:
        if self.workspace is None:
            return
        if which == "undo" and self._main.take_back_unsound():
            self.notify("What was typed and not taken is taken back", timeout=2, markup=False)
            return
        what = getattr(self.workspace, which)()
        if what is None:
            self.notify(f"Nothing to {which}", timeout=2, markup=False)
            return
        self._changed()
        self.notify(f"{which.title()}: {what}", timeout=2, markup=False)

    # Files

    def action_open(self) -> None:
        """Open another set."""

        def load() -> None:
            self._load(None)

        self._when_saved(load)

    def action_save(self) -> None:
        """Save the set to its file; a set without one is asked for it."""
        if self.workspace is None:
            return
        if self.workspace.path is None:
            self.action_save_as()
        else:
            self._save(None)

    def action_save_as(self) -> None:
        """Save the set to another file, which becomes its own."""
        self._save_as(lambda: None)

    def _save_as(self, go_on: Callable[[], None]) -> None:
        """Ask for a file, save the set to it, and go on."""
        from hough_tui.ui.screens.path_prompt import PathPrompt

        def chosen(path: Path | None) -> None:
            if path is not None and self._save(path):
                go_on()

        if self.workspace is not None:
            given = str(self.workspace.path or f"{self.workspace.given.name}.yaml")
            self.push_screen(PathPrompt("Save the set as", given, is_new=True), chosen)

    def _save(self, path: Path | None) -> bool:
        from algorithms.errors import RequestError

        assert self.workspace is not None
        wrong = self._main.why_not_runnable()
        if wrong is not None:
            self.push_screen(telling("The set is not saved", wrong))
            return False
        before = self.workspace.path
        try:
            saved = self.workspace.save(path)
        except RequestError as error:
            self.push_screen(telling("The set is not saved", str(error)))
            return False
        self._forget(self.workspace.given.name, before)
        self._main.show_set(self.workspace)
        self.notify(f"Saved {saved}", markup=False)
        return True

    # Running and looking

    def action_run(self) -> None:
        """Run the experiment."""
        self._main.run_experiment()

    @on(TrialOpened)
    def _open_trial(self, event: TrialOpened) -> None:
        self._main.open_trial(event)

    # Help

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave F1 to a text, which explains itself by it: a question mark is text there."""
        if action != "explain" or self.workspace is None:
            return True
        from hough_tui.ui.forms.controls import TextInput

        return not isinstance(self.focused, TextInput)

    def action_explain(self) -> None:
        """Tell what the focused view is for, and what the focused field is."""
        from hough_tui.ui.screens.explanation import ExplanationScreen
        from hough_tui.ui.screens.help import HelpScreen

        if isinstance(self.screen, HelpScreen):
            self.screen.dismiss(None)
            return
        if isinstance(self.screen, ExplanationScreen):
            self.screen.dismiss(None)
            screen: Screen[Any] = self._main
        else:
            screen = self.screen
        self.push_screen(HelpScreen(self._main.help_text(), list(screen.active_bindings.values())))

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """Yield every action of the application and of the focused view for the command palette."""
        yield from super().get_system_commands(screen)
        seen = set()
        for active in screen.active_bindings.values():
            binding, node = active.binding, active.node
            name = (node, binding.action)
            if binding.description and not binding.system and name not in seen:
                seen.add(name)
                keys = self.get_key_display(binding)
                yield SystemCommand(
                    binding.description,
                    f"{binding.id or binding.action} ({keys})",
                    lambda node=node, action=binding.action: self.call_later(self.run_action, action, node),
                )

    # Leaving

    def action_leave(self) -> None:
        """Quit; unsaved changes are asked about."""
        self._when_saved(self._leave)

    async def action_quit(self) -> None:
        """Quit, as the command palette calls it."""
        self.action_leave()

    def _leave(self, status: int = 0) -> None:
        self.is_leaving = True
        # A kernel that is at work, or a terminal that nobody reads, would have it wait.
        ending.request(status, QUITTING_SECONDS)

        async def close_and_exit() -> None:
            await self._main.leave()
            self.exit(return_code=status)

        self.run_worker(close_and_exit(), group="leave", exclusive=True)

    def _when_saved(self, go_on: Callable[[], None]) -> None:
        """Go on at once, or when the user has decided about unsaved changes."""
        workspace = self.workspace
        if workspace is None or not workspace.is_changed:
            go_on()
            return

        def answer(key: str | None) -> None:
            if key == "discard":
                self._forget(workspace.given.name, workspace.path)
                go_on()
            elif key == "save":
                if workspace.path is None:
                    self._save_as(go_on)
                elif self._save(None):
                    go_on()

        self.push_screen(
            Question(
                "There are unsaved changes",
                f"{workspace.given.name} was changed and is not saved.",
                {"save": "Save", "discard": "Discard", "stay": "Stay"},
            ),
            answer,
        )

    def end(self, status: int) -> None:
        """Keep unsaved work aside, if possible, and have the application end; any thread may ask for it."""
        try:
            self.keep_aside()
        finally:
            self.call_later(self._leave, status)

    @on(Worker.StateChanged)
    def _tell_failure(self, event: Worker.StateChanged) -> None:
        if event.state is WorkerState.ERROR and event.worker.error is not None:
            self._main.tell_state(None)
            self._tell_error(event.worker.error)

    def _tell_error(self, error: BaseException) -> None:
        self.push_screen(telling("That did not work", f"{error}" or type(error).__name__))
