"""Scenario sets as files: found by name, read, saved, and saved over what a person has written."""

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from algorithms.errors import RequestError
from algorithms.initiators.registry import initiators
from scenarios.experiments import LARGEST_SEED
from scenarios.files import set_files as files
from scenarios.files.bundled import bundled_paths
from scenarios.files.marked_yaml import read
from scenarios.files.set_files import (
    LARGEST_FILE,
    bundled_sets,
    load_set,
    locate,
    parse_set,
    read_text,
    save_set,
    set_data,
)
from scenarios.model import ScenarioSet

TEXT = """\
# What this set is for.
schema: 1
name: mine

experiments:            # first, as I like it
  - name: only
    criterion: {rho: 3.5} # km
    trials: 50
    seed: 2             # not 1
scenarios:
  # A small world.
  - targets: []
    scans: 5
    interval: 4.5   # s
    name: one
    sensor: {detection_probability: 0.9, sigma: 0.1}
    region:
      y: [0.5, 50.5]  # low
      x: [0.5, 99.5]
initiators:
  - name: standard
    votes: 4      # of five
"""


def parsed(text: str = TEXT) -> ScenarioSet:
    return parse_set(text, "mine.yaml")


def refusal(call, *arguments) -> str:
    with pytest.raises(RequestError) as caught:
        call(*arguments)
    return str(caught.value)


# Finding


def test_a_bundled_set_is_found_by_its_bare_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert locate("course-report") == bundled_paths()["course-report"]
    assert load_set("course-report").name == "course-report"
    # A file of that name goes before it.
    Path("course-report").write_text(TEXT)
    assert locate("course-report") == Path("course-report")
    assert load_set("course-report").name == "mine"


def test_bundled_sets_are_named_as_their_files():
    found = bundled_sets()
    assert [bundled.name for bundled in found] == list(bundled_paths())
    for bundled in found:
        given = load_set(bundled.path)
        assert given.name == bundled.name
        assert given.description == bundled.description != ""
        assert given.experiments


