"""The frame: sizes, keys, palette, help, and sets that cannot be opened."""

import threading

from textual.command import CommandPalette
from textual.widgets import OptionList

from algorithms.kernel_cache.folder import KernelFolder
from hough_tui.ui.config import read_config
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.plane import Plane
from hough_tui.ui.widgets.set_tree import SetTree

KEYS = {"scenario": "f2", "initiator": "f3", "look": "f4", "monte-carlo": "f6", "results": "f7"}


def visible(user, *selectors):
    """Return which of some widgets of the view have a place on the screen."""
    return [name for name in selectors if user.view.query_one(name).region.area > 0]


def help_keys(user):
    """Return the table of keys that the help shows, with its part beyond the screen."""
    table = user.app.screen.query_one(".keys").content
    return list(zip(*([str(cell) for cell in column.cells] for column in table.columns), strict=True))


def test_a_view_is_mounted_when_it_is_first_shown(drive):
    async def journey(user):
        assert list(user.main._views) == ["scenario"]
        for shown, (name, key) in enumerate(KEYS.items(), start=1):
            await user.go(key)
            assert user.tab == name
            assert list(user.main._views) == list(KEYS)[:shown]
        views = dict(user.main._views)
        await user.go("f2")
        assert user.main._views == views

    drive(journey, "course-report")


def test_a_terminal_made_narrow_and_wide_again_shows_all_views_whole(drive):
    async def journey(user):
        await user.go("f4")
        await user.until(lambda: user.view.query_one("LookPanel")._seen)
        wide = await user.still()
        assert visible(user, "Plane", "Heatmap", "TrackGrid") == ["Plane", "Heatmap", "TrackGrid"]
        assert user.main.query_one("#tree-place").region.width == 26

        await user.pilot.resize_terminal(80, 24)
        await user.until(lambda: user.app.size == (80, 24) and "scenarios" not in user.text)
        await user.settle()
        lines = user.text.split("\n")
        assert len(lines) == 24
        assert all(len(line) <= 80 for line in lines)
        # One panel at a time, and a key that leads to each.
        seen = []
        for _ in range(3):
            seen += visible(user, "Plane", "Heatmap", "TrackGrid")
            await user.press("v")
        assert seen == ["Plane", "Heatmap", "TrackGrid"]
        # The tree comes by its key, and goes.
        await user.press("f8")
        await user.until(lambda: user.main.query_one("#tree-place").region.width == 26)
        await user.press("f8")
        for key in KEYS.values():
            await user.go(key)
            await user.settle()
            assert user.app.focused is not None
            assert user.app.focused.region.area > 0
            assert "course-report (bundled, not saved)" in user.text
            # No line of the frame is lost.
            assert user.main.query_one("StatusLine").region.y == 22
            assert user.main.query_one("Footer").region.y == 23

        await user.go("f4")
        await user.pilot.resize_terminal(200, 60)
        await user.until(lambda: user.app.size == (200, 60) and "scenarios" in user.text)
        assert await user.still() == wide

    drive(journey, "course-report", size=(200, 60))


def test_form_and_picture_take_turns_where_there_is_room_for_one(drive):
    async def journey(user):
        await user.go("f2")
        assert visible(user, "ModelForm", "Plane") == ["ModelForm"]
        await user.press("f9")
        await user.until(lambda: visible(user, "ModelForm", "Plane") == ["Plane"])
        assert isinstance(user.app.focused, Plane)
        await user.press("f9")
        await user.until(lambda: visible(user, "ModelForm", "Plane") == ["ModelForm"])
        await user.pilot.resize_terminal(200, 60)
        await user.until(lambda: visible(user, "ModelForm", "Plane") == ["ModelForm", "Plane"])

    drive(journey, "course-report", size=(80, 24))


