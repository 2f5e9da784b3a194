"""Tables 3-1 to 3-3 and the five targets of section 4.3 of the master's thesis."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hough_tui.published.tables import Entry, PublishedTable

SOURCE = "master's thesis, Northwestern Polytechnical University, 2004"
TRIALS = 100

SUMMED = "printed as a sum over 100 trials; divided by 100"
MISPRINTED = f"{SUMMED}, and .0073814 read as .00073814"
NO_FRAME = "the ρ columns follow from no frame of coordinates: not fitted, not judged; ρ about the origin"
QUALIFIED = "trials where no cell has more votes than T1 are left out"

Figures = tuple[float, float, float, float]
"""Mean square errors as printed: θ by binary votes, by least deviation, then ρ by the same two."""


def _errors(
    case: str, experiment: str, suffix: str, figures: Figures, swept: Mapping[str, float], note: str | None
) -> Iterator[Entry]:
    for metric, binary, deviation, said, is_judged in (
        ("theta_mse", figures[0], figures[1], note, True),
        ("rho_mse", figures[2], figures[3], NO_FRAME, False),
    ):
        name, initiator = f"{case}, binary", f"binary-{suffix}"
        yield Entry(name, experiment, initiator, metric, binary, said, dict(swept), is_judged)
        for least in (40, 50):
            also = "; ".join(filter(None, (said, QUALIFIED)))
            name = f"{case}, least deviation, T1 = {least}"
            initiator = f"deviation-{least}-{suffix}"
            yield Entry(name, experiment, initiator, metric, deviation, also, dict(swept), is_judged)


def _noise_table(
    number: str, detection: float, published: dict[str, Figures], note: str | None
) -> PublishedTable:
    entries = [
        entry
        for sigma, figures in published.items()
        for entry in _errors(
            f"σ = {sigma} km",
            f"noise-{round(float(sigma) * 1000)}m",
            f"{round(float(sigma) * 1000)}m",
            figures,
            {"detection_probability": detection},
            note,
        )
    ]
    return _errors_table(number, f"mean square errors, Pd = {detection:g}", entries)


def _errors_table(number: str, what: str, entries: list[Entry]) -> PublishedTable:
    return PublishedTable(
        name=f"thesis-{number}",
        title=f"Table {number}: {what}",
        source=SOURCE,
        set_name="thesis-weighting",
        trials=TRIALS,
        rounding=0.0,
        entries=tuple(entries),
    )


def _clutter_table() -> PublishedTable:
    # θ of 156 and 234 is printed as .0073814 in the binary column.
    published: dict[int, tuple[Figures, str]] = {
        78: ((4.7315e-6, 1.289e-6, 0.078678, 0.018621), SUMMED),
        156: ((7.3814e-6, 1.289e-6, 0.0918199, 0.020727), MISPRINTED),
        234: ((7.3814e-6, 1.289e-6, 0.11347, 0.020946), MISPRINTED),
    }
    entries = [
        entry
        for count, (figures, note) in published.items()
        for entry in _errors(f"{count} clutter plots", "clutter", "100m", figures, {"count": count}, note)
    ]
    return _errors_table("3-3", "mean square errors by clutter, σ = 0.1 km, Pd = 0.9", entries)


WAYS = {
    "binary": "binary votes",
    "thesis": "binary, thesis extraction",
    "best-first": "binary, best-first",
    "vote-removal": "binary, vote removal",
    "weighted": "weighted votes",
    "weighted-thesis": "weighted, thesis extraction",
}
DRAWN = "the thesis draws one trial and gives no figure"


def _five_targets() -> PublishedTable:
    entries = tuple(
        Entry(
            f"{scans} scans, {count} clutter plots, {words}",
            experiment,
            f"{way}-{scans}",
            metric,
            note=DRAWN,
            swept={"count": count},
        )
        for scans, experiment, counts in (
            (20, "twenty-scans", (246, 376)),
            (40, "forty-scans", (475, 622, 784)),
        )
        for count in counts
        for way, words in WAYS.items()
        for metric in ("success_rate", "duplicates_per_trial", "false_tracks_per_trial")
    )
    return PublishedTable(
        name="thesis-five-targets",
        title="Section 4.3: five targets among clutter, by the way of taking peaks",
        source=SOURCE,
        set_name="thesis-five-targets",
        trials=1,
        rounding=0.0,
        entries=entries,
    )


TABLES = (
    _noise_table(
        "3-1",
        1.0,
        {
            "0.1": (6.5888e-6, 1.289e-6, 0.086244, 0.020671),
            "0.2": (4.0493e-5, 3.9389e-6, 0.55899, 0.063986),
            "0.3": (8.0762e-5, 4.8715e-5, 1.1316, 0.73976),
        },
        None,
    ),
    _noise_table(
        "3-2",
        0.9,
        {
            "0.1": (3.9389e-6, 1.289e-6, 0.065707, 0.019898),
            "0.2": (2.5658e-5, 7.3814e-6, 0.38054, 0.1156),
            "0.3": (1.0937e-4, 4.8715e-5, 1.5344, 0.77498),
        },
        SUMMED,
    ),
    _clutter_table(),
    _five_targets(),
)
