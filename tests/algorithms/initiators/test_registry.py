from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from pydantic import create_model

from algorithms import notices
from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.initiators import guard, registry
from algorithms.initiators.base import ChunkInitiator, Initiator
from algorithms.parameters import Parameters, parameter
from algorithms.plots import Plots
from algorithms.tracks import Tracks, TrackStates

ALWAYS = ["modified", "sequential", "standard"]


class AnyPlot(Initiator):
    """The smallest of plug-ins: each plot is a track."""

    name = "any-plot"
    summary = "each plot is a track"
    parameters = Parameters

    def initiate(self, plots, context, parameters):
        return Tracks(
            np.zeros(len(plots)), plots.position[:, 0].copy(), np.ones(len(plots)),
            tuple(np.array([row]) for row in range(len(plots))),
            TrackStates.open(len(plots), 2), np.full(len(plots), context.scans - 1),
        )  # fmt: skip


def named(name, *fields):
    declared = {field: (int, parameter(1, help="a number")) for field in fields}
    parameters = create_model("DeclaredParameters", __base__=Parameters, **declared)
    return type("PlugIn", (AnyPlot,), {"name": name, "parameters": parameters})


@dataclass
class Point:
    """An entry point, as far as the registry uses one."""

    name: str
    loaded: Any
    value: str = "package.module:Thing"

    def load(self):
        if isinstance(self.loaded, BaseException):
            raise self.loaded
        return self.loaded


@pytest.fixture
def with_plug_ins(monkeypatch):
    def install(*points):
        asked = []

        def entry_points(*, group):
            asked.append(group)
            return list(points)

        monkeypatch.setattr(registry, "entry_points", entry_points)
        monkeypatch.setattr(notices, "_notices", [])
        monkeypatch.setattr(notices, "_listeners", [])
        registry.initiators.cache_clear()
        return asked

    yield install
    monkeypatch.undo()
    registry.initiators.cache_clear()


def refusal(with_plug_ins, loaded):
    """Return why a plug-in is not used; all else works, and a notice says so once."""
    with_plug_ins()
    product = list(registry.initiators())
    with_plug_ins(Point("theirs", loaded), Point("a", AnyPlot))
    heard = []
    notices.listen(heard.append)
    for _ in range(2):
        assert list(registry.initiators()) == [*product, "any-plot"]
    (failed,) = registry.failed_plug_ins()
    assert failed.words.startswith("plug-in 'theirs' (package.module:Thing) ")
    assert heard == [f"{failed.words}; everything else works without it"]
    return failed.words


def test_the_initiators_of_the_product(with_plug_ins):
    with_plug_ins()
    assert set(ALWAYS) <= set(registry.initiators())
    for name, found in registry.initiators().items():
        assert found.name == name
        assert isinstance(found, ChunkInitiator)
        assert found.summary
        assert found.source


def test_a_plug_in_comes_after_those_of_the_product_as_class_or_as_object(with_plug_ins):
    with_plug_ins()
    product = list(registry.initiators())
    asked = with_plug_ins(Point("a", AnyPlot), Point("b", named("other")()))
    assert list(registry.initiators()) == [*product, "any-plot", "other"]
    assert asked == ["hough_tui.initiators"]
    assert isinstance(registry.initiator("any-plot"), AnyPlot)


def test_a_plug_in_in_plain_python_runs_and_has_no_accumulator(with_plug_ins):
    with_plug_ins(Point("a", AnyPlot))
    found = registry.initiator("any-plot")
    plots = Plots(np.zeros(2, np.int32), np.zeros(2), np.array([[1.0, 2.0], [3.0, 4.0]]))
    context = Context(3, 4.0)
    assert len(found.initiate(plots, context, found.parameters())) == 2
    assert found.accumulator(plots, context, found.parameters()) is None


def test_the_registry_looks_for_plug_ins_once(with_plug_ins):
    asked = with_plug_ins(Point("a", AnyPlot))
    for _ in range(3):
        registry.initiators()
    assert len(asked) == 1


@pytest.mark.parametrize("name", ALWAYS)
def test_a_plug_in_may_not_take_the_name_of_an_initiator_of_the_product(with_plug_ins, name):
    assert f"is named '{name}', as another initiator is; rename it" in refusal(with_plug_ins, named(name))


def test_of_two_plug_ins_of_one_name_the_first_counts(with_plug_ins):
    with_plug_ins(Point("first", AnyPlot), Point("second", AnyPlot))
    assert "any-plot" in registry.initiators()
    (failed,) = registry.failed_plug_ins()
    assert "plug-in 'second'" in failed.words
    assert "is named 'any-plot', as another initiator is; rename it" in failed.words


