"""The command line: arguments in, documents and tables out; the work is done elsewhere.

Heavy modules are imported inside the commands, so that `--help` answers at once.
"""

from __future__ import annotations

import contextlib
import sys
import warnings
from pathlib import Path
from typing import Annotated, Any

import typer

from hough_tui import streams
from hough_tui.cli.advise import advise
from hough_tui.cli.cluster import cluster
from hough_tui.cli.listings import initiators, metrics, schema, sets, validate
from hough_tui.cli.output import print_line
from hough_tui.cli.plots import initiate, simulate
from hough_tui.cli.process import WRONG_REQUEST, failed, refuse, reported
from hough_tui.cli.results import results_app
from hough_tui.cli.runs import batch, reproduce
from hough_tui.ending import watched
from hough_tui.reports.visible import visible

UsageError: Any = typer.BadParameter.__base__
"""A wrong command line; typer exports this one kind of it only."""

app = typer.Typer(
    name="hough-tui",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def print_version(asked: bool) -> None:
    """Print the version and end."""
    if asked:
        from hough_tui import __version__

        print_line(f"hough-tui {__version__}")
        raise typer.Exit


@app.callback()
def about(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=print_version, is_eager=True)
    ] = False,
) -> None:
    """Design and judge track initiation, above all by the Hough transform.

    Without a command the application opens; with the name of a scenario set in place of one, it opens on
    that set.
    """


@reported
def open_application(
    name: Annotated[
        str | None, typer.Argument(metavar="SET", help="A YAML file, or the name of a bundled set.")
    ] = None,
) -> None:
    """Open the application, on a set where one is given."""
    from hough_tui.ui.terminal import require_terminal
    from scenarios.files.bundled import bundled_paths

    if name is not None and name not in bundled_paths() and not Path(name).exists():
        from algorithms.parameters import unknown

        known = [*bundled_paths(), *(command for command in commands() if command != "open")]
        refuse(True, unknown(name, known, "file, bundled set or command"))
    require_terminal()
    from hough_tui.ui.interpreter import leave
    from hough_tui.ui.start import run as run_application

    leave(run_application(name))


# As `--help` lists them.
for command in (
    batch,
    initiate,
    simulate,
    advise,
    cluster,
    reproduce,
    sets,
    initiators,
    metrics,
    validate,
    schema,
):
    app.command()(command)
app.command("open", hidden=True)(open_application)
app.add_typer(results_app, name="results")


def commands() -> list[str]:
    """Return the names of the commands."""
    named = [
        command.name or command.callback.__name__ for command in app.registered_commands if command.callback
    ]
    return [*named, *(group.name or "" for group in app.registered_groups)]


def main() -> None:
    """Run the command line of this process, and see to it that it ends when it is asked to."""
    with watched():
        run(sys.argv[1:])


def run(arguments: list[str]) -> None:
    """Run a command line: without a command, the application is opened, on a set where one is named."""
    streams.prepare()
    silence_libraries()
    if not arguments or not (arguments[0].startswith("-") or arguments[0] in commands()):
        arguments = ["open", *arguments]
    try:
        status = status_of(arguments)
    finally:
        lost = streams.settle()
    if lost is not None and status == 0:
        status = failed(lost)
        streams.settle()
    sys.exit(status)


def status_of(arguments: list[str]) -> int:
    """Run a command and return its exit status."""
    try:
        return app(arguments, standalone_mode=False) or 0
    except UsageError as error:
        from typer.rich_utils import rich_format_error

        error.message = visible(error.message)
        # Where nobody can be told, the status still says that the request was wrong.
        with contextlib.suppress(OSError):
            rich_format_error(error)
        return WRONG_REQUEST
    except OSError as error:
        # A command has reported its own errors: this is help or the version, which could not be written.
        return failed(streams.named(error))


def silence_libraries() -> None:
    """Keep warnings of libraries from the user, unless Python itself was asked for them."""
    if not sys.warnoptions:
        warnings.showwarning = lambda *_, **__: None
