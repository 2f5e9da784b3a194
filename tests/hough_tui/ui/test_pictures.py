"""Pictures of the whole application, compared with pictures that people have looked at.

`pytest --snapshot-update tests/hough_tui/ui/test_pictures.py` takes them anew; then look at them.
"""

from datetime import datetime
from types import SimpleNamespace

import pytest
from pytest_textual_snapshot import SVGImageExtension

import hough_tui.experiments.chunks.clustering as scene_chunks
import hough_tui.experiments.chunks.initiation as chunks
import hough_tui.experiments.chunks.plot_sources as plot_sources
import hough_tui.experiments.stores.folder as store
import hough_tui.inspection.trial as looking
import hough_tui.quantisation.vote_cost as vote_cost
from hough_tui.experiments.engines.threads import Job
from hough_tui.ui.views.cluster_panel import ClusterPanel
from hough_tui.ui.widgets.heatmap import Heatmap
from hough_tui.ui.widgets.pair_votes import PairVotes
from hough_tui.ui.widgets.plane import Plane

SIZES = [(80, 24), (160, 48)]


class Noon(datetime):
    """A clock that stands still."""

    @classmethod
    def now(cls, tz=None):
        return cls(2026, 1, 5, 12, 0, 0, tzinfo=tz)


@pytest.fixture
def still_clocks(monkeypatch):
    """Let nothing that is shown depend on this machine or on this day."""
    monkeypatch.setattr(looking, "time", SimpleNamespace(perf_counter=lambda: 0.0))
    for module in (chunks, plot_sources, scene_chunks):
        monkeypatch.setattr(module, "time", SimpleNamespace(thread_time=lambda: 0.0))
    monkeypatch.setattr(Job, "seconds", property(lambda job: 1.0))
    monkeypatch.setattr(store, "datetime", Noon)
    cost = vote_cost.VoteCost(1e-9, 1e-10)
    monkeypatch.setattr(vote_cost, "_measured", {False: cost, True: cost})
    monkeypatch.setattr(store, "secrets", SimpleNamespace(token_hex=lambda count: "0" * 2 * count))


@pytest.fixture
def picture(snapshot):
    """Return a function that compares what is on the screen with the picture of a name."""
    kept = snapshot.use_extension(SVGImageExtension)

    async def compare(user, name):
        await user.still()
        assert user.app.export_screenshot(title="hough-tui", simplify=True) == kept(name=name)

    return compare


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_the_views_look_as_they_did(drive, still_clocks, picture, size):
    async def journey(user):
        await user.screen("Welcome")
        await picture(user, "welcome")
        await user.press("enter")
        await user.warm()
        await picture(user, "scenario")
        await user.go("f3")
        await picture(user, "initiator")
        panel = (await user.go("f4")).query_one("LookPanel")
        await user.until(lambda: panel._seen)
        await picture(user, "look")
        heatmap = panel.query_one(Heatmap)
        if not heatmap.size.area:
            await user.press("v")
            await picture(user, "accumulator")
        heatmap.focus()
        await user.press("enter")
        await user.screen("WhyPeak")
        await picture(user, "why-this-peak")
        await user.press("escape")
        await user.go("f6")
        user.view.query("RunField").first().focus()
        await user.type("40")
        await user.press("f5")
        await user.until(lambda: not user.view.is_at_work and user.view.query_one("RatePanel").display)
        await user.sees("240 trials in")
        await picture(user, "monte-carlo")
        await user.go("f7")
        await picture(user, "results")

    drive(journey, size=size)


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_trials_in_space_look_as_they_did(drive, still_clocks, picture, size):
    async def journey(user):
        view = await user.go("f2")
        if not view.query_one(Plane).size.area:
            await user.press("f9")
        await user.press("f10", "f10", "f10", "f10", "f10")
        await user.sees("together, trial 0")
        await picture(user, "rings")
        panel = (await user.go("f4")).query_one("LookPanel")
        await user.press("s", "s", "s", "s", "s", "i")
        await user.sees("cht on together, trial 0")
        panel.take_focus()
        await user.press("t")
        await picture(user, "projections")
        if not panel.query_one(PairVotes).size.area:
            await user.press("z", "v")
            await picture(user, "votes")

    drive(journey, "par-table-2", size=size)


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_clustering_looks_as_it_did(drive, still_clocks, picture, size):
    async def journey(user):
        view = await user.go("f11")
        panel = view.query(ClusterPanel).first()
        await user.press("s", "s", "s", "s", "s")
        await user.until(lambda: panel._seen and panel._seen.picture.scene.name == "interference")
        await picture(user, "clusters")
        await user.press(".", ".", ".")
        await picture(user, "step")
        for part in ("steps", "clusterings", "scenes"):
            await user.press("f9")
            assert view.panel == part
            await picture(user, part)
        await user.press("f9")
        if size[0] > 80:
            await user.press("f8")
            await user.until(lambda: view.size.width == size[0])
            await user.press("b")
            await user.until(lambda: len(view.query(ClusterPanel)) == 2)
            await user.until(lambda: all(found._seen for found in view.query(ClusterPanel)))
            await picture(user, "side-by-side")

    drive(journey, "range-doppler", size=size)
