"""What killed processes left in a store goes at a later start, and what a live one works on stays."""

import os
import subprocess
import sys
import time

import pytest

from hough_tui.experiments.stores import left_overs
from hough_tui.experiments.stores.folder import FolderStore
from hough_tui.experiments.stores.left_overs import UNFINISHED, working_folder

KILLED = """
import sys, time
from pathlib import Path
from hough_tui.experiments.stores.left_overs import UNFINISHED, working_folder
with working_folder(Path(sys.argv[1]), UNFINISHED) as folder:
    (folder / "sets").mkdir()
    print(folder.name, flush=True)
    time.sleep(600)
"""


def made(parent, name, days=0):
    folder = parent / name
    (folder / "sets").mkdir(parents=True)
    then = time.time() - days * 86_400
    os.utime(folder, (then, then))
    return folder


def test_the_folder_of_a_killed_process_goes_when_it_is_gone(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    name = process.stdout.readline().strip()
    FolderStore(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [name]
    process.kill()
    process.communicate()
    store = FolderStore(tmp_path)
    assert list(tmp_path.iterdir()) == []
    assert store.names() == []


@pytest.mark.parametrize("owner", ["", f"{os.getppid()}@elsewhere-", "1@a-b.example-"])
@pytest.mark.parametrize("purpose", ["unfinished", "removed"])
def test_a_process_that_cannot_be_asked_keeps_its_folder_for_a_day(tmp_path, owner, purpose):
    made(tmp_path, f".{purpose}-{owner}abcd1234", days=2)
    recent = made(tmp_path, f".{purpose}-{owner}abcd5678", days=0.9)
    FolderStore(tmp_path)
    assert list(tmp_path.iterdir()) == [recent]


def test_only_what_this_process_works_on_is_its_own(tmp_path):
    with working_folder(tmp_path, UNFINISHED) as folder:
        # From a process that had the same number, in another container for one.
        made(tmp_path, f"{folder.name[:-8]}00000000")
        made(tmp_path, f".unfinished-{2**200}@{left_overs._host()}-abcd1234")
        FolderStore(tmp_path)
        assert folder.is_dir()
        assert len(list(tmp_path.iterdir())) == 2
    assert len(list(tmp_path.iterdir())) == 1


def test_nothing_else_is_removed(tmp_path):
    others = [
        made(tmp_path, name, days=100) for name in ("a-run", ".hidden", ".unfinished", "unfinished-1@a-b")
    ]
    (tmp_path / ".unfinished-file").touch()
    FolderStore(tmp_path)
    assert {*tmp_path.iterdir()} == {*others, tmp_path / ".unfinished-file"}


def test_a_store_without_a_folder_is_opened(tmp_path):
    assert FolderStore(tmp_path / "none").names() == []
    assert not (tmp_path / "none").exists()
