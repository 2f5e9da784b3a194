"""Clustering: draws of scenes, step by step, the forms beside them, and the way from rates to a trial."""

import threading

import numpy as np
import pytest

from hough_tui.experiments.plan import plan_run
from hough_tui.inspection.scene import cluster_look, scene_picture
from hough_tui.ui.views.cluster_panel import ClusterPanel
from hough_tui.ui.widgets.cluster_plane import ClusterPlane
from hough_tui.ui.widgets.step_list import StepList

SET = "range-doppler"
INTERFERENCE = 5
"""Place in the set of the scene of that name."""


async def clustering(user, scene=None):
    """Open the view, and return its panel when a draw is seen."""
    view = await user.go("f11")
    panel = view.query(ClusterPanel).first()
    await user.until(lambda: panel._seen)
    if scene is not None:
        view.choose_part("scenes", scene)
        await user.until(lambda: panel._seen.picture.scene.name == view._given.scenes[scene].name)
    view.take_focus()
    await user.settle()
    return panel


def expected(user, scene, entry=0, trial=0):
    """Return what the set's clustering makes of a draw, worked out anew."""
    given = user.app.workspace.given
    found, chosen = given.scenes[scene], given.clusterings[entry]
    return cluster_look(scene_picture(found, 1, trial), chosen.name, chosen.parameters)


@pytest.mark.parametrize("size", [(80, 24), (160, 48)], ids=["narrow", "wide"])
def test_keys_go_through_the_steps_and_back_to_the_clusters(drive, size):
    async def journey(user):
        panel = await clustering(user, INTERFERENCE)
        plane, steps = panel.query_one(ClusterPlane), expected(user, INTERFERENCE).steps
        assert len(steps) > 5
        assert plane.step is None
        await user.sees(f"{len(steps)} steps led here")
        for index, step in enumerate(steps):
            await user.press(".")
            assert np.array_equal(plane.step.members, step.points)
            await user.sees(f"step {index} · ")
        await user.press(".")
        assert plane.step is None
        await user.press(",", ",")
        assert np.array_equal(plane.step.members, steps[-2].points)
        await user.press("escape")
        assert plane.step is None
        await user.press(",")
        assert panel.step == len(steps) - 1

    drive(journey, SET, size=size)


def test_a_key_fills_the_plane_with_the_set_or_the_cluster_and_takes_it_back(drive):
    async def journey(user):
        panel = await clustering(user, INTERFERENCE)
        plane, steps = panel.query_one(ClusterPlane), expected(user, INTERFERENCE).steps
        everything = plane.limits
        await user.press("z")
        assert plane.limits == everything
        whole = next(index for index, step in enumerate(steps) if step.cluster is not None)
        await user.press(*"." * (whole + 1), "z")
        shown = plane.limits
        for around in (plane.scene.position[steps[whole].points], plane.step.ellipse, plane.step.box):
            assert shown.holds(around[:, 0], around[:, 1]).all()
        assert shown.right - shown.left < 0.5 * (everything.right - everything.left)
        # The next set is shown where the plane is, until it is asked for.
        await user.press("comma")
        assert plane.limits == shown
        await user.press("z")
        assert plane.limits != shown
        await user.press("z")
        assert plane.limits == everything
        await user.press("escape", "t", "t", "z")
        ellipse = plane.scene.ellipses[1]
        assert plane.cluster == 1
        assert plane.limits.holds(ellipse[:, 0], ellipse[:, 1]).all()
        assert plane.limits != everything
        await user.press("z")
        assert plane.limits == everything

    drive(journey, SET, size=(160, 48))


def test_the_first_draw_is_announced_until_it_is_there(drive, monkeypatch):
    from hough_tui.ui.views import clustering as module

    may_go_on, draw = threading.Event(), module.scene_picture

    def late(*arguments):
        may_go_on.wait(60)
        return draw(*arguments)

    async def journey(user):
        monkeypatch.setattr(module, "scene_picture", late)
        await user.go("f11")
        try:
            await user.sees("Drawing the scene …")
        finally:
            may_go_on.set()
        await user.sees("recommended on same-doppler, trial 0")

    drive(journey, SET, size=(80, 24))


