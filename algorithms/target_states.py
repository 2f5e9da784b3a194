"""True states of targets: where each is and how it moves at every scan of every trial."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TargetStates:
    """The true states of the targets of a chunk of trials, scan by scan; d is 2 in the plane, 3 in space.

    This table is what plots are measured from, what pictures and files show as the truth, and what metrics
    of tracks compare with. Chance is in it: where each target began, and the noise of its motion.

    Attributes
    ----------
    time : float64 (scans,), of the scans of all sensors, rising; the scan of a plot is an index of it
    present : bool (scans, targets), whether a target is there in a scan, the same in all trials
    position, velocity : float64 (trials, scans, targets, d); NaN where a target is not there
    shift : float64 (trials, targets, d), how far from its declared position each target began
    """

    time: Array
    present: NDArray[np.bool_]
    position: Array
    velocity: Array
    shift: Array

    def paths(self, trial: int) -> tuple[Array, ...]:
        """Return the positions, (n, d), of each target of a trial in the n scans in which it is there."""
        return tuple(self.position[trial, present, target] for target, present in enumerate(self.present.T))
