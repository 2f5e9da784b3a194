"""Per-trial columns of initiation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.schema import Column, Columns

TARGETS = "targets"
CONTROL = "control"
"""Second axes: the targets; the targets where the experiment has a control, else nothing."""


@dataclass(frozen=True, slots=True)
class TrialColumns(Columns):
    """What each trial of a cell of initiation gave.

    Attributes
    ----------
    found : whether each target was found
    tracks, false, duplicates : numbers of tracks
    theta_error, rho_error : of each target, radians and the unit of length; NaN where it was not found
    votes_outside : votes outside the grid
    control_found : whether the draw without targets seems to have each target; without targets on its
        axis where the experiment has no control
    mixed : matching tracks with plots of several origins; −1 where the plots of tracks are not at hand
    scans_to_initiate : scans from each target's first to the confirmation of a track on it; −1 where none
    position_error, velocity_error, cross_track_error : of the track that stands for each target, in the
        unit of length and a second; NaN where there is none, or states are not judged
    nees : of its state, likewise
    gospa_localisation, gospa_missed, gospa_false : parts of the squared GOSPA distance; NaN where states
        are not judged
    effort : what the initiator counted of its work, by name
    """

    found: Annotated[NDArray[np.bool_], Column(np.bool_, TARGETS, is_required=True)]
    tracks: Annotated[NDArray[np.int32], Column(np.int32, is_required=True)]
    false: Annotated[NDArray[np.int32], Column(np.int32, is_required=True)]
    duplicates: Annotated[NDArray[np.int32], Column(np.int32, is_required=True)]
    theta_error: Annotated[NDArray[np.float32], Column(np.float32, TARGETS, np.nan, is_required=True)]
    rho_error: Annotated[NDArray[np.float32], Column(np.float32, TARGETS, np.nan, is_required=True)]
    votes_outside: Annotated[NDArray[np.int64], Column(np.int64, is_required=True)]
    control_found: Annotated[NDArray[np.bool_], Column(np.bool_, CONTROL, is_required=True)]
    mixed: Annotated[NDArray[np.int32], Column(np.int32, fill=-1)]
    scans_to_initiate: Annotated[NDArray[np.int32], Column(np.int32, TARGETS, -1)]
    position_error: Annotated[NDArray[np.float32], Column(np.float32, TARGETS, np.nan)]
    velocity_error: Annotated[NDArray[np.float32], Column(np.float32, TARGETS, np.nan)]
    cross_track_error: Annotated[NDArray[np.float32], Column(np.float32, TARGETS, np.nan)]
    nees: Annotated[NDArray[np.float32], Column(np.float32, TARGETS, np.nan)]
    gospa_localisation: Annotated[NDArray[np.float32], Column(np.float32, fill=np.nan)]
    gospa_missed: Annotated[NDArray[np.float32], Column(np.float32, fill=np.nan)]
    gospa_false: Annotated[NDArray[np.float32], Column(np.float32, fill=np.nan)]
    effort: Annotated[dict[str, NDArray[np.int64]], Column(np.int64, is_family=True)]
