"""Tables of rates and of trials."""

import asyncio
from types import SimpleNamespace

import numpy as np
import pytest
from textual.app import App

from hough_tui.experiments.columns.initiation import TrialColumns
from hough_tui.experiments.plan import plan_run
from hough_tui.ui.runs.shown_run import RowTrials
from hough_tui.ui.widgets.rate_grid import RateGrid, rate_columns, sort_value
from hough_tui.ui.widgets.track_trials import TrackTrials
from hough_tui.ui.widgets.trial_list import TrialList
from scenarios.files.set_files import load_set


@pytest.fixture(scope="module")
def cell():
    return plan_run([load_set("course-report")]).cells[0]


def row(scans, **given):
    found = {
        "set": "s", "experiment": "e", "scenario": "x", "initiator": "standard", "swept": {"scans": scans},
        "trials": 10, "seed": 1, "unit": "km", "criterion": {"rho": 3.0}, "success_rate": 0.1 * scans,
        "false_track_ratio": 0.5,
    }  # fmt: skip
    return {**found, **given}


def mounted(widget, journey, size=(100, 30)):
    class Host(App[None]):
        def __init__(self):
            super().__init__()
            self.opened = []

        def compose(self):
            yield widget

        def on_trial_list_opened(self, event):
            self.opened.append(event.trial)

    async def work():
        app = Host()
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            widget.focus()
            await pilot.pause()
            await journey(SimpleNamespace(app=app, pilot=pilot))

    asyncio.run(work())


def shown(grid, index):
    return [cell.plain.strip() for cell in grid.get_column_at(index)]


@pytest.mark.parametrize(
    ("less", "more"),
    [("9.5", "10.0"), ("998", "1,234"), (" 0.023 ", "0.5"), ("1.2e-5", "0.001"), ("-0.5", "+0.1"),
     ("9.1–10.2", "12.0–13.0"), ("alpha", "beta")],
)  # fmt: skip
def test_what_is_sorted_is_what_is_seen(less, more):
    assert sort_value(less) < sort_value(more)
    assert sort_value("–") > sort_value(more)


def test_rows_sort_by_any_column_and_what_is_missing_stands_last_either_way():
    grid = RateGrid()
    rows = [row(10), row(5), row(15, success_rate=None), row(2)]

    async def journey(user):
        grid.show_rows(rows)
        await user.pilot.pause()
        assert shown(grid, 1) == ["10", "5", "15", "2"]
        grid.sort_by("success %")
        assert shown(grid, 2) == ["20.0", "50.0", "100.0", "–"]
        assert grid.chosen_index == 0
        grid.sort_by("success %", is_falling=True)
        assert shown(grid, 2) == ["100.0", "50.0", "20.0", "–"]
        grid.sort_by(None)
        assert shown(grid, 1) == ["10", "5", "15", "2"]

    mounted(grid, journey)


def test_a_click_on_a_heading_sorts_turns_and_ends_it():
    grid = RateGrid()

    async def journey(user):
        grid.show_rows([row(10), row(5), row(2)])
        await user.pilot.pause()
        for expected in (["2", "5", "10"], ["10", "5", "2"], ["10", "5", "2"]):
            await user.pilot.click(grid, offset=(15, 1))
            await user.pilot.pause()
            assert shown(grid, 1) == expected
        assert grid.sorted_by is None

    mounted(grid, journey)


def test_a_table_that_fills_keeps_its_cursor_and_gains_columns():
    grid = RateGrid()

    async def journey(user):
        grid.show_rows([row(5, trials=0, success_rate=None), row(10, trials=0, success_rate=None)])
        await user.pilot.pause()
        await user.pilot.press("G")
        assert grid.chosen_index == 1
        before = [column.name for column in grid._shown]
        grid.show_rows([row(5, tracks_per_trial=3.0), row(10, trials=0, success_rate=None)])
        await user.pilot.pause()
        names = [column.name for column in grid._shown]
        assert set(names) - set(before) == {"trials", "tracks /trial"}
        assert grid.chosen_index == 1
        grid.show_rows([row(5, tracks_per_trial=3.0), row(10, tracks_per_trial=2.0)])
        await user.pilot.pause()
        assert "trials" not in [column.name for column in grid._shown]
        assert (grid.chosen_index, grid.row_count) == (1, 2)

    mounted(grid, journey)


def test_vim_keys_move_the_cursor():
    grid = RateGrid()

    async def journey(user):
        grid.show_rows([row(scans) for scans in range(1, 60)])
        await user.pilot.pause()
        for keys, expected in ((("j", "j"), 2), (("k",), 1), (("G",), 58), (("g",), 0), (("down",), 1)):
            await user.pilot.press(*keys)
            assert grid.chosen_index == expected

    mounted(grid, journey, size=(40, 12))


def test_rows_of_several_experiments_name_them():
    columns = rate_columns([row(5), row(5, experiment="other", criterion={"plots": 3})])
    assert columns[0].name == "experiment"
    assert columns[0].cells == ("e", "other")
    assert rate_columns([]) == []


