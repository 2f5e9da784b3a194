"""Edits: wrong ones, numbers as people type them, undo, targets, what is not saved yet."""

import pytest
from textual.widgets import Button

from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.ui.autosave import unsaved_work
from hough_tui.ui.forms.list_table import ListTable
from hough_tui.ui.widgets.plane import Plane
from scenarios.files.set_files import load_set

STEP = ("initiators", 0, "grid", "rho_step")
BINS = ("initiators", 0, "grid", "theta_bins")
PROBABILITY = ("scenarios", 0, "sensor", "detection_probability")
SCANS = ("scenarios", 0, "scans")
TARGETS = ("scenarios", 0, "targets")


def message_line(user, *path):
    """Return the line of the screen below a field."""
    place = user.field(*path).region
    return user.text.split("\n")[place.y + 1][place.x : place.right].strip()


def test_a_wrong_field_says_why_beside_it_and_nothing_runs_or_is_saved_until_it_is_mended(drive, home):
    path = home / "work" / "mine.yaml"
    path.write_text(BUNDLED, encoding="utf-8")

    async def journey(user):
        await user.go("f2")
        await user.fill(PROBABILITY, "1.5")
        # In the words of the model, below the field.
        await user.sees("✗ a field is wrong")
        assert user.field(*PROBABILITY).problem == "1.5 is given; it must be at most 1"
        assert message_line(user, *PROBABILITY) == "! 1.5 is given; it must be at most 1"
        assert user.value(*PROBABILITY) == 1.0

        await user.press("ctrl+s")
        await user.screen("Question")
        await user.sees("The set is not saved", "a field in the form of Scenario is wrong")
        await user.press("enter")
        await user.screen("MainScreen")
        assert path.read_text(encoding="utf-8") == BUNDLED

        await user.press("f5")
        await user.until(lambda: user.tab == "monte-carlo" and user.view)
        await user.sees("a field is wrong: a field in the form of Scenario is wrong")
        await user.press("r")
        assert not user.view.is_at_work
        assert user.view._live is None
        assert FolderStore().names() == []

        await user.go("f2")
        await user.fill(PROBABILITY, "0.9")
        await user.until(lambda: user.value(*PROBABILITY) == 0.9)
        await user.until(lambda: "✗" not in user.text)
        assert user.field(*PROBABILITY).problem is None
        view = await user.go("f6")
        await user.sees("rates: 1 cell", "r runs it")
        assert view._reason is None
        await user.press("ctrl+s")
        await user.until(lambda: load_set(str(path)).scenarios[0].sensor.detection_probability == 0.9)

    drive(journey, "mine.yaml")


def test_undo_mends_a_wrong_field(drive):
    async def journey(user):
        await user.go("f2")
        await user.fill(SCANS, "5")
        await user.until(lambda: user.value(*SCANS) == 5)
        await user.fill(SCANS, "-3")
        await user.sees("✗ a field is wrong")
        await user.press("ctrl+z")
        await user.until(lambda: "✗" not in user.text)
        assert user.field(*SCANS).problem is None
        assert user.field(*SCANS).text == str(user.value(*SCANS))
        assert user.main.why_not_runnable() is None

    drive(journey, "course-report")


def test_numbers_mean_what_people_type_and_the_text_stays(drive):
    async def journey(user):
        await user.go("f3")
        for typed, taken in (("1,5", 1.5), (".25", 0.25), ("3e-1", 0.3), ("2.50", 2.5), (" 0.7 ", 0.7)):
            field = await user.fill(STEP, typed)
            await user.until(lambda taken=taken: user.value(*STEP) == taken)
            # Leaving the field changes nothing.
            await user.press("tab")
            assert field.text == typed
            assert user.value(*STEP) == taken

    drive(journey, "course-report")


def test_what_may_mean_two_things_is_asked_back(drive):
    # What stands in the set is what was there, or the beginning, which is a number: never 15, never 1500.
    cases = [
        (STEP, "1,500", (0.6, 1, 1.5), "'1,500' may mean 1.500 or 1500; write one of them"),
        (STEP, "0.5 km", (2, 0.5), "'0.5 km' is given; write the number alone, without 'km'"),
        (BINS, "1,5", (90, 1), "'1,5' is given; it must be a whole number"),
    ]

    async def journey(user):
        await user.go("f3")
        for path, typed, kept, words in cases:
            field = await user.fill(path, typed)
            await user.sees("✗ a field is wrong", words)
            assert field.problem.startswith(words)
            assert field.text == typed
            assert user.value(*path) in kept
            await user.fill(path, "2")
            await user.until(lambda path=path: user.value(*path) == 2)
            await user.until(lambda: "✗" not in user.text)
            assert words not in user.text

    # Wide enough for each message to stand in one line.
    drive(journey, "course-report", size=(160, 48))


