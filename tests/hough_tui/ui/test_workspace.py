"""The set under edit: paths, defaults, what is refused, undo and redo, what is saved."""

import pytest

from algorithms.errors import RequestError
from algorithms.parameters import FieldError
from hough_tui.ui.workspace import MOST_UNDO, Workspace
from scenarios.files.set_files import load_set, parse_set

SET = """\
schema: 1
name: harbour
scenarios:
  - name: near   # the roads
    unit: km
    scans: 6
    interval: 4
    region: {x: [0, 10], y: [0, 20]}
    sensor: {kind: cartesian, sigma: 0.1}
    targets:
      - {name: ferry, position: [1, 2], velocity: [0.1, 0]}
      - {name: pilot, position: [3, 4], velocity: [0, 0.1]}
  - name: far
    unit: km
    scans: 9
    interval: 4
    region: {x: [0, 10], y: [0, 20]}
    sensor: {kind: cartesian, sigma: 0.1}
initiators:
  - {name: standard, grid: {theta_bins: 45}}
  - {name: sequential}
experiments:
  - {name: rates, scenarios: [near], initiators: [standard], trials: 10, seed: 1, criterion: {rho: 1.0}}
"""
SCANS = ("scenarios", 0, "scans")
TARGETS = ("scenarios", 0, "targets")


@pytest.fixture
def workspace():
    return Workspace(parse_set(SET, "harbour.yaml"), None)


def refused(call, *arguments):
    with pytest.raises(FieldError) as caught:
        call(*arguments)
    return caught.value.problem


def test_a_value_is_put_where_it_stands_and_nothing_else_changes(workspace):
    before = workspace.given
    workspace.set(SCANS, 7)
    assert workspace.value(SCANS) == 7
    assert before.scenarios[0].scans == 6
    assert workspace.given.scenarios[1] == before.scenarios[1]
    assert workspace.given.initiators == before.initiators
    assert workspace.is_changed


def test_values_are_read_with_their_defaults(workspace):
    assert workspace.value(("scenarios", 0, "sensor", "detection_probability")) == 1.0
    assert workspace.value(("initiators", 0, "grid", "theta_bins")) == 45
    assert workspace.value(("scenarios", 0, "targets", 1, "name")) == "pilot"
    assert workspace.value((*TARGETS, 2, "name")) is None
    assert workspace.value(("experiments", 0, "nothing")) is None


def test_a_field_at_its_default_is_written_out_when_it_is_edited(workspace):
    workspace.set(("scenarios", 0, "sensor", "detection_probability"), 0.9)
    assert workspace.value(("scenarios", 0, "sensor", "detection_probability")) == 0.9
    # A whole group that was left to its defaults: only what is edited differs from them.
    defaults = workspace.value(("initiators", 1, "grid"))
    workspace.set(("initiators", 1, "grid", "theta_bins"), 77)
    edited = workspace.value(("initiators", 1, "grid"))
    assert edited == defaults.model_copy(update={"theta_bins": 77})


def test_an_element_of_a_pair_is_edited_alone(workspace):
    workspace.set(("scenarios", 0, "region", "x", 1), 12)
    assert workspace.value(("scenarios", 0, "region", "x")) == (0, 12)


def test_an_optional_field_is_left_empty(workspace):
    path = (*TARGETS, 0, "death")
    assert workspace.value(path) is None
    workspace.set(path, 3)
    assert workspace.value(path) == 3
    workspace.set(path, None)
    assert workspace.value(path) is None
    # As if it had never been given.
    assert not workspace.is_changed
    assert "death" not in workspace.given.scenarios[0].targets[0].model_fields_set


def test_a_field_that_must_be_given_is_not_left_empty(workspace):
    problem = refused(workspace.set, SCANS, None)
    assert problem.path == SCANS
    assert workspace.value(SCANS) == 6


def test_elements_come_and_go(workspace):
    workspace.insert((*TARGETS, 1), {"name": "tug", "position": [5, 5], "velocity": [0.1, 0]})
    assert [target.name for target in workspace.value(TARGETS)] == ["ferry", "tug", "pilot"]
    workspace.remove((*TARGETS, 0))
    assert [target.name for target in workspace.value(TARGETS)] == ["tug", "pilot"]
    # Into a list that the file does not have.
    clutter = ("scenarios", 1, "clutter")
    assert workspace.value(clutter) == []
    workspace.insert((*clutter, 0), {"kind": "poisson", "rate": 5})
    assert workspace.value((*clutter, 0, "rate")) == 5
    workspace.remove((*clutter, 0))
    assert workspace.value(clutter) == []


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (SCANS, 0, "0 is given; it must be at least 1"),
        (("scenarios", 0, "sensor", "detection_probability"), 1.5, "1.5 is given; it must be at most 1"),
        (("initiators", 0, "grid", "rho_step"), -1.0, "-1.0 is given; it must be greater than 0"),
        ((*TARGETS, 1, "position"), [1.0], "2"),
        (("scenarios", 0, "unit"), "mile", "nmi"),
    ],
)
def test_what_is_not_valid_is_refused_at_its_field_and_changes_nothing(workspace, path, value, words):
    before = workspace.given
    problem = refused(workspace.set, path, value)
    assert problem.path[: len(path)] == path
    assert words in problem.message
    assert workspace.given is before
    assert not workspace.is_changed
    assert workspace.undoable is None


