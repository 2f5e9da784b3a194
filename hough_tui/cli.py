"""The command line: arguments in, documents and tables out; the work is done elsewhere.

Heavy modules are imported inside the commands, so that `--help` answers at once.
"""

from __future__ import annotations

import contextlib
import functools
import os
import signal
import sys
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from hough_tui.experiments.engine import Job

WRONG_REQUEST, FAILED, INTERRUPTED = 2, 1, 130

app = typer.Typer(
    name="hough-tui",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Metric(StrEnum):
    """What a chart of rates shows."""

    SUCCESS = "success_rate"
    CONTROL = "success_control"
    FALSE = "false_track_ratio"
    FALSE_TRACKS = "false_tracks_per_trial"
    DUPLICATES = "duplicates_per_trial"
    SECONDS = "seconds_per_trial"


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


def reported(command: Callable[..., None]) -> Callable[..., None]:
    """Make a command report what goes wrong as one message and an exit status."""

    @functools.wraps(command)
    def run(*args: Any, **kwargs: Any) -> None:
        from algorithms.errors import RequestError, WorkFailedError

        try:
            command(*args, **kwargs)
            sys.stdout.flush()
        except RequestError as error:
            stop(str(error), WRONG_REQUEST)
        except WorkFailedError as error:
            stop(str(error), FAILED)
        except KeyboardInterrupt as error:
            stop("interrupted", getattr(error, "status", INTERRUPTED))
        except BrokenPipeError:
            # Who reads the output has closed it; the interpreter must not stumble over it again.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(FAILED) from None
        except OSError as error:
            stop(f"{error.filename or 'the system'}: {error.strerror or error}", FAILED)
        except MemoryError:
            stop("there is not enough memory for this; give a smaller grid, or fewer scans or trials", FAILED)

    return run


def stop(message: str, status: int) -> None:
    """Say on standard error why the command ends, and end it."""
    tell(message)
    raise typer.Exit(status)


def counted(number: int, what: str) -> str:
    """Return a number of things, in words."""
    return f"{number:,} {what}" + ("" if number == 1 else "s")


def tell(message: str) -> None:
    """Say something on standard error."""
    # A terminal that has gone away must not keep the work from being ended in order.
    with contextlib.suppress(OSError):
        print(f"hough-tui: {message}", file=sys.stderr, flush=True)


def refuse(condition: bool, message: str) -> None:
    """Raise a wrong request where a condition holds."""
    from algorithms.errors import RequestError

    if condition:
        raise RequestError(message)


def print_renderables(*renderables: Any) -> None:
    """Print tables to standard output: as wide as the terminal, or as they need to be where it is none."""
    from rich.console import Console

    console = Console(width=output_width(), highlight=False, markup=False, soft_wrap=False)
    for renderable in renderables:
        console.print(renderable)


def output_width() -> int:
    """Return how many columns standard output has; 160 where it is no terminal and COLUMNS does not say."""
    import shutil

    if sys.stdout.isatty() or os.environ.get("COLUMNS", "").isdecimal():
        return shutil.get_terminal_size().columns
    return 160


def is_coloured() -> bool:
    """Return whether standard output may have colour."""
    return sys.stdout.isatty() and not os.environ.get("NO_COLOR")


def announce_compilation() -> None:
    """Say that kernels must be compiled, where they must."""
    from algorithms.compiled import is_cold

    if is_cold():
        tell("compiling the kernels, once for this version: up to 20 s")


class EndedError(KeyboardInterrupt):
    """The process was asked to end, or has lost its terminal."""

    def __init__(self, number: int, _: object) -> None:
        super().__init__()
        self.status = 128 + number
        raise self


def finish(job: Job, description: str) -> None:
    """Wait for a job with a progress bar on standard error; end it in order where the process must end."""
    from hough_tui.reports.progress import ProgressBar

    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, EndedError)
    progress = job.progress
    try:
        with ProgressBar(description) as bar:
            while not job.wait(0.1):
                bar.update(
                    progress.cells_done,
                    len(progress.total),
                    int(progress.done.sum()),
                    int(progress.total.sum()),
                )
    except KeyboardInterrupt:
        job.cancel()
        # What a worker fails with while everything is being ended is no news.
        with contextlib.suppress(Exception):
            job.wait()
        raise