def test_edits_are_undone_and_done_again_one_by_one(drive):
    async def journey(user):
        start = user.app.workspace.given
        await user.go("f2")
        table = user.form.table(TARGETS)
        assert isinstance(table, ListTable)
        table._table.focus()
        row = table._table.cursor_row
        await user.press("a")
        await user.until(lambda: len(user.value(*TARGETS)) == 3)
        added = user.app.workspace.given
        assert added.scenarios[0].targets[row + 1] not in start.scenarios[0].targets
        await user.until(lambda: table._table.row_count == 3)
        table._table.move_cursor(row=0)
        await user.press("d")
        await user.until(lambda: len(user.value(*TARGETS)) == 2)
        removed = user.app.workspace.given
        assert removed.scenarios[0].targets == added.scenarios[0].targets[1:]
        await user.fill(SCANS, "8")
        await user.until(lambda: user.value(*SCANS) == 8)
        edited = user.app.workspace.given

        for wanted, rows in ((removed, 2), (added, 3), (start, 2)):
            await user.press("ctrl+z")
            await user.until(lambda wanted=wanted: user.app.workspace.given == wanted)
            await user.until(lambda rows=rows: table._table.row_count == rows)
        assert user.field(*SCANS).text == "15"
        await user.until(lambda: "● changed" not in user.text)
        await user.press("ctrl+z")
        assert "Nothing to undo" in user.notes
        for wanted, rows in ((added, 3), (removed, 2), (edited, 2)):
            await user.press("ctrl+y")
            await user.until(lambda wanted=wanted: user.app.workspace.given == wanted)
            await user.until(lambda rows=rows: table._table.row_count == rows)
        assert user.field(*SCANS).text == "8"
        assert "● changed" in user.text
        await user.press("ctrl+y")
        assert "Nothing to redo" in user.notes

    drive(journey, "course-report")


def test_a_target_is_edited_in_its_row(drive):
    async def journey(user):
        await user.go("f2")
        table = user.form.table(TARGETS)
        table._table.focus()
        column = next(i for i, one in enumerate(table._columns) if one.path == ("position", 0))
        table._table.move_cursor(row=1, column=column)
        await user.press("enter", "home", "shift+end", "delete")
        await user.type("33,5")
        await user.press("enter")
        await user.until(lambda: user.value(*TARGETS, 1, "position")[0] == 33.5)
        await user.sees("33.5")

    drive(journey, "course-report")


def test_another_draw_changes_the_picture_and_the_one_before_comes_back(drive):
    async def journey(user):
        await user.go("f2")
        plane = user.view.query_one(Plane)
        await user.sees("trial 0 of seed 7")
        await user.settle()
        first = user.drawn(plane)
        assert plane.region.width > 30
        await user.press("ctrl+n")
        await user.sees("trial 1 of seed 7")
        await user.until(lambda: user.drawn(plane) != first)
        await user.press("ctrl+b")
        await user.sees("trial 0 of seed 7")
        await user.until(lambda: user.drawn(plane) == first)

    drive(journey, "course-report", size=(160, 48))


@pytest.mark.parametrize("answer", ["save", "discard", "stay"])
def test_unsaved_changes_are_asked_about_on_leaving(drive, home, answer):
    path = home / "work" / "mine.yaml"

    async def journey(user):
        await user.go("f2")
        await user.fill(SCANS, "9")
        await user.until(lambda: user.value(*SCANS) == 9)
        await user.until(unsaved_work)
        await user.press("ctrl+q")
        await user.screen("Question")
        await user.sees("There are unsaved changes", "course-report was changed and is not saved")
        user.app.screen.query_one(f"#{answer}", Button).focus()
        await user.press("enter")
        if answer == "stay":
            await user.screen("MainScreen")
            assert not user.app._exit
            assert user.value(*SCANS) == 9
        else:
            await user.until(lambda: user.app._exit)

    path.write_text(BUNDLED, encoding="utf-8")
    drive(journey, "mine.yaml")
    scans = load_set(str(path)).scenarios[0].scans
    assert scans == (9 if answer == "save" else 15)
    assert len(unsaved_work()) == (1 if answer == "stay" else 0)
    # Saving over a file leaves its comments where they are.
    assert "# s" in path.read_text(encoding="utf-8")


