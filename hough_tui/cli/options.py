"""Arguments and options that several commands have."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer


class Metric(StrEnum):
    """What a chart of rates shows."""

    SUCCESS = "success_rate"
    CONTROL = "success_control"
    FALSE = "false_track_ratio"
    FALSE_TRACKS = "false_tracks_per_trial"
    DUPLICATES = "duplicates_per_trial"
    EXACT = "count_exact_rate"
    EXCESS = "excess_per_trial"
    CENTROID = "centroid_rmse"
    SECONDS = "seconds_per_trial"


MetricOption = Annotated[
    Metric | None,
    typer.Option(help="What --plot shows; by default success, of clusterings the exact counts."),
]


class ComparedMetric(StrEnum):
    """What of two runs can be compared."""

    SUCCESS = "success_rate"
    FALSE = "false_track_ratio"
    EXACT = "count_exact_rate"


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
