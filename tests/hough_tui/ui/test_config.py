"""The settings file."""

import pytest

from algorithms.errors import RequestError
from hough_tui.ui.config import Config, config_file, read_config


@pytest.fixture
def write(home):
    """Return a function that writes the settings."""

    def put(text):
        path = config_file()
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    return put


def test_without_a_file_all_is_as_it_comes(home):
    assert config_file() == home / "config" / "hough-tui" / "config.yaml"
    assert read_config() == Config(None, {})


def test_theme_and_keys_are_read(write):
    write("theme: nord   # dark\nkeys:\n  app.quit: ctrl+x\n  tab.look: f11,ctrl+l\n")
    assert read_config() == Config("nord", {"app.quit": "ctrl+x", "tab.look": "f11,ctrl+l"})


@pytest.mark.parametrize("text", ["", "# nothing yet\n", "theme:\n", "keys:\n", "keys: {}\n"])
def test_an_empty_file_is_none(write, text):
    write(text)
    assert read_config() == Config(None, {})


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("theme: nord\nkeyz: {}\n", ":2:1:", ["keyz", "keys"]),
        ("keys: {}\ntheme: [nord]\n", ":2:8:", ["theme"]),
        ("theme: nord\nkeys: ctrl+x\n", ":2:7:", ["keys"]),
        ("theme: nord\nkeys:\n  app.quit: 5\n", ":3:", ["keys"]),
        ("- theme\n", ":1:1:", ["theme and keys"]),
        ("theme: nord\ntheme: gruvbox\n", ":2:", ["theme"]),
        ("theme: [nord\n", ":", ["config.yaml"]),
    ],
)
def test_what_is_wrong_is_told_with_file_and_line(write, text, place, words):
    write(text)
    with pytest.raises(RequestError) as caught:
        read_config()
    message = str(caught.value)
    assert message.startswith(f"{config_file()}{place}")
    assert all(word in message for word in words)


def test_a_relative_directory_is_ignored_as_the_specification_has_it(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CONFIG_HOME", "settings")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert config_file() == tmp_path / ".config" / "hough-tui" / "config.yaml"
