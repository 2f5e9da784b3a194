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
    effort: Annotated[dict[str, NDArray[np.int64]], Column(np.int64, is_family=True)]