def test_the_list_of_steps_is_the_tree_and_choosing_a_line_shows_it(drive):
    async def journey(user):
        panel = await clustering(user, INTERFERENCE)
        listed, plane = panel.query_one(StepList), panel.query_one(ClusterPlane)
        steps = expected(user, INTERFERENCE).steps
        assert listed.row_count == len(steps) + 1
        verdicts = [str(listed.get_row_at(row)[2]) for row in range(listed.row_count)]
        assert verdicts[0] == "2 clusters of 2 targets"
        for step, words in zip(steps, verdicts[1:], strict=True):
            if step.axis is not None:
                assert words.startswith(f"split in {'Doppler' if step.axis == 'doppler' else 'range'}")
            else:
                assert words == (f"cluster {step.cluster}" if step.cluster is not None else "too few points")
        # A step hangs below the one it is a part of.
        for index, step in enumerate(steps):
            branch = str(listed.get_row_at(index + 1)[0])
            assert len(branch) - len(branch.lstrip(" │├└")) == 2 * step.depth
        listed.focus()
        await user.press("j", "j", "down")
        assert panel.step == 2
        assert np.array_equal(plane.step.members, steps[2].points)
        await user.press("k", "k", "k")
        assert plane.step is None
        # Keys of the panel move the cursor of the list.
        await user.press(".", ".")
        await user.until(lambda: listed.chosen == "1")

    drive(journey, SET, size=(160, 48))


def test_modes_that_do_not_split_say_so(drive):
    async def journey(user):
        panel = await clustering(user)
        for name in ("corrected-patent", "dbscan", "k-means"):
            await user.press("i")
            await user.until(lambda name=name: panel._seen.name == name)
            if name == "corrected-patent":
                assert panel._seen.steps
                continue
            await user.sees(f"{name} does not split: there are no steps")
            assert not panel.query_one(StepList).display
            await user.press(".")
            assert user.notes[-1] == f"{name} does not split: there are no steps"
            assert panel.step is None
        await user.press("i")
        await user.until(lambda: panel._seen.name == "recommended")
        await user.press("I")
        await user.until(lambda: panel._seen.name == "k-means")

    drive(journey, SET, size=(160, 48))


def test_draws_and_scenes_follow_each_other(drive):
    async def journey(user):
        panel = await clustering(user)
        await user.press("]", "]", "[")
        await user.until(lambda: panel._seen.picture.trial == 1)
        points = expected(user, 0, trial=1).found.clusters.points
        assert np.array_equal(panel._seen.found.clusters.points.range, points.range)
        await user.press("[", "[")
        await user.until(lambda: panel._seen.picture.trial == 0)
        await user.press("s")
        await user.until(lambda: panel._seen.picture.scene.name == "separated")
        await user.press("f10")
        await user.until(lambda: panel._seen.picture.scene.name == "unequal")

    drive(journey, SET, size=(160, 48))


def test_an_edited_extent_changes_the_clusters_and_undo_takes_it_back(drive):
    async def journey(user):
        panel = await clustering(user)
        view = user.view
        before = panel._seen.found.clusters
        assert len(before) == 2
        await user.press(".", ".")
        form = view.form("clusterings").query_one("ModelForm")
        path = ("clusterings", 0, "range_extent")
        form.focus_field(path)
        await user.press("home", "shift+end", "delete")
        await user.type("3")
        await user.until(lambda: user.value(*path) == 3)
        await user.until(lambda: len(panel._seen.found.clusters) > 2)
        assert len(panel._seen.steps) == len(expected(user, 0).steps)
        # The step that is looked at is still the same.
        assert panel.step == 1
        await user.sees("● changed")
        await user.press("ctrl+z")
        await user.until(lambda: len(panel._seen.found.clusters) == 2)
        assert user.value(*path) == 16
        await user.until(lambda: "● changed" not in user.text)
        # What is wrong stands beside the field, and nothing else is shown meanwhile.
        form.focus_field(path)
        await user.press("home", "shift+end", "delete")
        await user.type("0")
        await user.sees("0 is given; it must be greater than 0")
        assert user.value(*path) == 16
        await user.press("ctrl+z")

    drive(journey, SET, size=(160, 48))


