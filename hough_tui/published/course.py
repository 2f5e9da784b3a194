"""Tables 2-1 and 2-2 of the course report: standard and sequential Hough transform by number of scans."""

from __future__ import annotations

from hough_tui.published.tables import Entry, PublishedTable


def _table(number: str, initiator: str, published: dict[int, tuple[float, float]]) -> PublishedTable:
    entries: list[Entry] = []
    for scans, (success, false) in published.items():
        case, swept = f"{initiator}, {scans} scans", {"scans": scans}
        sound = f"{case}, θ within 6°"
        for name, experiment, metric, figure, note in (
            (case, "tables", "success_rate", success, None),
            (case, "tables", "false_track_ratio", false, None),
            (case, "tables", "success_control", None, "the same draws without targets"),
            (sound, "tables-sound", "success_rate", None, "sound criterion"),
            (sound, "tables-sound", "false_track_ratio", None, "sound criterion"),
            (sound, "tables-sound", "success_control", None, "sound criterion, without targets"),
        ):
            entries.append(Entry(name, experiment, initiator, metric, figure, note, dict(swept)))
    return PublishedTable(
        name=f"course-{number}",
        title=f"Table {number}: {initiator} Hough transform, by number of scans",
        source="course report, Northwestern Polytechnical University, 2018",
        set_name="course-report",
        trials=100,
        rounding=0.0005,
        entries=tuple(entries),
    )


TABLES = (
    _table("2-1", "standard", {5: (1.0, 0.883), 10: (0.995, 0.709), 15: (1.0, 0.329)}),
    _table("2-2", "sequential", {5: (0.285, 0.71), 10: (0.695, 0.29), 15: (0.92, 0.07)}),
)
