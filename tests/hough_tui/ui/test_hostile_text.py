"""Text from outside in every view: it is seen, takes the room that it needs, and acts on nothing."""

import json
import re

from rich.cells import cell_len
from textual import events
from textual.widgets import Input

from hough_tui.ui.config import Config

MARKS = "\u061c\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"
CONTROLS = "".join(map(chr, [*range(1, 10), *range(11, 32), *range(127, 160)])) + MARKS
NAME = f"[red]\x1b]0;own\x07{CONTROLS}"
SHOWN = r"[red]\x1b]0;own\x07"
IN_PLACE = "[red]␛]0;own␇"
ACTING = re.compile(f"[{re.escape(CONTROLS)}\x00\n\ud800-\udfff]")
QUOTED = json.dumps(f"{NAME}\x00\n\r\n")

SET = f"""\
schema: 1
name: small
description: {QUOTED}
scenarios:
  - name: one
    description: {QUOTED}
    scans: 4
    interval: 4
    region: {{x: [0, 100], y: [0, 100]}}
    sensor: {{sigma: 0.1}}
    clutter: [{{rate: 5}}]
    targets: [{{position: [40, 20], velocity: [0.3, 0.18]}}]
initiators: [{{name: standard}}, {{name: other, initiator: standard}}]
experiments:
  - {{name: swept, description: {QUOTED}, sweep: {{scans: [4, 5]}}, trials: 4, criterion: {{plots: 3}}}}
  - {{name: gathered, kind: clustering, scenes: [apart], clusterings: [k-means], trials: 4}}
scenes:
  - name: apart
    description: {QUOTED}
    region: {{range: [0, 120], doppler: [0, 90]}}
    targets: [{{range: 30, doppler: 45}}, {{range: 75, doppler: 45}}]
clusterings: [{{name: k-means, mode: recommended, range_extent: 16, doppler_extent: 12}}]
"""


async def seen(user, *words):
    """Wait for words; nothing on the screen acts, and every line is as wide as the screen."""
    await user.sees(*words)
    await user.settle()
    for strip in user.app.screen._compositor.render_strips():
        assert not ACTING.search(strip.text), ascii(strip.text)
        assert cell_len(strip.text) == user.app.size.width


def test_every_view_shows_what_would_act(drive, home):
    path = home / "work" / f"{NAME}\udcff.yaml"
    path.write_text(SET, encoding="utf-8")

    async def journey(user):
        await seen(user, SHOWN)
        await user.press("ctrl+s")
        assert user.notes == [f"Saved {path}"]
        await seen(user)
        for key in ("f3", "f4", "f11"):
            await user.go(key)
            await seen(user, SHOWN)
        await user.press("f1")
        await user.screen("HelpScreen")
        await seen(user)
        await user.press("escape", "f12")
        await user.screen("PathPrompt")
        await seen(user, "␛␜␝␞␟␡", "�.yaml ")
        await user.press("escape")
        await user.go("f6")
        await user.press("f5")
        await user.sees("kept as")
        await seen(user)
        estrange(home)
        view = await user.go("f7")
        view.take_focus()
        await user.press("enter")
        await seen(user, SHOWN)
        await user.go("f2")
        await seen(user, IN_PLACE)
        for name in ("description", "scans"):
            field = ("scenarios", 0, name)
            user.form.focus_field(field)
            line = user.field(*field).query_one(Input)
            await user.until(lambda line=line: line.has_focus)
            line.value = ""
            line.post_message(events.Paste(NAME))
            await user.until(lambda line=line: line.value)
            await seen(user, IN_PLACE)
        await seen(user, "! ")

    drive(journey, str(path), size=(160, 48))
    assert path.read_text(encoding="utf-8") == SET


def estrange(home):
    """Put hostile names into the only kept run."""
    (folder,) = (home / "data" / "hough-tui" / "runs").iterdir()
    document = json.loads((folder / "result.json").read_text())
    for row in document["rows"]:
        row |= {part: f"{NAME}\n" for part in ("set", "experiment", "scenario", "initiator")}
        row["swept"] = {f"scenario.{NAME}": scans for scans in row["swept"].values()}
    (folder / "result.json").write_text(json.dumps(document))
    folder.rename(folder.with_name(f"{NAME}\udcff"))


def test_wrong_sets_and_settings_are_told_visibly(drive, home):
    path = home / "work" / f"{NAME}.yaml"
    path.write_text(f"{QUOTED}: 1\n{SET}", encoding="utf-8")

    async def journey(user):
        await user.screen("Question")
        await seen(user, SHOWN)
        assert user.notes == [f"There is no theme '{NAME}'"]
        await user.press("escape")
        await user.screen("Welcome")
        await seen(user)

    drive(journey, str(path), size=(240, 48), opens=False, config=Config(theme=NAME))
