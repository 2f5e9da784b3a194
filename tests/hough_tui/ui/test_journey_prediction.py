"""The Initiator view: what is predicted follows every edit, and what is recommended is taken."""

import json
from pathlib import Path

import pytest
from textual.widgets import Static

from algorithms.quantisation.advisor import advise
from algorithms.quantisation.prediction import predict
from hough_tui.quantisation.designs import Demands, question_of
from hough_tui.ui.widgets.false_cell_field import FalseCellField
from hough_tui.ui.widgets.prediction_density import PredictionDensity
from hough_tui.ui.widgets.prediction_panel import PredictionPanel
from hough_tui.ui.widgets.prediction_table import PredictionTable
from scenarios.files.set_files import load_set

ENTRY = ("initiators", 0)
STEP = (*ENTRY, "grid", "rho_step")


def told(user, bound=1.0):
    """Return what is to be on the screen for the first initiator on the first scenario, by direct calls."""
    given = user.app.workspace.given
    scenario, entry = given.scenarios[0], given.initiators[0]
    resolved = entry.parameters.resolved(scenario.context)
    grid = resolved.grid.grid(scenario.context)
    question = question_of(scenario, Demands(false_cells=bound))
    return predict(question, grid, resolved.votes), advise(question)


async def ready(user):
    """Wait until prediction and recommendation are those for what the set holds now."""
    panel = user.view.query_one(PredictionPanel)
    await user.until(lambda: panel.advice is not None)
    entry = user.app.workspace.given.initiators[user.view._index]
    await user.until(lambda: isinstance(panel._forecast, str) or panel._forecast.entry == entry)
    await user.until(lambda: isinstance(panel._forecast, str) or panel._cost)
    await user.settle()
    return panel


def both(user, *names):
    """Return the figures of a row, as it is and recommended; it has the name for which there is room."""
    # Not from the screen: what the application tells in passing may cover a part of it.
    for line in user.view.query_one(PredictionTable).render().plain.splitlines():
        for name in names:
            if line.startswith(f"{name} "):
                return [part.strip() for part in line.removeprefix(name).split("  ") if part.strip()]
    raise AssertionError(f"no row is named {names}")


def said(user):
    """Return what the panel says in words."""
    return str(user.view.query_one(PredictionPanel).query_one(".words", Static).content)


async def agrees(user, bound=1.0):
    """Check figures on the screen against direct calls."""
    await ready(user)
    now, advice = told(user, bound)
    better = advice.prediction
    assert both(user, "P_D of the home cell", "P_D") == [
        f"{100 * now.p_detection:.1f} %",
        f"{100 * better.p_detection:.1f} %",
    ]
    assert both(user, "votes in the home cell", "home cell") == [
        f"{100 * now.share:.1f} %",
        f"{100 * better.share:.1f} %",
    ]
    assert both(user, "least votes", "votes ≥")[1] == str(advice.votes)
    return advice


@pytest.mark.parametrize("size", [(160, 48), (120, 36)], ids=["wide", "medium"])
def test_figures_follow_an_edit_and_the_recommendation_is_taken(drive, size):
    async def journey(user):
        view = await user.go("f3")
        advice = await agrees(user)
        await user.sees(f"{100 * advice.prediction.p_detection:.1f} %")
        panel, form = view.query_one(PredictionPanel), user.form
        # Form and prediction stand side by side.
        assert panel.region.width > 36
        assert form.region.width > 40
        assert not panel.region.overlaps(form.region)
        before = both(user, "P_D of the home cell", "P_D")
        drawn = user.drawn(panel.query_one(PredictionDensity))

        # From within a field: the key is not typed there.
        await user.fill(STEP, "0.3")
        await user.until(lambda: user.value(*STEP) == 0.3)
        advice = await agrees(user)
        assert both(user, "P_D of the home cell", "P_D") != before
        assert user.drawn(panel.query_one(PredictionDensity)) != drawn
        edited = user.app.workspace.given
        await user.press("ctrl+t")
        await user.until(lambda: user.value(*STEP) == advice.grid.rho_step)
        entry = user.app.workspace.given.initiators[0]
        assert (entry.grid.theta_bins, entry.votes) == (advice.grid.theta_bins, advice.votes)
        assert (
            entry.parameters.resolved(edited.scenarios[0].context).grid.grid(edited.scenarios[0].context)
            == advice.grid
        )
        await user.until(lambda: user.field(*STEP).text == str(advice.grid.rho_step))
        assert user.field(*ENTRY, "grid", "theta_bins").text == str(advice.grid.theta_bins)
        assert user.field(*ENTRY, "votes").text == str(advice.votes)
        assert user.form.is_sound
        await agrees(user)
        assert len(set(both(user, "P_D of the home cell", "P_D"))) == 1
        await user.press("ctrl+t")
        await user.until(lambda: any("already" in note for note in user.notes))
        # One step takes all of it back.
        await user.press("ctrl+z")
        await user.until(lambda: user.app.workspace.given == edited)
        await user.until(lambda: user.field(*STEP).text == "0.3")
        await agrees(user)

        # Another bound, another recommendation; what is no bound is said.
        field = view.query_one(FalseCellField)
        field.focus()
        await user.until(lambda: field.has_focus)
        await user.type("0,1")
        other = await agrees(user, 0.1)
        assert other.votes != advice.votes
        await user.type("x")
        await user.until(lambda: "'0,1x' is given" in said(user))
        assert panel.advice.votes == other.votes

    drive(journey, "course-report", size=size)


