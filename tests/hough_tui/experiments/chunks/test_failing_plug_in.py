"""A compiled plug-in that fails in one trial of a chunk: that trial is named, in a run and in a look."""

import re
from dataclasses import replace

import numpy as np
import pytest

from algorithms.initiators.guard import Origin, PlugInError, guard
from algorithms.initiators.registry import initiator
from hough_tui.experiments.engines.threads import Job
from hough_tui.experiments.plan import plan_run
from hough_tui.inspection.trial import look, picture
from scenarios.files.set_files import load_set

TRIAL = 13


@pytest.fixture
def plan(monkeypatch):
    """Return a plan whose initiator returns a wrong track in one trial."""
    plan = plan_run([load_set("course-report")], experiments=["tables"], trials=20)
    cell = plan.cells[0]
    first_plot = picture(cell.scenario, cell.experiment.seed, TRIAL).plots.position[0]

    class Failing(type(initiator("standard"))):
        def initiate_chunk(self, chunk, context, parameters):
            tracks = super().initiate_chunk(chunk, context, parameters)
            starts = chunk.position[chunk.offsets[:-1]]
            wrong = np.flatnonzero((starts == first_plot).all(axis=1))
            theta = tracks.theta.copy()
            theta[tracks.offsets[wrong]] = 4.0
            return replace(tracks, theta=theta)

    algorithm = Failing()
    guard(algorithm, Origin("failing", f"{__name__}:Failing"))
    monkeypatch.setattr("scenarios.entries.initiator", lambda name: algorithm)
    return plan


def test_a_run_names_the_trial_that_fails(plan):
    with pytest.raises(PlugInError) as caught:
        Job(plan, 2).wait()
    message = str(caught.value)
    assert re.match(
        rf"set course-report, scenario \S+, seed {plan.cells[0].experiment.seed}, trial 13: ", message
    )
    assert "plug-in 'failing'" in message
    assert re.search(r"initiate_chunk: track 0 has θ = 4; .* \(.*test_failing_plug_in\.py:\d+\)", message)


def test_a_look_names_the_trial_that_fails(plan):
    cell = plan.cells[0]
    for trial in (TRIAL - 1, TRIAL):
        seen = picture(cell.scenario, cell.experiment.seed, trial)
        if trial == TRIAL:
            with pytest.raises(PlugInError, match="trial 13: plug-in 'failing'"):
                look(seen, cell.entry, cell.parameters, None)
        else:
            assert look(seen, cell.entry, cell.parameters, None).total
