from __future__ import annotations

import math
from typing import Annotated, Literal

import pytest
from pydantic import Discriminator, Field

from algorithms.context import Context
from algorithms.errors import RequestError
from algorithms.hough.grid import GridParameters
from algorithms.initiators.modified import ModifiedParameters
from algorithms.initiators.sequential import SequentialParameters
from algorithms.initiators.standard import StandardParameters
from algorithms.parameters import (
    Auto,
    Count,
    Declared,
    Dimension,
    FieldError,
    Fraction,
    NotNegative,
    Number,
    Parameters,
    Positive,
    Problem,
    Whole,
    dotted,
    field_at,
    fields_at,
    join,
    numeric_paths,
    parameter,
    replaced,
    unknown,
    validated,
)


class Disc(Declared):
    kind: Literal["disc"] = "disc"
    radius: Positive


class Square(Declared):
    kind: Literal["square"] = "square"
    side: Positive
    corner: tuple[Number, Number] = (0.0, 0.0)


class Drawing(Declared):
    """Every kind of field that the product declares."""

    title: str = ""
    number: Number = 0.0
    size: Positive | Auto = "auto"
    share: Fraction = 0.5
    weight: NotNegative = 0.0
    count: Count = 1
    whole: Whole = 0
    flag: bool = False
    pair: tuple[Number, Number] = (0.0, 0.0)
    names: Annotated[list[str], Field(min_length=2)] = parameter(["a", "b"], help="names")
    below: Annotated[Number, Field(lt=10)] = parameter(0.0, help="less than ten")
    above: Annotated[Number, Field(gt=1, le=100)] = parameter(5.0, help="within bounds")
    many: Annotated[int, Field(strict=True, le=2**64 - 1)] = 0
    few: Annotated[Count, Field(le=7)] = parameter(1, help="seven at most")
    middle: Annotated[Fraction, Field(ge=0.25, le=0.75)] = parameter(0.5, help="about a half")
    mode: Literal["sound", "document"] = "sound"
    grid: GridParameters = GridParameters()
    shapes: list[Annotated[Disc | Square, Discriminator("kind")]] = parameter(
        default_factory=list, help="shapes"
    )


def message(data, model=Drawing):
    with pytest.raises(RequestError) as error:
        validated(model, data, "drawing")
    return str(error.value)


@pytest.mark.parametrize(
    ("data", "field", "given_value", "allowed"),
    [
        ({"number": "1.5"}, "number", "'1.5'", "a number"),
        ({"number": True}, "number", "true", "a number"),
        ({"number": False}, "number", "false", "a number"),
        ({"number": None}, "number", "nothing", "a number"),
        ({"number": [1]}, "number", "a list of 1", "a number"),
        ({"number": {}}, "number", "a mapping", "a number"),
        ({"number": math.nan}, "number", "nan", "a finite number"),
        ({"number": math.inf}, "number", "inf", "a finite number"),
        ({"number": -math.inf}, "number", "-inf", "a finite number"),
        ({"size": 0}, "size", "0", "greater than 0 or 'auto'"),
        ({"size": True}, "size", "true", "a number or 'auto'"),
        ({"size": "automatic"}, "size", "'automatic'", "a number or 'auto'"),
        ({"share": 1.01}, "share", "1.01", "at most 1"),
        ({"share": -0.1}, "share", "-0.1", "at least 0"),
        ({"weight": -1}, "weight", "-1", "at least 0"),
        ({"count": 0}, "count", "0", "at least 1"),
        ({"count": 2.0}, "count", "2.0", "a whole number"),
        ({"count": 2.5}, "count", "2.5", "a whole number"),
        ({"count": "2"}, "count", "'2'", "a whole number"),
        ({"count": True}, "count", "true", "a whole number"),
        ({"whole": -1}, "whole", "-1", "at least 0"),
        ({"flag": 7}, "flag", "7", "true or false"),
        ({"flag": "perhaps"}, "flag", "'perhaps'", "true or false"),
        ({"title": 7}, "title", "7", "text"),
        ({"below": 10}, "below", "10", "less than 10"),
        ({"above": 1}, "above", "1", "greater than 1"),
        ({"above": 101}, "above", "101", "at most 100"),
        ({"mode": "loud"}, "mode", "'loud'", "'sound' or 'document'"),
        ({"pair": [1]}, "pair", "a list of 1", "a list of 2"),
        ({"pair": [1, 2, 3]}, "pair", "a list of 3", "a list of at most 2"),
        ({"pair": 5}, "pair", "5", "a list"),
        ({"pair": [1, "x"]}, "pair[1]", "'x'", "a number"),
        ({"pair": [math.nan, 1]}, "pair[0]", "nan", "a finite number"),
        ({"names": ["a"]}, "names", "a list of 1", "a list of at least 2"),
        ({"names": "ab"}, "names", "'ab'", "a list"),
        ({"grid": 3}, "grid", "3", "a mapping of names to values"),
        ({"grid": {"theta_bins": 0}}, "grid.theta_bins", "0", "at least 1"),
        ({"grid": {"theta_offset": 1}}, "grid.theta_offset", "1", "less than 1"),
        ({"grid": {"rho_step": "fine"}}, "grid.rho_step", "'fine'", "a number or 'auto'"),
        (
            {"shapes": [{"kind": "disc", "radius": 1}, {"kind": "square", "side": -1}]},
            "shapes[1].side",
            "-1",
            "greater than 0",
        ),
        (
            {"shapes": [{"kind": "square", "side": 1, "corner": [2]}]},
            "shapes[0].corner",
            "a list of 1",
            "a list of 2",
        ),
    ],
)  # fmt: skip
def test_a_wrong_value_is_named_with_what_is_allowed(data, field, given_value, allowed):
    assert message(data) == f"drawing: {field}: {given_value} is given; it must be {allowed}"