def test_targets_are_edited_in_a_table_and_a_new_one_stands_in_the_middle(drive):
    async def journey(user):
        panel = await clustering(user)
        form = user.view.form("scenes").query_one("ModelForm")
        table = form.table(("scenes", 0, "targets"))
        headings = [column.label for column in table._columns]
        assert {"Scatter range", "Scatter doppler", "Spread range", "Spread doppler"} <= set(headings)
        assert table.worked_out_cells(user.value("scenes", 0, "targets", 0)) == ["8.49", "5.66"]
        form.focus_field(("scenes", 0, "targets"))
        await user.press("a")
        await user.until(lambda: len(user.value("scenes", 0, "targets")) == 3)
        assert (
            user.value("scenes", 0, "targets", 1).range,
            user.value("scenes", 0, "targets", 1).doppler,
        ) in (
            (60, 45),
            (75, 45),
        )
        await user.until(lambda: len(panel._seen.picture.drawn.centres[0]) == 3)
        await user.press("escape", "d")
        await user.until(lambda: len(user.value("scenes", 0, "targets")) == 2)

    drive(journey, SET, size=(160, 48))


def test_on_a_narrow_terminal_the_parts_take_turns(drive):
    async def journey(user):
        panel = await clustering(user)
        view = user.view
        parts = {
            "plane": panel.query_one("#plane-side"),
            "steps": panel.query_one("#step-side"),
            "clusterings": view.form("clusterings"),
            "scenes": view.form("scenes"),
        }
        for name in ("plane", "steps", "clusterings", "scenes", "plane"):
            await user.until(lambda name=name: view.panel == name)
            await user.settle()
            assert [part for part, widget in parts.items() if widget.size.area] == [name]
            await user.press("f9")

    drive(journey, SET, size=(80, 24))


def test_two_clusterings_side_by_side(drive):
    async def journey(user):
        await clustering(user)
        view = user.view
        await user.press("b")
        assert "Two clusterings side by side need 120 columns" in user.notes[-1]
        await user.press("f8")
        view.take_focus()
        await user.press("b")
        await user.until(lambda: len(view.query(ClusterPanel)) == 2)
        first, second = view.query(ClusterPanel)
        await user.until(lambda: first._seen and second._seen)
        assert (first._seen.name, second._seen.name) == ("recommended", "corrected-patent")
        assert first._seen.picture is second._seen.picture
        await user.until(lambda: second.size.width >= 55)
        await user.press("b")
        await user.until(lambda: len(view.query(ClusterPanel)) == 1)

    drive(journey, SET, size=(130, 40))


def test_a_set_without_scenes_says_what_to_do_and_gets_one(drive):
    async def journey(user):
        view = await user.go("f11")
        await user.sees("The set has no scene of the range-Doppler plane.", "a adds one")
        await user.press("a")
        await user.until(lambda: user.value("scenes") and user.value("clusterings"))
        panel = view.query_one(ClusterPanel)
        await user.until(lambda: panel._seen)
        assert panel._seen.name == "recommended"
        await user.sees("2 clusters of 2 targets")
        await user.press("a")
        await user.screen("Choice")
        await user.press("down", "down", "enter")
        await user.until(lambda: len(user.value("clusterings")) == 2)
        await user.until(lambda: panel._seen.name == "corrected-patent")
        await user.press("ctrl+z", "ctrl+z", "ctrl+z")
        await user.sees("The set has no scene of the range-Doppler plane.")

    drive(journey, "course-report", size=(120, 40))


