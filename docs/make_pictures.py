"""Make the pictures of the application, as SVG, and the tables of its keys, from the application itself.

Run it with `python docs/make_pictures.py`; the pictures come into `docs/pictures/`, or into the folder
that is given. Each view is taken on a wide terminal (120 × 36) and on a narrow one (80 × 24).
`python docs/make_pictures.py keys` writes the tables of `docs/keys.md` anew.

The same sources give the same pictures: draws come from seeds, and what tells of this machine or of
this day (speeds, times, names of runs) is taken out. Settings, unsaved work and runs of the user are
left alone.
"""

from __future__ import annotations

import asyncio
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

SIZES = {"": (120, 36), "-80x24": (80, 24)}
MOST_BYTES = 400_000
WIDE = 100
SET, SETS = "course-report", {"projections": "par-table-2", "clustering": "range-doppler"}
"""The set of the pictures, and those of pictures of another one."""

KEPT = ("20260105-090000-course-report-a1b2", "20260105-091500-course-report-c3d4")
"""What the kept runs are called: their own names hold the time."""

NO_PATHS = ("/home/", "/Users/", tempfile.gettempdir())
"""What no picture may hold: where files lie on this machine."""


RUN = re.compile(
    r'<text class="([^"]+)" x="([^"]+)" y="([^"]+)" textLength="[^"]+" clip-path="([^"]+)">([^<]+)</text>'
)
SPACE, WIDTH = "&#160;", 12.2


async def settled(pilot: Any) -> None:
    """Wait until nothing is worked out or moves any more."""
    for _ in range(3):
        await pilot.pause(0.25)
        await pilot.app.workers.wait_for_complete()
    await pilot.pause()


async def press(pilot: Any, *keys: str) -> None:
    """Press keys one by one, as a person does."""
    for key in keys:
        await pilot.press(key)
        await settled(pilot)


async def scenario(pilot: Any) -> None:
    """The form of a scenario, and one draw of it where there is room."""
    await press(pilot, "f2")


async def initiator(pilot: Any) -> None:
    """The parameters of an initiator, and what its quantisation leads to where there is room."""
    await press(pilot, "f3", "enter")
    forget_cost(pilot)


async def prediction(pilot: Any) -> None:
    """What the quantisation of an initiator leads to."""
    await press(pilot, "f3", "f9")
    forget_cost(pilot)


def forget_cost(pilot: Any) -> None:
    """Take out how long a vote takes on this machine."""
    from dataclasses import replace

    from hough_tui.ui.widgets.prediction_table import PredictionTable

    table = pilot.app.screen.query_one(PredictionTable)
    table.compared = replace(table.compared, cost=None)


async def look(pilot: Any) -> None:
    """One trial; the second track is chosen in the table where there is room for it."""
    await press(pilot, "f4")


async def projections(pilot: Any) -> None:
    """One trial in space, its first track chosen."""
    await press(pilot, "f4", "s", "s", "s", "s", "s", "i")
    if pilot.app.size.width < WIDE:
        await press(pilot, "t", "z", "v")
    else:
        await press(pilot, "f8", "t")
    from hough_tui.ui.widgets.caption import Caption

    # The last part is how long it took on this machine.
    line = pilot.app.screen.query_one("LookPanel Caption", Caption)
    line.parts = line.parts[:-1]


async def clustering(pilot: Any) -> None:
    """The first step by which the points of a scene are split; the steps, too, where there is room."""
    await press(pilot, "f11", "s", "s", "s", "s", "s", "full_stop")


async def why(pilot: Any) -> None:
    """Why the strongest cell is a peak."""
    from hough_tui.ui.widgets.heatmap import Heatmap

    await press(pilot, "f4")
    heatmap = pilot.app.screen.query_one(Heatmap)
    if not heatmap.size.area:
        await press(pilot, "v")
    heatmap.focus()
    await press(pilot, "enter")


async def monte_carlo(pilot: Any) -> None:
    """The rates of a run, and its chart where there is room."""
    from hough_tui.ui.widgets.rate_panel import RatePanel
    from hough_tui.ui.widgets.run_line import RunLine

    await press(pilot, "f6", "r")
    panel, line = (pilot.app.screen.query_one(kind) for kind in (RatePanel, RunLine))
    panel.fill([{**row, "seconds_per_trial": None} for row in panel.shown.rows])
    line.tell(f"{sum(row['trials'] for row in panel.shown.rows):,} trials · kept")
    await press(pilot, "down", "down")


async def results(pilot: Any) -> None:
    """The runs that were kept, and one of them where there is room."""
    from hough_tui.ui.widgets.rate_panel import RatePanel

    await press(pilot, "f7")
    if pilot.app.size.width >= 100:
        await press(pilot, "enter")
        panel = pilot.app.screen.query_one(RatePanel)
        panel.fill([{**row, "seconds_per_trial": None} for row in panel.shown.rows])
        await settled(pilot)


VIEWS: dict[str, Callable[[Any], Awaitable[None]]] = {
    "scenario": scenario,
    "initiator": initiator,
    "prediction": prediction,
    "look": look,
    "projections": projections,
    "why-this-peak": why,
    "clustering": clustering,
    "monte-carlo": monte_carlo,
    "results": results,
}


