"""Commands that run experiments, and that show the runs which were kept."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Self

import typer

from hough_tui.cli.options import (
    ColumnsOption,
    JsonOption,
    MetricOption,
    SeedOption,
    TrialsOption,
    WorkersOption,
)
from hough_tui.cli.output import (
    is_coloured,
    output_width,
    print_line,
    print_picture,
    print_renderables,
    write_document,
)
from hough_tui.cli.process import FAILED, announce_compilation, counted, finish, refuse, reported, tell
from hough_tui.ending import finishing


@reported
def batch(
    sets: Annotated[list[str], typer.Argument(metavar="SET…", help="YAML files, or names of bundled sets.")],
    experiment: Annotated[
        list[str] | None, typer.Option(help="Run this experiment only; may be repeated.")
    ] = None,
    trials: TrialsOption = None,
    seed: SeedOption = None,
    workers: WorkersOption = None,
    as_json: JsonOption = False,
    csv: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the rows as CSV, too; - prints them.")
    ] = None,
    plot: Annotated[bool, typer.Option("--plot", help="Draw a chart of the rates below the tables.")] = False,
    metric: MetricOption = None,
    columns: ColumnsOption = None,
    keep: Annotated[
        bool, typer.Option("--keep/--no-keep", help="Keep the run below the data directory.")
    ] = True,
) -> None:
    """Run the experiments of scenario sets and print their rates."""
    refuse(plot and str(csv) == "-", "--csv - prints the rows and nothing else: leave out --plot")
    refuse(
        as_json and (plot or str(csv) == "-"),
        "--json prints one document and nothing else: leave out --plot and --csv -",
    )
    from hough_tui.experiments.engines.threads import Job
    from hough_tui.experiments.plan import plan_run
    from hough_tui.experiments.results import result
    from hough_tui.reports.documents import csv_text, document_text
    from scenarios.files.atomic import replace_file
    from scenarios.files.set_files import load_set

    shown = Shown.parse(columns, metric)
    plan = plan_run([load_set(name) for name in sets], experiments=experiment or (), trials=trials, seed=seed)
    announce_compilation()
    job = Job(plan, workers)
    try:
        finish(job, ", ".join(sets))
    except KeyboardInterrupt:
        if keep and job.progress.done.any():
            keep_run(result(job))
        raise
    run = result(job)
    status = keep_run(run) if keep else 0
    # The file first: what cannot be printed must not cost it, nor it what is printed.
    failure: OSError | None = None
    if csv is not None and str(csv) != "-":
        try:
            replace_file(csv, csv_text(run.document["rows"]))
        except OSError as error:
            failure = error
    if as_json:
        write_document(document_text(run.document))
    elif str(csv) == "-":
        write_document(csv_text(run.document["rows"]))
    else:
        print_rates(run.document["rows"], shown, plot)
    if failure is not None:
        raise failure
    seconds = job.seconds
    tell(
        f"{counted(len(plan.cells), 'cell')}, {counted(plan.trials, 'trial')} in {seconds:.1f} s, "
        f"{plan.trials / seconds:,.0f} a second"
    )
    if status:
        raise typer.Exit(status)


def keep_run(run: Any) -> int:
    """Keep a run and say where; return the exit status, since a full disk must not cost the result."""
    from algorithms.errors import RequestError
    from hough_tui.experiments.stores.folder import FolderStore

    try:
        with finishing():
            name = FolderStore().add(run)
    except OSError as error:
        tell(f"the run could not be kept: {error.filename or ''}: {error.strerror or error}")
        return FAILED
    except RequestError as error:
        tell(f"the run could not be kept: {error}")
        return FAILED
    tell(f"kept as {name}" + ("" if run.document["complete"] else " (the finished trials only)"))
    return 0


@dataclass(frozen=True, slots=True)
class Shown:
    """What is shown of result rows.

    Attributes
    ----------
    columns : keys of the columns of tables; None for what fits
    metric : key of what charts show; None for what rows of a kind are for
    """

    columns: tuple[str, ...] | None
    metric: str | None

    @classmethod
    def parse(cls, columns: str | None, metric: str | None) -> Self:
        """Return what options ask for.

        Raises
        ------
        RequestError
            Where there is no such column or metric.
        """
        from hough_tui.reports.metric_columns import charted, parse_columns

        wanted = None if columns is None else parse_columns(columns)
        return cls(wanted, None if metric is None else charted(metric).key)


def print_rates(rows: list[dict[str, Any]], shown: Shown, with_charts: bool) -> None:
    """Print the tables of rows and, if so asked, a chart of each experiment."""
    from itertools import groupby

    from hough_tui.experiments.metrics.registry import leading_metric
    from hough_tui.reports.charts import rate_chart
    from hough_tui.reports.tables import rate_tables

    width = output_width()
    print_renderables(*rate_tables(rows, width, shown.columns))
    if not with_charts:
        return
    for (_, name), group in groupby(rows, key=lambda row: (row["set"], row["experiment"])):
        print_line(f"\n{name}")
        part = list(group)
        key = shown.metric or leading_metric(part).key
        print_picture(rate_chart(part, key, min(width, 120), 22, is_coloured()))


@reported
def reproduce(
    table: Annotated[
        str | None, typer.Argument(metavar="TABLE", help="Which table; without one: all.")
    ] = None,
    trials: Annotated[int, typer.Option(min=2, max=10_000_000, help="Trials of every figure.")] = 4000,
    seed: SeedOption = None,
    workers: WorkersOption = None,
    as_json: JsonOption = False,
) -> None:
    """Print published tables beside what is measured here, with 95 % intervals."""
    from hough_tui.experiments.engines.threads import Job
    from hough_tui.published.comparison import TABLES, compare, plan_table
    from hough_tui.published.comparison import published_table as find_table
    from hough_tui.reports.documents import document_text
    from hough_tui.reports.tables import published_table

    documents = []
    for chosen in [find_table(table)] if table else list(TABLES.values()):
        plan = plan_table(chosen, trials, seed)
        announce_compilation()
        job = Job(plan, workers)
        finish(job, chosen.name)
        documents.append(compare(chosen, job))
    if as_json:
        write_document(document_text({"tables": documents}))
        return
    print_renderables(*(published_table(document, output_width()) for document in documents))