@app.command()
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
    metric: Annotated[Metric, typer.Option(help="What --plot shows.")] = Metric.SUCCESS,
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
    from hough_tui.experiments.engine import Job
    from hough_tui.experiments.plan import plan_run
    from hough_tui.experiments.results import result
    from hough_tui.reports.documents import csv_text, json_text
    from scenarios.atomic import replace_file
    from scenarios.files import load_set

    plan = plan_run([load_set(name) for name in sets], experiments=experiment or (), trials=trials, seed=seed)
    announce_compilation()
    job = Job(plan, workers)
    try:
        finish(job, ", ".join(sets))
    except KeyboardInterrupt:
        if keep and job.rows():
            keep_run(result(job))
        raise
    run = result(job)
    status = keep_run(run) if keep else 0
    if as_json:
        sys.stdout.write(json_text(run.document))
    elif str(csv) == "-":
        sys.stdout.write(csv_text(run.document["rows"]))
    else:
        print_rates(run.document["rows"], metric if plot else None)
    if csv is not None and str(csv) != "-":
        replace_file(csv, csv_text(run.document["rows"]))
    seconds = job.seconds
    tell(
        f"{counted(len(plan.cells), 'cell')}, {counted(plan.trials, 'trial')} in {seconds:.1f} s, "
        f"{plan.trials / seconds:,.0f} a second"
    )
    if status:
        raise typer.Exit(status)


def keep_run(run: Any) -> int:
    """Keep a run and say where; return the exit status, since a full disk must not cost the result."""
    from hough_tui.experiments.store import FolderStore

    try:
        name = FolderStore().add(run)
    except OSError as error:
        tell(f"the run could not be kept: {error.filename or ''}: {error.strerror or error}")
        return FAILED
    tell(f"kept as {name}" + ("" if run.document["complete"] else " (the finished trials only)"))
    return 0


def print_rates(rows: list[dict[str, Any]], metric: Metric | None) -> None:
    """Print the tables of rows, and a chart of each experiment where a metric is given."""
    from itertools import groupby

    from hough_tui.reports.charts import rate_chart
    from hough_tui.reports.tables import rate_tables

    width = output_width()
    print_renderables(*rate_tables(rows, width))
    if metric is None:
        return
    for (_, name), group in groupby(rows, key=lambda row: (row["set"], row["experiment"])):
        print(f"\n{name}")
        print(rate_chart(list(group), metric.value, min(width, 120), 22, is_coloured()))


@app.command()
@reported
def initiate(
    plots: Annotated[Path, typer.Argument(metavar="PLOTS", help="A CSV file: scan or time, x, y.")],
    name: Annotated[
        str, typer.Option("--initiator", "-i", metavar="NAME", help="Which initiator.")
    ] = "standard",
    config: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Its parameters, as YAML; --set goes before them.")
    ] = None,
    assignments: SetOption = None,
    scans: Annotated[
        str | None, typer.Option(metavar="A:B", help="Use scans A to B - 1 only; they are numbered from 0.")
    ] = None,
    interval: Annotated[float | None, typer.Option(help="Time between scans, in seconds.")] = None,
    sigma: Annotated[float | None, typer.Option(help="Standard deviation of the noise on x and y.")] = None,
    detection_probability: Annotated[
        float | None, typer.Option("--detection-probability", "--pd", help="Probability of a plot in a scan.")
    ] = None,
    unit: Annotated[str | None, typer.Option(help="Unit of the positions: km, m or nmi.")] = None,
    region: Annotated[
        str | None, typer.Option(metavar="X0,X1,Y0,Y1", help="Where plots can lie; by default their extent.")
    ] = None,
    like: Annotated[
        str | None,
        typer.Option(metavar="SET[:SCENARIO]", help="Take the sensor and the region from a scenario."),
    ] = None,
    most: Annotated[int, typer.Option(min=1, help="Give at most so many tracks, the strongest.")] = 1000,
    as_json: JsonOption = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the plots, and the tracks as lines.")] = False,
    accumulator: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.npz", help="Write votes, theta (radians) and rho of the accumulator, too."
        ),
    ] = None,
    assigned: Annotated[
        Path | None, typer.Option(metavar="FILE.csv", help="Write the plots with a column `track`, too.")
    ] = None,
) -> None:
    """Run an initiator on recorded plots and print its tracks."""
    refuse(as_json and plot, "--json prints one document and nothing else: leave out --plot")
    from algorithms.initiators.registry import initiator
    from hough_tui.experiments import initiation
    from hough_tui.experiments.options import known_sensor, window
    from hough_tui.reports.documents import json_text
    from scenarios.atomic import replace_file
    from scenarios.files import read_text
    from scenarios.recordings import parse_plots, write_assigned

    algorithm = initiator(name)
    parameters = initiation.given_parameters(algorithm, config, assignments or ())
    known = known_sensor(sigma, detection_probability, unit, region, interval)
    base = initiation.scenario_context(like) if like else None
    text = read_text(plots)
    spacing = interval if interval is not None else base and base.interval
    recording = parse_plots(text, str(plots), interval=spacing, scans=window(scans))
    context, assumed = initiation.context_of(recording, known, base, window(scans))
    announce_compilation()
    found = initiation.initiate(recording, algorithm, parameters, context, assumed, most)
    if accumulator is not None:
        refuse(found.accumulator is None, f"--accumulator: {name} has no accumulator")
        initiation.write_accumulator(found, accumulator)
    if assigned is not None:
        replace_file(assigned, write_assigned(text, recording, found.tracks.plots))
    for field, value in assumed.items():
        tell(f"assumed {field}: {value}")
    for note in initiation.notes(found):
        tell(note)
    document = initiation.document(found)
    if as_json:
        sys.stdout.write(json_text(document))
        return
    from hough_tui.reports.tables import track_table

    print_renderables(track_table(document, output_width()))
    if plot:
        print_plane(found)