def test_on_a_narrow_screen_form_and_prediction_take_turns(drive):
    async def journey(user):
        view = await user.go("f3")
        panel, form = view.query_one(PredictionPanel), user.form
        assert form.region.area
        assert not panel.region.area
        await user.press("f9")
        await user.until(lambda: panel.region.area and not form.region.area)
        await agrees(user)
        density = panel.query_one(PredictionDensity)
        await user.until(lambda: density.has_focus)
        # Every figure, the bound, and all words are in view.
        await user.sees("in the home cell", "false cells a batch", "memory of the accumulator")
        await user.sees("time a trial, estimated", "False cells ≤", "Ctrl+T takes it", "rising, 1 of 2")
        shown = density.shown
        await user.sees(f"{100 * shown.mean:.1f} %", f"{100 * shown.least:.1f} %", "km).")
        assert panel.max_scroll_y == 0
        await user.press("n")
        await user.sees("2 of 2")
        await user.sees(f"{100 * density.shown.mean:.1f} %")
        await user.press("t")
        await user.until(lambda: user.value(*STEP) != 0.6)
        await user.press("ctrl+z", "f9")
        await user.until(lambda: form.region.area and not panel.region.area)

        # An initiator without an accumulator has the form alone.
        view.take_focus()
        await user.press("j", "j")
        await user.sees("Speed min")
        assert not panel.region.area
        await user.press("f9")
        assert user.form.region.area
        assert not panel.region.area
        assert "This initiator accumulates no votes: nothing is predicted of it" in user.notes
        before = user.app.workspace.given
        await user.press("t")
        assert user.app.workspace.given == before

    drive(journey, "course-report", size=(80, 24))


def test_what_cannot_be_predicted_is_said(drive, home):
    given = load_set("course-report")
    data = given.model_dump(mode="json", exclude_unset=True)
    first = data["scenarios"][0]
    data["scenarios"] = [
        first,
        {**first, "name": "no-noise", "sensor": {**first["sensor"], "sigma": 0}},
        {**first, "name": "no-target", "targets": []},
    ]
    data["initiators"] = data["initiators"][:1]
    data["experiments"] = []
    Path("mine.yaml").write_text(json.dumps(data), encoding="utf-8")

    async def journey(user):
        view = await user.go("f3")
        panel = await ready(user)
        await user.sees("standard on two-crossing", "F10: 2 others")
        await user.press("f10")
        await user.sees("standard on no-noise")
        await user.until(lambda: "Nothing is recommended: the noise is 0" in said(user))
        await user.until(lambda: "Without noise all votes of a line" in said(user))
        assert both(user, "P_D of the home cell", "P_D")[1] == "none"
        assert panel.query_one(PredictionDensity).region.area
        await user.press("t")
        assert any(note.startswith("Nothing is recommended: the noise is 0") for note in user.notes)
        await user.press("f10")
        await user.sees("standard on no-target")
        await user.until(
            lambda: "Nothing is predicted: no-target: there is no target that moves" in said(user)
        )
        assert not panel.query_one(PredictionDensity).region.area
        await user.until(lambda: panel.advice is not None)
        assert said(user).count("there is no target that moves") == 1
        await user.press("f10")
        await user.sees("standard on two-crossing")
        await agrees(user)
        assert user.app.workspace.given == view._given
        assert not user.app.workspace.is_changed

    drive(journey, "mine.yaml", size=(160, 48))
