from textual.coordinate import Coordinate
from textual.pilot import Pilot
from textual.widgets import Button, Input

from algorithms.parameters import Path
from hough_tui.ui.forms.cell_table import CellTable
from hough_tui.ui.forms.list_table import ListTable
from hough_tui.ui.forms.model_form import ModelForm
from hough_tui.ui.screens.explanation import ExplanationScreen
from tests.hough_tui.ui.test_forms_app import SCENARIO, FormApp, drive

TARGETS, CLUTTER = (*SCENARIO, "targets"), (*SCENARIO, "clutter")
X, Y, VX, VY, BIRTH, DEATH, SPREAD, MOTION, NOISE, SPEED = range(1, 11)
"""The columns of the table of targets, after the name."""
KIND, OVER, RATE, COUNT, PER, REGION_X, REGION_Y, REGION_Z = range(8)
"""The columns of the table of clutter."""


async def at(app: FormApp, pilot: Pilot[None], path: Path, row: int, column: int) -> ListTable:
    """Put the cursor on a cell."""
    table = app.form.table(path)
    assert table is not None
    table.query_one(CellTable).focus()
    table.query_one(CellTable).move_cursor(row=row, column=column)
    await pilot.pause()
    return table


async def edit(pilot: Pilot[None], text: str, *after: str) -> None:
    await pilot.press("enter", "home", "ctrl+k", *text, *after)
    await pilot.pause()


def asked(app: FormApp) -> list[str]:
    return [action for action, _ in app.posted]


def message(table: ListTable) -> str:
    return str(table.query_one(".list--message").visual)


def rows(table: ListTable) -> list[list[str]]:
    cells = table.query_one(CellTable)
    return [[text.plain for text in cells.get_row_at(row)] for row in range(cells.row_count)]


def test_targets_are_shown_with_speed_and_heading():
    async def journey(app, pilot):
        table = app.form.table(TARGETS)
        *declared, motion, noise, speed, heading = rows(table)[0]
        assert declared == ["rising", "40", "20", "0.3", "0.18", "0", "", "0"]
        assert (motion, noise, speed, heading) == ("constant-velocity", "0", "0.350", "59.0")
        assert rows(table)[1][-1] == "121.0"

    assert asked(drive(SCENARIO, journey, (100, 50))) == []


def test_a_cell_is_edited_in_its_place():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 1, VY)
        await edit(pilot, "-0,2", "enter")
        assert app.workspace.value((*TARGETS, 1, "velocity")) == (0.3, -0.2)
        assert rows(table)[1][VY] == "-0.2"
        assert not table.query(Input)
        assert table.query_one(CellTable).has_focus

    assert asked(drive(SCENARIO, journey, (100, 50))) == ["set"]


def test_tab_takes_the_value_and_goes_to_the_next_cell():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, X)
        await edit(pilot, "41", "tab")
        await edit(pilot, "21", "tab")
        assert app.workspace.value((*TARGETS, 0, "position")) == (41.0, 21.0)
        assert table.query_one(CellTable).cursor_coordinate == (0, VX)

    drive(SCENARIO, journey, (100, 50))


def test_a_wrong_cell_stays_open_with_what_is_wrong():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, BIRTH)
        await edit(pilot, "1.5", "enter")
        assert message(table) == "! '1.5' is given; it must be a whole number"
        assert app.unreadable == ["'1.5' is given; it must be a whole number"]
        assert not app.form.is_sound
        await pilot.press("home", "ctrl+k", "-", "1", "enter")
        await pilot.pause()
        assert message(table) == "! -1 is given; it must be at least 0"
        assert table.query_one(Input).value == "-1"
        await pilot.press("escape")
        await pilot.pause()
        assert not table.query(Input)
        assert message(table) == ""
        assert app.form.is_sound

    app = drive(SCENARIO, journey, (100, 50))
    assert app.workspace.value((*TARGETS, 0, "birth")) == 0
    assert not app.workspace.is_changed


def test_a_wrong_thousand_is_never_taken_for_another_number():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, X)
        await edit(pilot, "1,000", "enter")
        assert "may mean 1.000 or 1000" in message(table)

    assert asked(drive(SCENARIO, journey, (100, 50))) == []


