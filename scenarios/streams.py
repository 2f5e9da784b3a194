"""Which numbers of the counter-based streams each source of plots draws, so that none is drawn twice.

A stream is named by its source and sensor; in it, numbers are counted by scan and block. The clutter of a
sensor and each target have streams of their own, so that a draw without targets has the same clutter, and a
draw of fewer scans is the first part of one of more.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from algorithms.compiled import kernel

# Blocks of a target's stream in a scan. Its start is drawn in scan 0 of the first sensor alone, and so
# are its accelerations, with intervals since its birth in place of scans.
SEEN, NOISE, START, START_IN_SPACE, NOISE_IN_SPACE, ACCELERATION, ACCELERATION_IN_SPACE = 0, 1, 2, 3, 4, 5, 6

POINTS = 16
"""First block of a target's stream in a scan from which its points are drawn, two blocks a point."""

SENSOR = 1 << 20
"""Distance of the streams of one sensor from those of the next."""

CLUTTER_POINTS = SENSOR - 2
"""Stream of a sensor, beyond those of its targets, that gives Doppler and amplitude of clutter."""

IN_SPACE = 1 << 31
"""Distance of the block of a third number of a clutter plot's place from that of the first two."""


class Streams(NamedTuple):
    """Which trials are drawn.

    Attributes
    ----------
    seed : uint64
    first_trial, trials : consecutive trials, numbered from 0
    """

    seed: np.uint64
    first_trial: int
    trials: int


@kernel
def target_stream(target, sensor):  # type: ignore[no-untyped-def]
    """Return the stream of a target as a sensor sees it."""
    return 2 * target + 1 + SENSOR * sensor


@kernel
def clutter_stream(source, sensor):  # type: ignore[no-untyped-def]
    """Return the stream of a source of clutter in the scans of a sensor."""
    return 2 * source + SENSOR * sensor