@pytest.mark.parametrize("reserved", ["name", "initiator"])
def test_a_parameter_may_not_have_a_reserved_name(with_plug_ins, reserved):
    found = refusal(with_plug_ins, named("theirs", reserved))
    assert f"declares a parameter '{reserved}', a reserved name; rename it" in found


@pytest.mark.parametrize(
    "error",
    [
        ImportError("no module named 'torch'"),
        AttributeError("Thing"),
        SyntaxError("bad"),
        ZeroDivisionError("division"),
        SystemExit(3),
    ],
)
def test_a_plug_in_that_does_not_load_is_named_with_the_reason(with_plug_ins, error):
    found = refusal(with_plug_ins, error)
    assert f"cannot be loaded: {type(error).__name__}: {error}; mend or remove it" in found


@pytest.mark.parametrize(
    ("loaded", "kind"), [(5, "int"), ("text", "str"), (dict, "dict"), (None, "NoneType")]
)
def test_what_is_no_initiator_is_refused(with_plug_ins, loaded, kind):
    assert f"gives {kind}, not an Initiator" in refusal(with_plug_ins, loaded)


class WithoutInitiate(Initiator):
    name = "without-initiate"
    summary = "abstract"
    parameters = Parameters


class FailsToStart(AnyPlot):
    def __init__(self):
        raise OSError("no device")


@pytest.mark.parametrize("loaded", [WithoutInitiate, FailsToStart])
def test_a_plug_in_that_cannot_be_made_is_named_with_the_reason(with_plug_ins, loaded):
    refusal(with_plug_ins, loaded)


@pytest.mark.parametrize("lacking", ["name", "parameters"])
def test_a_plug_in_that_does_not_declare_itself_is_refused(with_plug_ins, lacking):
    declared = {"name": "bare", "summary": "", "parameters": Parameters, "initiate": AnyPlot.initiate}
    del declared[lacking]
    assert lacking in refusal(with_plug_ins, type("Bare", (Initiator,), declared))


@pytest.mark.parametrize("taken", ["parameters", "algorithm"])
@pytest.mark.filterwarnings("ignore:Field name")
def test_a_parameter_may_not_have_the_name_of_what_a_set_entry_offers(with_plug_ins, taken):
    assert taken in refusal(with_plug_ins, named("theirs", taken))


def test_parameters_must_be_of_their_class_and_have_a_schema(with_plug_ins):
    assert "no class of Parameters" in refusal(
        with_plug_ins, type("PlugIn", (AnyPlot,), {"name": "theirs", "parameters": dict})
    )
    undescribed = create_model(
        "Undescribed", __base__=Parameters, call=(Callable[[], int], parameter(int, help="no text"))
    )
    assert "PydanticInvalidForJsonSchema" in refusal(
        with_plug_ins, type("PlugIn", (AnyPlot,), {"name": "theirs", "parameters": undescribed})
    )


def test_dimensions_must_be_those_of_plots(with_plug_ins):
    declared = type("PlugIn", (AnyPlot,), {"name": "theirs", "dimensions": 4})
    assert "declares 4 dimensions, and there are 2 or 3" in refusal(with_plug_ins, declared)


def test_an_initiator_that_could_not_be_loaded_says_why(with_plug_ins):
    with_plug_ins(Point("theirs", ImportError("no module named 'torch'")))
    with pytest.raises(RequestError, match=r"^the initiator 'theirs' could not be loaded: plug-in .*'torch'"):
        registry.initiator("theirs")
    with pytest.raises(RequestError, match=r"no initiator 'thiers'.*; could not be loaded: theirs$"):
        registry.initiator("thiers")


def test_the_distribution_of_a_plug_in_is_named():
    distribution = SimpleNamespace(name="their-package", version="1.2")
    point = SimpleNamespace(name="theirs", value="package.module:Thing", dist=distribution)
    assert str(guard.Origin.of(point)) == "plug-in 'theirs' (package.module:Thing, their-package 1.2)"


def test_an_unknown_initiator_is_answered_with_the_nearest(with_plug_ins):
    with_plug_ins()
    with pytest.raises(RequestError) as error:
        registry.initiator("standart")
    known = ", ".join(registry.initiators())
    assert str(error.value) == (
        f"there is no initiator 'standart'; did you mean 'standard'? (known: {known})"
    )