def test_a_great_bound_is_written_out():
    assert message({"many": 2**64}).endswith("it must be at most 18446744073709551615")


@pytest.mark.parametrize(
    ("data", "allowed"),
    [({"few": 8}, "at most 7"), ({"middle": 0.8}, "at most 0.75"), ({"middle": 0.2}, "at least 0.25")],
)
def test_a_bound_of_a_field_is_kept_where_its_type_has_a_wider_one(data, allowed):
    assert message(data).endswith(f"it must be {allowed}")


def test_the_rows_of_an_accumulator_are_bounded():
    assert message({"theta_bins": 100_001}, GridParameters).endswith("it must be at most 100000")


def test_a_wrong_element_of_a_list_that_may_be_automatic_is_one_problem():
    found = message({"origin": [1, "x"]}, GridParameters)
    assert found == "drawing: origin[1]: 'x' is given; it must be a number"


def test_a_name_that_is_no_text_is_refused_in_words():
    assert "Keys should be strings" not in message({1: 2})


def test_data_that_are_no_mapping_are_refused():
    assert message(3) == "drawing: 3 is given; it must be a mapping of names to values"


@pytest.mark.parametrize(
    ("data", "field", "name", "nearest"),
    [
        ({"nubmer": 1}, "nubmer", "nubmer", "number"),
        ({"grid": {"theta_bin": 9}}, "grid.theta_bin", "theta_bin", "theta_bins"),
        ({"shapes": [{"kind": "disc", "radius": 1, "radus": 2}]}, "shapes[0].radus", "radus", "radius"),
    ],
)
def test_an_unknown_name_is_answered_with_the_nearest(data, field, name, nearest):
    assert f"drawing: {field}: there is no field '{name}'; did you mean '{nearest}'? (known: " in message(
        data
    )


def test_an_unknown_name_like_no_other_is_answered_with_all_that_are_known():
    found = message({"grid": {"qqq": 9}})
    assert "did you mean" not in found
    assert found.endswith("(known: theta_bins, rho_step, rho_bins, rho_min, origin, theta_offset)")


def test_the_names_known_are_those_of_the_chosen_alternative():
    found = message({"shapes": [{"kind": "square", "side": 1, "radius": 2}]})
    assert "known: kind, side, corner" in found


def test_an_unknown_alternative_is_named():
    found = message({"shapes": [{"kind": "disk", "radius": 1}]})
    assert found == "drawing: shapes[0]: there is no kind 'disk'; did you mean 'disc'? (known: disc, square)"


def test_a_missing_value_is_named():
    assert (
        message({"shapes": [{"kind": "disc"}]}) == "drawing: shapes[0].radius: is missing; it must be given"
    )


def test_every_problem_has_a_line():
    lines = message({"count": 0, "nubmer": 1, "grid": {"theta_bins": "x"}}).splitlines()
    assert len(lines) == 3
    assert all(line.startswith("drawing: ") for line in lines)


def test_whole_numbers_are_numbers_and_lists_are_pairs():
    found = validated(Drawing, {"number": 3, "pair": [1, 2]}, "drawing")
    assert (found.number, found.pair) == (3.0, (1.0, 2.0))


