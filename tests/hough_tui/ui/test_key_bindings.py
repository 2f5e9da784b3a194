"""The key bindings: each has an id and a description, and other keys by the settings file."""

import re
from types import SimpleNamespace

import pytest
from textual.binding import Binding

from algorithms.errors import RequestError
from hough_tui.ui import start as application
from hough_tui.ui.app import HoughApp
from hough_tui.ui.config import config_file, read_config
from hough_tui.ui.key_bindings import declared_bindings, require_known


@pytest.mark.parametrize(("name", "bindings"), declared_bindings().items())
def test_every_binding_has_an_id_and_a_description(name, bindings):
    for binding in bindings:
        assert isinstance(binding, Binding), name
        assert re.fullmatch(r"[a-z-]+\.[a-z_-]+", binding.id or ""), binding
        assert binding.description, binding


def test_one_id_has_one_meaning():
    said = {}
    for bindings in declared_bindings().values():
        for binding in bindings:
            said.setdefault(binding.id, set()).add(binding.action.partition("(")[0])
    assert not {name: actions for name, actions in said.items() if len(actions) > 1}


def test_every_id_is_known():
    require_known({binding.id: "here" for bindings in declared_bindings().values() for binding in bindings})


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tab.lok", "there is no binding 'tab.lok'; did you mean 'tab.look'? F1 in"),
        ("zzzz", "there is no binding 'zzzz'; F1 in"),
    ],
)
def test_an_id_that_is_not_known_is_told_with_place_and_nearest(name, words):
    with pytest.raises(RequestError) as caught:
        require_known({"tab.look": "config.yaml:3:3", name: "config.yaml:4:3"})
    assert str(caught.value).startswith(f"config.yaml:4:3: {words}")


def test_an_unknown_id_ends_the_application(home, drive, monkeypatch):
    config_file().parent.mkdir(parents=True)
    config_file().write_text("keys:\n  tab.look: ctrl+l\n  app.qit: ctrl+x\n", encoding="utf-8")

    async def journey(user):
        await user.until(lambda: user.app._exit)

    ended = drive(journey, "course-report", config=read_config(), opens=False)
    assert str(ended.wrong_setting).startswith(f"{config_file()}:3:3: there is no binding 'app.qit'")
    # What is wrong goes to the one who called, once the terminal is as it was.
    monkeypatch.setattr(HoughApp, "run", lambda self: setattr(self, "wrong_setting", ended.wrong_setting))
    monkeypatch.setattr(application.interpreter, "prepare", lambda: None)
    monkeypatch.setattr(application, "Terminal", lambda: SimpleNamespace(restore=None, descriptor=0))
    monkeypatch.setattr(application.ending, "hand_over", lambda *_: None)
    with pytest.raises(RequestError, match=r"app\.qit"):
        application.run("course-report")


def test_the_palette_has_another_key(drive, home):
    config_file().parent.mkdir(parents=True)
    config_file().write_text("keys:\n  app.palette: ctrl+t\n", encoding="utf-8")

    async def journey(user):
        await user.sees("^t Actions")
        await user.press("ctrl+p")
        assert type(user.app.screen).__name__ == "MainScreen"
        await user.press("ctrl+t")
        await user.screen("CommandPalette")

    drive(journey, "course-report", config=read_config())