def test_the_palette_lists_every_action(drive):
    async def journey(user):
        await user.go("f4")
        user.view.query_one(Heatmap).focus()
        await user.settle()
        screen = user.app.screen
        described = {
            active.binding.description
            for active in screen.active_bindings.values()
            if active.binding.description and not active.binding.system
        }
        assert {"Save", "Save as", "Open", "Redo", "Run", "Next peak", "Next trial", "Results"} <= described
        listed = [command.title for command in user.app.get_system_commands(screen)]
        assert described <= set(listed)
        # Each of them once: what two keys do is one action.
        assert len([title for title in listed if title == "Zoom in"]) == 1

        await user.press("ctrl+p")
        await user.until(lambda: isinstance(user.app.screen, CommandPalette))
        await user.type("monte carlo")
        options = user.app.screen.query_one(OptionList)
        await user.until(lambda: options.option_count and "Monte Carlo" in user.text)
        await user.press("enter")
        await user.until(lambda: not isinstance(user.app.screen, CommandPalette))
        await user.until(lambda: user.tab == "monte-carlo")

        # An action of a widget is done there, though the palette had the focus.
        await user.go("f4")
        heatmap = user.view.query_one(Heatmap)
        heatmap.focus()
        await user.until(lambda: not heatmap._scene.is_empty)
        heatmap.move_cursor(0, 0)
        await user.press("ctrl+p")
        await user.until(lambda: isinstance(user.app.screen, CommandPalette))
        await user.type("next peak")
        await user.until(lambda: "Next peak" in user.text)
        await user.press("enter")
        await user.until(lambda: heatmap.cursor != (0, 0))

    drive(journey, "course-report")


def test_f1_tells_what_a_view_is_for_and_lists_its_keys(drive):
    async def journey(user):
        for name, words, keys in (
            ("scenario", "Every change is checked at once", ["scenario.draw", "field.explain"]),
            ("look", "One trial, as an initiator sees it", ["look.next-trial", "plane.next-track"]),
            ("monte-carlo", "Runs an experiment of the set", ["monte-carlo.run"]),
        ):
            await user.go(KEYS[name])
            await user.press("f1")
            await user.screen("HelpScreen")
            await user.sees(words)
            known = help_keys(user)
            assert {*keys, "app.quit", "app.help"} <= {binding for _, _, binding in known}
            assert ("^q", "Quit", "app.quit") in known
            await user.press("f1")
            await user.screen("MainScreen")

    drive(journey, "course-report", size=(120, 60))


def test_a_question_mark_explains_a_numeric_field(drive):
    async def journey(user):
        await user.go("f3")
        user.form.focus_field(("initiators", 0, "grid", "rho_step"))
        await user.settle()
        await user.press("?")
        await user.screen("ExplanationScreen")
        await user.sees("Unit", "km", "Allowed", "greater than 0", "initiators[0].grid.rho_step")
        await user.press("escape")
        await user.screen("MainScreen")
        assert user.field("initiators", 0, "grid", "rho_step").text == "0.6"

    drive(journey, "course-report")


def test_keys_and_theme_of_the_config_file_are_in_force(drive, home):
    folder = home / "config" / "hough-tui"
    folder.mkdir(parents=True)
    (folder / "config.yaml").write_text(
        "theme: textual-light\nkeys:\n  tab.look: ctrl+l\n  look.next-trial: full_stop\n", encoding="utf-8"
    )

    async def journey(user):
        assert user.app.theme == "textual-light"
        await user.press("f4")
        assert user.tab == "scenario"
        await user.go("ctrl+l")
        assert user.tab == "look"
        await user.sees("trial 0:")
        await user.press("]")
        await user.settle()
        assert "trial 0:" in user.text
        await user.press("full_stop")
        await user.sees("trial 1:")
        await user.press("f1")
        await user.screen("HelpScreen")
        assert ("^l", "Look", "tab.look") in help_keys(user)
        assert (".", "Next trial", "look.next-trial") in help_keys(user)

    drive(journey, "course-report", config=read_config())


def test_a_set_that_cannot_be_opened_tells_why_and_another_one_can_be_chosen(drive, home):
    (home / "work" / "wrong.yaml").write_text("schema: 1\nname: wrong\nscenarios: 5\n", encoding="utf-8")

    async def damaged(user):
        await user.screen("Question")
        await user.sees("This set cannot be opened", "wrong.yaml:3", "scenarios")
        await user.press("enter")
        await user.screen("Welcome")
        await user.press("enter")
        await user.warm()
        await user.sees("course-report (bundled, not saved)")

    async def absent(user):
        await user.screen("Question")
        await user.sees("This set cannot be opened", "course-reprt", "course-report")
        await user.press("escape")
        await user.screen("Welcome")
        await user.press("escape")
        await user.until(lambda: user.app._exit)

    drive(damaged, "wrong.yaml", opens=False)
    assert drive(absent, "course-reprt", opens=False).return_code == 0