def test_a_bundled_set_is_asked_for_a_name_when_it_is_saved_on_leaving(drive, home):
    async def journey(user):
        await user.go("f2")
        await user.fill(SCANS, "9")
        await user.until(lambda: user.value(*SCANS) == 9)
        await user.press("ctrl+q")
        await user.screen("Question")
        await user.press("enter")
        await user.screen("PathPrompt")
        await user.press("enter")
        await user.until(lambda: user.app._exit)

    drive(journey, "course-report")
    assert load_set(str(home / "work" / "course-report.yaml")).scenarios[0].scans == 9
    assert unsaved_work() == []


def test_unsaved_work_is_kept_aside_and_recovered_at_the_next_start(drive):
    async def lost(user):
        await user.go("f2")
        await user.fill(SCANS, "9")
        await user.until(unsaved_work)
        # The connection drops: nobody is asked anything.
        user.app.exit()

    drive(lost, "course-report")
    (kept,) = unsaved_work()
    assert kept.given.scenarios[0].scans == 9
    assert kept.path is None

    async def without_a_set(user):
        await user.screen("Welcome")
        await user.sees("unsaved course-report")
        await user.press("enter")
        await user.warm()
        assert user.value(*SCANS) == 9
        await user.sees("● changed")

    drive(without_a_set)
    assert len(unsaved_work()) == 1

    async def with_the_set(user):
        await user.screen("Question")
        await user.sees("There are unsaved changes", "Recover them")
        assert user.value(*SCANS) == 15
        await user.press("enter")
        await user.screen("MainScreen")
        await user.until(lambda: user.value(*SCANS) == 9)
        await user.go("f2")
        await user.until(lambda: user.field(*SCANS).text == "9")
        await user.sees("● changed")
        await user.press("f12")
        await user.screen("PathPrompt")
        await user.press("enter")
        await user.screen("MainScreen")
        await user.until(lambda: "● changed" not in user.text)

    drive(with_the_set, "course-report")
    assert unsaved_work() == []


def test_unsaved_work_that_was_not_decided_about_outlives_further_edits(drive):
    async def lost(user):
        await user.go("f2")
        await user.fill(SCANS, "9")
        await user.until(unsaved_work)
        user.app.exit()

    async def go_on(user):
        await user.screen("Question")
        await user.press("escape")
        await user.screen("MainScreen")
        await user.go("f2")
        await user.fill(SCANS, "8")
        await user.until(lambda: 8 in kept_scans())
        assert kept_scans() == [8, 9]
        await user.press("ctrl+z")
        await user.until(lambda: kept_scans() == [9])
        user.app.exit()

    async def take_up(user):
        await user.screen("Welcome")
        await user.sees("unsaved course-report")
        await user.press("enter")
        await user.warm()
        assert user.value(*SCANS) == 9
        await user.press("f12")
        await user.screen("PathPrompt")
        await user.press("enter")
        await user.screen("MainScreen")
        await user.until(lambda: "● changed" not in user.text)

    def kept_scans():
        return sorted(kept.given.scenarios[0].scans for kept in unsaved_work())

    drive(lost, "course-report")
    drive(go_on, "course-report")
    assert kept_scans() == [9]
    drive(take_up)
    assert kept_scans() == []


def test_unsaved_work_can_be_forgotten(drive):
    async def lost(user):
        await user.go("f2")
        await user.fill(SCANS, "9")
        await user.until(unsaved_work)
        user.app.exit()

    async def forget(user):
        await user.screen("Question")
        await user.press("right", "enter")
        await user.screen("MainScreen")
        assert user.value(*SCANS) == 15
        assert not user.app.workspace.is_changed

    drive(lost, "course-report")
    drive(forget, "course-report")
    assert unsaved_work() == []


BUNDLED = """\
schema: 1
name: course-report
scenarios:
  - name: two-crossing
    unit: km
    scans: 15
    interval: 4   # s
    region: {x: [0, 100], y: [0, 100]}
    sensor: {kind: cartesian, sigma: 0.1, detection_probability: 1.0}
    clutter:
      - {kind: poisson, rate: 50}
    targets:
      - {position: [40, 20], velocity: [0.3, 0.18]}
initiators:
  - {name: standard, fraction: 0.95}
experiments:
  - {name: rates, trials: 10, seed: 7, criterion: {rho: 3.0}}
"""