def test_the_forms_copy_and_remove(drive):
    async def journey(user):
        panel = await clustering(user)
        view = user.view
        await user.click("#form-clusterings #copy")
        await user.until(lambda: len(user.value("clusterings")) == 5)
        assert (user.value("clusterings", 4).name, user.value("clusterings", 4).mode) == (
            "recommended-2",
            "recommended",
        )
        await user.until(lambda: panel._seen.name == "recommended-2")
        await user.click("#form-clusterings #remove")
        await user.until(lambda: len(user.value("clusterings")) == 4)
        await user.until(lambda: panel._seen.name == "k-means")
        await user.click("#form-scenes #copy")
        await user.until(lambda: view._scene == 7 and user.value("scenes", 7).name == "same-doppler-2")

    drive(journey, SET, size=(160, 48))


def test_the_tree_lists_scenes_and_clusterings_and_shows_them(drive):
    async def journey(user):
        panel = await clustering(user)
        await user.sees("▼ scenes", "▼ clusterings", "corrected-patent")
        tree = user.main.query_one("SetTree")
        assert "initiators" not in user.text or user.value("initiators")
        tree.post_message(tree.Chosen("scenes", 3))
        await user.until(lambda: panel._seen.picture.scene.name == "diagonal")
        tree.post_message(tree.Chosen("clusterings", 2))
        await user.until(lambda: panel._seen.name == "dbscan")

    drive(journey, SET, size=(160, 48))


def test_plots_are_copied_as_csv(drive, home):
    async def journey(user):
        panel = await clustering(user)
        await user.press("y")
        (path,) = (home / "data").rglob("*-recommended-clusters.csv")
        lines = path.read_text().splitlines()
        assert lines[0].startswith("scan,range,doppler,amplitude")
        assert len(lines) == 1 + len(panel._seen.found.clusters)

    drive(journey, SET)


def test_what_a_mode_cannot_do_is_said(drive):
    async def journey(user):
        panel = await clustering(user)
        await user.press("I")
        await user.until(lambda: panel._seen.name == "k-means")
        form = user.view.form("clusterings").query_one("ModelForm")
        form.focus_field(("clusterings", 3, "number"))
        await user.press("home", "shift+end", "delete")
        await user.type("99")
        await user.sees("k-means on same-doppler, trial 0", "k-means is to find 99 targets")

    drive(journey, SET, size=(160, 48))


def test_from_steps_and_an_edit_to_the_worst_trial_of_a_run(drive):
    async def journey(user):
        panel = await clustering(user, INTERFERENCE)
        view = user.view
        await user.press(".", ".", ",")
        assert panel.step == 0
        form = view.form("clusterings").query_one("ModelForm")
        path = ("clusterings", 0, "doppler_extent")
        form.focus_field(path)
        await user.press("home", "shift+end", "delete")
        await user.type("4")
        await user.until(lambda: len(panel._seen.found.clusters) > 2)
        await user.press("ctrl+z")
        await user.until(lambda: len(panel._seen.found.clusters) == 2)

        monte_carlo = await user.go("f6")
        await user.sees("Each way to cluster on each kind of scene")
        monte_carlo.query("RunField").first().focus()
        await user.type("40")
        await user.press("f5")
        rates = monte_carlo.query_one("RatePanel")
        await user.until(lambda: not monte_carlo.is_at_work and rates.display and rates.shown)
        await user.sees("exact", "RMSE", "1,120 trials in")
        rows = rates.shown.rows
        index = next(
            place
            for place, row in enumerate(rows)
            if (row["scene"], row["clustering"]) == ("interference", "corrected-patent")
        )
        assert rows[index]["count_exact_rate"] < 0.5
        rates.grid.focus()
        rates.grid.move_to(str(index))
        await user.press("enter")
        await user.screen("TrialsScreen")
        await user.sees("interference · corrected-patent", "clusters", "excess", "with too many")
        listed = user.app.screen.query_one("TrialList")
        columns = rates.shown.trials(index).columns
        worst = np.abs(columns.excess).max()
        assert abs(columns.excess[listed.trial]) == worst
        trial = listed.trial
        await user.press("s")
        await user.until(lambda: listed.sorted_by == "trial")
        await user.until(lambda: listed.trial == 0)
        await user.press("s", "s", "s")
        await user.until(lambda: listed.sorted_by == "failed first" and listed.trial == trial)
        await user.press("enter")
        await user.until(lambda: user.tab == "clustering")
        await user.until(lambda: panel._seen.picture.trial == trial)
        assert (panel._seen.name, panel._seen.picture.scene.name) == ("corrected-patent", "interference")
        assert len(panel._seen.found.clusters) - 2 == columns.excess[trial]
        await user.sees("of a run")

    drive(journey, SET, size=(160, 48))


