import numpy as np
import pytest

from algorithms.errors import RequestError
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.metrics.metric import Sample
from hough_tui.experiments.metrics.registry import METRICS
from hough_tui.published.comparison import (
    TABLES,
    compare,
    is_consistent_mean,
    is_consistent_rate,
    plan_table,
    published_table,
)
from scenarios.files.set_files import load_set

TRIALS = 600

# Success and mean false ratio in %, 4,000 trials of an independent implementation.
REFERENCE = {
    "course-2-1": {5: (100.0, 88.2), 10: (99.8, 70.8), 15: (99.6, 34.5)},
    "course-2-2": {5: (33.4, 65.2), 10: (74.6, 23.9), 15: (93.6, 5.9)},
}

# θ mean square errors in 1e-6 rad², 1,000 trials of an independent implementation: binary votes, least
# deviation with T1 = 40 and 50; by σ in km, by σ, by the number of clutter plots.
THETA_MSE = {
    "thesis-3-1": {"0.1 km": (2.9, 2.2, 2.4), "0.2 km": (25, 14, 5.8), "0.3 km": (78, 53, 34)},
    "thesis-3-2": {"0.1 km": (5.7, 2.2, 1.9), "0.2 km": (28, 8.0, 13), "0.3 km": (80, 32, 38)},
    "thesis-3-3": {"78": (3.8, 1.6, 2.1), "156": (4.8, 2.7, 1.8), "234": (5.8, 2.8, 2.5)},
}

# Mean P_D, duplicates and false tracks a trial, 500 trials of an independent implementation.
FIVE_TARGETS = {
    (20, 376): {
        "binary votes": (0.994, 16, 14),
        "binary, thesis extraction": (0.984, 2.6, 5.2),
        "binary, best-first": (0.956, 0, 2.8),
        "binary, vote removal": (0.950, 0, 0.27),
        "weighted votes": (0.796, 3.9, 3.9),
        "weighted, thesis extraction": (0.750, 0.33, 3.0),
    },
    (40, 475): {
        "binary votes": (1.0, 10, 0.66),
        "binary, thesis extraction": (1.0, 0.59, 0.13),
        "binary, best-first": (1.0, 0, 0),
        "binary, vote removal": (0.992, 0, 0),
        "weighted votes": (0.978, 10, 1.4),
        "weighted, thesis extraction": (0.972, 0.81, 0.44),
    },
}


def measured(name, trials):
    """Return the document of a table, and the standard deviation of each figure's per-trial values."""
    table = published_table(name)
    job = Job(plan_table(table, trials), 2)
    job.wait()
    found = {
        (cell.experiment.name, cell.entry.name, tuple(cell.swept.items())): Sample(cell, columns, seconds)
        for cell, columns, seconds in job.finished()
    }
    spreads = [
        np.nanstd(
            METRICS[entry.metric].per_trial(found[entry.experiment, entry.method, tuple(entry.swept.items())])
        )
        for entry in table.entries
    ]
    return compare(table, job), spreads


@pytest.mark.parametrize("name", REFERENCE)
def test_the_tables_of_the_course_report(name):
    table = published_table(name)
    job = Job(plan_table(table, TRIALS), 2)
    job.wait()
    document = compare(table, job)
    assert document["table"] == name
    assert document["trials"] == TRIALS
    rows = {(row["case"], row["metric"]): row for row in document["rows"]}
    for scans, (success, false) in REFERENCE[name].items():
        case = f"{table.entries[0].method}, {scans} scans"
        for metric, expected in (("success_rate", success), ("false_track_ratio", false)):
            row = rows[case, metric]
            half = (row["ci95"][1] - row["ci95"][0]) / 2
            # Four standard errors, and the rounding of the reference.
            assert row["measured"] == pytest.approx(expected / 100, abs=2.05 * half + 0.0015)
            assert row["consistent"] is True
            assert row["published"] is not None
        assert rows[f"{case}, θ within 6°", "success_rate"]["published"] is None
        assert rows[f"{case}, θ within 6°", "success_rate"]["consistent"] is None
    control = rows[f"{table.entries[0].method}, 5 scans", "success_control"]
    assert control["measured"] > (0.99 if name == "course-2-1" else 0.05)


def test_consistency_takes_the_published_trial_count_into_account():
    values = (np.arange(4000) < 3000).astype(float)
    assert is_consistent_rate(0.70, 100, 0.0005, values) is True
    assert is_consistent_rate(0.70, 4000, 0.0005, values) is False
    assert is_consistent_rate(0.60, 100, 0.0005, values) is False
    # The standard deviation is .433: two of them over ten are .085.
    assert is_consistent_mean(0.67, 100, 0.0, values)
    assert not is_consistent_mean(0.66, 100, 0.0, values)