def test_of_several_problems_the_one_nearest_to_the_edit_is_told(workspace):
    # Without its scenario the experiment is wrong too; what was edited is the name in use.
    problem = refused(workspace.remove, ("scenarios", 0))
    assert "near" in problem.message
    # A name that another one has is wrong where it was typed.
    problem = refused(workspace.set, ("scenarios", 1, "name"), "near")
    assert problem.path == ("scenarios", 1, "name")
    # Two fields that do not fit are wrong at the one that was edited.
    workspace.set((*TARGETS, 1, "death"), 4)
    problem = refused(workspace.set, (*TARGETS, 1, "birth"), 5)
    assert problem.path[:4] == (*TARGETS, 1)


def test_a_new_name_is_put_where_the_old_one_is_referred_to(workspace):
    workspace.set(("scenarios", 0, "name"), "close")
    workspace.set(("initiators", 0, "name"), "classic")
    assert workspace.value(("experiments", 0, "scenarios")) == ["close"]
    assert workspace.value(("experiments", 0, "initiators")) == ["classic"]
    assert workspace.value(("initiators", 0, "initiator")) == "standard"


def test_edits_are_taken_back_and_done_again(workspace):
    states = [workspace.given]
    workspace.set(SCANS, 7)
    states.append(workspace.given)
    workspace.remove((*TARGETS, 0))
    states.append(workspace.given)
    workspace.insert((*TARGETS, 0), {"position": [1, 1], "velocity": [0.1, 0]})
    states.append(workspace.given)

    assert "targets" in workspace.undoable
    for state in reversed(states[:-1]):
        assert workspace.undo()
        assert workspace.given == state
    assert workspace.undo() is None
    assert not workspace.is_changed
    assert "scans" in workspace.redoable
    for state in states[1:]:
        assert workspace.redo()
        assert workspace.given == state
    assert workspace.redo() is None


def test_what_is_typed_into_one_field_is_one_edit(workspace):
    for value in (1, 12, 120):
        workspace.set(SCANS, value)
    workspace.set(("scenarios", 1, "scans"), 10)
    assert workspace.undo()
    assert workspace.value(SCANS) == 120
    assert workspace.undo()
    assert workspace.value(SCANS) == 6


def test_rows_are_added_one_by_one(workspace):
    for _ in range(3):
        workspace.insert((*TARGETS, 2), {"position": [1, 1], "velocity": [0.1, 0]})
    workspace.undo()
    assert len(workspace.value(TARGETS)) == 4


def test_an_edit_after_undo_drops_what_could_be_done_again(workspace):
    workspace.set(SCANS, 7)
    workspace.undo()
    assert workspace.redoable is not None
    workspace.set(("scenarios", 1, "scans"), 8)
    assert workspace.redoable is None
    assert workspace.redo() is None
    assert workspace.value(SCANS) == 6


def test_an_edit_that_changes_nothing_is_none(workspace):
    workspace.set(SCANS, 6)
    assert workspace.undoable is None
    assert not workspace.is_changed


def test_only_so_many_edits_can_be_undone(workspace):
    fields = (SCANS, ("scenarios", 1, "scans"))
    for number in range(MOST_UNDO + 7):
        workspace.set(fields[number % 2], 20 + number)
    undone = 0
    while workspace.undo() is not None:
        undone += 1
    assert undone == MOST_UNDO
    assert workspace.value(SCANS) == 20 + 6
    assert workspace.value(("scenarios", 1, "scans")) == 20 + 5


def test_what_is_saved_is_no_longer_changed_and_undo_changes_it_again(workspace, tmp_path):
    path = tmp_path / "harbour.yaml"
    path.write_text(SET, encoding="utf-8")
    opened = Workspace(load_set(str(path)), path)
    opened.set(SCANS, 7)
    assert opened.is_changed
    assert opened.save() == path
    assert not opened.is_changed
    assert load_set(str(path)) == opened.given
    assert "# the roads" in path.read_text(encoding="utf-8")
    opened.undo()
    assert opened.is_changed
    opened.redo()
    assert not opened.is_changed

    other = tmp_path / "other.yaml"
    assert opened.save(other) == other
    assert opened.path == other


def test_what_cannot_be_saved_stays_changed(workspace, tmp_path):
    workspace.set(SCANS, 7)
    with pytest.raises(RequestError):
        workspace.save(tmp_path / "no-such-folder" / "harbour.yaml")
    assert workspace.is_changed
    assert workspace.path is None


def test_recovered_work_is_changed_against_the_file(workspace):
    other = Workspace(workspace.given, None)
    other.set(SCANS, 8)
    found = workspace.recovered(other.given)
    assert found.given == other.given
    assert found.is_changed
    assert not workspace.is_changed
    found.set(SCANS, 6)
    assert not found.is_changed


def test_work_without_a_file_is_changed(workspace):
    workspace.forget_saved()
    assert workspace.is_changed
