import os
import threading

import pytest

from scenarios.files.atomic import replace_file


def test_a_pipe_is_written_to_and_stays_a_pipe(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    got = []
    reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()))
    reader.start()
    replace_file(pipe, "through the pipe")
    reader.join(10)
    assert got == [b"through the pipe"]
    assert pipe.is_fifo()


def test_a_link_stays_a_link(tmp_path):
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_text("old")
    link.symlink_to(target)
    replace_file(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_what_cannot_be_written_is_named_and_leaves_nothing(tmp_path):
    missing = tmp_path / "none" / "file"
    with pytest.raises(FileNotFoundError) as error:
        replace_file(missing, "x")
    assert error.value.filename == str(missing)
    with pytest.raises(IsADirectoryError) as error:
        replace_file(tmp_path, "x")
    assert error.value.filename == str(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_permissions_survive(tmp_path):
    file = tmp_path / "file"
    file.write_text("old")
    file.chmod(0o640)
    replace_file(file, b"new")
    assert file.stat().st_mode & 0o777 == 0o640
