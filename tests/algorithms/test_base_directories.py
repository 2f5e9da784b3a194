import os
import pwd
from pathlib import Path

import pytest

from algorithms.base_directories import DEFAULTS, base_directory
from algorithms.errors import RequestError


@pytest.mark.parametrize("variable", DEFAULTS)
@pytest.mark.parametrize("value", ["", "relative", "./here", "../above"])
def test_a_relative_base_directory_is_ignored(monkeypatch, tmp_path, variable, value):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv(variable, value)
    assert base_directory(variable) == tmp_path / DEFAULTS[variable]
    monkeypatch.setenv(variable, str(tmp_path / "own"))
    assert base_directory(variable) == tmp_path / "own"


def test_a_user_without_home_folder_is_told_what_to_set(monkeypatch):
    monkeypatch.setenv("HOME", "nowhere")
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    monkeypatch.setattr("os.getuid", lambda: 2**31 - 5)
    with pytest.raises(RequestError, match="no home folder; set HOME or XDG_DATA_HOME to the absolute path"):
        base_directory("XDG_DATA_HOME")


@pytest.mark.parametrize("home", ["", "relative"])
def test_without_an_absolute_home_the_list_of_users_counts(monkeypatch, home):
    monkeypatch.setenv("HOME", home)
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    assert base_directory("XDG_DATA_HOME") == Path(pwd.getpwuid(os.getuid()).pw_dir) / ".local/share"
