"""The command that recommends a quantisation."""

from __future__ import annotations

from typing import Annotated

import typer

from hough_tui.cli.options import JsonOption, SetOption
from hough_tui.cli.output import output_width, print_renderables, write_document
from hough_tui.cli.process import announce_compilation, refuse, reported, tell


@reported
def advise(
    name: Annotated[
        str | None,
        typer.Argument(metavar="SET[:SCENARIO]", help="The scenario that it is for; or give options."),
    ] = None,
    assignments: SetOption = None,
    sigma: Annotated[float | None, typer.Option(help="Standard deviation of the noise on x and y.")] = None,
    scans: Annotated[int | None, typer.Option(min=1, help="Number of scans of a batch.")] = None,
    interval: Annotated[float | None, typer.Option(help="Time between scans, in seconds.")] = None,
    detection_probability: Annotated[
        float | None, typer.Option("--detection-probability", "--pd", help="Probability of a plot in a scan.")
    ] = None,
    clutter: Annotated[float | None, typer.Option(help="Mean number of clutter plots a scan.")] = None,
    region: Annotated[str | None, typer.Option(metavar="X0,X1,Y0,Y1", help="Where plots can lie.")] = None,
    speed: Annotated[float | None, typer.Option(help="Of a target, in units of length a second.")] = None,
    extent: Annotated[
        float | None, typer.Option(help="Length of a target's track within the batch, in place of its speed.")
    ] = None,
    unit: Annotated[str | None, typer.Option(help="Unit of all lengths: km, m or nmi.")] = None,
    false_cells: Annotated[
        float,
        typer.Option(metavar="BOUND", help="How many cells a batch clutter alone may lift, on the mean."),
    ] = 1.0,
    kappa: Annotated[
        float, typer.Option(help="How far a line's extent may spread its votes, in σ of the noise.")
    ] = 1.0,
    separation: Annotated[
        float | None, typer.Option(help="Distance of parallel lines that must be held apart.")
    ] = None,
    confidence: Annotated[
        float, typer.Option(help="Share of each line's votes that --separation holds apart.")
    ] = 0.95,
    with_map: Annotated[bool, typer.Option("--map", help="Show P_D over Δθ and Δρ, too.")] = False,
    check: Annotated[
        int | None, typer.Option(min=2, max=10_000_000, metavar="N", help="Confirm it by N trials.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, max=2**64 - 1, help="Draws of --check.")] = 1,
    apply: Annotated[
        str | None, typer.Option(metavar="SET.yaml", help="Write it into the initiators of this set.")
    ] = None,
    initiator: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Entry that --apply changes; may be repeated.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Recommend Δθ, Δρ and a threshold, with reasons and with what they cost."""
    refuse(bool(initiator) and apply is None, "--initiator says what --apply changes: give --apply SET.yaml")
    refuse(as_json and with_map, "--json has the map already: leave out --map")
    described = {
        "--sigma": sigma, "--scans": scans, "--interval": interval, "--pd": detection_probability,
        "--clutter": clutter, "--region": region, "--speed": speed, "--extent": extent, "--unit": unit,
    }  # fmt: skip
    given = [option for option, value in described.items() if value is not None]
    refuse(
        name is not None and bool(given),
        f"{', '.join(given)}: the scenario says that already; change a field of it with --set KEY=VALUE",
    )
    refuse(name is None and bool(assignments), "--set changes fields of a scenario: name one, SET:SCENARIO")
    from algorithms.quantisation.advisor import advise as recommend
    from hough_tui.cli.sensor_options import demands, known_sensor, sensing
    from hough_tui.quantisation.advice import document
    from hough_tui.quantisation.designs import scenario_design, sensing_design
    from hough_tui.reports.advice import advice_tables
    from hough_tui.reports.documents import document_text

    wanted = demands(false_cells, kappa, separation, confidence)
    if name is None:
        known = known_sensor(sigma, detection_probability, unit, region, interval)
        found, assumed = sensing(known, scans, interval, clutter, speed, extent)
        design = sensing_design(found, wanted, seed, assumed)
    else:
        design = scenario_design(name, assignments or (), wanted)
    announce_compilation()
    advice = recommend(design.question)
    told = document(design, advice)
    if check is not None:
        from hough_tui.quantisation.confirmation import confirm

        told["check"] = confirm(design, advice.grid, advice.votes, check, seed)
    if apply is not None:
        from hough_tui.quantisation.apply_advice import adopt_in_file

        adoption = adopt_in_file(apply, advice, initiator or ())
        told["applied"] = {"set": apply, "initiators": adoption.names}
        tell(f"written to {apply}: {', '.join(adoption.names)}")
        for note in adoption.notes:
            tell(note)
    if as_json:
        write_document(document_text(told))
        return
    print_renderables(*advice_tables(told, output_width(), with_map))
