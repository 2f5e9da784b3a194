from __future__ import annotations

import io

import pytest
from rich.cells import cell_len
from rich.console import Console, RenderableType

from hough_tui.reports.tables import listing, published_table, rate_tables, track_table

WIDTHS = (60, 80, 120, 160)


def drawn(width: int, *tables: RenderableType) -> str:
    console = Console(width=width, file=io.StringIO(), force_terminal=False)
    for table in tables:
        console.print(table)
    return console.file.getvalue()


def whole(text: str) -> str:
    return " ".join(text.split())


def fits(text: str, width: int) -> bool:
    return "…" not in text and all(cell_len(line) <= width for line in text.split("\n"))


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_and_no_line_is_too_long(rows, tracks, published, width):
    names = [("course-report", "two crossing targets " * 12), ("thesis-quantisation-and-weighting", "")]
    tables = [*rate_tables(rows, width), track_table(tracks, width), published_table(published, width)]
    text = drawn(width, *tables, listing("Bundled sets", names, width))
    assert fits(text, width)
    for name in ("standard", "sequential", "success", "false", "100", "course-2-1", "-103.47"):
        assert name in text


@pytest.mark.parametrize("width", WIDTHS)
def test_figures_of_every_row_stand_on_one_line(rows, width):
    text = drawn(width, rate_tables(rows, width)[0])
    lines = [line.split() for line in text.split("\n") if line.startswith(("standard", "sequential-200"))]
    assert [line[:3] for line in lines][:2] == [["standard", "5", "65.0"], ["standard", "10", "80.0"]]
    assert len({len(line) for line in lines}) == 1
    assert len(lines) == 6


def test_one_table_an_experiment(rows):
    tables = rate_tables(rows, 80)
    assert [str(table.title) for table in tables] == [
        "course-report · tables",
        "course-report · wide",
        "course-report · nulls",
    ]
    assert rate_tables([], 80) == []


def test_decimal_points_stand_below_each_other(row):
    rows = [row(scans=scans, success_rate=rate) for scans, rate in ((5, 1.0), (10, 0.05), (100, None))]
    text = drawn(120, *rate_tables(rows, 120))
    lines = [line for line in text.split("\n") if line.startswith("standard")]
    assert lines[0].index("100.0") + 3 == lines[1].index("5.0") + 1
    assert lines[2].index("–") == lines[1].index("5.0")
    # 20.5, 41.0 and 410 false tracks a trial.
    assert lines[0].index("20.5") + 2 == lines[1].index("41.0") + 2 == lines[2].index("410") + 3


def test_wider_terminals_show_more(rows):
    counts = [len(rate_tables(rows, width)[0].columns) for width in WIDTHS]
    assert counts == sorted(counts)
    narrow, wide = (whole(drawn(width, rate_tables(rows, width)[0])) for width in (60, 160))
    assert "A wider terminal also shows" in narrow
    assert "A wider terminal also shows" not in wide
    for heading in ("control", "duplic.", "θ RMSE", "ρ RMSE", "µs", "target 1", "target 2"):
        assert heading in wide


def test_success_by_target_goes_before_other_columns_where_several_targets_differ(row):
    named = {"target_names": ["T1", "T2", None]}
    alike = row(success_by_target=[0.95, 0.9, 0.94], **named)
    unlike = row(success_by_target=[0.95, 0.1, 0.94], **named)
    assert "T2" not in drawn(90, *rate_tables([alike], 90))
    text = drawn(90, *rate_tables([alike, unlike], 90))
    for heading in ("T1", "T2", "target 3"):
        assert heading in text
    assert "10.0" in text
    # A name that not all rows use names no column.
    other = row(success_by_target=[0.95, 0.1, 0.94], target_names=["T1", "T4", None])
    text = drawn(160, *rate_tables([unlike, other], 160))
    assert "T1" in text
    assert "target 2" in text
    assert "T4" not in text


def test_what_was_counted_is_said_once_for_all_who_counted_the_same(row):
    counted = [
        ("cht", {"pairs": 3752.0, "pairs_gated": 44.4}),
        ("cht", {"pairs": 3752.0, "pairs_gated": 45.0}),
        ("logic", {"pairs": 3752.0, "pairs_gated": 44.4}),
        ("lines", {"pairs": 3752.0, "pairs_gated": 45.0}),
        ("lines", {"pairs": 3752.0, "pairs_gated": 44.4}),
    ]
    text = whole(
        drawn(100, *rate_tables([row(initiator=name, effort_per_trial=e) for name, e in counted], 100))
    )
    assert "cht, lines, on the mean of a trial: pairs 3,752, pairs gated 44.4 to 45." in text
    assert "logic, on the mean of a trial: pairs 3,752, pairs gated 44.4." in text


