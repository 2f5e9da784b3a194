"""Writing a recommended quantisation into a scenario set, over what its initiators have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from algorithms.errors import RequestError
from algorithms.initiators.accumulating import AccumulatingParameters
from algorithms.parameters import Parameters, unknown
from algorithms.quantisation.advisor import Advice
from scenarios.files.bundled import bundled_paths
from scenarios.files.set_files import load_set, locate, save_set, set_data
from scenarios.model import ScenarioSet

LEAST_VOTES = "least_votes"
"""Where this is declared, the threshold is on weighted votes, and plain votes must be more than these."""


@dataclass(frozen=True, slots=True)
class Adoption:
    """A set with a recommendation written into it.

    Attributes
    ----------
    changed : the set
    names : of the initiator entries that have it now
    notes : what a reader must know
    """

    changed: ScenarioSet
    names: tuple[str, ...]
    notes: tuple[str, ...]


def adopt(given: ScenarioSet, advice: Advice, names: Sequence[str] = ()) -> Adoption:
    """Return a set with a recommended quantisation and threshold in its accumulating initiators.

    Rows, Δρ and votes are written; where the columns begin and how many there are follows from the region
    again, since those of another Δρ would not cover it. A suppression window is written where the entry has
    one, `fraction` goes because `votes` replaces it. Where votes are weighted their threshold stays, and the
    least plain votes of a cell are written.

    Parameters
    ----------
    given : the set
    advice : what is recommended
    names : of initiator entries; without any, all that accumulate votes

    Raises
    ------
    RequestError
        Where an entry is not known, or does not accumulate votes, or none does.
    """
    known = [entry.name for entry in given.initiators]
    able = [
        entry.name
        for entry in given.initiators
        if issubclass(entry.algorithm.parameters, AccumulatingParameters)
    ]
    for name in names:
        if name not in known:
            raise RequestError(f"--initiator: {unknown(name, known, 'initiator entry')}")
        if name not in able:
            raise RequestError(f"--initiator {name}: it has no accumulator, so no quantisation")
    if not able:
        raise RequestError(
            f"{given.name} lists no initiator that accumulates votes; add one, such as standard"
        )
    chosen = tuple(name for name in able if not names or name in names)
    data = set_data(given)
    for entry in data["initiators"]:
        if entry["name"] in chosen:
            _write(entry, advice, given.entry(entry["name"]).algorithm.parameters)
    notes = [
        f"experiment {experiment.name} sweeps {key}, over what is recommended"
        for experiment in given.experiments
        for key in experiment.sweep
        if key.rpartition(".")[2] in ("fraction", "votes", "theta_bins", "rho_step", "rho_bins", "rho_min")
    ]
    return Adoption(ScenarioSet.model_validate(data), chosen, tuple(notes))


def _write(entry: dict[str, Any], advice: Advice, declared: type[Parameters]) -> None:
    grid = {
        key: value
        for key, value in (entry.get("grid") or {}).items()
        if key in ("theta_bins", "theta_offset")
    }
    entry["grid"] = {**grid, "theta_bins": advice.grid.theta_bins, "rho_step": advice.grid.rho_step}
    if LEAST_VOTES in declared.model_fields:
        entry[LEAST_VOTES] = advice.votes - 1
    else:
        entry.pop("fraction", None)
        entry["votes"] = advice.votes
    window = advice.prediction.window
    for key, value in (("suppress_theta", window.theta), ("suppress_rho", window.rho_upright)):
        if key in entry:
            entry[key] = value


def adopt_in_file(name: str, advice: Advice, names: Sequence[str] = ()) -> Adoption:
    """Write a recommendation into a set's file; comments, order and layout survive.

    Raises
    ------
    RequestError
        Where the file is no set that can be written, or an entry is not fit for it.
    """
    path = locate(name)
    if path in bundled_paths().values():
        raise RequestError(
            f"--apply {name}: a bundled set is not written to; write into a copy: hough-tui sets {path.stem} "
            "> mine.yaml"
        )
    adoption = adopt(load_set(path), advice, names)
    save_set(adoption.changed, path)
    return adoption