def test_leaving_a_cell_by_the_mouse_takes_what_is_typed():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, X)
        await edit(pilot, "42")
        app.form.focus_field(("scenarios", 0, "interval"))
        await pilot.pause()
        assert app.workspace.value((*TARGETS, 0, "position", 0)) == 42.0
        assert not table.query(Input)
        assert not table.query_one(CellTable).has_focus

    drive(SCENARIO, journey, (100, 50))


def test_a_change_from_elsewhere_is_shown_and_leaves_an_open_cell_alone():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, X)
        await edit(pilot, "42")
        app.workspace.set((*TARGETS, 1, "velocity", 0), 0.5)
        app.show()
        await pilot.pause()
        assert rows(table)[1][VX] == "0.5"
        assert table.query_one(Input).value == "42"
        await pilot.press("enter")
        await pilot.pause()
        app.workspace.undo()
        app.show()
        await pilot.pause()
        assert rows(table)[0][X] == "40"

    assert asked(drive(SCENARIO, journey, (100, 50))) == ["set"]


def test_elements_are_added_duplicated_and_removed_by_keys():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, 0)
        await pilot.press("a")
        await pilot.pause()
        targets = app.workspace.value(TARGETS)
        assert [target.name for target in targets] == ["rising", None, "falling"]
        assert targets[1].position == (50.0, 50.0)
        assert not targets[1].stands_still
        assert table.query_one(CellTable).cursor_row == 1
        await pilot.press("k", "c")
        await pilot.pause()
        assert [target.name for target in app.workspace.value(TARGETS)][:2] == ["rising", "rising-2"]
        await pilot.press("d")
        await pilot.pause()
        await pilot.press("delete")
        await pilot.pause()
        assert [row[0] for row in rows(table)] == ["rising", "falling"]

    assert asked(drive(SCENARIO, journey, (100, 50))) == ["insert", "insert", "remove", "remove"]


def test_the_last_element_may_go_and_the_first_may_come():
    async def journey(app, pilot):
        table = await at(app, pilot, CLUTTER, 0, 0)
        await pilot.press("d")
        await pilot.pause()
        assert app.workspace.value(CLUTTER) == []
        assert table.query_one(".list--empty").display
        await pilot.press("a")
        await pilot.pause()
        assert [source.rate for source in app.workspace.value(CLUTTER)] == [1.0]
        assert not table.query_one(".list--empty").display

    drive(SCENARIO, journey, (100, 50))


def test_a_cell_that_spoils_something_elsewhere_stays_open():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, VX)
        await edit(pilot, "0", "tab")
        await edit(pilot, "0", "enter")
        problem = app.form.query_one(".form--problem")
        assert "stands still" in str(problem.visual)
        # The cell is not in effect, and it says so itself.
        assert table.query_one(Input).value == "0"
        assert message(table) == "! this is not taken; the top of the form says why"
        assert not app.form.is_sound

    drive(SCENARIO, journey, (100, 50))


def test_the_mouse_edits_and_presses():
    async def journey(app, pilot):
        table = app.form.table(TARGETS)
        cells = table.query_one(CellTable)
        region = cells.cell_region(Coordinate(1, X))
        for _ in range(2):
            await pilot.click(cells, offset=(region.x + 2, region.y))
            await pilot.pause()
        assert table.query_one(Input).has_focus
        await pilot.press("7", "enter")
        await pilot.pause()
        assert app.workspace.value((*TARGETS, 1, "position")) == (7.0, 80.0)
        add, copy, remove = table.query(Button)
        for button in (copy, add, remove):
            await pilot.click(button)
            await pilot.pause()
        assert [target.name for target in app.workspace.value(TARGETS)] == ["rising", "falling", "falling-2"]

    assert asked(drive(SCENARIO, journey, (100, 50))) == ["set", "insert", "insert", "remove"]


def test_an_empty_region_of_clutter_shows_and_begins_as_that_of_the_scenario():
    async def journey(app, pilot):
        table = await at(app, pilot, CLUTTER, 0, REGION_X)
        assert rows(table)[0] == ["poisson", "region", "50", "", "", "0, 100", "0, 100", ""]
        await edit(pilot, "10 20", "enter")
        region = app.workspace.value((*CLUTTER, 0, "region"))
        assert (region.x, region.y) == ((10.0, 20.0), (0.0, 100.0))
        await edit(pilot, "", "enter")
        assert app.workspace.value((*CLUTTER, 0, "region")) is None

    drive(SCENARIO, journey, (100, 50))


