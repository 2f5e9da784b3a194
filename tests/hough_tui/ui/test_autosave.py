"""Unsaved work, kept aside."""

import json
from pathlib import Path

import pytest

from hough_tui.ui.autosave import aside_file, forget, keep_aside, read_aside, unsaved_work
from hough_tui.ui.workspace import Workspace
from scenarios.files.set_files import load_set


@pytest.fixture
def given(home):
    """A set that differs from the bundled one."""
    workspace = Workspace(load_set("course-report"), None)
    workspace.set(("scenarios", 0, "scans"), 9)
    return workspace.given


def test_what_is_kept_aside_is_read_back_as_it_was(given, home):
    path = Path("mine.yaml")
    file = keep_aside(given, path)
    assert file.is_relative_to(home / "state" / "hough-tui")
    kept = read_aside(file)
    assert kept.given == given
    # The place does not depend on the folder that one works in next time.
    assert kept.path == path.resolve()
    assert kept.file == file
    assert unsaved_work() == [kept]


def test_a_later_state_takes_the_place_of_the_one_before(given):
    first = keep_aside(given, None)
    workspace = Workspace(given, None)
    workspace.set(("scenarios", 0, "scans"), 11)
    assert keep_aside(workspace.given, None) == first
    (kept,) = unsaved_work()
    assert kept.given.scenarios[0].scans == 11


def test_each_file_has_a_place_of_its_own(given, tmp_path):
    paths = [None, tmp_path / "a" / "mine.yaml", tmp_path / "b" / "mine.yaml"]
    files = {keep_aside(given, path) for path in paths}
    assert len(files) == 3
    assert {kept.path for kept in unsaved_work()} == set(paths)
    forget(given.name, paths[1])
    assert {kept.path for kept in unsaved_work()} == {paths[0], paths[2]}
    # What is not there can be forgotten as well.
    forget(given.name, paths[1])


def test_the_newest_comes_first(given, tmp_path):
    for day in ("2025-01-02", "2025-03-04", "2024-05-06"):
        file = keep_aside(given, tmp_path / day)
        content = json.loads(file.read_text(encoding="utf-8"))
        content["when"] = f"{day} 12:00:00"
        file.write_text(json.dumps(content), encoding="utf-8")
    assert [kept.when[:10] for kept in unsaved_work()] == ["2025-03-04", "2025-01-02", "2024-05-06"]


@pytest.mark.parametrize(
    "damage",
    [
        b"",
        b"{",
        b"[]",
        b"null",
        b"\xff\xfe\x00",
        b'{"path": null, "when": "2025-01-01 00:00:00"}',
        b'{"path": null, "when": "2025-01-01 00:00:00", "set": 5}',
        b'{"path": null, "when": "2025-01-01 00:00:00", "set": "schema: 99"}',
        b'{"path": null, "when": "2025-01-01 00:00:00", "set": "schema: ["}',
    ],
)
def test_what_is_damaged_is_left_out(given, damage):
    sound = keep_aside(given, None)
    (sound.parent / "damaged-0123456789.json").write_bytes(damage)
    (kept,) = unsaved_work()
    assert kept.given == given
    sound.write_bytes(damage)
    assert read_aside(sound) is None
    assert unsaved_work() == []


def test_an_odd_time_does_no_harm(given, tmp_path):
    keep_aside(given, None)
    file = keep_aside(given, tmp_path / "mine.yaml")
    content = json.loads(file.read_text(encoding="utf-8"))
    content["when"] = 5
    file.write_text(json.dumps(content), encoding="utf-8")
    assert len(unsaved_work()) == 2


def test_where_nothing_was_kept_nothing_is_found(home):
    assert unsaved_work() == []
    assert read_aside(aside_file("course-report", None)) is None


def test_a_full_or_forbidden_place_is_told(given, home):
    (home / "state").mkdir()
    (home / "state" / "hough-tui").write_text("in the way", encoding="utf-8")
    with pytest.raises(OSError, match="unsaved"):
        keep_aside(given, None)
    assert unsaved_work() == []
