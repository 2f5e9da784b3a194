"""Plug-ins that fail or return what they must not: one message names plug-in, cause and line."""

import pickle
import re
from dataclasses import replace

import numpy as np
import pytest

from algorithms.context import Context
from algorithms.errors import RequestError, WorkFailedError
from algorithms.initiators.base import ChunkInitiator, Initiator
from algorithms.initiators.guard import LONGEST, Origin, PlugInError, guard, located
from algorithms.parameters import Parameters
from algorithms.plots import PlotChunk
from algorithms.tracks import TrackChunk, Tracks, TrackStates

SCANS = 4
CONTEXT = Context(SCANS, 4.0)
CHUNK = PlotChunk(
    np.tile(np.repeat(np.arange(SCANS, dtype=np.int32), 2), 3),
    np.tile(np.repeat(np.arange(SCANS) * 4.0, 2), 3),
    np.arange(48.0).reshape(24, 2),
    np.array([0, 8, 16, 24]),
)
ORIGIN = Origin("theirs", f"{__name__}:Thing", "their-package 1.2")


def tracks(**changed):
    """Return two tracks, with columns changed."""
    whole = Tracks(
        np.array([0.0, 3.1]),
        np.array([-5.0, 5.0]),
        np.ones(2),
        (np.array([0, 2]), np.array([1, 3, 7])),
        TrackStates.open(2, 2),
        np.array([1, 3]),
    )
    return replace(whole, **changed)


def chunk_tracks(**changed):
    """Return the tracks of three trials: two, none and one."""
    whole = TrackChunk(
        np.array([0, 2, 2, 3]),
        np.array([0.0, 1.0, 3.1]),
        np.zeros(3),
        np.ones(3),
        np.zeros(3, np.int64),
        np.array([[0, 2, -1], [1, 3, 5], [7, -1, -1]]),
    )
    return replace(whole, **changed)


def states(**changed):
    return TrackStates.open(2, 2)._replace(**changed)


class Own(Initiator):
    name = "theirs"
    summary = "returns what it is told to"
    parameters = Parameters

    def __init__(self, returned):
        self.returned = returned

    def initiate(self, plots, context, parameters):
        if isinstance(self.returned, BaseException):
            raise self.returned
        return self.returned


class OwnChunk(ChunkInitiator):
    name = "theirs"
    summary = "returns what it is told to"
    parameters = Parameters

    def __init__(self, returned):
        self.returned = returned

    def initiate_chunk(self, chunk, context, parameters):
        return replace(self.returned, plots=None) if isinstance(self.returned, TrackChunk) else self.returned

    def associate_chunk(self, chunk, tracks, context, parameters):
        return self.returned


def initiated(returned, dimensions=2):
    algorithm = Own(returned)
    algorithm.dimensions = dimensions
    guard(algorithm, ORIGIN)
    return algorithm.initiate(CHUNK.trial(0), CONTEXT, Parameters())


def initiated_chunk(returned):
    algorithm = OwnChunk(returned)
    guard(algorithm, ORIGIN)
    return algorithm.tracks_of_chunk(CHUNK, CONTEXT, Parameters(), plots=True, states=False)


WRONG = [
    ([], "it returned list, not Tracks"),
    (None, "it returned NoneType, not Tracks"),
    (tracks(theta=np.array([0.0, np.pi])), "track 1 has θ = 3.14159; it must lie in [0, π)"),
    (tracks(theta=np.array([-0.1, 3.0])), "track 0 has θ = -0.1;"),
    (tracks(theta=np.array([0.1, np.nan])), "track 1 has θ = nan;"),
    (tracks(rho=np.array([0.1, np.inf])), "track 1 has ρ = inf; it must be a finite number"),
    (tracks(score=np.array([np.nan, 1])), "track 0 has the score = nan;"),
    (tracks(rho=np.zeros(3)), "its rho has the shape (3,); it must be (2,)"),
    (tracks(theta=5.0), "its theta is float, not a column"),
    (tracks(score=["many", "few"]), "its score holds something else than numbers"),
    (tracks(plots=(np.array([0]),)), "it returned 2 tracks and the plots of 1"),
    (tracks(plots=(np.array([0]), np.array([8]))), "track 1 names plot 8, and the batch has 8 plots"),
    (tracks(plots=(np.array([-1, 0]), np.array([7]))), "track 0 names plot -1,"),
    (tracks(plots=(np.array([0, 1]), np.array([7]))), "track 0 has two plots of scan 0; one is allowed"),
    (tracks(plots=(np.array([2, 0]), np.array([7]))), "the plots of track 0 are not in the order"),
    (tracks(plots=(np.array([2.0]), np.array([7]))), "its list of plots of track 0 holds float64"),
    (tracks(states=None), "its states are NoneType, not TrackStates"),
    (tracks(states=TrackStates.open(2, 3)), "its position has the shape (2, 3); it must be (2, 2)"),
    (tracks(states=states(velocity=np.array([[0, 0], [np.inf, 0]]))), "the velocity of track 1 is infinite"),
    (tracks(confirmed_scan=np.array([0, SCANS])), "track 1 is confirmed in scan 4; it must be one of 0 to 3"),
]


