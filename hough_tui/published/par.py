"""Table 2 of Wang and Zhao (2014): true tracks of a precision approach radar, by target."""

from __future__ import annotations

from hough_tui.published.tables import Entry, PublishedTable

COMBINATORIAL = {"T1": 0.965, "T2": 0.94, "T3": 0.945, "T4": 0.956, "T5": 0.97}
LOGIC = {"T1": 0.01, "T2": 0.982, "T3": 0.985, "T4": 0.0, "T5": 0.0}

READING = (
    "Δθ, Δd, N and the surveillance volume are not given; 20°, 20 km, 2 votes and 1 to 40 km are assumed"
)
FITTED = "with the allowance for noise and the fit in space, which the paper does not have"
LITERAL = "as the paper describes it; the published failure does not follow"
IN_PLANES = "with a speed of 50 m/s demanded in each plane; with a quarter of the noise it fails wholly"

WAYS: tuple[tuple[str, str, dict[str, float] | None, str], ...] = (
    ("combinatorial, as described", "cht-document", COMBINATORIAL, READING),
    ("combinatorial, sound", "cht", None, FITTED),
    ("gates and logic, as described", "logic", None, LITERAL),
    ("gates and logic, speed in each plane", "logic-in-planes", LOGIC, IN_PLANES),
)
FURTHER = (
    ("false_tracks_per_trial", "the paper leaves it out"),
    ("pure_track_ratio", "the paper leaves it out"),
)


def _table() -> PublishedTable:
    entries = []
    for words, initiator, published, note in WAYS:
        for target in COMBINATORIAL:
            case = f"{target}, {words}"
            figure = published[target] if published is not None else None
            entries.append(Entry(case, "table-2", initiator, "success_rate", figure, note, world=target))
            for metric, said in FURTHER:
                entries.append(Entry(case, "table-2", initiator, metric, None, said, world=target))
    return PublishedTable(
        name="par-2",
        title="Table 2: probability of true track initiation by target, 4 scans, λ = 20",
        source="Wang and Zhao, Electronics Optics & Control 21(1), 2014",
        set_name="par-table-2",
        trials=1000,
        rounding=0.0005,
        entries=tuple(entries),
    )


TABLES = (_table(),)
