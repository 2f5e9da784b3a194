"""Commands on plots: initiating tracks on recorded ones, writing simulated ones."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from hough_tui.cli.options import JsonOption, SeedOption, SetArgument, SetOption
from hough_tui.cli.output import (
    is_coloured,
    output_width,
    print_picture,
    print_renderables,
    write_document,
)
from hough_tui.cli.process import announce_compilation, refuse, reported, tell


@reported
def initiate(
    plots: Annotated[Path, typer.Argument(metavar="PLOTS", help="A CSV file: scan or time, x, y, maybe z.")],
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
    sigma: Annotated[float | None, typer.Option(help="Standard deviation of the noise on each axis.")] = None,
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
    csv: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the tracks with their states as CSV, too; - prints them."),
    ] = None,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the plots, and the tracks as lines.")] = False,
    accumulator: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.npz",
            help="Write votes, theta (radians) and rho of the accumulator, too; of weighted also std and "
            "weighted.",
        ),
    ] = None,
    assigned: Annotated[
        Path | None, typer.Option(metavar="FILE.csv", help="Write the plots with a column `track`, too.")
    ] = None,
) -> None:
    """Run an initiator on recorded plots and print its tracks."""
    is_printed = str(csv) == "-"
    refuse(
        as_json and (plot or is_printed),
        "--json prints one document and nothing else: leave out --plot and --csv -",
    )
    refuse(plot and is_printed, "--csv - prints the tracks and nothing else: leave out --plot")
    from algorithms.initiators.registry import initiator
    from hough_tui.cli.sensor_options import known_sensor, window
    from hough_tui.recorded import initiation
    from hough_tui.reports.documents import document_text, track_csv
    from scenarios.files.atomic import replace_file
    from scenarios.files.set_files import read_text
    from scenarios.recordings.csv_plots import parse_plots, write_assigned

    algorithm = initiator(name)
    parameters = initiation.given_parameters(algorithm, config, assignments or ())
    known = known_sensor(sigma, detection_probability, unit, region, interval)
    scenario = initiation.like_scenario(like) if like else None
    base = scenario.context if scenario else None
    text = read_text(plots)
    spacing = base.interval if interval is None and base is not None else interval
    recording = parse_plots(text, str(plots), interval=spacing, scans=window(scans))
    recording = initiation.with_noise(recording, known, scenario)
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
    if csv is not None and not is_printed:
        replace_file(csv, track_csv(found.tracks))
    if as_json or is_printed:
        write_document(document_text(document) if as_json else track_csv(found.tracks))
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
    x, y = place[:, 0], place[:, 1]
    print_picture(plane_chart(x, y, plots.scan, lines, limits, unit, width, 36, is_coloured()))


@reported
def simulate(
    name: SetArgument,
    scenario: Annotated[str | None, typer.Option(help="Which scenario, where the set has several.")] = None,
    trial: Annotated[int, typer.Option(min=0, max=2**32 - 1, help="Which trial, from 0.")] = 0,
    seed: SeedOption = None,
    assignments: SetOption = None,
    clustering: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Of sensors of high resolution: cluster the points so, or ideal; by default the points are "
            "written.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Write here, not to standard output."),
    ] = None,
) -> None:
    """Write the plots of one trial as CSV, with the target that each came from and its true position."""
    from hough_tui.inspection.simulated_trial import cell_words, simulated
    from scenarios.files.atomic import replace_file
    from scenarios.files.set_files import load_set
    from scenarios.selection import changed, chosen_clustering, chosen_scenario, seed_of

    given = load_set(name)
    chosen = chosen_scenario(given, scenario)
    seed = seed_of(given, chosen) if seed is None else seed
    chosen = changed(chosen, assignments or ())
    stage = chosen_clustering(given, chosen, clustering)
    announce_compilation()
    text = simulated(chosen, seed, trial, stage)
    if chosen.is_resolved and stage is None:
        tell(cell_words(chosen))
    if output is None:
        write_document(text)
    else:
        replace_file(output, text)