def test_declared_models_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        Drawing().count = 3


@pytest.mark.parametrize(
    "model", [StandardParameters, SequentialParameters, ModifiedParameters, GridParameters]
)
def test_every_parameter_has_a_default_and_a_line_of_help(model):
    assert validated(model, {}, "x") == model()
    for name, field in model.model_fields.items():
        assert field.description, name
        assert "\n" not in field.description


@pytest.mark.parametrize("model", [StandardParameters, SequentialParameters, ModifiedParameters])
def test_a_length_that_may_be_automatic_says_how_it_is_worked_out(model):
    properties = {
        **model.model_json_schema()["properties"],
        **GridParameters.model_json_schema()["properties"],
    }
    for name, field in properties.items():
        if field.get("default") == "auto":
            assert field["auto"], name
            assert field["dimension"] in set(Dimension), name


@pytest.mark.parametrize(("low", "high"), [(0.5, 0.4), (0.5, 0.5), (1, 0.5)])
def test_speeds_in_the_wrong_order_are_refused(low, high):
    found = message({"speed_min": low, "speed_max": high}, ModifiedParameters)
    assert found == (
        f"drawing: speed_min {low:g} is given with speed_max {high:g}; speed_min must be the smaller one"
    )


@pytest.mark.parametrize("given_speed", [{"speed_min": 0.8}, {"speed_max": 0.05}])
def test_a_speed_beyond_the_default_of_the_other_is_refused(given_speed):
    with pytest.raises(RequestError, match="give both"):
        ModifiedParameters(**given_speed).resolved(Context(3, 4.0))


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ((), ""),
        (("targets", 0, "position", 1), "targets[0].position[1]"),
        (("a", "b"), "a.b"),
        ((2, "x"), "[2].x"),
    ],
)
def test_paths_are_written_as_people_write_them(path, expected):
    assert dotted(path) == expected
    assert Problem(path, "wrong").field == expected


def test_a_problem_without_a_place_is_its_message():
    assert join(Problem((), "wrong")) == "wrong"
    assert join(Problem(("a", 1), "wrong")) == "a[1]: wrong"


def test_unknown_says_when_nothing_is_known():
    assert unknown("x", [], "field") == "there is no field 'x' (known: none)"


def test_replacing_a_value_validates_it_anew():
    model = Drawing(shapes=[Square(side=1.0)])
    found = replaced(model, {("shapes", 0, "corner", 1): 7})
    assert found.shapes[0].corner == (0.0, 7.0)
    assert model.shapes[0].corner == (0.0, 0.0)
    with pytest.raises(FieldError) as error:
        replaced(model, {("shapes", 0, "side"): -1})
    assert error.value.problem.path == ("shapes", 0, "side")
    assert str(error.value) == "shapes[0].side: -1 is given; it must be greater than 0"


def test_numeric_paths_are_all_fields_that_take_a_number():
    paths = set(numeric_paths(Drawing(shapes=[Disc(radius=1.0)])))
    top = {"number", "size", "share", "weight", "count", "whole", "below", "above", "many", "few", "middle"}
    grid = {"theta_bins", "rho_step", "rho_bins", "rho_min", "theta_offset"}
    assert paths == (
        {(name,) for name in top}
        | {("grid", name) for name in grid}
        | {("pair", 0), ("pair", 1), ("shapes", 0, "radius")}
    )


def test_a_field_is_found_by_its_path():
    assert field_at(Drawing, ("above",)).description == "within bounds"
    assert field_at(Drawing, ("grid", "theta_bins")) is GridParameters.model_fields["theta_bins"]
    assert field_at(Drawing, ("shapes", 0, "radius")) is Disc.model_fields["radius"]
    assert field_at(Drawing, ("shapes", 0, "angle")) is None
    assert field_at(Drawing, ("nothing",)) is None


def test_the_fields_at_a_place_follow_the_data():
    data = {"shapes": [{"kind": "disc"}, {"kind": "square"}, {}]}
    assert fields_at(Drawing, data, ("shapes", 0)) == ["kind", "radius"]
    assert fields_at(Drawing, data, ("shapes", 1)) == ["kind", "side", "corner"]
    assert set(fields_at(Drawing, data, ("shapes", 2))) == {"kind", "radius", "side", "corner"}


def test_parameters_without_automatic_values_resolve_to_themselves():
    given_parameters = Parameters()
    assert given_parameters.resolved(Context(3, 1.0)) is given_parameters
