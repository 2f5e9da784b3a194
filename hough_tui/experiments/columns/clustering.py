"""Per-trial columns of clustering."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from hough_tui.experiments.columns.schema import Column, Columns, Listed

TARGETS = "targets"
"""Second axis."""

EXCESS = Column(np.int32, is_required=True, listed=Listed("excess", "excess"))
SQUARED_ERROR = Column(
    np.float64, TARGETS, np.nan, is_required=True, listed=Listed("error", "error", 2, np.sqrt)
)


@dataclass(frozen=True, slots=True)
class ClusterColumns(Columns):
    """What each trial of a cell of clustering gave.

    Attributes
    ----------
    excess : number of clusters less number of targets
    squared_error : squared distance of each target's centre from the nearest plot, in cells; NaN in a
        trial without plots
    """

    excess: Annotated[NDArray[np.int32], EXCESS]
    squared_error: Annotated[NDArray[np.float64], SQUARED_ERROR]

    @property
    def clusters(self) -> NDArray[np.int32]:
        """Number of clusters of each trial."""
        return self.excess + np.int32(self.squared_error.shape[1])

    @property
    def trial_square(self) -> NDArray[np.float64]:
        """Mean squared error over the targets of each trial; NaN without plots, or without targets."""
        if self.squared_error.shape[1] == 0:
            return np.full(len(self), np.nan)
        mean: NDArray[np.float64] = self.squared_error.mean(axis=1)
        return mean
