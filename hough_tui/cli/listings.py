"""Commands that tell what there is, and whether a set is right."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import typer

from hough_tui.cli.options import JsonOption
from hough_tui.cli.output import output_width, print_line, print_renderables, write_document
from hough_tui.cli.process import counted, refuse, reported


@reported
def sets(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="Print the YAML of this set.")] = None,
    as_json: JsonOption = False,
) -> None:
    """List the bundled scenario sets, or print one to begin from."""
    from hough_tui.reports.documents import document_text
    from hough_tui.reports.tables import listing
    from scenarios.files.set_files import bundled_sets, locate, read_text

    if name is not None:
        refuse(as_json, "--json lists the sets: leave out the name")
        write_document(read_text(locate(name)))
        return
    known = bundled_sets()
    if as_json:
        listed = [{"name": one.name, "description": one.description} for one in known]
        write_document(document_text({"sets": listed}))
        return
    entries = [(found.name, found.description) for found in known]
    print_renderables(listing("bundled scenario sets", entries, output_width()))


@reported
def initiators(
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="Show the parameters of this one.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """List the initiators, or show the parameters of one."""
    from algorithms.initiators import registry
    from hough_tui.reports.describe_initiator import declaration, failed_declaration
    from hough_tui.reports.documents import document_text
    from hough_tui.reports.tables import listing

    chosen = [registry.initiator(name)] if name else list(registry.initiators().values())
    failed = [] if name else registry.failed_plug_ins()
    declared = [*map(declaration, chosen), *map(failed_declaration, failed)]
    if as_json:
        write_document(document_text({"initiators": declared}))
    elif name:
        entries = [(parameter["name"], described(parameter)) for parameter in declared[0]["parameters"]]
        title = f"{name}: {declared[0]['summary']}"
        print_renderables(listing(title, entries, output_width(), ("parameter", "what it is")))
    else:
        entries = [(each["name"], each["error"] or each["summary"]) for each in declared]
        print_renderables(listing("initiators", entries, output_width()))


def described(declared: dict[str, Any]) -> str:
    """Return what a parameter is, what it may be, and what it is where nothing is given."""
    default = "none" if declared["default"] is None else declared["default"]
    text = f"{declared['help']} ({declared['allowed']}; default {default})"
    return f"{text}; auto: {declared['auto']}" if declared["auto"] else text


@reported
def validate(
    names: Annotated[list[str], typer.Argument(metavar="SET…", help="YAML files, or names of bundled sets.")],
) -> None:
    """Check scenario sets and say what is wrong, with file, line, column and field."""
    from algorithms.errors import RequestError
    from scenarios.files.set_files import load_set

    wrong = []
    for name in names:
        try:
            found = load_set(name)
        except RequestError as error:
            wrong.append(str(error))
        else:
            parts: dict[str, Sequence[object]] = {
                "scenario": found.scenarios,
                "scene": found.scenes,
                "initiator": found.initiators,
                "clustering": found.clusterings,
                "experiment": found.experiments,
            }
            always = {"scenario", "initiator", "experiment"} if found.scenarios else {"scene", "experiment"}
            told = [(part, len(listed)) for part, listed in parts.items() if listed or part in always]
            counts = ", ".join(counted(number, part) for part, number in told)
            print_line(f"{name}: valid: {counts}")
    if wrong:
        raise RequestError("\n".join(wrong))


@reported
def metrics(as_json: JsonOption = False) -> None:
    """List what experiments measure: what --columns, --metric and charts take, and documents hold."""
    from hough_tui.reports.documents import document_text
    from hough_tui.reports.layout import sheet_table
    from hough_tui.reports.metric_listing import metric_document, metric_sheet

    if as_json:
        write_document(document_text(metric_document()))
    else:
        print_renderables(sheet_table(metric_sheet(), output_width()))


@reported
def schema() -> None:
    """Print the JSON Schema of scenario sets, for the completion of editors."""
    from hough_tui.reports.documents import json_text
    from scenarios.model import ScenarioSet

    document = {"$schema": "https://json-schema.org/draft/2020-12/schema", **ScenarioSet.model_json_schema()}
    write_document(json_text(document))