@pytest.mark.parametrize(("returned", "words"), WRONG, ids=[words for _, words in WRONG])
def test_wrong_tracks_are_refused_in_words(returned, words):
    with pytest.raises(PlugInError) as caught:
        initiated(returned)
    message = str(caught.value)
    assert message.startswith(f"plug-in 'theirs' ({__name__}:Thing, their-package 1.2): initiate: ")
    assert words in message
    assert re.search(r"\(.*test_guard\.py:\d+\); mend the plug-in$", message)


WRONG_CHUNKS = [
    (5, "it returned int, not a TrackChunk"),
    (chunk_tracks(offsets=np.array([0, 2, 3])), "its offsets has the shape (3,); it must be (4,)"),
    (chunk_tracks(offsets=np.array([0, 2, 1, 3])), "its offsets must rise from 0 to the number of tracks, 3"),
    (chunk_tracks(offsets=np.array([0, 0, 0, 2])), "its offsets must rise"),
    (chunk_tracks(theta=np.array([0, 1, np.nan])), "track 2 has θ = nan;"),
    (chunk_tracks(votes_outside=np.zeros(2, int)), "its votes_outside has the shape (2,); it must be (3,)"),
    (chunk_tracks(plots=np.array([[0], [1], [8]])), "track 2 names plot 8, and the batch has 8 plots"),
    (chunk_tracks(plots=np.array([[0, 1], [1, -1], [7, -1]])), "track 0 has two plots of scan 0"),
    (chunk_tracks(plots=np.array([0, 1, 7])), "its plots has the shape (3,); it must be (3, 1)"),
    (chunk_tracks(effort={"pairs": np.zeros(3)}), "its effort pairs holds float64, not whole numbers"),
    (chunk_tracks(confirmed_scan=np.array([0, -1, 0])), "track 1 is confirmed in scan -1"),
]


@pytest.mark.parametrize(("returned", "words"), WRONG_CHUNKS, ids=[words for _, words in WRONG_CHUNKS])
def test_wrong_tracks_of_a_chunk_are_refused_in_words(returned, words):
    with pytest.raises(PlugInError, match=re.escape(words)):
        initiated_chunk(returned)


def test_right_tracks_come_as_arrays_of_their_types():
    returned = initiated(tracks(theta=[0, 3], score=[1, 2], plots=[[], [1, 3]]))
    assert returned.theta.dtype == returned.score.dtype == np.float64
    assert [rows.dtype for rows in returned.plots] == [np.int64, np.int64]
    assert [rows.tolist() for rows in returned.plots] == [[], [1, 3]]
    assert initiated_chunk(chunk_tracks()).counts.tolist() == [2, 0, 1]
    nothing = Tracks([], [], [], (), TrackStates.open(0, 2), np.zeros(0, int))
    assert len(initiated(nothing)) == 0


def test_a_motion_straight_up_has_no_line():
    upright = {"theta": np.array([np.nan, 1]), "rho": np.array([np.nan, 1])}
    in_space = tracks(states=TrackStates.open(2, 3), **upright)
    assert np.isnan(initiated(in_space, dimensions=3).theta[0])
    with pytest.raises(PlugInError, match="θ = nan"):
        initiated(tracks(**upright))


class OwnError(Exception):
    def __init__(self, first, second):
        super().__init__(f"{first}\n  and {second}")


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ZeroDivisionError("division by zero"), "ZeroDivisionError: division by zero"),
        (KeyError("speed"), "KeyError: 'speed'"),
        (OwnError("one", "other"), "OwnError: one and other"),
        (SystemExit(0), "SystemExit: 0"),
        (AssertionError(), "AssertionError"),
        (RuntimeError("x" * 2 * LONGEST), f"RuntimeError: {'x' * LONGEST}…"),
    ],
)
def test_an_exception_names_plug_in_and_line(error, words):
    with pytest.raises(PlugInError) as caught, located("scenario one, trial 7"):
        initiated(error)
    message = str(caught.value)
    assert message.startswith(f"scenario one, trial 7: {ORIGIN}: {words} (")
    assert re.search(r"test_guard\.py:\d+\); mend the plug-in$", message)
    assert isinstance(caught.value, WorkFailedError)
    # It comes back whole from a worker process, whatever the plug-in's own exception is made of.
    assert str(pickle.loads(pickle.dumps(caught.value))) == message


class OwnRequestError(RequestError):
    def __init__(self, first, second):
        super().__init__(f"{first} {second}")


def test_a_wrong_request_passes():
    with pytest.raises(RequestError, match=r"^give more$") as caught, located("trial 7"):
        initiated(OwnRequestError("give", "more"))
    assert type(pickle.loads(pickle.dumps(caught.value))) is RequestError


def test_parameters_that_cannot_be_resolved_name_the_plug_in():
    class Unresolved(Parameters):
        def resolved(self, context):
            return 1 / 0

    class PlugIn(Own):
        parameters = Unresolved

    guard(PlugIn(tracks()), ORIGIN)
    with pytest.raises(PlugInError, match="ZeroDivisionError"):
        Unresolved().resolved(CONTEXT)
    assert Parameters().resolved(CONTEXT) == Parameters()