def test_what_is_neither_a_file_nor_a_bundled_set(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "did you mean 'course-text'?" in refusal(load_set, "course-tex")
    assert refusal(load_set, "course-text.yaml") == "course-text.yaml: there is no such file"
    assert refusal(load_set, "sets/course-text") == "sets/course-text: there is no such file"
    assert refusal(load_set, ".").startswith(".: this is a folder")


# Reading


def test_a_byte_order_mark_and_the_line_ends_of_windows_are_read(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    assert load_set(path) == parsed()


def test_a_file_larger_than_any_set_is_not_read(tmp_path):
    path = tmp_path / "huge.yaml"
    with path.open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    assert refusal(load_set, path) == f"{path}: the file has 2.0 MiB; the limit is 2 MiB"


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="a device without an end")
def test_a_file_without_an_end_is_not_read():
    assert "the limit is 0.5 MiB" in refusal(read_text, Path("/dev/zero"), 2**19)


@pytest.mark.parametrize(("content", "line"), [(b"\xff", 1), (b"a\nb\n\xc3(", 3), (b"\n\nx\xe9y\n", 3)])
def test_the_line_of_what_is_not_utf_8(tmp_path, content, line):
    path = tmp_path / "mine.yaml"
    path.write_bytes(content)
    assert refusal(read_text, path).startswith(f"{path}:{line}: the file is not UTF-8 text (byte 0x")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(TEXT)
    path.chmod(0)
    assert refusal(load_set, path) == f"{path}: cannot be read: Permission denied"


def test_scalars_are_those_of_yaml_1_2():
    given = parsed(TEXT.replace("interval: 4.5", "interval: 1e-3").replace("name: one", "name: no"))
    assert given.scenarios[0].interval == 0.001
    assert given.scenarios[0].name == "no"


# Saving


@pytest.mark.parametrize(
    ("part", "cause"),
    [
        ("<<: *base", "merge keys (<<) are not YAML 1.2; write the fields out"),
        ("name: !foo two", "the tag !foo means nothing here; remove it"),
        ("name: *other", "the alias *other has no anchor before it; write the value out"),
        ("\tname: two", "not valid YAML: "),
        ("{scans:5}", "scans:5 is no field with a value; write scans: 5"),
    ],
)
def test_the_cause_of_missing_fields_is_named_alone(part, cause):
    text = TEXT.replace("  - targets: []", f"  - {part}\n  - &base\n    targets: []")
    line = text[: text.index(part)].count("\n") + 1
    told = refusal(parsed, text)
    assert told.startswith(f"mine.yaml:{line}:")
    assert cause in told
    assert "missing" not in told
    assert "\n" not in told


def test_a_set_is_saved_with_the_fields_that_were_given_and_no_others():
    given = parsed()
    assert set_data(given) == read(TEXT, "mine.yaml").data
    assert next(iter(set_data(given))) == "schema"
    assert "control" not in set_data(given)["experiments"][0]


def test_saving_what_was_loaded_changes_no_byte(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(TEXT)
    save_set(load_set(path), path)
    assert path.read_text() == TEXT


def changed(data: dict) -> ScenarioSet:
    data["experiments"][0]["trials"] = 75
    data["scenarios"][0]["region"]["y"] = [0.5, 60.5]
    data["scenarios"][0]["clutter"] = [{"rate": 5.5}]
    data["initiators"].append({"name": "modified"})
    return ScenarioSet.model_validate(data)


def test_saving_over_a_file_keeps_comments_and_the_order_of_keys(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(TEXT)
    given = changed(read(TEXT, "").data)
    save_set(given, path)
    text = path.read_text()
    assert load_set(path) == given
    for comment in ("# What this set is for.", "# first, as I like it", "# km", "# not 1", "# A small world.",
                    "# s", "# low", "# of five"):  # fmt: skip
        assert text.count(comment) == 1
    assert list(read(text, "").data) == ["schema", "name", "experiments", "scenarios", "initiators"]
    scenario = read(text, "").data["scenarios"][0]
    assert list(scenario) == ["targets", "scans", "interval", "name", "sensor", "region", "clutter"]
    assert list(scenario["sensor"]) == ["detection_probability", "sigma"]
    # Nothing but what was changed.
    kept = set(text.splitlines()) & set(TEXT.splitlines())
    assert set(TEXT.splitlines()) - kept == {"    trials: 50", "      y: [0.5, 50.5]  # low"}


def test_a_comment_stays_on_the_line_of_a_changed_value(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(TEXT)
    data = read(TEXT, "").data
    data["experiments"][0]["seed"] = 12
    save_set(ScenarioSet.model_validate(data), path)
    assert path.read_text() == TEXT.replace("seed: 2  ", "seed: 12  ")


def test_a_new_file_is_written_and_read_back(tmp_path):
    path = tmp_path / "new.yaml"
    save_set(parsed(), path)
    assert load_set(path) == parsed()
    assert [found.name for found in tmp_path.iterdir()] == ["new.yaml"]


def test_a_folder_that_cannot_be_written_is_a_wrong_request(tmp_path):
    path = tmp_path / "nowhere" / "mine.yaml"
    assert refusal(save_set, parsed(), path) == f"{path}: cannot be written: No such file or directory"
    assert list(tmp_path.iterdir()) == []
    assert "folder" in refusal(save_set, parsed(), tmp_path)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission_leaves_the_old_file(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(TEXT)
    tmp_path.chmod(0o500)
    try:
        message = refusal(save_set, changed(read(TEXT, "").data), path)
    finally:
        tmp_path.chmod(0o700)
    assert message == f"{path}: cannot be written: Permission denied"
    assert path.read_text() == TEXT


@pytest.mark.parametrize("step", ["fsync", "replace", "chmod"])
def test_a_full_disk_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch, step):
    path = tmp_path / "mine.yaml"
    path.write_text(TEXT)

    def full(*arguments):
        raise OSError(28, "No space left on device")

    given = changed(read(TEXT, "").data)
    monkeypatch.setattr(f"scenarios.files.atomic.os.{step}", full)
    assert refusal(save_set, given, path) == f"{path}: cannot be written: No space left on device"
    monkeypatch.undo()
    assert path.read_text() == TEXT
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_is_no_yaml_is_not_saved_over(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("name: [\n")
    refusal(save_set, parsed(), path)
    assert path.read_text() == "name: [\n"


def test_an_error_of_the_old_file_names_the_file(tmp_path, monkeypatch):
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xff")
    assert refusal(save_set, parsed(), path).startswith(f"{path}:1: the file is not UTF-8")
    monkeypatch.setattr(files, "LARGEST_FILE", 10)
    path.write_text(TEXT)
    assert "the limit" in refusal(save_set, parsed(), path)
    assert path.read_text() == TEXT


# Whatever is valid comes back from a file

names = st.from_regex(r"\A[A-Za-z0-9][A-Za-z0-9._-]{0,8}\Z")
texts = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), max_size=20)
numbers = st.floats(-1e6, 1e6) | st.integers(-(10**6), 10**6)
lengths = st.floats(0, 1e3) | st.integers(0, 1000)
sigmas = st.just(0) | st.floats(0.1, 1e3) | st.integers(1, 1000)  # so that every grid fits into memory
positive = st.floats(1e-3, 1e3) | st.integers(1, 1000)
counts = st.integers(1, 1000)


def some(**fields):
    """Return mappings with any of these fields."""
    return st.fixed_dictionaries({}, optional=fields)


def joined(*parts):
    """Return mappings with the fields of several."""
    return st.tuples(*parts).map(lambda found: {key: value for part in found for key, value in part.items()})


bounds = st.tuples(st.integers(-500, 0), st.integers(1, 500) | st.floats(0.5, 500)).map(list)
regions = st.fixed_dictionaries({"x": bounds, "y": bounds})
targets = joined(
    st.fixed_dictionaries(
        {
            "position": st.lists(numbers, min_size=2, max_size=2),
            "velocity": st.lists(positive, min_size=2, max_size=2),
        }
    ),
    some(name=names, birth=st.integers(0, 5), death=st.none() | st.integers(5, 9)),
)
scenarios = joined(
    st.fixed_dictionaries(
        {
            "scans": st.integers(1, 100),
            "interval": positive,
            "region": regions,
            "sensor": joined(
                st.fixed_dictionaries({"sigma": sigmas | st.lists(sigmas, min_size=2, max_size=2)}),
                some(kind=st.just("cartesian"), detection_probability=st.floats(0.01, 1) | st.just(1)),
            ),
        }
    ),
    some(
        description=texts,
        unit=st.sampled_from(["km", "m", "nmi"]),
        clutter=st.lists(
            joined(st.fixed_dictionaries({"rate": lengths}), some(kind=st.just("poisson"), region=regions)),
            max_size=3,
        ),
        targets=st.lists(targets, max_size=3),
    ),
)
grids = joined(
    st.fixed_dictionaries({"rho_bins": counts, "rho_step": positive, "rho_min": numbers}),
    some(theta_bins=counts, theta_offset=st.floats(0, 0.99), origin=st.just("auto")),
)
entries = st.one_of(
    joined(
        st.just({"initiator": "standard"}),
        some(grid=grids, fraction=st.floats(0, 1), votes=st.none() | counts),
    ),
    joined(
        st.just({"initiator": "sequential"}),
        some(maxima=counts, ties=st.sampled_from(["last", "first"]), suppress_rho=st.integers(0, 9)),
    ),
    joined(
        st.just({"initiator": "modified"}), some(speed_min=st.just(0.01), angle_tolerance_deg=st.just(3.5))
    ),
)
criteria = st.one_of(
    joined(st.fixed_dictionaries({"rho": positive}), some(theta_deg=st.none() | st.floats(0.1, 90))),
    st.fixed_dictionaries({"plots": counts}),
)
experiments = joined(
    st.fixed_dictionaries({"criterion": criteria}),
    some(
        description=texts,
        trials=counts,
        seed=st.integers(0, LARGEST_SEED),
        control=st.booleans(),
        sweep=some(
            scans=st.lists(st.integers(1, 50), min_size=1, max_size=3),
            interval=st.lists(positive, min_size=1, max_size=3),
        ),
    ),
)


@st.composite
def valid_sets(draw) -> dict:
    """Return plain data of valid sets, in the types that a file gives."""
    data: dict = draw(
        joined(st.fixed_dictionaries({"name": names}), some(description=texts, schema=st.just(1)))
    )
    for part, item, least in (
        ("scenarios", scenarios, 1),
        ("initiators", entries, 1),
        ("experiments", experiments, 0),
    ):
        found = draw(st.lists(item, min_size=least, max_size=3))
        labels = draw(st.lists(names, min_size=len(found), max_size=len(found), unique=True))
        data[part] = [{"name": label, **value} for label, value in zip(labels, found, strict=True)]
    return data


quick = settings(
    derandomize=True,
    max_examples=50,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)


def test_the_sets_below_are_of_the_initiators_that_there_are():
    assert {"standard", "sequential", "modified"} <= initiators().keys()


@quick
@given(valid_sets())
def test_a_set_comes_back_from_a_new_file(tmp_path, data):
    path = tmp_path / "set.yaml"
    path.unlink(missing_ok=True)
    saved = ScenarioSet.model_validate(data)
    save_set(saved, path)
    loaded = load_set(path)
    assert loaded == saved
    assert set_data(loaded) == set_data(saved)
    # What was not given is not in the file either.
    assert read(path.read_text(), "").data.keys() == data.keys()


@quick
@given(valid_sets(), valid_sets())
def test_a_set_comes_back_from_a_file_that_held_another(tmp_path, before, data):
    path = tmp_path / "set.yaml"
    path.unlink(missing_ok=True)
    save_set(ScenarioSet.model_validate(before), path)
    path.write_text("# mine\n" + path.read_text())
    saved = ScenarioSet.model_validate(data)
    save_set(saved, path)
    assert load_set(path) == saved
    assert path.read_text().startswith("# mine\n")
