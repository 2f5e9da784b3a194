"""From the first run to a set of one's own, and back to it."""

from textual.widgets import Input

from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.rate_grid import RateGrid
from hough_tui.ui.widgets.trial_list import TrialList
from scenarios.files.set_files import load_set

STEP = ("initiators", 0, "grid", "rho_step")
TRIALS = 40


async def seen_accumulator(user):
    """Return the accumulator of Look as it is drawn, once it is drawn for the set as it is."""
    view = await user.go("f4")
    wanted = user.value(*STEP)

    def is_drawn():
        (panel,) = view.query("LookPanel")
        return panel._seen is not None and panel._seen.parameters.grid.rho_step == wanted

    await user.until(is_drawn)
    await user.settle()
    heatmap = view.query_one(Heatmap)
    assert heatmap.region.height > 5
    return user.drawn(heatmap)


async def edit_step(user, text):
    await user.go("f3")
    await user.fill(STEP, text)
    await user.until(lambda: user.value(*STEP) == float(text))


async def run_experiment(user, trials):
    """Run the experiment that is chosen, with so many trials, to its end."""
    view = await user.go("f6")
    await user.click("#run-trials")
    await user.press("home", "shift+end", "delete")
    await user.type(str(trials))
    await user.press("f5")
    await user.until(lambda: view._live is not None)
    await user.until(lambda: not view.is_at_work)
    return view


def test_first_run_edit_look_run_worst_trial_save_and_reopen(drive, home):
    async def first(user):
        await user.screen("Welcome")
        await user.sees("course-report", "course-text", "Open a file")
        await user.press("enter")
        await user.warm()
        await user.sees("course-report (bundled, not saved)")

        # Δρ, and what it does to the accumulator.
        before = await seen_accumulator(user)
        await edit_step(user, "0.3")
        await user.sees("● changed")
        after = await seen_accumulator(user)
        assert after != before
        await edit_step(user, "0.6")
        assert await seen_accumulator(user) == before
        await edit_step(user, "0.3")
        assert await seen_accumulator(user) == after

        # The rates, one row for each number of scans and initiator.
        view = await run_experiment(user, TRIALS)
        await user.sees(f"{6 * TRIALS} trials in", "kept as")
        grid = view.query_one(RateGrid)
        assert grid.row_count == 6
        rows = view._live.rows
        assert [row["trials"] for row in rows] == [TRIALS] * 6
        assert all(row["parameters"]["grid"]["rho_step"] == 0.3 for row in rows[:3])
        assert len(FolderStore().names()) == 1

        # The trials behind the row with the fewest scans; the worst of them comes first.
        grid.move_cursor(row=0)
        await user.press("enter")
        await user.screen("TrialsScreen")
        trials = user.app.screen.query_one(TrialList)
        columns = view._live.trials(0).columns
        worst = trials.trial
        found, false = columns.found.sum(axis=1), columns.false
        assert found[worst] == found.min()
        assert false[worst] == false[found == found.min()].max()
        await user.press("enter")
        await user.screen("MainScreen")
        assert user.tab == "look"
        panel = user.view.query_one("LookPanel")
        await user.until(lambda: panel._seen.picture.trial == worst)
        # The trial is the one that was counted: its scans, its seed, its tracks.
        seen = panel._seen
        assert seen.picture.scenario.scans == rows[0]["swept"]["scans"] == 5
        assert len(seen.tracks) == columns.tracks[worst]
        assert int((seen.state == 0).sum()) == false[worst]
        await user.sees(f"standard on two-crossing, trial {worst}: {columns.tracks[worst]} tracks")
        # It says that it is not the set as it is; another initiator of the set looks at that again.
        await user.sees("tracks · of a run: scans 5 · ")
        await user.press("i")
        await user.sees("sequential on two-crossing")
        assert "of a run" not in user.text

        # A file of one's own.
        await user.press("ctrl+s")
        await user.screen("PathPrompt")
        assert user.app.screen.query_one(Input).value == "course-report.yaml"
        await user.press("home", "shift+end", "delete")
        await user.type("mine.yaml")
        await user.press("enter")
        await user.screen("MainScreen")
        await user.sees("mine.yaml")
        assert "● changed" not in user.text
        await user.press("ctrl+q")
        await user.until(lambda: user.app._exit)

    ended = drive(first, size=(160, 48))
    assert ended.return_code == 0
    saved = ended.workspace.given
    path = home / "work" / "mine.yaml"
    assert load_set(str(path)) == saved

    async def second(user):
        assert user.app.workspace.given == saved
        assert user.app.workspace.path.resolve() == path
        assert not user.app.workspace.is_changed
        await user.go("f3")
        assert user.field(*STEP).text == "0.3"
        await user.go("f7")
        await user.sees("1 run ·", "course-report     6      40     7  tables")

    drive(second, "mine.yaml", size=(160, 48))
    assert path.read_text(encoding="utf-8").count("rho_step: 0.3") == 1