def test_a_rate_of_one_is_consistent_with_one_and_not_with_nine_tenths():
    assert is_consistent_rate(1.0, 100, 0.0005, np.ones(1000)) is True
    assert is_consistent_rate(0.9, 100, 0.0005, np.ones(1000)) is False


def test_no_interval_of_few_trials_reaches_below_0():
    table = published_table("thesis-3-1")
    job = Job(plan_table(table, 20), 2)
    job.wait()
    intervals = [row["ci95"] for row in compare(table, job)["rows"] if row["ci95"] is not None]
    assert min(low for low, _ in intervals) == 0.0


def test_an_unknown_table_is_named_with_those_known():
    with pytest.raises(RequestError, match="did you mean 'course-2-2'"):
        published_table("course-2-3")


@pytest.mark.parametrize("name", THETA_MSE)
def test_the_angle_errors_of_the_thesis(name):
    trials = 1000
    document, spreads = measured(name, trials)
    rows = iter(zip(document["rows"], spreads, strict=True))
    for case, expected in THETA_MSE[name].items():
        for figure, (row, spread) in zip(expected, rows, strict=False):
            assert case in row["case"]
            assert row["metric"] == "theta_mse"
            # Four standard errors of the difference of two means, and half a digit of the reference.
            # Where none of ours missed the nearest row of θ, one miss of .0163 rad would be no surprise.
            scatter = max(spread, 0.0163**2 / np.sqrt(trials))
            margin = 4.0 * scatter * np.sqrt(1.0 / row["trials_counted"] + 1.0 / 1000) + 0.5e-6
            assert row["measured"] == pytest.approx(figure * 1e-6, abs=margin)
            assert row["published"] > 0.0
        for _ in range(2):
            next(rows)
        row, _ = next(rows)
        assert (row["metric"], row["consistent"]) == ("rho_mse", None)
        assert "no frame" in row["note"]


def test_five_targets_by_the_way_of_taking_peaks():
    trials = 300
    document, spreads = measured("thesis-five-targets", trials)
    rows = {
        (row["case"], row["metric"]): (row["measured"], spread)
        for row, spread in zip(document["rows"], spreads, strict=True)
    }
    assert len(rows) == 90
    for (scans, count), ways in FIVE_TARGETS.items():
        for way, figures in ways.items():
            case = f"{scans} scans, {count} clutter plots, {way}"
            metrics = ("success_rate", "duplicates_per_trial", "false_tracks_per_trial")
            for metric, figure in zip(metrics, figures, strict=True):
                found, spread = rows[case, metric]
                # Four standard errors; where no trial scatters, one trial that did would not be a surprise.
                error = max(spread, 1.0 / np.sqrt(trials)) * np.sqrt(1.0 / trials + 1.0 / 500)
                digit = 0.5 if figure >= 10 else 0.05 if figure >= 1 else 0.005
                margin = 0.01 if metric == "success_rate" else 0.05 * figure
                assert found == pytest.approx(figure, abs=4.0 * error + digit + margin), (case, metric)


def test_every_figure_has_its_cell_in_a_bundled_set():
    for table in TABLES.values():
        given = load_set(table.set_name)
        experiments = {experiment.name: experiment for experiment in given.experiments}
        for entry in table.entries:
            experiment = experiments[entry.experiment]
            worlds, *_, methods = (given.chosen(experiment, part) for part in experiment.parts)
            assert entry.method in [found.name for found in methods]
            assert entry.world is None or entry.world in [found.name for found in worlds]
            assert set(entry.swept) == set(experiment.sweep)
            assert all(entry.swept[key] in experiment.sweep[key] for key in entry.swept)
            assert entry.metric in METRICS


def test_counts_and_centroids_by_kind_of_scene():
    document = measured_alone("clustering", 200)
    rows = {(row["case"], row["metric"]): row for row in document["rows"]}
    assert len(rows) == 2 * 4 * 7
    judged = [row for row in rows.values() if row["consistent"] is not None]
    assert len(judged) == 18
    assert all(row["metric"] == "count_exact_rate" and row["consistent"] for row in judged)
    for scene in {row["case"].partition(",")[0] for row in document["rows"]}:
        ours, known = (
            rows[f"{scene}, {method}", "centroid_rmse"]["measured"] for method in ("recommended", "k-means")
        )
        assert ours <= 1.1 * known
        assert rows[f"{scene}, recommended", "count_exact_rate"]["measured"] >= 0.97


def measured_alone(name, trials):
    """Return the document of a table."""
    table = published_table(name)
    job = Job(plan_table(table, trials), 2)
    job.wait()
    return compare(table, job)
