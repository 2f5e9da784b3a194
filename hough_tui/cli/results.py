"""`hough-tui results`: the runs that were kept."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hough_tui.cli.options import ColumnsOption, JsonOption, MetricOption
from hough_tui.cli.output import output_width, print_renderables, write_document
from hough_tui.cli.process import refuse, reported, tell
from hough_tui.cli.runs import Shown, print_rates

results_app = typer.Typer(
    help="List, show, compare and export the runs that were kept.", no_args_is_help=True
)


@results_app.command("list")
@reported
def list_results(as_json: JsonOption = False) -> None:
    """List the runs that were kept, the newest first."""
    from hough_tui.experiments.stores.folder import FolderStore
    from hough_tui.reports.documents import document_text
    from hough_tui.reports.tables import listing

    names = FolderStore().names()
    if as_json:
        write_document(document_text({"runs": names}))
    elif names:
        store = FolderStore()
        documents = [(name, store.document(name)) for name in names]
        told = [(name, f"{len(found['rows'])} rows, seed {found['seed']}") for name, found in documents]
        print_renderables(listing("runs", told, output_width()))
    else:
        tell("no run has been kept yet; `hough-tui batch` keeps each of its runs")


RunArgument = Annotated[
    str, typer.Argument(metavar="RUN", help="Its name, or a part of it that fits no other.")
]


@results_app.command("show")
@reported
def show_result(
    name: RunArgument,
    as_json: JsonOption = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw a chart of the rates below the tables.")] = False,
    metric: MetricOption = None,
    columns: ColumnsOption = None,
) -> None:
    """Show the rates of a run that was kept."""
    refuse(as_json and plot, "--json prints one document and nothing else: leave out --plot")
    from hough_tui.experiments.stores.folder import FolderStore
    from hough_tui.reports.documents import document_text

    shown = Shown.parse(columns, metric)
    document = FolderStore().document(name)
    if as_json:
        write_document(document_text(document))
    else:
        print_rates(document["rows"], shown, plot)


@results_app.command("compare")
@reported
def compare_results(
    names: Annotated[
        list[str], typer.Argument(metavar="RUN RUN…", help="Names, or parts of them that fit no other.")
    ],
    metric: Annotated[
        str | None,
        typer.Option(
            metavar="METRIC",
            help="What is compared: a metric that has an interval; by default success, of clusterings the "
            "exact counts.",
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Compare runs row by row, each with the first, and tell which rates differ beyond chance."""
    refuse(len(names) < 2, f"there is one run only, '{names[0]}': name another one to compare it with")
    from hough_tui.experiments.metrics.registry import leading_metric
    from hough_tui.experiments.stores.folder import FolderStore
    from hough_tui.reports.comparison import compare, comparison_document, comparison_sheet
    from hough_tui.reports.documents import document_text
    from hough_tui.reports.layout import sheet_table
    from hough_tui.reports.metric_columns import charted

    chosen = None if metric is None else charted(metric)
    store = FolderStore()
    full = [store.full_name(name) for name in names]
    twice = next((name for name in full if full.count(name) > 1), None)
    refuse(twice is not None, f"the run {twice} is given twice: a run does not differ from itself")
    runs = [(name, store.load(name)) for name in full]
    rows = [row for _, run in runs for row in run.document["rows"]]
    comparison = compare(runs, chosen or leading_metric(rows))
    if as_json:
        write_document(document_text(comparison_document(comparison)))
    else:
        print_renderables(sheet_table(comparison_sheet(comparison), output_width()))


@results_app.command("export")
@reported
def export_result(
    name: RunArgument,
    path: Annotated[
        Path, typer.Argument(metavar="FILE", help="What to write: .csv, .json or .md says in which format.")
    ],
) -> None:
    """Write the rates of a run that was kept to a file, which is replaced where it exists."""
    from hough_tui.experiments.stores.folder import FolderStore
    from hough_tui.reports.documents import FORMATS
    from scenarios.files.atomic import replace_file

    ending = path.suffix.lower()
    refuse(ending not in FORMATS, f"{path}: the name must end in one of {', '.join(FORMATS)}")
    refuse(path.is_dir(), f"{path} is a folder; give a file in it")
    refuse(not path.parent.is_dir(), f"{path}: there is no folder {path.parent}")
    document = FolderStore().document(name)
    replace_file(path, FORMATS[ending][1](document))
    tell(f"{len(document['rows'])} rows written to {path}")
