import pytest
from textual.pilot import Pilot
from textual.widgets import Input, Select

from algorithms.parameters import FieldError, Path, Problem
from hough_tui.ui.forms.controls import Flag
from hough_tui.ui.forms.value_field import ValueField
from hough_tui.ui.screens.explanation import ExplanationScreen
from tests.hough_tui.ui.test_forms_app import EXPERIMENT, MODIFIED, SCENARIO, SEQUENTIAL, FormApp, drive

STEP = (*SEQUENTIAL, "grid", "rho_step")


async def typed(app: FormApp, pilot: Pilot[None], path: Path, text: str) -> ValueField:
    """Type a text into a field in place of its own, key by key."""
    app.form.focus_field(path)
    await pilot.pause()
    await pilot.press("home", "ctrl+k", *text)
    await pilot.pause()
    field = app.form.field(path)
    assert field is not None
    return field


def test_a_typed_number_takes_effect_and_is_left_as_it_was_typed():
    async def journey(app, pilot):
        field = await typed(app, pilot, STEP, "0,30")
        assert app.workspace.value(STEP) == 0.3
        assert field.text == "0,30"
        assert app.form.is_sound

    app = drive(SEQUENTIAL, journey)
    assert {value for _, value in app.posted} <= {0.0, 0.3}


def test_a_wrong_value_is_refused_beside_its_field_in_the_words_of_the_model():
    async def journey(app, pilot):
        field = await typed(app, pilot, STEP, "-1")
        assert field.problem == "-1 is given; it must be greater than 0 or 'auto'"
        assert field.query_one(".field--message").display
        assert not app.form.is_sound
        await typed(app, pilot, STEP, "0.6")
        assert field.problem is None
        assert not field.query_one(".field--message").display
        assert app.form.is_sound

    app = drive(SEQUENTIAL, journey)
    assert app.workspace.value(STEP) == 0.6


@pytest.mark.parametrize("text", ["1,000", "1 000", "x", "0.6 km", ""])
def test_what_cannot_be_read_is_said_and_never_asked_for(text):
    async def journey(app, pilot):
        field = await typed(app, pilot, STEP, text)
        assert field.text == text
        assert field.problem == app.unreadable[-1]
        assert not app.form.is_sound

    app = drive(SEQUENTIAL, journey)
    assert 1000.0 not in [value for _, value in app.posted]


def test_a_decimal_comma_is_never_lost():
    async def journey(app, pilot):
        field = await typed(app, pilot, (*MODIFIED, "angle_tolerance_deg"), "1,5")
        assert field.text == "1,5"

    app = drive(MODIFIED, journey)
    assert app.workspace.value((*MODIFIED, "angle_tolerance_deg")) == 1.5
    assert 15.0 not in [value for _, value in app.posted]


def test_undo_is_shown_and_posts_nothing():
    async def journey(app, pilot):
        field = await typed(app, pilot, STEP, "9")
        before = len(app.posted)
        app.workspace.undo()
        app.show()
        await pilot.pause()
        assert field.text == "0.6"
        app.workspace.redo()
        app.show()
        await pilot.pause()
        assert field.text == "9"
        assert len(app.posted) == before

    drive(SEQUENTIAL, journey)


def test_a_value_set_elsewhere_leaves_text_that_means_it():
    async def journey(app, pilot):
        field = app.form.field(STEP)
        field.query_one(Input).value = "6e-1"
        await pilot.pause()
        app.show()
        assert field.text == "6e-1"
        # Its own earlier value, coming back late, is no news.
        await typed(app, pilot, STEP, "0.65")
        field.refresh_value(0.65)
        assert field.text == "0.65"
        field.refresh_value(0.7)
        assert field.text == "0.7"

    app = drive(SEQUENTIAL, journey)
    assert app.workspace.value(STEP) == 0.65


def test_a_value_set_elsewhere_takes_the_place_of_one_that_was_refused():
    async def journey(app, pilot):
        field = await typed(app, pilot, STEP, "-1")
        app.workspace.set(STEP, 0.7)
        app.show()
        await pilot.pause()
        assert (field.text, field.problem) == ("0.7", None)
        assert app.form.is_sound

    assert drive(SEQUENTIAL, journey).workspace.value(STEP) == 0.7


def test_escape_puts_back_the_value_in_effect():
    async def journey(app, pilot):
        field = await typed(app, pilot, STEP, "x")
        await pilot.press("escape")
        await pilot.pause()
        assert (field.text, field.problem) == ("0.6", None)
        assert app.form.is_sound

    drive(SEQUENTIAL, journey)


def test_auto_shows_what_it_is_worked_out_to():
    async def journey(app, pilot):
        app.workspace.set((*SEQUENTIAL, "grid", "rho_bins"), "auto")
        app.show()
        field = await typed(app, pilot, STEP, "auto")
        assert str(field.query_one(".field--note").visual) == "auto: 0.6 km"
        votes = app.form.field((*SEQUENTIAL, "votes"))
        assert str(votes.query_one(".field--note").visual) == "worked out: 1"
        await typed(app, pilot, STEP, "0.5")
        assert not str(field.query_one(".field--note").visual)

    drive(SEQUENTIAL, journey)