def tidied(picture: str) -> str:
    """Return a picture in which no text begins with spaces: some programs drop those, and all is shifted."""

    def parts(found: re.Match[str]) -> str:
        style, x, y, clip, text = found.groups()
        text = text.replace(SPACE, "\xa0")
        made = []
        for word in re.finditer("[^\xa0]+(?:\xa0[^\xa0]+)*", text):
            # An escaped character counts as one.
            before = len(re.sub("&[^;]+;", "x", text[: word.start()]))
            count = len(re.sub("&[^;]+;", "x", word[0]))
            place = f'x="{float(x) + WIDTH * before:.5g}" y="{y}" textLength="{WIDTH * count:.5g}"'
            shown = word[0].replace("\xa0", SPACE)
            made.append(f'<text class="{style}" {place} clip-path="{clip}">{shown}</text>')
        return "".join(made)

    return RUN.sub(parts, picture)


def keep_runs() -> None:
    """Keep the runs that the pictures of the results show."""
    from hough_tui.experiments.engines.threads import Job
    from hough_tui.experiments.plan import plan_run
    from hough_tui.experiments.results import result
    from hough_tui.experiments.stores.folder import FolderStore
    from scenarios.files.set_files import load_set

    for called, seed in zip(KEPT, (7, 8), strict=True):
        job = Job(plan_run([load_set(SET)], experiments=["tables"], seed=seed))
        job.wait()
        store = FolderStore()
        (store.folder / store.add(result(job))).rename(store.folder / called)


def forget_new_runs() -> None:
    """Remove the runs that a picture was taken of: no later one shall show them."""
    from hough_tui.experiments.stores.folder import FolderStore

    store = FolderStore()
    for name in store.names():
        if name not in KEPT:
            shutil.rmtree(store.folder / name)


async def taken(name: str, size: tuple[int, int]) -> str:
    """Return the picture of a view."""
    from hough_tui.ui.app import HoughApp
    from hough_tui.ui.config import Config

    app = HoughApp(SETS.get(name, SET), Config())
    async with app.run_test(size=size) as pilot:
        await settled(pilot)
        await VIEWS[name](pilot)
        await settled(pilot)
        found = app.export_screenshot(title="hough-tui", simplify=True)
        app.exit()
    return found


PLACES = {
    "Everywhere": ("HoughApp", "MainScreen"),
    "The tree of the set": ("SetTree",),
    "Forms": ("ModelForm", "ValueField", "NumberInput", "TextInput", "Menu", "Flag"),
    "Tables in forms (targets, clutter)": ("ListTable", "CellTable"),
    "Scenario": ("ScenarioView",),
    "Initiator": ("InitiatorView", "PredictionDensity"),
    "Look": ("LookView", "LookPanel"),
    "Look: the plane (and the picture of Scenario)": ("Plane",),
    "Look: the accumulator": ("Heatmap",),
    "Look: the votes of pairs of plots (in space)": ("PairVotes",),
    "Look: the table of tracks": ("TrackGrid",),
    "Look: why this peak": ("WhyPeak",),
    "Clustering": ("ClusteringView", "ClusterPanel"),
    "Clustering: the range-Doppler plane": ("ClusterPlane",),
    "Monte Carlo": ("MonteCarloView", "RunField", "ExperimentForm"),
    "Monte Carlo and Results: rates as table and chart": ("RatePanel", "RateGrid"),
    "The trials behind a row": ("TrialsScreen", "TrialList"),
    "Results": ("ResultsView", "RunList"),
    "Results: runs compared": ("ComparisonScreen",),
    "Tables of rates, of runs": ("VimTable",),
}
"""The classes whose keys stand under each heading; those of all others stand under `OTHERS`."""

OTHERS = "Dialogues"
BEGIN, END = "<!-- keys: begin -->", "<!-- keys: end -->"


def key_tables() -> str:
    """Return the tables of all keys, as Markdown."""
    from hough_tui.ui.key_bindings import declared_bindings

    known = declared_bindings()
    placed = {name for names in PLACES.values() for name in names}
    lines = []
    for title, names in (PLACES | {OTHERS: tuple(name for name in known if name not in placed)}).items():
        rows = dict.fromkeys(
            (binding.id or "", binding.key, binding.description)
            for name in names
            for binding in known.get(name, ())
        )
        if rows:
            lines += [f"### {title}", "", "| id | keys | what it does |", "|---|---|---|"]
            lines += [
                f"| `{name}` | {', '.join(f'`{key}`' for key in keys.split(','))} | {what} |"
                for name, keys, what in rows
            ]
            lines.append("")
    return "\n".join(lines)


def write_keys() -> None:
    """Put the tables into the page of keys."""
    path = Path(__file__).with_name("keys.md")
    before, _, rest = path.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    path.write_text(f"{before}{BEGIN}\n\n{key_tables()}\n{END}{after}", encoding="utf-8")


def main() -> None:
    """Make all pictures, or the tables of keys."""
    if sys.argv[1:] == ["keys"]:
        write_keys()
        return
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("pictures")
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as own:
        for name in ("CONFIG", "STATE", "DATA"):
            os.environ[f"XDG_{name}_HOME"] = own
        os.environ |= {"TERM": "xterm-256color", "COLORTERM": "truecolor", "TEXTUAL_ANIMATIONS": "none"}
        os.environ.pop("NO_COLOR", None)
        keep_runs()
        for name in VIEWS:
            for suffix, size in SIZES.items():
                text, path = tidied(asyncio.run(taken(name, size))), folder / f"{name}{suffix}.svg"
                forget_new_runs()
                wrong = [found for found in (*NO_PATHS, str(Path.home()), own) if found in text]
                count = len(text.encode())
                if wrong or count > MOST_BYTES:
                    sys.exit(f"{path.name}: {count:,} bytes, with {', '.join(wrong) or 'no paths'}")
                path.write_text(text, encoding="utf-8")
                print(f"{path.name:32} {count:8,} bytes", flush=True)


if __name__ == "__main__":
    main()