def test_a_trial_opens_with_the_values_that_were_swept(drive):
    async def journey(user):
        panel = await clustering(user)
        given = user.app.workspace.given
        data = given.experiments[0].model_copy(
            update={"sweep": {"clustering.range_extent": [16.0, 4.0]}, "clusterings": ["recommended"]}
        )
        cell = plan_run([given.model_copy(update={"experiments": [data]})]).cells[1]
        assert cell.swept == {"clustering.range_extent": 4.0}
        user.main.open_trial(type("Opened", (), {"cell": cell, "trial": 7})())
        await user.until(lambda: panel._seen.picture.trial == 7)
        assert panel._seen.found.parameters.range_extent == 4.0
        await user.sees("range_extent 4")
        # The set's own values are shown again when something is edited or chosen.
        await user.press("i")
        await user.until(lambda: panel._seen.name == "corrected-patent")
        assert panel._seen.found.parameters.range_extent == 16.0

    drive(journey, SET, size=(160, 48))


def test_rates_of_clustering_have_charts_of_their_own_metrics(drive):
    async def journey(user):
        await clustering(user)
        monte_carlo = await user.go("f6")
        monte_carlo.query("RunField").first().focus()
        await user.type("20")
        await user.press("f5")
        rates = monte_carlo.query_one("RatePanel")
        await user.until(lambda: not monte_carlo.is_at_work and rates.display and rates.shown)
        chart = rates.chart
        assert chart.metric == "count_exact_rate"
        seen = [chart.metric]
        rates.grid.focus()
        for _ in range(4):
            await user.press("m")
            seen.append(chart.metric)
        assert {"too_few_rate", "too_many_rate", "excess_per_trial"} <= set(seen)
        await user.press("t")
        assert "have no tracks" in user.notes[-1]
        assert chart.metric == seen[-1]

    drive(journey, SET, size=(160, 48))


def test_a_new_experiment_is_of_the_kind_that_is_chosen(drive):
    async def journey(user):
        await clustering(user)
        monte_carlo = await user.go("f6")
        await user.press("f9")
        count = len(user.value("experiments"))
        await user.click("ExperimentForm #add")
        await user.screen("Choice")
        await user.press("down", "enter")
        await user.until(lambda: len(user.value("experiments")) == count + 1)
        assert user.value("experiments", count).kind == "clustering"
        await user.until(lambda: monte_carlo.query_one("ExperimentForm").region.height > 0)
        await user.sees("clustering")

    drive(journey, SET, size=(160, 48))


@pytest.mark.parametrize("name", ["course-report", SET])
def test_targets_say_how_far_they_extend_where_a_sensor_resolves_it(drive, name):
    async def journey(user):
        table = (await user.go("f2")).query_one("ModelForm").table(("scenarios", 0, "targets"))
        is_told = any(column.path[0] == "extended" for column in table._columns)
        assert is_told == (name == SET)

    drive(journey, name, size=(160, 48))
