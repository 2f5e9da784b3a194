import json
import os

import numpy as np
import pytest

from algorithms.errors import RequestError
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.experiments.results import result
from hough_tui.experiments.stores.folder import FolderStore
from scenarios.files.set_files import load_set


@pytest.fixture(scope="module")
def run():
    job = Job(plan_run([load_set("course-report")], trials=20), 2)
    job.wait()
    return result(job)


def test_a_run_reads_back_as_it_was_kept(run, tmp_path):
    store = FolderStore(tmp_path / "runs")
    name = store.add(run)
    assert store.names() == [name]
    loaded = store.load(name)
    assert loaded.document == run.document
    assert loaded.sets == run.sets
    for ours, theirs in zip(run.columns, loaded.columns, strict=True):
        assert set(ours) == set(theirs)
        for key in ours:
            np.testing.assert_array_equal(ours[key], theirs[key])


def test_a_part_of_the_name_is_enough_where_it_fits_one_run(run, tmp_path):
    store = FolderStore(tmp_path)
    first, second = store.add(run), store.add(run)
    assert store.document(first[-4:]) == run.document
    with pytest.raises(RequestError, match="fits 2 runs"):
        store.document("course-report")
    with pytest.raises(RequestError, match="there is no run 'none of these'"):
        store.document("none of these")
    assert set(store.names()) == {first, second}


def test_a_run_that_cannot_be_finished_leaves_nothing(run, tmp_path, monkeypatch):
    def full(*args, **kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.raises(OSError, match="No space"):
        FolderStore(tmp_path).add(run)
    assert list(tmp_path.iterdir()) == []


def test_a_damaged_run_is_named(run, tmp_path):
    store = FolderStore(tmp_path)
    name = store.add(run)
    (tmp_path / name / "trials.npz").write_bytes(b"not an archive")
    with pytest.raises(RequestError, match="damaged"):
        store.load(name)
    (tmp_path / name / "result.json").write_text("{")
    with pytest.raises(RequestError, match="no JSON"):
        store.document(name)


def test_a_run_is_removed_by_its_whole_name_only(run, tmp_path):
    store = FolderStore(tmp_path)
    first, second = store.add(run), store.add(run)
    with pytest.raises(RequestError, match="there is no run"):
        store.remove(first[:-1])
    store.remove(first)
    assert store.names() == [second]
    assert [path.name for path in tmp_path.iterdir()] == [second]
    with pytest.raises(RequestError, match="there is no run"):
        store.remove(first)


def test_without_a_folder_there_are_no_runs(tmp_path):
    assert FolderStore(tmp_path / "never").names() == []


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_cannot_be_written_is_an_operating_system_error(run, tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(OSError, match="denied"):
        FolderStore(tmp_path / "runs").add(run)


def test_documents_of_format_1_are_read_as_those_of_today(run, tmp_path):
    store = FolderStore(tmp_path)
    name = store.add(run)
    path = tmp_path / name / "result.json"
    old = json.loads(path.read_text())
    del old["format"]
    for row in old["rows"]:
        row["success_ci95"] = row.pop("success_rate_ci95")
        del row["no_track_rate"]
    path.write_text(json.dumps(old))
    assert store.document(name)["rows"] == json.loads(json.dumps(run.document["rows"]))
    path.write_text('["no document"]')
    with pytest.raises(RequestError, match="no document of a run"):
        store.document(name)
