"""The command that gathers points of a high-resolution radar into plots."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from hough_tui.cli.options import JsonOption, SetOption
from hough_tui.cli.output import (
    is_coloured,
    output_width,
    print_picture,
    print_renderables,
    write_document,
)
from hough_tui.cli.process import announce_compilation, refuse, reported, tell


class Result(StrEnum):
    """Which plot a cluster gives."""

    MEAN = "mean"
    STRONGEST = "strongest"


@reported
def cluster(
    points: Annotated[Path, typer.Argument(metavar="POINTS", help="A CSV file: range, doppler, amplitude.")],
    mode: Annotated[
        str, typer.Option(metavar="MODE", help="recommended, corrected-patent, dbscan or k-means.")
    ] = "recommended",
    range_extent: Annotated[
        float | None, typer.Option(metavar="D_r", help="Greatest extent of a target in range.")
    ] = None,
    doppler_extent: Annotated[
        float | None, typer.Option(metavar="D_d", help="Greatest extent of a target in Doppler.")
    ] = None,
    result: Annotated[
        Result | None, typer.Option(help="The plot of a cluster; by default the mean, by amplitude.")
    ] = None,
    assignments: SetOption = None,
    doppler_span: Annotated[
        float | None,
        typer.Option(metavar="SPAN", help="Unambiguous span of Doppler, which then is a circle."),
    ] = None,
    scan: Annotated[int | None, typer.Option(min=0, help="Use the points of this scan only.")] = None,
    as_json: JsonOption = False,
    csv: Annotated[
        str | None, typer.Option(metavar="FILE", help="Write the plots as CSV; - prints them instead.")
    ] = None,
    with_places: Annotated[
        bool,
        typer.Option("--xy", help="Tell x and y of the plots: dwell is the azimuth in °, from north."),
    ] = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw a scan's points, ellipses and plots.")] = False,
    with_steps: Annotated[bool, typer.Option("--steps", help="Tell the splits of a scan, too.")] = False,
) -> None:
    """Gather the points of a high-resolution radar into one plot a target."""
    printed = csv == "-"
    refuse(as_json and plot, "--json prints one document and nothing else: leave out --plot")
    refuse(as_json and printed, "--json and --csv - both print to standard output: leave one of them out")
    refuse(printed and (plot or with_steps), "--csv - prints nothing but CSV: leave out --plot and --steps")
    refuse(
        csv is not None and not printed and _is_same_file(Path(csv), points),
        f"--csv {csv}: this is the file of the points, which the plots would replace; give another name",
    )
    from hough_tui.recorded.clustering import (
        can_be_followed,
        cluster_recording,
        document,
        given_clustering,
        plot_rows,
        with_cells,
    )
    from hough_tui.reports.clusters import cluster_table, step_table
    from hough_tui.reports.documents import csv_text, document_text
    from scenarios.files.atomic import replace_file
    from scenarios.files.point_files import parse_points
    from scenarios.files.set_files import read_text

    parameters, notes = given_clustering(
        mode, range_extent, doppler_extent, result and result.value, assignments or ()
    )
    refuse(with_steps and not can_be_followed(parameters), f"--steps: mode {mode} splits nothing")
    recording = parse_points(read_text(points), str(points), scan)
    parameters, assumed = with_cells(parameters, recording)
    announce_compilation()
    found = cluster_recording(recording, parameters, doppler_span)
    for note in (*notes, *assumed):
        tell(note)
    told = document(found, with_steps, with_places)
    if csv is not None:
        text = csv_text(plot_rows(told))
        if printed:
            write_document(text)
            return
        replace_file(Path(csv), text)
    if as_json:
        write_document(document_text(told))
        return
    print_renderables(cluster_table(told, output_width()))
    place = recording.place(recording.fullest)
    scan = int(place["scan"])
    if (plot or with_steps) and len(recording.scans) > 1:
        which = f"the first of {len(recording.scans):,}"
        if recording.dwells is not None:
            which = f"dwell {place['dwell']:g}, that of the most points among {len(recording.scans):,}"
        tell(f"scan {scan} is shown, {which}; see --scan")
    if with_steps:
        print_renderables(step_table(told, scan, output_width(), place.get("dwell")))
    if plot:
        print_plane(found)


def _is_same_file(one: Path, other: Path) -> bool:
    return one.exists() and other.exists() and one.samefile(other)


def print_plane(found: Any) -> None:
    """Print a chart of the points of the first scan, or of the fullest dwell, and of its clusters."""
    from hough_tui.reports.charts import cluster_chart

    shown = found.recording.fullest
    width = min(output_width(), 120)
    print_picture(cluster_chart(found.clusters, shown, found.radius, width, 36, is_coloured()))