def print_plane(found: Any) -> None:
    """Print a chart of the plots of an initiation, and of its tracks as lines."""
    from hough_tui.reports.charts import TrackLine, plane_chart

    plots, region = found.recording.plots, found.context.region
    place = plots.position
    lines = [
        TrackLine(place[rows, 0], place[rows, 1], str(index)) for index, rows in enumerate(found.tracks.plots)
    ]
    limits = region and ((region.lower[0], region.upper[0]), (region.lower[1], region.upper[1]))
    unit, width = found.context.unit.value, min(output_width(), 120)
    print(plane_chart(place[:, 0], place[:, 1], plots.scan, lines, limits, unit, width, 36, is_coloured()))


@app.command()
@reported
def simulate(
    name: SetArgument,
    scenario: Annotated[str | None, typer.Option(help="Which scenario, where the set has several.")] = None,
    trial: Annotated[int, typer.Option(min=0, max=2**32 - 1, help="Which trial, from 0.")] = 0,
    seed: SeedOption = None,
    assignments: SetOption = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Write here, not to standard output."),
    ] = None,
) -> None:
    """Write the plots of one trial as CSV, with the target that each came from and its true position."""
    from hough_tui.experiments.choice import changed, chosen_scenario, seed_of
    from scenarios.atomic import replace_file
    from scenarios.files import load_set
    from scenarios.recordings import write_plots
    from scenarios.simulate import World, draw

    given = load_set(name)
    chosen = chosen_scenario(given, scenario)
    seed = seed_of(given, chosen) if seed is None else seed
    chosen = changed(chosen, assignments or ())
    announce_compilation()
    text = write_plots(draw(World.of(chosen), seed, trial), chosen)
    if output is None:
        sys.stdout.write(text)
    else:
        replace_file(output, text)


@app.command()
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
    from hough_tui.experiments.engine import Job
    from hough_tui.experiments.published import TABLES, compare, plan_table
    from hough_tui.experiments.published import published_table as find_table
    from hough_tui.reports.documents import json_text
    from hough_tui.reports.tables import published_table

    documents = []
    for chosen in [find_table(table)] if table else list(TABLES.values()):
        plan = plan_table(chosen, trials, seed)
        announce_compilation()
        job = Job(plan, workers)
        finish(job, chosen.name)
        documents.append(compare(chosen, job))
    if as_json:
        sys.stdout.write(json_text(documents[0] if table else {"tables": documents}))
        return
    print_renderables(*(published_table(document, output_width()) for document in documents))


@app.command()
@reported
def sets(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="Print the YAML of this set.")] = None,
    as_json: JsonOption = False,
) -> None:
    """List the bundled scenario sets, or print one to begin from."""
    from hough_tui.reports.documents import json_text
    from hough_tui.reports.tables import listing
    from scenarios.files import bundled_sets, locate, read_text

    if name is not None:
        refuse(as_json, "--json lists the sets: leave out the name")
        sys.stdout.write(read_text(locate(name)))
        return
    known = bundled_sets()
    if as_json:
        sys.stdout.write(
            json_text([{"name": found.name, "description": found.description} for found in known])
        )
        return
    entries = [(found.name, found.description) for found in known]
    print_renderables(listing("bundled scenario sets", entries, output_width()))