def test_success_by_target_stands_beside_success_when_asked_for():
    grid = RateGrid()

    async def journey(user):
        grid.show_rows([row(5)])
        assert not grid.turn_targets()
        grid.show_rows([row(5, success_by_target=[0.5, 1.0, 0.25]), row(10)])
        headings = [" ".join(column.label.plain.split()) for column in grid.ordered_columns]
        assert headings[-1] == "target 3 %"
        assert grid.turn_targets()
        await user.pilot.pause()
        names = [column.name for column in grid._shown]
        place = names.index("success %")
        assert names[place + 1 : place + 4] == ["target 1 %", "target 2 %", "target 3 %"]
        assert shown(grid, place + 3) == ["25.0", "–"]
        assert grid.turn_targets()
        assert [column.name for column in grid._shown][-3:] == ["target 1 %", "target 2 %", "target 3 %"]

    mounted(grid, journey)


def test_a_row_without_trials_can_be_shown(cell):
    assert [column.name for column in rate_columns([cell.blank()])][:3] == [
        "initiator", "scans", "success %"
    ]  # fmt: skip


def many(cell, count):
    random = np.random.default_rng(3)
    found = random.random((count, 2)) < 0.9
    errors = np.where(found, random.normal(size=(count, 2)), np.nan).astype(np.float32)
    columns = TrialColumns.of(
        0,
        count,
        found=found,
        tracks=random.integers(1, 300, count),
        false=random.integers(0, 50, count),
        duplicates=random.integers(0, 9, count),
        theta_error=errors,
        rho_error=errors,
        control_found=random.random((count, 2)) < 0.1,
    )
    return TrackTrials(RowTrials(cell, columns))


def test_failed_trials_stand_first(cell):
    table = many(cell, 2000)
    columns = table.trials.columns
    order = table.first_order
    keys = [
        (columns.found[row].sum(), -columns.false[row], -columns.duplicates[row], row)
        for row in order.tolist()
    ]
    assert keys == sorted(keys)
    assert f"{int((columns.found.sum(axis=1) < 2).sum()):,} miss a target" in table.words


def test_every_order_holds_every_trial_once(cell):
    table = many(cell, 500)
    columns = table.trials.columns
    first = {
        "failed first": table.first_order[0],
        "trial": 0,
        "tracks": int(columns.tracks.argmax()),
        "false tracks": int(columns.false.argmax()),
        "duplicates": int(columns.duplicates.argmax()),
        "error in ρ": int(np.nanmax(np.abs(columns.rho_error), axis=1, initial=-1.0).argmax()),
        "control": int(columns.control_found.sum(axis=1).argmax()),
    }
    assert first.keys() <= table.orders.keys()
    # What no trial says anything of is neither shown nor sorted by.
    assert "NEES" not in table.orders
    for by in table.orders:
        assert sorted(table.order(by).tolist()) == list(range(500))
        assert table.order(by)[0] == first.get(by, table.order(by)[0])


def test_a_hundred_thousand_trials_open_without_a_line_for_each(cell, monkeypatch):
    table = many(cell, 100_000)
    trials = TrialList(table, table.first_order)
    drawn = set()
    draw = TrialList._trial
    monkeypatch.setattr(TrialList, "_trial", lambda self, line, *_: drawn.add(line) or draw(self, line, *_))

    async def journey(user):
        await user.pilot.pause()
        assert max(drawn) < 40
        assert trials.trial == table.first_order[0]
        await user.pilot.press("G")
        await user.pilot.pause()
        assert trials.cursor == 99_999
        assert trials.render_line(trials.size.height - 1).text.split()[0] == f"{trials.trial:,}"
        assert len(drawn) < 200
        await user.pilot.press("g", "j", "j", "k", "enter")
        await user.pilot.pause()
        assert user.app.opened == [table.first_order[1]]

    mounted(trials, journey)


def test_trials_sort_by_key_and_by_heading(cell):
    table = many(cell, 300)
    trials = TrialList(table, table.first_order)

    async def sorted_by(user, name):
        for _ in range(500):
            if trials.sorted_by == name:
                return
            await user.pilot.pause(0.01)
        raise AssertionError(trials.sorted_by)

    async def journey(user):
        await user.pilot.press("s")
        await sorted_by(user, "trial")
        assert trials.trial == 0
        await user.pilot.press("s", "s")
        await sorted_by(user, "false tracks")
        assert trials.trial == table.trials.columns.false.argmax()
        await user.pilot.click(trials, offset=(5, 1))
        await sorted_by(user, "trial")
        await user.pilot.click(trials, offset=(5, 6))
        assert trials.cursor == 4
        await user.pilot.click(trials, offset=(5, 6))
        await user.pilot.pause()
        assert user.app.opened == [4]

    mounted(trials, journey)


def test_a_trial_that_misses_a_target_says_which(cell):
    table = many(cell, 400)
    trials = TrialList(table, table.first_order)
    columns = table.trials.columns

    async def journey(user):
        line = trials._trial(0, False).text
        worst = int(table.first_order[0])
        assert line.count("missed") == 2 * int((~columns.found[worst]).sum())
        assert f"{int(columns.found[worst].sum())}/2" in line

    mounted(trials, journey)