def test_a_question_mark_explains_a_number_and_is_not_typed():
    async def journey(app, pilot):
        app.form.focus_field(STEP)
        await pilot.press("?")
        await pilot.pause()
        assert isinstance(app.screen, ExplanationScreen)
        said = " ".join(str(one.visual) for one in app.screen.query("Static"))
        for word in ("Width Δρ of a column", "km", "greater than 0", "6 σ of the measurement noise"):
            assert word in said
        await pilot.press("escape")
        await pilot.pause()
        assert app.form.field(STEP).text == "0.6"
        # In a text it is typed, and F1 explains.
        field = await typed(app, pilot, (*SEQUENTIAL, "name"), "a?")
        assert field.text == "a?"
        await pilot.press("f1")
        await pilot.pause()
        assert isinstance(app.screen, ExplanationScreen)

    drive(SEQUENTIAL, journey)


def test_the_explaining_key_can_be_remapped():
    async def journey(app, pilot):
        app.set_keymap({"field.explain": "!"})
        app.form.focus_field(STEP)
        await pilot.press("!")
        await pilot.pause()
        assert isinstance(app.screen, ExplanationScreen)

    app = drive(SEQUENTIAL, journey)
    assert app.workspace.value(STEP) == 0.6


def test_arrows_and_enter_go_from_field_to_field():
    async def journey(app, pilot):
        app.form.focus_field((*SEQUENTIAL, "votes"))
        await pilot.press("down", "enter", "up")
        await pilot.pause()
        assert app.form.field((*SEQUENTIAL, "fraction")).query_one(Input).has_focus

    assert drive(SEQUENTIAL, journey).posted == []


def test_choices_and_flags():
    async def journey(app, pilot):
        app.form.field((*SEQUENTIAL, "ties")).query_one(Select).focus()
        await pilot.press("enter", "down", "enter")
        await pilot.pause()
        assert app.workspace.value((*SEQUENTIAL, "ties")) == "first"
        app.workspace.undo()
        app.show()
        await pilot.pause()
        assert app.form.field((*SEQUENTIAL, "ties")).text == "last"
        assert len(app.posted) == 1
        app.path = EXPERIMENT
        app.show()
        await pilot.pause()
        await pilot.click(app.form.field((*EXPERIMENT, "control")).query_one(Flag))
        await pilot.pause()
        assert app.workspace.value((*EXPERIMENT, "control")) is False

    drive(SEQUENTIAL, journey)


def test_edits_that_are_allowed_only_together_are_made_together():
    async def journey(app, pilot):
        field = await typed(app, pilot, (*EXPERIMENT, "criterion", "rho"), "")
        assert (
            field.problem == "exactly one of rho and plots must be given: match by line, or by shared plots"
        )
        await typed(app, pilot, (*EXPERIMENT, "criterion", "plots"), "3")
        assert app.workspace.value((*EXPERIMENT, "criterion")).document == {"plots": 3}
        assert field.problem is None
        assert app.form.is_sound

    drive(EXPERIMENT, journey)


def test_what_was_refused_is_asked_again_when_it_is_allowed():
    async def journey(app, pilot):
        slow, fast = (*MODIFIED, "speed_min"), (*MODIFIED, "speed_max")
        field = await typed(app, pilot, slow, "1")
        assert "must be the smaller one" in field.problem
        await typed(app, pilot, fast, "2")
        assert (app.workspace.value(slow), app.workspace.value(fast)) == (1.0, 2.0)
        assert app.form.is_sound

    drive(MODIFIED, journey)


def test_a_problem_stands_beside_its_field_or_else_at_the_top():
    async def journey(app, pilot):
        top, sigma = app.form.query_one(".form--problem"), (*SCENARIO, "sensor", "sigma")
        app.form.problems([Problem((*sigma, 0), "wrong"), Problem(("experiments", 0, "sweep"), "unfit")])
        assert app.form.field(sigma).problem == "wrong"
        assert str(top.visual) == "! experiments[0].sweep: unfit"
        app.show()
        assert not top.display
        assert app.form.field(sigma).problem is None
        # What an edit spoils elsewhere is marked where the edit was made, too.
        app.workspace.set = refuse
        field = await typed(app, pilot, (*SCENARIO, "interval"), "9")
        assert str(top.visual) == "! experiments[0].sweep: unfit"
        assert field.problem == "this is not taken; the top of the form says why"

    def refuse(path, value):
        raise FieldError(Problem(("experiments", 0, "sweep"), "unfit"))

    drive(SCENARIO, journey)


def test_another_model_of_the_same_kind_takes_over_the_form():
    async def journey(app, pilot):
        fields = set(app.form.query(ValueField))
        await typed(app, pilot, (*SCENARIO, "interval"), "x")
        app.path = ("scenarios", 1)
        app.show()
        await pilot.pause()
        assert set(app.form.query(ValueField)) == fields
        assert app.form.field((*SCENARIO, "interval")) is None
        assert app.form.field(("scenarios", 1, "interval")).text == "4"
        assert app.form.field(("scenarios", 1, "sensor", "sigma")).text == "0.05"
        assert app.form.is_sound

    app = drive(SCENARIO, journey)
    assert app.posted == []


def test_the_unit_of_a_scenario_is_the_unit_of_its_fields():
    async def journey(app, pilot):
        app.workspace.set((*SCENARIO, "unit"), "nmi")
        app.show()
        await pilot.pause()
        label = app.form.field((*SCENARIO, "sensor", "sigma")).query_one(".field--label")
        assert str(label.visual) == "σ [nmi]"

    drive(SCENARIO, journey)


def test_fields_stand_in_two_columns_where_there_is_room():
    def lefts(app):
        return {field.region.x for field in app.form.query(ValueField)}

    async def journey(app, pilot):
        assert len(lefts(app)) == 2
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert len(lefts(app)) == 1

    drive(SEQUENTIAL, journey, (160, 48))