@app.command()
@reported
def initiators(
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="Show the parameters of this one.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """List the initiators, or show the parameters of one."""
    from algorithms.initiators.registry import initiator
    from algorithms.initiators.registry import initiators as known
    from hough_tui.experiments.declarations import declaration
    from hough_tui.reports.documents import json_text
    from hough_tui.reports.tables import listing

    chosen = [initiator(name)] if name else list(known().values())
    told = [declaration(found) for found in chosen]
    if as_json:
        sys.stdout.write(json_text(told[0] if name else told))
    elif name:
        entries = [(found["name"], described(found)) for found in told[0]["parameters"]]
        title = f"{name}: {told[0]['summary']}"
        print_renderables(listing(title, entries, output_width(), ("parameter", "what it is")))
    else:
        entries = [(found["name"], found["summary"]) for found in told]
        print_renderables(listing("initiators", entries, output_width()))


def described(declared: dict[str, Any]) -> str:
    """Return what a parameter is, what it may be, and what it is where nothing is given."""
    default = "none" if declared["default"] is None else declared["default"]
    text = f"{declared['help']} ({declared['allowed']}; default {default})"
    return f"{text}; auto: {declared['auto']}" if declared["auto"] else text


@app.command()
@reported
def validate(
    names: Annotated[list[str], typer.Argument(metavar="SET…", help="YAML files, or names of bundled sets.")],
) -> None:
    """Check scenario sets and say what is wrong, with file, line, column and field."""
    from algorithms.errors import RequestError
    from scenarios.files import load_set

    wrong = []
    for name in names:
        try:
            found = load_set(name)
        except RequestError as error:
            wrong.append(str(error))
        else:
            parts = {
                "scenario": found.scenarios,
                "initiator": found.initiators,
                "experiment": found.experiments,
            }
            counts = ", ".join(counted(len(listed), part) for part, listed in parts.items())
            print(f"{name}: valid: {counts}")
    if wrong:
        raise RequestError("\n".join(wrong))


@app.command()
@reported
def schema() -> None:
    """Print the JSON Schema of scenario sets, for the completion of editors."""
    from hough_tui.reports.documents import json_text
    from scenarios.model import ScenarioSet

    document = {"$schema": "https://json-schema.org/draft/2020-12/schema", **ScenarioSet.model_json_schema()}
    sys.stdout.write(json_text(document))


results_app = typer.Typer(help="List and show the runs that were kept.", no_args_is_help=True)
app.add_typer(results_app, name="results")


@results_app.command("list")
@reported
def list_results(as_json: JsonOption = False) -> None:
    """List the runs that were kept, the newest first."""
    from hough_tui.experiments.store import FolderStore
    from hough_tui.reports.documents import json_text
    from hough_tui.reports.tables import listing

    names = FolderStore().names()
    if as_json:
        sys.stdout.write(json_text(names))
    elif names:
        store = FolderStore()
        documents = [(name, store.document(name)) for name in names]
        told = [(name, f"{len(found['rows'])} rows, seed {found['seed']}") for name, found in documents]
        print_renderables(listing("runs", told, output_width()))
    else:
        tell("no run has been kept yet; `hough-tui batch` keeps each of its runs")


@results_app.command("show")
@reported
def show_result(
    name: Annotated[str, typer.Argument(metavar="RUN", help="Its name, or a part of it that fits no other.")],
    as_json: JsonOption = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw a chart of the rates below the tables.")] = False,
    metric: Annotated[Metric, typer.Option(help="What --plot shows.")] = Metric.SUCCESS,
) -> None:
    """Show the rates of a run that was kept."""
    refuse(as_json and plot, "--json prints one document and nothing else: leave out --plot")
    from hough_tui.experiments.store import FolderStore
    from hough_tui.reports.documents import json_text

    document = FolderStore().document(name)
    if as_json:
        sys.stdout.write(json_text(document))
    else:
        print_rates(document["rows"], metric if plot else None)


def print_version(asked: bool) -> None:
    """Print the version and end."""
    if asked:
        from hough_tui import __version__

        print(f"hough-tui {__version__}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=print_version, is_eager=True)
    ] = False,
) -> None:
    """Design and judge track initiation, above all by the Hough transform.

    Without a command the application opens; with the name of a scenario set in place of one, it opens on
    that set.
    """


@app.command("open", hidden=True)
@reported
def open_application(
    name: Annotated[
        str | None, typer.Argument(metavar="SET", help="A YAML file, or the name of a bundled set.")
    ] = None,
) -> None:
    """Open the application, on a set where one is given."""
    from hough_tui.ui.terminal import require_terminal
    from scenarios.bundled import bundled_paths

    if name is not None and name not in bundled_paths() and not Path(name).exists():
        from algorithms.parameters import unknown

        known = [*bundled_paths(), *(command for command in commands() if command != "open")]
        refuse(True, unknown(name, known, "file, bundled set or command"))
    require_terminal()
    from hough_tui.ui.app import run
    from hough_tui.ui.interpreter import leave

    leave(run(name))


def commands() -> list[str]:
    """Return the names of the commands."""
    named = [
        command.name or command.callback.__name__ for command in app.registered_commands if command.callback
    ]
    return [*named, *(group.name or "" for group in app.registered_groups)]


def main() -> None:
    """Run the command line: without a command, the application is opened, on a set where one is named."""
    arguments = sys.argv[1:]
    if not arguments or not (arguments[0].startswith("-") or arguments[0] in commands()):
        arguments = ["open", *arguments]
    app(arguments)