def test_clutter_becomes_of_another_kind_in_its_cell():
    async def journey(app, pilot):
        table = await at(app, pilot, CLUTTER, 0, KIND)
        await pilot.press("enter")
        await pilot.pause()
        assert app.workspace.value((*CLUTTER, 0, "kind")) == "exact"
        table = await at(app, pilot, CLUTTER, 0, COUNT)
        await edit(pilot, "90", "enter")
        assert app.workspace.value((*CLUTTER, 0, "count")) == 90
        assert rows(table)[0][:5] == ["exact", "region", "", "90", "scan"]
        await at(app, pilot, CLUTTER, 0, RATE)
        await pilot.press("enter")
        await pilot.pause()
        assert message(table) == "! this one has no rate"

    drive(SCENARIO, journey, (100, 50))


def test_a_target_moves_in_another_way_in_its_cell():
    async def journey(app, pilot):
        async def next_motion():
            await at(app, pilot, TARGETS, 0, MOTION)
            await pilot.press("enter")
            await pilot.pause()
            return app.workspace.value((*TARGETS, 0, "motion"))

        table = await at(app, pilot, TARGETS, 0, NOISE)
        await edit(pilot, "0.001", "enter")
        motion = await next_motion()
        assert (motion.kind, motion.acceleration, motion.process_noise) == ("acceleration", (0.0, 0.0), 0.001)
        headings = [column.label.plain for column in table.query_one(CellTable).ordered_columns]
        units = "\n[km/s²]"
        own = [f"Motion process noise{units}", f"ax{units}", f"ay{units}"]
        assert headings[MOTION : MOTION + 4] == ["Motion", *own]
        await at(app, pilot, TARGETS, 0, NOISE + 2)
        await edit(pilot, "0.002", "enter")
        assert app.workspace.value((*TARGETS, 0, "motion", "acceleration")) == (0.0, 0.002)
        await at(app, pilot, TARGETS, 1, NOISE + 2)
        await pilot.press("enter")
        await pilot.pause()
        assert message(table) == "! this one has no ay"
        assert (await next_motion()).rate_deg == 1.0
        assert (await next_motion()).points == [(48.4, 25.04)]
        await at(app, pilot, TARGETS, 0, NOISE + 1)
        await edit(pilot, "60, 20; 60 40", "enter")
        assert app.workspace.value((*TARGETS, 0, "motion", "points")) == [(60.0, 20.0), (60.0, 40.0)]
        assert rows(table)[0][NOISE + 1] == "60, 20; 60, 40"
        # The first leg leads east, wherever the velocity points.
        assert rows(table)[0][-1] == "90.0"
        assert (await next_motion()).kind == "constant-velocity"
        assert app.workspace.value((*TARGETS, 0, "motion", "process_noise")) == 0.001

    drive(SCENARIO, journey, (100, 50))


def test_what_is_worked_out_is_not_edited():
    async def journey(app, pilot):
        table = await at(app, pilot, TARGETS, 0, SPEED)
        await pilot.press("enter")
        await pilot.pause()
        assert not table.query(Input)
        assert "worked out" in message(table)

    drive(SCENARIO, journey, (100, 50))


def test_a_question_mark_explains_the_cell():
    async def journey(app, pilot):
        await at(app, pilot, TARGETS, 0, VX)
        for keys in (["?"], ["enter", "?"]):
            await pilot.press(*keys)
            await pilot.pause()
            assert isinstance(app.screen, ExplanationScreen)
            assert app.screen.field.title == "vx [km/s]"
            await pilot.press("escape")
            await pilot.pause()
        assert app.form.table(TARGETS).query_one(Input).value == "0.3"

    assert asked(drive(SCENARIO, journey, (100, 50))) == []


def test_vim_keys_move_the_cursor():
    async def journey(app, pilot):
        table = (await at(app, pilot, TARGETS, 0, 0)).query_one(CellTable)
        await pilot.press("j", "l", "l", "h")
        assert table.cursor_coordinate == (1, 1)
        await pilot.press("g")
        assert table.cursor_row == 0
        await pilot.press("G")
        assert table.cursor_row == 1

    drive(SCENARIO, journey, (100, 50))


def test_every_binding_has_an_id_and_a_description():
    for widget in (ListTable, CellTable, ModelForm, ExplanationScreen):
        for binding in widget.BINDINGS:
            assert binding.id
            assert binding.description
