"""An experiment made in the application, from the form to its rates."""

from textual.widgets import Select

from scenarios.files.set_files import load_set

BASE = ("experiments",)


def test_an_experiment_is_made_edited_run_and_saved(drive, home):
    async def journey(user):
        await user.go("f6")
        await user.press("f9")
        chosen = user.view.query_one("RunForm Select", Select)
        assert user.form.model.name == chosen.value == "tables"
        # A copy of it is shown at once.
        await user.click("ExperimentForm #copy")
        await user.until(lambda: chosen.value == "tables-2" and user.form.model.name == "tables-2")
        at = len(user.app.workspace.given.experiments) - 1
        # While its name is typed it stays the one that is shown.
        await user.fill((*BASE, at, "name"), "short")
        await user.until(lambda: chosen.value == "short")
        assert user.form.model.name == "short"
        # What is wrong stands beside the field, and nothing runs.
        field = await user.fill((*BASE, at, "scenarios"), "nowhere")
        await user.until(lambda: field.problem)
        await user.press("f5")
        assert not user.view.is_at_work
        await user.fill((*BASE, at, "scenarios"), "two-crossing")
        await user.fill((*BASE, at, "sweep"), "scans: 5, 6")
        await user.fill((*BASE, at, "trials"), "20")
        await user.until(lambda: user.value(*BASE, at, "trials") == 20)
        # F1 tells of the view and of the field; in a text, which takes ? as it is, first of the field.
        await user.press("f1")
        await user.screen("HelpScreen")
        await user.sees("Runs an experiment of the set", "Trials: ", "? tells more")
        await user.press("escape")
        user.form.focus_field((*BASE, at, "sweep"))
        await user.settle()
        await user.press("f1")
        await user.screen("ExplanationScreen")
        await user.press("f1")
        await user.screen("HelpScreen")
        await user.press("escape")
        # Running shows the rates in place of the form.
        await user.press("f5")
        await user.until(lambda: not user.view.is_at_work and user.view.query_one("RatePanel").display)
        await user.sees("80 trials in")
        await user.press("f12")
        await user.screen("PathPrompt")
        await user.press("ctrl+u")
        await user.type("own.yaml")
        await user.press("enter")
        await user.until(lambda: (home / "work" / "own.yaml").exists())
        await user.screen("MainScreen")
        # Removed, and brought back.
        await user.press("f9")
        await user.click("ExperimentForm #remove")
        await user.until(lambda: len(user.app.workspace.given.experiments) == at)
        await user.press("ctrl+z")
        await user.until(lambda: len(user.app.workspace.given.experiments) == at + 1)

    drive(journey, "course-report", size=(80, 24))
    kept = load_set(str(home / "work" / "own.yaml")).experiments[-1]
    assert (kept.name, kept.trials, kept.sweep) == ("short", 20, {"scans": [5, 6]})