def test_who_ignores_z_is_said(row):
    flat, deep = row(initiator="flat", ignores_z=True), row(initiator="deep", ignores_z=False)
    also = row(initiator="also-flat", ignores_z=True)
    assert "flat works in the plane: z is ignored." in whole(drawn(100, *rate_tables([flat, deep], 100)))
    assert "flat, also-flat work in the plane" in whole(drawn(100, *rate_tables([flat, also], 100)))
    assert "z is ignored" not in whole(drawn(100, *rate_tables([deep], 100)))


def test_criteria_in_words(rows):
    first, second, third = (whole(drawn(100, table)) for table in rate_tables(rows, 100))
    assert "A track matches a target when |Δρ| ≤ 3 km, θ not compared." in first
    assert "A track matches a target when |Δρ| ≤ 3 km and |Δθ| ≤ 6°." in second
    assert "A track matches a target when at least 3 of its plots are the target's own." in third
    assert "1,000 trials a row, seed 7." in first


def test_a_high_control_is_explained(rows, row):
    text = whole(drawn(100, *rate_tables(rows[:1], 100)))
    assert "clutter alone still reaches a success of up to 99.9 % (control)" in text
    assert "clutter alone" not in drawn(100, *rate_tables([row(success_control=0.04)], 100))


def test_trials_without_track_and_votes_outside_are_said(rows):
    text = whole(drawn(100, rate_tables(rows, 100)[1]))
    assert "In up to 12.0 % of a row's trials there is no track at all" in text
    assert "Up to 3.20 votes a trial fall outside the grid" in text


def test_null_values_are_dashes_and_empty_columns_are_left_out(rows):
    table = rate_tables(rows, 160)[2]
    text = drawn(160, table)
    assert any(line.startswith("standard  ") and "–" in line for line in text.split("\n"))
    for absent in ("control", "RMSE", "µs", "None", "nan"):
        assert absent not in text


def test_bare_rows_are_no_error():
    assert "standard" in drawn(
        80, *rate_tables([{"initiator": "standard", "success_rate": float("nan")}], 80)
    )


def test_units_that_differ_stand_beside_their_numbers(row):
    rows = [row(), row(scenario="approach", unit="m", rho_rmse=35.0)]
    text = drawn(160, *rate_tables(rows, 160))
    assert "0.200 km" in text
    assert "35.0   m" in text
    assert "|Δρ| ≤ 3 of the scenario's unit" in text


def test_names_are_not_markup(row):
    assert "a[red]b" in drawn(80, *rate_tables([row("a[red]b")], 80))


def test_tracks_strongest_first(tracks):
    lines = drawn(100, track_table(tracks, 100)).split("\n")
    body = [line.split() for line in lines if line[:1].isdigit() and "  " in line]
    assert [line[1] for line in body] == ["15", "14", "9"]
    # West is a heading of 270°; 0.3 east and 0.18 south of it one of 121°.
    assert body[0][-2:] == ["0.300", "270.0"]
    assert body[1][-2:] == ["0.350", "121.0"]
    assert body[2][-2:] == ["–", "–"]
    assert "km/s" in "\n".join(lines)
    assert "12 votes fell outside the grid" in "\n".join(lines)


def test_only_so_many_tracks(tracks):
    text = drawn(100, track_table(tracks, 100, most=1))
    assert "standard · 3 tracks" in text
    assert "The 1 strongest are shown" in text
    assert "78.90" not in text


def test_tracks_in_three_dimensions():
    track = {"theta_deg": 0.0, "rho": 0.0, "score": 4, "plots": [1], "position": [0, 30000, 2500],
             "velocity": [0, -250, -20], "time": 1.5}  # fmt: skip
    text = drawn(120, track_table({"initiator": "cht", "unit": "m", "tracks": [track]}, 120))
    assert "251    180.0" in text
    assert "30,000  2,500" in text
    assert "Position and velocity at 1.5 s" in text


def test_no_tracks():
    assert "standard · 0 tracks" in drawn(80, track_table({"initiator": "standard", "tracks": []}, 80))


def test_published(published):
    text = drawn(100, published_table(published, 100))
    assert "1 of 2 compared figures agree" in text
    assert text.count("[1]") == 3
    assert "99.7–99.9" in text
    assert "2.90e-6" in text
    assert "4,000 trials an entry." in text
