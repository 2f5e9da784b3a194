"""Arguments and options that several commands have."""

from __future__ import annotations

from typing import Annotated

import typer

MetricOption = Annotated[
    str | None,
    typer.Option(
        metavar="METRIC",
        help="What --plot shows; by default success, of clusterings the exact counts. `hough-tui metrics` "
        "lists what there is.",
    ),
]
ColumnsOption = Annotated[
    str | None,
    typer.Option(
        metavar="METRIC,…",
        help="What the tables show, in this order: metrics, intervals by METRIC_ci95, or all; by default "
        "what fits.",
    ),
]
SetArgument = Annotated[str, typer.Argument(metavar="SET", help="A YAML file, or the name of a bundled set.")]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document and nothing else.")]
SeedOption = Annotated[
    int | None, typer.Option(min=0, max=2**64 - 1, help="Draws to use in place of those of the set.")
]
WorkersOption = Annotated[
    int | None, typer.Option(min=1, max=1024, help="Threads; by default all processors.")
]
TrialsOption = Annotated[int | None, typer.Option(min=1, max=10_000_000, help="Trials of every experiment.")]
SetOption = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="A field and its value; may be repeated."),
]
