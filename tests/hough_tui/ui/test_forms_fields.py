from typing import Annotated, Literal

import pytest
from pydantic import BaseModel, Field

from algorithms.context import Unit
from algorithms.hough.grid import GridParameters
from algorithms.initiators.registry import initiators
from algorithms.parameters import Auto, Count, Declared, Dimension, Positive, field_at, parameter
from hough_tui.ui.forms.columns import columns_of
from hough_tui.ui.forms.edits import duplicate, edit_of, names_of, starter, together, unused, value_in
from hough_tui.ui.forms.fields import FieldDescription, Kind, described, walk
from hough_tui.ui.forms.numbers import Unreadable
from hough_tui.ui.forms.texts import text_of, value_of
from hough_tui.ui.screens.explanation import explained
from scenarios.clutter import ExactClutter, PoissonClutter, Region
from scenarios.entries import entry_model
from scenarios.experiments import InitiationExperiment, MatchCriterion
from scenarios.files.set_files import bundled_paths, load_set
from scenarios.model import Scenario, ScenarioSet
from scenarios.motion import Waypoints
from scenarios.sensors import CartesianSensor
from scenarios.targets import Target

MODELS = [
    ScenarioSet,
    Scenario,
    Region,
    CartesianSensor,
    PoissonClutter,
    Target,
    InitiationExperiment,
    MatchCriterion,
    GridParameters,
    *(entry_model(known) for known in initiators().values()),
    *(known.parameters for known in initiators().values()),
]
UNITS = {
    "length": "nmi",
    "speed": "nmi/s",
    "acceleration": "nmi/s²",
    "angle": "°",
    "turn-rate": "°/s",
    "time": "s",
    "count": "",
    "fraction": "",
}


@pytest.fixture
def given() -> ScenarioSet:
    return load_set("course-report")


def field_of(model: type[BaseModel] | BaseModel, *path: str, unit: Unit = Unit.KILOMETRE) -> FieldDescription:
    return next(field for field in walk(described(model, (), unit)) if field.path == path)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_every_field_is_described_by_its_declaration(model):
    fields = list(walk(described(model, (), Unit.NAUTICAL_MILE)))
    assert {field.path[0] for field in fields} == set(model.model_fields)
    for field in fields:
        declared = field_at(model, field.path)
        assert field.label
        assert field.help == declared.description
        extra = declared.json_schema_extra or {}
        assert field.unit == UNITS[extra["dimension"]] if "dimension" in extra else not field.unit
        assert field.auto == extra.get("auto", "")
        assert bool(field.auto) == ("auto" in field.wanted.words)
        assert field.required == declared.is_required()
        assert ("Unit", field.unit) in explained(field) or not field.unit


@pytest.mark.parametrize("name", bundled_paths())
def test_every_value_of_a_set_is_shown_as_text_that_reads_as_it(name):
    found = load_set(name)
    for model in (found, *found.scenarios, *found.initiators, *found.experiments):
        elements = [
            inner for attribute in vars(model).values() if isinstance(attribute, list) for inner in attribute
        ]
        for one in (model, *(element for element in elements if isinstance(element, BaseModel))):
            for field in walk(described(one)):
                if field.kind in (Kind.GROUP, Kind.LIST, Kind.FLAG) or field.is_constant:
                    continue
                value = value_in(one, field.path)
                assert value_of(field, text_of(field, value)) == value


@pytest.mark.parametrize(
    ("model", "path", "kind"),
    [
        (Scenario, ("name",), Kind.TEXT),
        (Scenario, ("unit",), Kind.CHOICE),
        (Scenario, ("scans",), Kind.WHOLE),
        (Scenario, ("interval",), Kind.NUMBER),
        (Scenario, ("region",), Kind.GROUP),
        (Scenario, ("region", "x"), Kind.VECTOR),
        (Scenario, ("sensor", "sigma"), Kind.VECTOR),
        (Scenario, ("targets",), Kind.LIST),
        (GridParameters, ("rho_step",), Kind.NUMBER),
        (GridParameters, ("rho_bins",), Kind.WHOLE),
        (GridParameters, ("origin",), Kind.VECTOR),
        (Waypoints, ("points",), Kind.VECTORS),
        (InitiationExperiment, ("control",), Kind.FLAG),
        (InitiationExperiment, ("scenarios",), Kind.TEXTS),
        (InitiationExperiment, ("sweep",), Kind.MAPPING),
    ],
)
def test_the_kind_of_a_field_follows_from_its_type(model, path, kind):
    assert field_of(model, *path).kind is kind


