"""Per-trial columns of initiation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.schema import Column, Columns, Listed

TARGETS = "targets"
CONTROL = "control"
"""Second axes: the targets; the targets where the experiment has a control, else nothing."""

Flags = NDArray[np.bool_]
Counts = NDArray[np.int32]
Many = NDArray[np.int64]
Numbers = NDArray[np.float32]

FOUND = Column(np.bool_, TARGETS, is_required=True, listed=Listed("found", "failed first"))
TRACKS = Column(np.int32, is_required=True, listed=Listed("tracks", "tracks"))
FALSE = Column(np.int32, is_required=True, listed=Listed("false", "false tracks"))
DUPLICATES = Column(np.int32, is_required=True, listed=Listed("dupl.", "duplicates"))
THETA_ERROR = Column(
    np.float32, TARGETS, np.nan, is_required=True, listed=Listed("Δθ °", "error in θ", 2, np.degrees)
)
RHO_ERROR = Column(np.float32, TARGETS, np.nan, is_required=True, listed=Listed("Δρ", "error in ρ", 3))
OUTSIDE = Listed("votes\noutside", "votes outside", is_hidden_at_zero=True)
VOTES_OUTSIDE = Column(np.int64, is_required=True, listed=OUTSIDE)
CONTROL_FOUND = Column(np.bool_, CONTROL, is_required=True, listed=Listed("control", "control"))
MIXED = Column(np.int32, fill=-1)
SCANS_TO_INITIATE = Column(np.int32, TARGETS, -1)


def _error(listed: Listed) -> Column:
    """Return the declaration of an error of each target, which is NaN where states are not judged."""
    return Column(np.float32, TARGETS, np.nan, listed=listed)


POSITION_ERROR = _error(Listed("position", "error in position", 3))
VELOCITY_ERROR = _error(Listed("velocity", "error in velocity", 4))
CROSS_TRACK_ERROR = _error(Listed("across", "error across", 3))
NEES = _error(Listed("NEES", "NEES", 1))

GOSPA_PART = Column(np.float32, fill=np.nan)
EFFORT = Column(np.int64, is_family=True)


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

    found: Annotated[Flags, FOUND]
    tracks: Annotated[Counts, TRACKS]
    false: Annotated[Counts, FALSE]
    duplicates: Annotated[Counts, DUPLICATES]
    theta_error: Annotated[Numbers, THETA_ERROR]
    rho_error: Annotated[Numbers, RHO_ERROR]
    votes_outside: Annotated[Many, VOTES_OUTSIDE]
    control_found: Annotated[Flags, CONTROL_FOUND]
    mixed: Annotated[Counts, MIXED]
    scans_to_initiate: Annotated[Counts, SCANS_TO_INITIATE]
    position_error: Annotated[Numbers, POSITION_ERROR]
    velocity_error: Annotated[Numbers, VELOCITY_ERROR]
    cross_track_error: Annotated[Numbers, CROSS_TRACK_ERROR]
    nees: Annotated[Numbers, NEES]
    gospa_localisation: Annotated[Numbers, GOSPA_PART]
    gospa_missed: Annotated[Numbers, GOSPA_PART]
    gospa_false: Annotated[Numbers, GOSPA_PART]
    effort: Annotated[dict[str, Many], EFFORT]