def test_that_kernels_are_compiled_is_told_until_they_are(drive, monkeypatch):
    ready = threading.Event()
    monkeypatch.setattr("algorithms.kernel_cache.folder.is_cold", lambda: True)
    monkeypatch.setattr("hough_tui.ui.warming.warm", lambda given: ready.wait(60))

    async def journey(user):
        await user.sees("Detection probability", "compiling kernels")
        ready.set()
        await user.warm()
        assert "compiling" not in user.text

    drive(journey, "course-report", opens=False)


def test_kernels_that_cannot_be_kept_are_told_once(drive, monkeypatch, tmp_path):
    ready = threading.Event()
    monkeypatch.setattr("algorithms.notices._notices", [])
    monkeypatch.setattr("hough_tui.ui.app.NOTICE_SECONDS", 600)
    in_the_way = tmp_path / "hough-tui"
    in_the_way.touch()
    folder = KernelFolder(in_the_way / "kernels-algorithms-0123456789abcdef")
    monkeypatch.setattr("algorithms.kernel_cache.folder.kernel_folder", lambda package="algorithms": folder)
    monkeypatch.setattr("hough_tui.ui.warming.warm", lambda given: ready.wait(60))

    async def journey(user):
        await user.sees("the compiled kernels cannot be kept in")
        assert len(user.app._notifications) == 1
        assert user.app._compiling == "compiling kernels, up to two minutes"
        ready.set()
        await user.warm()

    drive(journey, "course-report", opens=False)


def test_a_file_is_opened_by_its_path(drive, home):
    (home / "work" / "small.yaml").write_text(SMALL, encoding="utf-8")

    async def journey(user):
        await user.screen("Welcome")
        await user.press("o")
        await user.screen("PathPrompt")
        await user.type("smal.yaml")
        await user.press("enter")
        await user.sees("there is no file smal.yaml")
        await user.press("home", "shift+end", "delete")
        await user.type("small.yaml")
        await user.press("enter")
        await user.warm()
        await user.sees("small.yaml", "quiet-sea")
        # A set without initiators and experiments has views that say so.
        await user.go("f3")
        await user.sees("The set has no initiators")
        await user.go("f4")
        await user.sees("The set has no initiators.")
        await user.go("f6")
        await user.sees("the set has no experiments, so there is nothing to run")
        await user.press("r")
        assert not user.view.is_at_work

    drive(journey)


SMALL = """\
schema: 1
name: small
scenarios:
  - name: quiet-sea
    unit: nmi
    scans: 3
    interval: 2
    region: {x: [0, 10], y: [0, 10]}
    sensor: {kind: cartesian, sigma: 0.1}
    targets: [{position: [1, 1], velocity: [0.1, 0.1]}]
"""


def test_the_tree_leads_to_what_the_set_holds(drive):
    async def journey(user):
        tree = user.main.query_one("SetTree")
        # To the second scenario, the third initiator, the last experiment.
        for steps, tab, words in (
            (3, "scenario", "three-scans, trial 0 of seed"),
            (4, "initiator", "modified"),
            (4, "monte-carlo", "modified"),
        ):
            tree.focus()
            await user.press(*["j"] * steps, "enter")
            await user.until(lambda tab=tab: user.tab == tab)
            await user.sees(words)
        await user.until(lambda: user.view.query_one("RunForm Select").value == "modified")
        # To and fro, faster than the forms are built.
        initiator = user.main._views["initiator"]
        for _ in range(3):
            for index in (0, 2, 1):
                user.main.query_one("SetTree").post_message(SetTree.Chosen("initiators", index))
        await user.until(lambda: user.tab == "initiator" and initiator.query_one("ModelForm").model)
        await user.still()
        assert initiator.query_one("ModelForm").model.name == "sequential"
        assert initiator.query_one("OptionList").highlighted == 1
        # Into the form from the list.
        initiator.query_one("OptionList").focus()
        await user.press("enter")
        assert initiator.query_one("ModelForm") in user.app.focused.ancestors

    drive(journey, "course-report")