def test_labels_units_and_bounds():
    titles = {field.path[-1]: field.title for field in walk(described(GridParameters, (), Unit.METRE))}
    assert titles["theta_bins"] == "θ bins"
    assert titles["rho_step"] == "ρ step [m]"
    assert field_of(MatchCriterion, "theta_deg").title == "θ [°]"
    assert field_of(Scenario, "interval").title == "Interval [s]"
    assert field_of(GridParameters, "theta_bins").bounds == "at least 1, at most 100000"
    assert field_of(GridParameters, "theta_offset").bounds == "at least 0, less than 1"
    assert field_of(MatchCriterion, "theta_deg").bounds == "greater than 0, at most 90"
    assert field_of(GridParameters, "rho_min").bounds == ""


def test_a_scenario_says_its_own_unit(given):
    metric = given.scenarios[0].model_copy(update={"unit": Unit.METRE})
    assert field_of(metric, "sensor", "sigma").unit == "m"


def test_vectors_are_typed_with_semicolons_between_them():
    points = field_of(Waypoints, "points")
    assert value_of(points, "60 20; 60, 40;") == [(60, 20), (60, 40)]
    assert value_of(points, "1 2 3") == [(1, 2, 3)]
    assert value_of(points, "1 2; 3").message == "'3' is 1 number; it must be 2 or 3 numbers, as in '40, 20'"
    assert isinstance(value_of(points, ""), Unreadable)
    assert text_of(points, [(60.0, 20.5), (1.0, 2.0)]) == "60, 20.5; 1, 2"


def test_what_a_plug_in_may_declare():
    class Odd(Declared):
        sizes: list[Count] = parameter(help="some sizes")
        weights: tuple[Positive, Positive, Positive] | None = parameter(None, help="three weights")
        span: tuple[Count, Count] = parameter((1, 2), dimension=Dimension.LENGTH, help="[low, high] of it")
        mode: Literal["a", "b"] | None = parameter(None, help="a choice or none")
        width: Annotated[Positive, Field(lt=9)] | Auto = parameter(
            "auto", help="a width", auto="as wide as it is"
        )

    fields = {field.path[0]: field for field in described(Odd, (), Unit.KILOMETRE)}
    assert value_of(fields["sizes"], "1 2 3") == (1, 2, 3)
    assert fields["sizes"].wanted.whole
    assert value_of(fields["weights"], "") is None
    assert isinstance(value_of(fields["weights"], "1 2"), Unreadable)
    assert fields["span"].parts == ("low", "high")
    assert (fields["mode"].choices, fields["mode"].optional) == (("a", "b"), True)
    assert fields["width"].bounds == "greater than 0, less than 9"


def test_columns_open_groups_and_named_vectors():
    columns = {column.title: column for column in columns_of([Target], Unit.KILOMETRE)}
    assert list(columns) == [
        "Name",
        "x [km]",
        "y [km]",
        "vx [km/s]",
        "vy [km/s]",
        "Birth",
        "Death",
        "Spread [km]",
        "Motion",
        "Motion process noise [km/s²]",
        "ax [km/s²]",
        "ay [km/s²]",
        "Motion rate [°/s]",
        "Motion points [km]",
        "Extended points",
        "Extended range spread [km]",
        "Extended doppler spread [km/s]",
        "Extended correlation",
        "Extended amplitude",
    ]
    assert columns["vy [km/s]"].path == ("velocity", 1)
    clutter = columns_of([PoissonClutter], Unit.KILOMETRE)
    assert [column.label for column in clutter] == ["Over", "Rate", "Region x", "Region y", "Region z"]
    # What the one kind alone has stands where it stands in its declaration.
    clutter = columns_of([PoissonClutter, ExactClutter], Unit.KILOMETRE)
    labels = ["Kind", "Over", "Rate", "Count", "Per", "Region x", "Region y", "Region z"]
    assert [column.label for column in clutter] == labels
    entries = columns_of([entry_model(known) for known in initiators().values()], Unit.KILOMETRE)
    assert [column.label for column in entries[:2]] == ["Name", "Initiator"]


