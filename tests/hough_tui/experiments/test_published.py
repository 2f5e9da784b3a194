import numpy as np
import pytest

from algorithms.errors import RequestError
from hough_tui.experiments.engine import Job
from hough_tui.experiments.published import compare, is_consistent, plan_table, published_table

TRIALS = 600

# Success and mean false ratio in %, 4,000 trials of an independent implementation.
REFERENCE = {
    "course-2-1": {5: (100.0, 88.2), 10: (99.8, 70.8), 15: (99.6, 34.5)},
    "course-2-2": {5: (33.4, 65.2), 10: (74.6, 23.9), 15: (93.6, 5.9)},
}


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
        case = f"{table.initiator}, {scans} scans"
        for metric, expected in (("success_rate", success), ("false_track_ratio", false)):
            row = rows[case, metric]
            half = (row["ci95"][1] - row["ci95"][0]) / 2
            # Four standard errors, and the rounding of the reference.
            assert row["measured"] == pytest.approx(expected / 100, abs=2.05 * half + 0.0015)
            assert row["consistent"] is True
            assert row["published"] is not None
        assert rows[f"{case}, θ within 6°", "success_rate"]["published"] is None
        assert rows[f"{case}, θ within 6°", "success_rate"]["consistent"] is None
    control = rows[f"{table.initiator}, 5 scans", "success_control"]
    assert control["measured"] > (0.99 if name == "course-2-1" else 0.05)


def test_consistency_takes_the_published_trial_count_into_account():
    values = (np.arange(4000) < 3000).astype(float)
    assert is_consistent(0.70, 100, 0.0005, values) is True
    assert is_consistent(0.70, 4000, 0.0005, values) is False
    assert is_consistent(0.60, 100, 0.0005, values) is False
    assert is_consistent(None, 100, 0.0005, values) is None


def test_a_rate_of_one_is_consistent_with_one_and_not_with_nine_tenths():
    assert is_consistent(1.0, 100, 0.0005, np.ones(1000)) is True
    assert is_consistent(0.9, 100, 0.0005, np.ones(1000)) is False


def test_an_unknown_table_is_named_with_those_known():
    with pytest.raises(RequestError, match="did you mean 'course-2-2'"):
        published_table("course-2-3")