def test_vectors_have_as_many_columns_as_the_elements_have_numbers():
    flat = Target(position=(1.0, 2.0), velocity=(3.0, 4.0))
    high = Target(position=(1.0, 2.0, 5.0), velocity=(3.0, 4.0, 0.0))
    labels = [column.label for column in columns_of([Target], Unit.METRE, [high])]
    assert labels[:7] == ["Name", "x", "y", "z", "vx", "vy", "vz"]
    assert [column.label for column in columns_of([Target], Unit.METRE, [flat])][:5] == labels[:3] + labels[
        4:6
    ]
    place = next(field for field in described(high) if field.path == ("position",))
    assert value_of(place, "1 2 3") == (1.0, 2.0, 3.0)
    assert value_of(place, "1 2") == (1.0, 2.0)
    refused = value_of(place, "1")
    assert isinstance(refused, Unreadable)
    assert "2 or 3 numbers" in refused.message


def test_sweeps_are_read_name_by_name():
    field = field_of(InitiationExperiment, "sweep")
    assert value_of(field, "scans: 5, 10; rate: [0.5, 1]") == {"scans": [5, 10], "rate": [0.5, 1]}
    assert value_of(field, "") == {}
    for wrong in ("scans", "scans: x", "scans: 1; scans: 2", ": 5", "scans:"):
        assert isinstance(value_of(field, wrong), Unreadable)


def test_a_group_that_is_not_there_begins_as_the_one_around_it(given):
    scenario, base = given.scenarios[0], ("scenarios", 0, "clutter", 0)
    path = (*base, "region", "x")
    found = edit_of(scenario.clutter[0], base, path, (10.0, 20.0), holder=scenario)
    assert found == ((*base, "region"), {"x": (10.0, 20.0), "y": [0.0, 100.0]})
    bounded = scenario.clutter[0].model_copy(update={"region": scenario.region})
    assert edit_of(bounded, base, path, None, holder=scenario) == ((*base, "region"), None)


class _Steady(Declared):
    kind: Literal["steady"] = parameter("steady", help="which")
    rate: Positive = parameter(help="rate")
    note: str = parameter("", help="note")


class _Counted(Declared):
    kind: Literal["counted"] = parameter("counted", help="which")
    count: Count = parameter(help="count")
    note: str = parameter("", help="note")


class _Holder(Declared):
    source: _Steady | _Counted = parameter(help="one of two")


def test_another_kind_keeps_what_both_kinds_have():
    holder = _Holder(source=_Steady(rate=2.0, note="kept"))
    assert field_of(holder, "source", "kind").choices == ("steady", "counted")
    found = edit_of(holder, (), ("source", "kind"), "counted")
    assert found == (("source",), {"count": 1, "note": "kept", "kind": "counted"})
    assert _Holder.model_validate({"source": found[1]}).source.count == 1


def test_edits_together_are_one_edit_of_what_holds_them(given):
    base = ("experiments", 0)
    edits = {(*base, "criterion", "rho"): None, (*base, "criterion", "plots"): 3}
    path, data = together(given.experiments[0], base, edits)
    assert path == (*base, "criterion")
    assert MatchCriterion.model_validate(data) == MatchCriterion(plots=3)


def test_new_elements_are_valid_and_have_names_of_their_own(given):
    assert Target.model_validate(starter(Target))
    assert PoissonClutter.model_validate(starter(PoissonClutter))
    begun = {**starter(Scenario, ["new"]), "region": starter(Region)}
    assert Scenario.model_validate(begun).name == "new-2"
    targets = given.scenarios[0].targets
    assert duplicate(targets[0], names_of(targets))["name"] == "rising-2"
    assert unused("rising-2", ["rising", "rising-2"]) == "rising-3"
    # An entry's initiator may be known by its name alone, which is another one now.
    copy = duplicate(given.initiators[0], names_of(given.initiators))
    assert (copy["name"], copy["initiator"]) == ("standard-2", "standard")
